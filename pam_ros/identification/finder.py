# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The trace: how wrong is the declared model, what does it lack, how wrong is it with that."""

from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification import verdict
from pam_ros.identification.admission import Tried
from pam_ros.identification.candidate import Fit, fitted
from pam_ros.identification.coarse import coarse_step
from pam_ros.identification.elimination import plain, promises_little, without_needless
from pam_ros.identification.noise import Noise, noise_of
from pam_ros.identification.problem import Problem
from pam_ros.identification.result import Candidate, Finding, Trace
from pam_ros.identification.retuning import only_starts, problem_of
from pam_ros.identification.round import NEAR
from pam_ros.identification.search import Progress, Search, search
from pam_ros.identification.segment import Segment, segments_of
from pam_ros.identification.solve import Solution, solve
from pam_ros.identification.stages import estimates, stage
from pam_ros.identification.structure import Structure, structure_of
from pam_ros.identification.unknowns import Unknown
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.model import RigModel

Array = NDArray[np.float64]
STEP = 1e-3  # s, longest step of the final fits
HOPE = 100.0  # rise of the cost that a plainer fit of all samples may promise to be tried
NEEDLESS = 'chosen at first, and not needed beside what was found later'
FAR_FROM_THIN = 1.5  # errors of the thinned runs at which a final fit has not arrived
SHARES = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)  # of a strength, at which a final fit may begin
SHORTER = (4e-3, 2e-3, STEP)  # s, the steps by which it is led there
POLISH = 10  # iterations of a final fit, which starts where the thinned one ended


def trace(
    model: RigModel,
    recordings: Sequence[Recording],
    test: Sequence[Recording] = (),
    progress: Progress | None = None,
) -> Trace:
    """Trace what *recordings* show beyond *model* to effects of the model's library.

    Errors are judged on *test*, or without it on every third of ten blocks of each recording,
    which no fit sees. With *test*, all of the recordings are fitted in the end; what was chosen
    was chosen before, on the blocks. progress(fraction, text) is told what runs.

    Raises RecordingError when the recordings do not fit together or carry no output.
    """
    tell: Progress = progress or (lambda fraction, text: None)
    blocks = segments_of(recordings, keep_back=True)
    tests = segments_of(test, keep_back=False)
    noise = noise_of([(s.t, s.target) for s in blocks])
    lacking = verdict.too_little(blocks, noise)
    found = search(model, blocks, noise, tell)
    tell(0.9, 'fitting the chosen models in full')
    final, fits = blocks, polished(found, model, blocks, noise)
    if test:
        final = segments_of(recordings, keep_back=False)
        declared, retuned, augmented = fits
        found = replace(found, declared=declared, retuned=retuned, augmented=augmented)
        fits = polished(found, model, final, noise)
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
        warnings=tuple(w for r in (*recordings, *test) for w in r.warnings),
        next_experiment='',
    )
    tell(1.0, 'done')
    return verdict.judged(answer, lacking, model.library)


def polished(
    found: Search, model: RigModel, segments: Sequence[Segment], noise: Noise
) -> tuple[Fit, Fit, Fit]:
    """Return the declared, re-tuned and augmented models fitted to every sample.

    Effects that are not needed there are dropped, and finer parameters of theirs.
    """
    whole = replace(problem_of(model, segments, noise, STEP), slope_step=coarse_step(model))
    starts = [k for k in whole.unknowns if k.segment >= 0]
    fits = []
    with ThreadPoolExecutor() as pool:
        for fit in (found.declared, found.retuned, found.augmented):
            thin = fit.solution.problem
            kept = [k for k, x in enumerate(thin.unknowns) if x.segment < 0]
            unknowns = (*(thin.unknowns[k] for k in kept), *starts)
            full = replace(
                whole,
                row=thin.row,
                active=thin.active,
                unknowns=unknowns,
                outlier=thin.outlier,
            )
            u = np.concatenate([fit.solution.u[kept], _same_starts(fit, starts)])
            if fit is found.declared:
                solution = only_starts(full, u, pool)
            else:
                solution = _settled(full, u, fit.fit_error, noise, pool)
            fits.append(fitted(fit.effects, solution))
        declared, retuned, augmented = fits
        # What finer parameters made up for may be the longer steps of the thinned runs.
        augmented = plain(augmented, model, pool, HOPE)
        augmented = without_needless(
            augmented, _doubted(augmented, model, noise), retuned, model, noise, pool
        )
    if augmented.score > retuned.score:
        # A nested model is never worse: what the thinned runs saw is not in the full ones.
        augmented = retuned
    return declared, retuned, augmented


def _settled(full: Problem, u: Array, thin_error: float, noise: Noise, pool: Executor) -> Solution:
    """Return the fit to every sample that begins at u, where thinned runs leave *thin_error*.

    One that does not come near the noise begins anew from strengths that do better than those of
    the thinned runs. And since a load that sticks slips elsewhere with other steps, so that u says
    little, one that is far from what long steps left goes there by shorter and shorter ones.
    """
    ends = [solve(full, u, POLISH, pool)]
    exact = replace(full, slope_step=0.0)
    if _rms(ends[0]) > NEAR * noise.sigma:
        weaker = _scanned(exact, u)
        if weaker is not None:
            ends.append(solve(exact, weaker, 2 * POLISH, pool))
    if min(map(_rms, ends)) > FAR_FROM_THIN * thin_error:
        for step in SHORTER:
            end = solve(replace(exact, step=step), u, 2 * POLISH, pool)
            u = end.u
        ends.append(end)
    best = min(ends, key=lambda one: one.cost)
    return replace(best, problem=full)


def _rms(solution: Solution) -> float:
    return float(np.sqrt(np.mean(solution.r**2)))


def _scanned(problem: Problem, u: Array) -> Array | None:
    """Return u with strengths of effects at a share of theirs that leaves less; None without any.

    Long steps soften a stiff stop: there no stiffness is too high, and a derivative at one that
    is far too high does not say so.
    """
    every = ((e, p) for e in problem.active for p in e.parameters)
    strengths = {f'effects.{e.name}.{p.name}' for e, p in every if p.strength}
    found, cost = u, problem.cost(u, problem.residuals(u))
    for k, unknown in enumerate(problem.unknowns):
        for share in SHARES if unknown.name in strengths else ():
            moved = u.copy()
            moved[k] *= share
            other = problem.cost(moved, problem.residuals(moved))
            if other < cost:
                found, cost = moved, other
    return None if found is u else found


def _doubted(fit: Fit, model: RigModel, noise: Noise) -> list[str]:
    """Return the effects of *fit* that the fit to every sample may not need.

    All of them where it is far from the noise: thinned runs may have stopped at a place where
    one of them made up for another. None of them where no sample is kept back to say so.
    """
    if np.isnan(fit.held_error):
        return []
    is_near = fit.fit_error < NEAR * noise.sigma
    return [n for n in fit.effects if not is_near or promises_little(fit, n, HOPE, model)]


def _same_starts(fit: Fit, starts: Sequence[Unknown]) -> Array:
    """Return *starts* at the values that *fit* gave them, as far as the measurement allows.

    Runs that were cut into windows have starts of their own: then the measured ones.
    """
    thin = fit.solution.problem
    values = {
        x.name: x.value(u)
        for x, u in zip(thin.unknowns, fit.solution.u, strict=True)
        if x.segment >= 0
    }
    if len(values) != len(starts):
        return np.zeros(len(starts))
    return np.array([np.clip(x.coordinate(values[x.name]), -2.0, 2.0) for x in starts])


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
    column = at.Y if s.kind == 'free' else 3
    inputs = (out[:, at.P], out[:, at.Y], out[:, at.V])
    return structure_of(s.t, s.target - out[:, column], inputs, noise.sigma)


def _findings(found: Search, fit: Fit, model: RigModel) -> tuple[Finding, ...]:
    values = estimates(fit, model)
    findings = []
    for tried in _chosen(found):
        name = tried.effect.name
        if name not in fit.effects:
            continue
        prefix = f'effects.{name}.'
        parameters = {k.removeprefix(prefix): v for k, v in values.items() if prefix in k}
        findings.append(
            Finding(name, parameters, verdict.alternatives(found, tried), _reason(tried))
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


def _candidates(found: Search, fit: Fit, model: RigModel) -> tuple[Candidate, ...]:
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
            prefix = f'effects.{t.effect.name}.'
            values = estimates(t.fit, model)
            rows.append(
                Candidate(
                    t.effect.name,
                    t.parents,
                    t.fit.fit_error,
                    t.fit.held_error,
                    t.evidence.p,
                    t.evidence.gain,
                    t.evidence.interval_clear,
                    {k.removeprefix(prefix): v for k, v in values.items() if prefix in k},
                    decision,
                    reason,
                )
            )
    return tuple(rows)
