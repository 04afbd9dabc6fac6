# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Searches that have found one effect by their first move."""

from dataclasses import replace

import numpy as np

from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.fit.solve import solve
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.moves import with_each
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Setting
from support import bench_truth

FILL = 0.05  # s, the lag of the rig in the tests of what comes after a search


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

    *fit* and *choose* are where these parts end; with *spoil*, what judges is gone.
    """
    parts = parts_of(recordings, fit, choose)
    if spoil:
        targets = [np.where(part.judge, 0.0, part.segment.target) for part in parts]
        parts = [
            replace(part, segment=replace(part.segment, target=target))
            for part, target in zip(parts, targets, strict=True)
        ]
    setting = Setting(model or bench_truth.nominal(), parts, CRITERIA, budget, pool)
    problem = setting.problem
    retuned = setting.model((), solve(problem, np.zeros(len(problem.unknowns))))
    (best,) = with_each(retuned, [name], setting)
    return Search(setting, retuned, best, [retuned, best])
