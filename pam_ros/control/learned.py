# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The results of learning from the motion, as figures for users."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Learned:
    """What the sliding-mode law has learned, and how far it uses this.

    For a revolute joint, read rad for m, and N m for N.

    motion
        time in s for which the load has moved while the law learned
    missing
        force in N that changes with the motion and that the nominal model lacks, RMS over the
        last seconds of motion
    noise
        RMS force in N that is attributed to noise and cannot be explained
    explained
        share of the square of ``missing`` that the learned parameters predict, 0 to 1
    weight
        0 to 1, with which the feed-forward uses them
    friction
        friction and hysteresis together in N: half the width of the force over the position in a
        large motion
    breakaway
        additional friction at rest, N
    stiffness
        additional stiffness of the joint where the reference is, N/m
    lag
        time constants in s of the pressure while filling and while venting, without the weight;
        0 where the motion is predicted better without a lag. None if a lag is configured
    dropped_lag
        the lag that was used before and is no longer used, None if there is none
    restarts
        how often all learned parameters were reset because the loop oscillated
    """

    motion: float
    missing: float
    noise: float
    explained: float
    weight: float
    friction: float
    breakaway: float
    stiffness: float
    lag: tuple[float, float] | None
    dropped_lag: tuple[float, float] | None
    restarts: int
