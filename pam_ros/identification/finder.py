# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The trace: how wrong is the declared model, what does it lack, how wrong is it with that."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import instance, sequence
from pam_ros.effects.names import by_effect
from pam_ros.errors import RecordingError
from pam_ros.identification import verdict
from pam_ros.identification.admission import Tried
from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.noise import Noise, noise_of
from pam_ros.identification.data.segment import Segment, segments_of
from pam_ros.identification.drift import drifts
from pam_ros.identification.final import polished
from pam_ros.identification.result import Candidate, Finding, Trace
from pam_ros.identification.selection import Progress, Search, search
from pam_ros.identification.stages import estimates, stage
from pam_ros.identification.structure import Structure, structure_of
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
NEEDLESS = 'chosen at first, and not needed beside what was found later'


def trace(
    model: Joint,
    recordings: Sequence[Recording],
    test: Sequence[Recording] = (),
    progress: Progress | None = None,
) -> Trace:
    """Trace what *recordings* show beyond *model* to effects of the model's library.

    Errors are judged on *test*, or without it on every third of ten blocks of each recording,
    which no fit sees. With *test*, all of the recordings are fitted in the end; what was chosen
    was chosen before, on the blocks. progress(fraction, text) is told what runs.

    Raises RecordingError when there are no recordings, when they do not fit together or carry no
    output, and ParameterError for objects of another kind.
    """
    instance('model', model, Joint, 'a Joint')
    recordings = sequence('recordings', recordings, Recording, 'a Recording')
    test = sequence('test', test, Recording, 'a Recording')
    if not recordings:
        raise RecordingError('recordings is empty: give at least one Recording')
    tell: Progress = progress or (lambda fraction, text: None)
    blocks = segments_of(recordings, keep_back=True)
    tests = segments_of(test, keep_back=False)
    noise = noise_of([(s.t, s.target) for s in blocks])
    lacking = verdict.too_little(blocks, noise)
    found = search(model, blocks, noise, tell)
    tell(0.9, 'fitting the chosen models in full')
    drifting = drifts(found.augmented, noise.sigma)
    final, fits = blocks, polished(found, model, blocks, noise, drifting)
    if test:
        final = segments_of(recordings, keep_back=False)
        declared, retuned, augmented = fits
        found = replace(found, declared=declared, retuned=retuned, augmented=augmented)
        fits = polished(found, model, final, noise, drifting)
    noise = _least(noise, fits, final)
    stages = tuple(
        stage(name, model, fit, tests)
        for name, fit in zip(('declared', 'retuned', 'augmented'), fits, strict=True)
    )
    tell(0.97, 'looking for structure in what is left')
    structure = _structure(fits[2], noise)
    effects = _findings(found, fits[2], model)
    quantity = final[0].quantity
    answer = Trace(
        verdict='',
        sentence='',
        quantity=quantity,
        unit='m' if quantity == 'position' else 'N',
        noise=noise,
        stages=(stages[0], stages[1], stages[2]),
        effects=effects,
        candidates=_candidates(found, fits[2], model),
        structure=structure,
        segments=tuple(final),
        test=tuple(tests),
        warnings=(
            *(w for r in (*recordings, *test) for w in r.warnings),
            *map(str, drifting),
        ),
        next_experiment='',
    )
    tell(1.0, 'done')
    return verdict.judged(answer, lacking, model.library)


def _least(noise: Noise, fits: Sequence[Fit], segments: Sequence[Segment]) -> Noise:
    """Return the smallest noise seen: in the signal, and in what each model leaves of it.

    A model that follows the motion leaves a smoother signal than the raw one, whose quick
    parts a polynomial cannot follow.
    """
    found = [noise]
    for fit in fits:
        simulated = fit.solution.problem.predict(fit.solution.u)
        found.append(
            noise_of([(s.t, s.target - p) for s, p in zip(segments, simulated, strict=True)])
        )
    return min(found, key=lambda n: n.sigma)


def _structure(fit: Fit, noise: Noise) -> Structure:
    """Return the structure of the residual of the longest run."""
    problem = fit.solution.problem
    longest = max(range(len(problem.segments)), key=lambda k: problem.segments[k].t.size)
    s = problem.segments[longest]
    out = problem.runs(fit.solution.u, longest)[0]
    column = at.RUN_S if s.kind == 'free' else at.RUN_F
    inputs = (out[:, at.RUN_P], out[:, at.RUN_S], out[:, at.RUN_V])
    return structure_of(s.t, s.target - out[:, column], inputs, noise.sigma)


def _findings(found: Search, fit: Fit, model: Joint) -> tuple[Finding, ...]:
    values = by_effect(estimates(fit, model))
    findings = []
    for tried in _chosen(found):
        name = tried.effect.name
        if name not in fit.effects:
            continue
        findings.append(
            Finding(name, values.get(name, {}), verdict.alternatives(found, tried), _reason(tried))
        )
    return tuple(findings)


def _chosen(found: Search) -> list[Tried]:
    """Return the candidate that each round chose, in order."""
    chosen = []
    for tried in found.rounds:
        names = [t.effect.name for t in tried if t.chosen]
        chosen += [t for t in tried if t.effect.name in names]
    return chosen


def _reason(tried: Tried) -> str:
    e = tried.evidence
    if e.absorbed:
        return (
            'explains with its own parameter what re-tuning explains only by constants far from '
            f'those declared ({verdict.likelihood(e.p)})'
        )
    return (
        f'lowers the error of the samples kept back by {100 * e.gain:.0f} % '
        f'({verdict.likelihood(e.p)} after correction for the number of candidates)'
    )


def _candidates(found: Search, fit: Fit, model: Joint) -> tuple[Candidate, ...]:
    rows = []
    for tried in found.rounds:
        winner = next((t for t in tried if t.chosen), None)
        rivals = verdict.alternatives(found, winner) if winner else ()
        for t in tried:
            if t.chosen and t.effect.name not in fit.effects:
                decision, reason = 'rejected', NEEDLESS
            elif t.chosen:
                decision, reason = 'chosen', _reason(t)
            else:
                decision = 'ambiguous' if t.effect.name in rivals else 'rejected'
                reason = verdict.why_not(t, winner)
            values = by_effect(estimates(t.fit, model))
            rows.append(
                Candidate(
                    t.effect.name,
                    t.parents,
                    t.fit.fit_error,
                    t.fit.held_error,
                    t.evidence.p,
                    t.evidence.gain,
                    t.evidence.interval_clear,
                    values.get(t.effect.name, {}),
                    decision,
                    reason,
                )
            )
    return tuple(rows)
