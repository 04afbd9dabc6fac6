# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which effects does a residual ask for? Forward selection, then backward elimination."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from pam_ros.effects.base import Effect
from pam_ros.identification.admission import Tried, admitted, could_matter, plainest
from pam_ros.identification.candidate import Fit, fitted, released
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import FreeSegment, Segment, windows
from pam_ros.identification.data.thinning import coarse_step, thinned
from pam_ros.identification.elimination import plain, without_needless
from pam_ros.identification.exchange import exchanged
from pam_ros.identification.pairs import paired
from pam_ros.identification.retuning import only_starts, problem_of, robust
from pam_ros.identification.round import NEAR, Setting, try_effects
from pam_ros.identification.solve import solve
from pam_ros.identification.weak import motion_of
from pam_ros.rig.joint import Joint

Progress = Callable[[float, str], None]

EFFECTS_AT_MOST = 3
WINDOW = 2.0  # s of a run of a load without a muscle


@dataclass(frozen=True, eq=False)
class Search:
    """How the search went: each round's candidates, and the models that it ended with."""

    declared: Fit
    retuned: Fit
    augmented: Fit
    rounds: tuple[tuple[Tried, ...], ...]


def search(model: Joint, segments: Sequence[Segment], noise: Noise, progress: Progress) -> Search:
    """Find the effects that *model* lacks, on thinned runs: forward, then backward."""
    step = coarse_step(model)
    thin = [thinned(s, step) for s in segments]
    stride = max(1, round(segments[0].t.size / thin[0].t.size))
    if model.is_driven:
        thin = [part for s in thin for part in windows(s, WINDOW)]
    problem = problem_of(model, thin, noise, step, stride)
    # A load without a spring is cut into windows, which are no runs to be smoothed.
    pairs = [] if model.is_driven else zip(segments, thin, strict=True)
    motions = [
        motion_of(full, part, noise.sigma)
        for full, part in pairs
        if isinstance(full, FreeSegment) and isinstance(part, FreeSegment)
    ]
    with ThreadPoolExecutor() as pool:
        progress(0.0, 'simulating the model as declared')
        declared = fitted((), only_starts(problem, np.zeros(len(problem.unknowns)), pool))
        progress(0.05, 're-tuning its parameters')
        retuned = fitted((), solve(problem, declared.solution.u, pool=pool))
        if thin[0].kind == 'held':
            retuned = robust(retuned, pool)
            same = retuned.solution.problem
            declared = fitted((), only_starts(same, np.zeros(len(same.unknowns)), pool))
        setting = Setting(model, declared, noise, motions, pool)
        parent, plainer, rounds = retuned, retuned, []
        for k in range(EFFECTS_AT_MOST):
            if parent.effects and not could_matter(parent, retuned, noise):
                break
            progress(0.1 + 0.25 * k, f'trying effects, round {k + 1}')
            parent, tried = try_effects(parent, _absent(parent, model), setting)
            able = [t for t in tried if admitted(t, parent, retuned, noise)]
            if not able:
                rounds.append(tried)
                break
            first = plainest(able)
            chosen = replace(first, chosen=True)
            rounds.append(tuple(chosen if t is first else t for t in tried))
            plainer = plain(chosen.fit, model, pool)
            parent = _finer(plainer, chosen, setting)
            if thin[0].kind == 'held':
                parent = robust(parent, pool)
        progress(0.85, 'leaving out what is not needed')
        # The last one was just weighed on top of the others.
        doubted = parent.effects[:-1]
        parent = without_needless(parent, doubted, retuned, model, noise, pool)
        parent, rounds = exchanged(parent, rounds, setting)
        parent, pair = paired(parent, retuned, _absent(retuned, model), setting)
        if pair:
            rounds = [tuple(replace(t, chosen=False) for t in tried) for tried in rounds]
            parent, rounds = exchanged(parent, [*rounds, *pair], setting)
        if parent is not plainer:
            parent = plain(parent, model, pool)
    return Search(declared, retuned, parent, tuple(rounds))


def _absent(parent: Fit, model: Joint) -> list[Effect]:
    """Return the effects that *parent* lacks and its rig could have."""
    return [
        e
        for e in model.library
        if e.name not in parent.effects
        and e not in model.all_present
        and not (e.needs_muscle and model.is_driven)
    ]


def _finer(fit: Fit, chosen: Tried, setting: Setting) -> Fit:
    """Return the plain *fit* of what was chosen with finer parameters that earn their cost.

    Of the effects before it, too, as far as something is left: they were fitted without it.
    """
    model, pool = setting.model, setting.pool
    for name in (chosen.effect.name, *chosen.parents):
        if fit.fit_error > NEAR * setting.noise.sigma:
            effect = next(e for e in model.library if e.name == name)
            fit = released(fit, model, effect, pool)
    return min(fit, chosen.fit, key=lambda one: one.score)
