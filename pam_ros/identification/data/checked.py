# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Check recordings with what is known about the joint that they are recordings of."""

from dataclasses import dataclass, replace

from pam_ros.recording.direction import with_contraction_positive
from pam_ros.recording.quality import check
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint
from pam_ros.rig.statics import is_direct


@dataclass(frozen=True)
class Bounds:
    """What the values of a recording cannot exceed.

    ``l0`` is the length in m of the one muscle, None if the position is not its contraction.
    ``p_max`` are the highest pressures of the muscles in gauge Pa. ``reach`` is the least and the
    greatest position of a joint in m or rad, None for one muscle on a mass.
    """

    l0: float | None
    p_max: tuple[float, ...]
    reach: tuple[float, float] | None

    @classmethod
    def of(cls, joint: Joint) -> 'Bounds':
        """Return the bounds of the recordings of *joint*."""
        is_single = is_direct(joint)
        return cls(
            # A known force on a load, which replaces a muscle, has no length.
            l0=joint.muscle.l0 if is_single and not joint.is_driven else None,
            p_max=tuple(muscle.p_max for muscle in joint.muscles),
            reach=None if is_single else joint.position_range,
        )


def checked(recording: Recording, joint: Joint) -> Recording:
    """Return *recording* with warnings about its data, which are checked with those of *joint*.

    Recordings that :func:`pam_ros.read_recording` returns have passed these checks, recordings
    that are made of arrays have not. Raises RecordingError for a recording that cannot be used.
    """
    bounds = Bounds.of(joint)
    recording = with_contraction_positive(recording)
    found = check(recording, bounds.l0, bounds.p_max, bounds.reach)
    return replace(recording, warnings=tuple(dict.fromkeys((*recording.warnings, *found))))
