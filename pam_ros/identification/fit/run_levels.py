# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Levels (offsets of the force) between recordings at one prescribed length, as unknowns."""

from collections.abc import Sequence

import numpy as np

from pam_ros.identification.data.segment import HeldSegment, Segment
from pam_ros.identification.fit.unknowns import RunLevel, Unknown
from pam_ros.rig.joint import Joint

# Standard deviation of the level between recordings of a muscle at one length, as a share of the
# range of the force: repeated recordings of the measured muscle differ by 0.2 to 2 % of it.
LEVEL = 0.01
SAME = 1e-3  # share of the muscle's length by which recordings of one length may differ


def repeats(segments: Sequence[Segment], l0: float) -> list[list[int]]:
    """Return the indices of the runs at each prescribed length that is constant in a run.

    *l0* is the muscle's length in m.
    """
    groups: dict[float, list[int]] = {}
    for k, s in enumerate(segments):
        if isinstance(s, HeldSegment) and np.ptp(s.position) < SAME * l0:
            length = float(s.position.mean())
            known = next((one for one in groups if abs(one - length) < SAME * l0), length)
            groups.setdefault(known, []).append(k)
    return list(groups.values())


def level_unknowns(segments: Sequence[Segment], joint: Joint) -> list[Unknown]:
    """Return the levels of all runs at a constant length except the last one at each length.

    The runs are in the order of their recording, of the single muscle of *joint*. A run whose
    length changes has no level.
    """
    if segments[0].kind != 'held':
        return []
    earlier = sorted(k for runs in repeats(segments, joint.muscle.l0) for k in runs[:-1])
    if not earlier:
        return []
    force = np.concatenate([s.target[s.fit] for s in segments])
    scale = LEVEL * float(np.ptp(force)) + 1e-9
    return [Unknown(RunLevel(k), 0.0, scale, prior=1.0) for k in earlier]
