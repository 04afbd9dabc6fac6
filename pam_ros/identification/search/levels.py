# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Warnings for isometric recordings at the same length whose forces differ."""

import numpy as np

from pam_ros.identification.data.segment import HeldSegment
from pam_ros.identification.fit.run_levels import repeats
from pam_ros.identification.fit.solve import Solution
from pam_ros.identification.fit.unknowns import RunLevel
from pam_ros.rig import layout as at


def apart(solution: Solution, noise: float) -> tuple[str, ...]:
    """Return a sentence for each length whose recordings differ by more than the *noise* in N.

    The differences are those of the fitted levels; that of the last recording is 0.
    """
    problem = solution.problem
    l0 = float(problem.row[problem.layout.constant(at.L0)])
    pairs = zip(problem.unknowns, solution.u, strict=True)
    level = {one.of.run: one.value(u) for one, u in pairs if isinstance(one.of, RunLevel)}
    sentences = []
    for runs in repeats(problem.segments, l0):
        levels = np.array([level.get(run, 0.0) for run in runs])
        if np.ptp(levels) > noise:
            s = problem.segments[runs[0]]
            assert isinstance(s, HeldSegment)
            listed = ', '.join(f'{value:+.1f}' for value in levels)
            sentences.append(
                f'the recordings at {100.0 * float(s.position.mean()) / l0:.4g} % contraction '
                f'differ by {np.ptp(levels):.1f} N, more than the noise ({listed} N, in their '
                'order): the model describes the last one'
            )
    return tuple(sentences)
