# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How blind trials are scored: by the rules that the targets state."""

import numpy as np
import pytest

from benchmarks import tracing_late, tracing_pressures
from benchmarks._intervals import SAME, intervals, mean_delay, truth_of
from benchmarks.tracing import (
    TARGETS,
    is_exact,
    is_right,
    nominal_model,
    pair_hits,
    recording_of,
    report,
    scores,
)
from benchmarks.tracing_late import is_named, is_near, is_wrong
from pam_ros.effects import EFFECTS
from pam_ros.identification.result import Estimate
from truth import DEVELOPING, FORMS, LATE, TruthPlant, blind_trial, effect, late_trial, stamps
from truth.excitation import multisine


def row(kind, found=(), alternatives=None, **changes):
    """Return a trial's row; *kind* as in the benchmark, *found* the names in their order."""
    names = [] if kind == 'noise_only' else kind.split('+')
    given = {
        'kind': kind,
        'seed': 0,
        'accepted': [[name] for name in names],
        'in_library': True,
        'verdict': 'effect_found' if found else 'no_missing_effect',
        'found': list(found),
        'alternatives': [list(a) for a in alternatives or [()] * len(found)],
        'augmented': 1.1e-5,
        'noise': 1e-5,
        'floor': 1.1e-5,
        'seconds': 1.0,
        'intervals': {},
    }
    return given | changes


@pytest.mark.parametrize(
    ('found', 'alternatives', 'right'),
    [
        (['creep'], [()], True),
        ([], [], False),
        (['leak'], [()], False),
        (['leak'], [('creep',)], True),  # a set of two that holds it
        (['leak'], [('slack', 'creep')], False),  # a set of three
        (['creep'], [('slack', 'leak')], True),  # first, whatever else
        (['leak', 'creep'], [(), ()], False),  # it must be first
        (['creep', 'leak'], [(), ()], True),
    ],
)
def test_a_single_effect(found, alternatives, right):
    assert is_right(row('creep', found, alternatives)) is right


def test_equations_that_are_two_effects_may_be_called_either():
    for name in ('leak', 'pressure_lag'):
        assert is_right(row('leak', [name], accepted=[['leak', 'pressure_lag']]))


@pytest.mark.parametrize(
    ('found', 'alternatives', 'hits', 'wrong'),
    [
        (['creep', 'leak'], [(), ()], 2, 0),
        (['leak', 'creep'], [(), ()], 2, 0),
        (['creep'], [()], 1, 0),
        ([], [], 0, 0),
        (['creep', 'slack'], [(), ()], 1, 1),
        (['creep', 'slack'], [(), ('leak',)], 2, 0),
        (['creep', 'slack'], [(), ('payload', 'leak')], 1, 1),
        (['creep', 'creep'], [(), ()], 1, 0),  # said twice: one hit, and not wrong
        (['creep', 'leak', 'slack'], [(), (), ()], 2, 1),
    ],
)
def test_a_pair(found, alternatives, hits, wrong):
    assert pair_hits(row('creep+leak', found, alternatives)) == (hits, wrong)


@pytest.mark.parametrize(
    ('kind', 'found', 'exact'),
    [
        ('creep', ['creep'], True),
        ('creep', ['creep', 'leak'], False),
        ('creep', [], False),
        ('creep+leak', ['leak', 'creep'], True),
        ('creep+leak', ['creep'], False),
        ('noise_only', [], True),
        ('noise_only', ['leak'], False),
    ],
)
def test_the_right_effects_alone(kind, found, exact):
    assert is_exact(row(kind, found)) is exact


@pytest.mark.parametrize(('kind', 'form'), SAME)
def test_parameters_of_the_same_meaning_exist_on_both_sides(kind, form):
    there = effect(kind, form)
    (name,) = FORMS[(kind, form)].names
    (kind_of,) = [one for one in EFFECTS if one.name == name]
    nominal = {f'effects.{name}.{one.name}' for one in kind_of.parameters()}
    assert set(SAME[kind, form]) <= nominal
    stamps = np.arange(100) / 100.0
    for value in SAME[kind, form].values():
        assert np.isfinite(value(there.values, stamps))


@pytest.mark.parametrize('jitter', [0.0, 0.3])
def test_the_true_delay_of_commands_is_that_of_a_plant_with_substeps_without_length(jitter):
    rng = np.random.default_rng(1)
    t, u = stamps(250.0, 2.0, jitter, rng), multisine(250.0, 2.0, 2e5, 3e5, rng)
    dead_time = 0.00561

    def moved(delay, **given):
        plant = TruthPlant(effects=[effect('dead_time', dead_time_s=delay)], p0=u[0], **given)
        return plant.run(t, u).y

    real = moved(dead_time)
    delay = mean_delay(dead_time, t)
    assert dead_time < delay < dead_time + 5e-5
    off = [np.std(real - moved(one, dt=1e-6)) for one in (dead_time, delay)]
    assert off[1] < 0.1 * off[0]


def test_what_was_not_fitted_or_has_no_truth_has_no_interval():
    trial = blind_trial('payload', 0, rate=100.0, duration=10.0)
    truth = truth_of(trial)
    assert truth['effects.payload.mass'] == trial.effects[0].values['payload_kg']
    assert truth['a3'] == trial.constants_si[2]
    estimates = {
        'a1': Estimate(1.0, 0.9, 1.1, ''),
        'a2': Estimate(1.0, 1.0, 1.0, ''),
        'effects.payload.mass': Estimate(2.0, 1.0, 3.0, 'kg'),
        'effects.creep.time_1': Estimate(2.0, 1.0, 3.0, 's'),
    }
    assert intervals(truth, estimates) == {
        'a1': [truth['a1'], 0.9, 1.1],
        'effects.payload.mass': [truth['effects.payload.mass'], 1.0, 3.0],
    }


ROWS = [
    row('creep', ['creep'], intervals={'a1': [1.0, 0.9, 1.2], 'zeta': [0.1, 0.2, 0.3]}),
    row('creep', ['leak'], augmented=3e-5, intervals={'a1': [9.0, 0.0, 1.0]}),
    row('leak', ['leak'], augmented=1.0e-5, floor=1.2e-5),
    row('noise_only'),
    row('noise_only', ['slack']),
    row('creep+leak', ['creep', 'leak'], intervals={'effects.leak.rate': [1.0, 0.9, 1.2]}),
    row('creep+leak', ['creep'], intervals={'effects.creep.share_1': [9.0, 0.0, 1.0]}),
    row('creep+leak', ['creep', 'slack'], intervals={'effects.slack.share': [9.0, 0.0, 1.0]}),
    row('creep+leak'),
    row('cogging', verdict='unexplained_structure', in_library=False),
    row('cogging', ['creep'], in_library=False, floor=0.8e-5),
]


def test_scores_by_hand():
    values = list(scores(ROWS).values())
    assert values == pytest.approx([2 / 3, 1 / 2, 1 / 4, 2 / 4, 1 / 2, 1.1, 9 / 11, 1.0, 1 / 2])
    assert list(scores(ROWS)) == list(TARGETS)


def test_what_was_not_tried_has_no_score():
    values = list(scores([row('noise_only')]).values())
    assert (values[1], values[6]) == (0.0, 1.0)
    assert np.isnan([values[k] for k in (0, 2, 3, 4, 5, 7, 8)]).all()


def test_the_report_has_the_rates_and_the_confusions(capsys):
    report(ROWS)
    lines = capsys.readouterr().out.splitlines()
    reached = ('median', 'intervals of the effects')
    for name in TARGETS:
        (line,) = [text for text in lines if name in text]
        assert line.endswith('reached' if any(one in name for one in reached) else 'SHORT')
    (line,) = [text for text in lines if text.startswith('  creep ')]
    assert '1 x creep' in line
    assert '1 x leak' in line
    assert line.endswith('(2.05)')


def test_the_finder_is_given_what_a_user_has():
    trial = blind_trial('payload', 0, rate=100.0, duration=10.0)
    model, recording = nominal_model(trial), recording_of(trial)
    # The published constants, not those of the specimen, and the mass without the payload.
    np.testing.assert_allclose(model.muscle.si, trial.nominal.constants_si)
    assert not np.allclose(model.muscle.si, trial.constants_si, rtol=1e-3)
    assert model.load.mass == trial.mass
    assert model.all_effects == ()
    assert recording.kind == 'free'
    assert (recording.force, recording.pressure, recording.velocity) == (None, None, None)
    assert recording.t[0] == 0.0
    np.testing.assert_array_equal(recording.position, trial.recording.position_m)
    np.testing.assert_array_equal(recording.command, trial.recording.pressure_command_pa)


# Effects that begin in the middle ----------------------------------------------------------------


def late_row(found=(), since=None, **changes):
    """Return a trial's row: a leak begins at 20 s, and shows at 40 s."""
    given = {
        'accepted': [['leak', 'pressure_lag']],
        'onset': 20.0,
        'shows': 40.0,
        'verdict': 'effect_found' if found else 'unexplained_structure',
        'found': list(found),
        'alternatives': [()] * len(found),
        'since': None if since is None else [since - 0.2, since, since + 0.2],
    }
    return given | changes


@pytest.mark.parametrize(
    ('since', 'near'),
    [(None, False), (20.9, True), (19.1, True), (21.1, False), (39.5, True), (30.0, False)],
)
def test_a_moment_is_near_the_true_one_or_the_one_at_which_it_shows(since, near):
    assert is_near(late_row(['leak'], since)) is near


@pytest.mark.parametrize(
    ('found', 'alternatives', 'named', 'wrong'),
    [
        (['leak'], [()], True, False),
        (['pressure_lag'], [()], True, False),
        (['creep'], [()], False, True),
        (['creep'], [('leak',)], True, False),
        (['creep'], [('slack', 'leak')], False, True),
        (['leak', 'creep'], [(), ()], False, True),
        ([], [], False, False),
    ],
)
def test_a_name_counts_alone_or_in_a_set_of_two(found, alternatives, named, wrong):
    one = late_row(found, 20.0, alternatives=alternatives)
    assert (is_named(one), is_wrong(one)) == (named, wrong)


def test_the_figures_are_shares():
    rows = [
        late_row(['leak'], 20.1),
        late_row(['leak'], 20.5),  # its interval misses the moment
        late_row(['leak']),  # no moment
        late_row(['creep'], 20.1),
        late_row([], 40.3),
    ]
    figures = dict(zip(tracing_late.TARGETS, (0.6, 0.4, 0.8, 0.5), strict=True))
    assert tracing_late.scores(rows) == pytest.approx(figures)


@pytest.mark.parametrize('kind', [*LATE, *DEVELOPING])
def test_until_the_moment_nothing_is_there(kind):
    late = late_trial(kind, 3)
    trial, recording = late.trial, late.trial.recording
    t = recording.t_s - recording.t_s[0]
    plain = TruthPlant(
        trial.constants_si, trial.mass, trial.zeta, p0=recording.pressure_command_pa[0]
    ).run(recording.t_s, recording.pressure_command_pa)
    moved = np.abs(recording.truth['position_m'] - plain.y)
    assert 0.19 * t[-1] < late.onset < 0.61 * t[-1]
    assert moved[t <= late.onset].max() < 1e-12
    assert moved[t < late.shows].max() <= 3.0 * trial.noise
    assert moved[t >= late.shows][0] > 3.0 * trial.noise
    assert late.onset <= late.shows <= t[-1]


def test_shares_of_trials_with_measured_pressures():
    three = 'pressure_lag+hysteresis+coulomb_friction'
    rows = [
        row('noise_only'),
        row('creep', ['creep']),
        row('creep', ['leak']),
        row(three, three.split('+')),
        row(three, ['pressure_lag', 'hysteresis', 'creep']),
    ]
    figures = dict(zip(tracing_pressures.TARGETS, (0.5, 5 / 6, 0.5, 0.5, 1.0), strict=True))
    assert tracing_pressures.scores(rows) == pytest.approx(figures)
