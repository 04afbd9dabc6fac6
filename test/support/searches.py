# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Searches that have found one effect by their first move."""

from dataclasses import replace

import numpy as np

from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.fit.solve import initial_solution, solve
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.moves import with_each
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Setting
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint
from support import bench_truth

FILL = 0.05  # s, the lag of the rig in the tests of what comes after a search
NOISE = 20e-6  # m, of the recordings of the truth plant and of a load on a rail


def setting_of(
    recordings,
    pool,
    model=None,
    fit=CRITERIA.fit,
    choose=CRITERIA.choose,
    budget=BUDGET,
    muscles=(),
):
    """Return the setting of a search; *fit* and *choose* are where these parts end."""
    parts = parts_of(recordings, fit, choose)
    return Setting(model or bench_truth.nominal(), parts, CRITERIA, budget, pool, muscles)


def at_nominal(problem):
    """Return the solution of *problem* where no fit has begun."""
    return initial_solution(problem, np.zeros(len(problem.unknowns)))


def retuned_of(setting):
    """Return the re-tuned model of a setting."""
    problem = setting.problem
    known = solve(problem, np.zeros(len(problem.unknowns)), pool=setting.pool)
    return setting.model((), known)


def on_rail(gain=0.01, effects=()):
    """Return 5 kg on a rail, without a spring, drawn by *gain* N/Pa."""
    drawn = Muscle(
        *(0.0, 0.0, 0.0, 0.0, gain, 0.0),
        pressure_unit='Pa',
        contraction_unit='fraction',
        zeta=0.0,
        l0=1.0,
    )
    return single_muscle_joint(drawn, Mass(mass=5.0, mount='horizontal'), effects)


def recorded_on_rail(joint, begin=0.0):
    """Return 16 s of a load on a rail that is drawn to and fro."""
    t = np.arange(1600) / 100.0
    command = 100.0 * np.where(np.sin(1.3 * t) > 0.0, 1.0, -1.0)
    y = simulate(joint, t, command, position=0.1).position
    y = y + NOISE * np.random.default_rng(3).standard_normal(t.size)
    return Recording('rail', begin + t, begin + t, command, y)


def found_in(
    recordings,
    pool,
    fit=CRITERIA.fit,
    choose=CRITERIA.choose,
    spoil=False,
    name='pressure_lag',
    model=None,
    budget=BUDGET,
):
    """Return a search that has found the effect, and nothing else, by its first move.

    With *spoil*, what judges is gone.
    """
    setting = setting_of(recordings, pool, model, fit, choose, budget)
    if spoil:
        targets = [np.where(part.judge, 0.0, part.segment.target) for part in setting.parts]
        parts = [
            replace(part, segment=replace(part.segment, target=target))
            for part, target in zip(setting.parts, targets, strict=True)
        ]
        setting = replace(setting, parts=parts)
    retuned = retuned_of(setting)
    (best,) = with_each(retuned, [name], setting)
    return Search(setting, retuned, best, [retuned, best])
