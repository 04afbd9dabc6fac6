# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Results made by hand from simulated recordings: what a report is made of, without a fit."""

from dataclasses import replace

import numpy as np

from pam_ros.effects import EFFECTS
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.solve import FitLog, FitStatus
from pam_ros.identification.identification import Identification
from pam_ros.identification.result import Candidate, Estimate, Finding, Stage, Verdict
from pam_ros.identification.structure import Structure
from pam_ros.recording.recording import Recording
from pam_ros.report.provenance import provenance
from pam_ros.rig.arrangements import LOAD
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.settings.inputs import Inputs
from pam_ros.settings.nominal import NominalJoint
from pam_ros.settings.rig import RigParameters

NOISE = 5e-5  # m
SECONDS = 20.0  # long enough to see all that a report shows, also as plain Python
DECLARED = {'mass': 20.0, 'zeta': 0.15}
FRICTION = {'effects.coulomb_friction.level': 14.0}
PRESET = 'dmsp_20_400n'


def commands(seconds, rate, seed=0):
    """Return stamps and pressures of steps, a slow triangle and a multisine, a third each."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * rate)) / rate
    third = t.size // 3
    steps = np.repeat(rng.uniform(2.2e5, 4.8e5, 1 + third // round(1.5 * rate)), round(1.5 * rate))
    x = np.linspace(0.0, 2.0, third, endpoint=False)
    triangle = 2.2e5 + 2.6e5 * (1.0 - np.abs(1.0 - x))
    rest = t[: t.size - 2 * third]
    sines = sum(np.sin(2.0 * np.pi * f * rest + rng.uniform(0, 6)) for f in (0.3, 0.7, 1.6, 3.1))
    return t, np.concatenate([steps[:third], triangle, 3.5e5 + 3e4 * sines])


def free_recording(model, seconds=SECONDS, rate=200.0, seed=0, name='bench.csv', gap=False):
    """Return a recording of a free rig with white noise on its position."""
    t, command = commands(seconds, rate, seed)
    y = simulate(model, t, command).position
    y = y + NOISE * np.random.default_rng(seed + 1).standard_normal(t.size)
    whole = Recording(name, t, t, command, y, digest=64 * 'a')
    if not gap:
        return whole
    keep = (t < 0.4 * seconds) | (t > 0.42 * seconds)
    gaps = ((float(t[keep][t[keep] < 0.4 * seconds][-1]), float(t[t > 0.42 * seconds][0])),)
    return replace(whole, t=t[keep], position=y[keep], gaps=gaps, warnings=('1 gap(s)',))


def held_recording(model, kappa, seconds=SECONDS, rate=100.0, seed=0):
    """Return a recording of a muscle held at *kappa*, with white noise on its force."""
    t, pressure = commands(seconds, rate, seed)
    y = np.full(t.size, kappa * model.muscle.l0)
    force = simulate_held(model, t, pressure, y).force
    force = force + 2.0 * np.random.default_rng(seed + 1).standard_normal(t.size)
    name = f'kappa_{100 * kappa:g}.csv'
    return Recording(name, t, None, None, y, None, force, pressure, 'held', digest=64 * 'b')


def rig(**values):
    """Return a rig with flat *values*, ``__`` for a dot, over those that are configured."""
    given = {k.replace('__', '.'): v for k, v in values.items()}
    (joint,) = RigParameters({}).build_joints({**DECLARED, **given})
    return joint


def rms(e):
    return float(np.sqrt(np.mean(e**2))) if e.size else float('nan')


def stage(name, model, segments, test, parameters):
    """Return the stage of a model that starts where each segment was measured to start."""

    def run(s):
        if s.kind == 'free':
            return simulate(model, s.t, s.drive, s.drive_t, position=s.y0, velocity=s.v0).position
        return simulate_held(model, s.t, s.pressure, s.position, s.velocity).force

    simulated, tested = (tuple(run(s) for s in part) for part in (segments, test))
    e = np.concatenate([p - s.target for p, s in zip(simulated, segments, strict=True)])
    fit = np.concatenate([s.fit for s in segments])
    held = e[~fit]
    if test:
        held = np.concatenate([p - s.target for p, s in zip(tested, test, strict=True)])
    errors, log = (rms(e[fit]), rms(held)), FitLog(FitStatus.CONVERGED, 12, 140)
    return Stage(name, model, '', parameters, *errors, simulated, tested, log)


def estimate(value, share, unit, at_bound=False):
    """Return an estimate with an interval of this share of its value to each side."""
    return Estimate(value, value - share * abs(value), value + share * abs(value), unit, at_bound)


def candidates(chosen, ambiguous=(), untestable=()):
    """Return one candidate for each effect of the library, with what could have been found."""
    found = []
    for k, effect in enumerate(EFFECTS):
        is_chosen = effect.name in chosen
        gain = 0.9 if is_chosen else 0.02 + 0.001 * k
        decision = 'chosen' if is_chosen else 'rejected'
        reason = 'lowers the score by 450' if is_chosen else 'gain below 3 %'
        if effect.name in ambiguous:
            decision, reason, gain = 'ambiguous', 'within one standard error of the winner', 0.89
        p = 1e-12 if gain > 0.5 else 0.4
        if effect.name in untestable:
            decision, p = 'untestable', np.nan
            reason = f'these data cannot show it; record: {effect.experiment}'
        name, scale = effect.parameters()[0].name, effect.parameters()[0].scale
        values = {name: estimate(scale, 0.3, effect.parameters()[0].unit)}
        error = 1e-3 * (1.0 - gain)
        size = error, 1.02 * error, 500.0 * gain, gain, p, gain > 0.5
        found.append(Candidate(effect.name, (), *size, values, decision, reason))
    return tuple(found)


def result_of(recordings, test, nominal, retuned, augmented, verdict, findings=(), quantity=None):
    """Return the result that three models make of the recordings."""
    segments = segments_of(recordings)
    if not test:
        segments = [replace(s, fit=s.t < s.t[0] + 0.75 * (s.t[-1] - s.t[0])) for s in segments]
    test_segments = segments_of(test) if test else []
    quantity = quantity or segments[0].quantity
    units = {'a1': 'N/bar', 'a5': 'N/bar', 'zeta': ''}
    known = {k: estimate(getattr(nominal.muscle, k), 0.0, unit) for k, unit in units.items()}
    moved, final = (
        {
            k: estimate(getattr(one.muscle, k), share, units[k], at_bound=k == 'zeta')
            for k, share in {'a1': 0.04, 'a5': 0.003, 'zeta': 0.2}.items()
        }
        for one in (retuned, augmented)
    )
    added = {
        f'effects.{finding.name}.{name}': value
        for finding in findings
        for name, value in finding.parameters.items()
    }
    chosen = [finding.name for finding in findings]
    others = [name for finding in findings for name in finding.alternatives]
    hidden = ('payload', 'end_stop') if quantity == 'force' else ()
    return Identification(
        verdict=Verdict(verdict),
        quantity=quantity,
        unit='m' if quantity == 'position' else 'N',
        noise=Noise(NOISE, 0.1) if quantity == 'position' else Noise(2.0, 0.0),
        stages=(
            stage('declared', nominal, segments, test_segments, known),
            stage('retuned', retuned, segments, test_segments, moved),
            stage('augmented', augmented, segments, test_segments, {**final, **added}),
        ),
        effects=tuple(findings),
        candidates=candidates(chosen, others, hidden),
        structure=Structure(0.71, 0.0, 0.96),
        segments=tuple(segments),
        test=tuple(test_segments),
        recordings=tuple(recordings),
        test_recordings=tuple(test),
        since=None,
        transition=None,
        development=None,
        uncertain={'mass': '2%'},
        doubt='',
        uses_pressures=False,
        is_complete=True,
        sentence='The configured model lacks something.' if findings else 'Nothing is missing.',
        next_experiment='slow triangles with minor loops: the force reverses within micrometres',
        next_command="pam_excite --ros-args -p segments:='[slow_triangle, fast_triangle]'",
        warnings=('the position covers 11 % of the stroke',),
    )


FRICTION_FOUND = Finding(
    'coulomb_friction',
    {'level': Estimate(14.02, 13.9, 14.14, 'N'), 'presliding': Estimate(1e-5, 1e-6, 1e-4, 'm')},
    ('hysteresis',),
    'lowers the held-out error by 90 %, p < 0.0001, level surely above 0',
)


def friction_result(test=False, gap=False, seconds=SECONDS, rate=200.0):
    """Return (result, provenance) of a free rig with friction that was found."""
    truth = rig(**{'effects.coulomb_friction.level': 14.0, 'a5': 303.5, 'zeta': 0.2})
    recordings = [free_recording(truth, seconds, rate, gap=gap)]
    others = [free_recording(truth, seconds, rate, 5, 'other.csv')] if test else []
    nominal, retuned = rig(), rig(a5=303.4, zeta=0.24)
    augmented = rig(**{'effects.coulomb_friction.level': 14.02, 'a5': 303.502, 'zeta': 0.201})
    result = result_of(
        recordings, others, nominal, retuned, augmented, 'effect_found', (FRICTION_FOUND,)
    )
    return result, source_of(nominal, recordings, others)


def clean_result():
    """Return (result, provenance) of a free rig that lacks nothing: augmented is re-tuned."""
    truth = rig()
    recordings = [free_recording(truth)]
    retuned = rig(a5=302.23)
    result = result_of(recordings, [], truth, retuned, retuned, 'no_missing_effect')
    return result, source_of(truth, recordings, [])


def held_result():
    """Return (result, provenance) of a muscle held at three lengths, with hysteresis found."""
    hysteresis = next(e for e in EFFECTS if e.name == 'hysteresis')
    strength = next(p for p in hysteresis.parameters() if p.strength)
    values = {f'effects.hysteresis.{strength.name}': 3.0 * strength.scale}
    truth = rig(**values)
    recordings = [
        held_recording(truth, kappa, seed=k) for k, kappa in enumerate((0.02, 0.1, 0.18))
    ]
    found = Finding('hysteresis', {'amplitude': estimate(30.0, 0.1, 'N')}, (), 'loops')
    result = result_of(recordings, [], rig(), rig(a5=302.0), truth, 'effect_found', (found,))
    return result, source_of(rig(), recordings, [])


def crowded_result():
    """Return (result, provenance) with long names, nine recordings and three effects."""
    truth = rig(**{'effects.coulomb_friction.level': 14.0})
    names = [f'2026-11-20T10-15-{k:02d}_bench_south_muscle_dmsp_20_400n.csv' for k in range(9)]
    recordings = [free_recording(truth, 8.0, 200.0, k, name) for k, name in enumerate(names)]
    warning = 'pressure_command has only 3 levels: poor excitation, curvature cannot be seen'
    recordings = [replace(recording, warnings=(warning,)) for recording in recordings]
    tiny = Estimate(-1.2345678e-9, -3.1415926e5, 1e4, 'N/(bar percent)', at_bound=True)
    values = dict.fromkeys(('level', 'breakaway', 'stribeck_speed', 'per_pressure'), tiny)
    reason = 'explains with its own parameter what re-tuning explains only by constants far away '
    findings = [
        Finding(effect.name, values, ('pressure_dependent_damping', 'hysteresis'), 3 * reason)
        for effect in EFFECTS[-3:]
    ]
    result = result_of(recordings, [], rig(), rig(a5=304.0), truth, 'effect_found', findings)
    later = tuple(
        replace(
            c, parents=tuple(f.name for f in findings), reason=2 * reason, choose_error=123.4e-9
        )
        for c in result.candidates
    )
    overrides = ('mass=20', 'zeta=0.2', 'effects.pressure_dependent_damping.per_pressure=1e-5')
    source = replace(
        source_of(rig(), recordings, []),
        overrides=overrides,
        command='pam_identify ' + ' '.join(names) + ' --out /a/long/' + 40 * 'path' + '/out',
    )
    return replace(result, candidates=(*result.candidates, *later), sentence=4 * reason), source


def source_of(nominal, recordings, test):
    """Return the provenance of a result that was made by hand."""
    joint = NominalJoint(nominal, LOAD, ('muscle',), 'muscle')
    command = 'pam_identify bench.csv --out report'
    inputs = Inputs(PRESET, joint, {}, recordings, test)
    return provenance(inputs, ('mass=20',), command)
