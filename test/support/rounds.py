# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the rounds of a search are given, for tests of one of its parts."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np

from pam_ros.effects import EFFECTS
from pam_ros.identification.candidate import extended, fitted
from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.data.thinning import coarse_step, thinned
from pam_ros.identification.retuning import only_starts, problem_of
from pam_ros.identification.round import Setting
from pam_ros.identification.solve import solve
from pam_ros.identification.weak import motion_of
from support import bench_truth

KNOWN = {e.name: e for e in EFFECTS}
MODEL = bench_truth.declared(off=[0.01, -0.01, 0.0, 0.01, 0.0, 0.01])


@contextmanager
def setting_of(model, *effects, rate=200.0):
    """Give the setting of a search in a recording of the truth plant with these effects."""
    full = segments_of([bench_truth.free(*effects, seed=3, rate=rate)], keep_back=True)
    noise = noise_of([(s.t, s.target) for s in full])
    thin = [thinned(s, coarse_step(model)) for s in full]
    problem = problem_of(model, thin, noise, coarse_step(model), 1)
    motions = [motion_of(f, s, noise.sigma) for f, s in zip(full, thin, strict=True)]
    with ThreadPoolExecutor() as pool:
        declared = fitted((), only_starts(problem, np.zeros(len(problem.unknowns)), pool))
        yield Setting(model, declared, noise, motions, pool)


def retuned(setting):
    """Return the fit of the declared parameters alone."""
    known = setting.declared.solution
    return fitted((), solve(known.problem, known.u))


def with_effects(setting, *names):
    """Return the fit of these effects, each from the first of its starts."""
    return with_effect_starts(setting, {name: KNOWN[name].fit_starts[0] for name in names})


def with_effect_starts(setting, starts):
    """Return the fit of effects (name -> parameters), one after the other from these starts."""
    fit = setting.declared
    for name, start in starts.items():
        known = fit.solution
        problem, added = extended(known.problem, setting.model, KNOWN[name], start)
        fit = fitted((*fit.effects, name), solve(problem, np.concatenate([known.u, added])))
    return fit
