# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of a joint before its recording is read: the bounds of the values."""

from dataclasses import dataclass
from typing import Any, Protocol

from pam_ros.arguments import refuse
from pam_ros.errors import RecordingError


@dataclass(frozen=True)
class Bounds:
    """What the values of a recording cannot exceed; the default knows nothing.

    ``l0`` is the length in m of the one muscle, None if the position is not its contraction.
    ``p_max`` are the highest pressures of the muscles in gauge Pa, empty if they are not known.
    ``reach`` is the least and the greatest position of a joint in m or rad, None for one muscle on
    a mass. ``unit`` is that of the position, ``m`` or ``rad``, None if it is not known.
    """

    l0: float | None = None
    p_max: tuple[float, ...] = ()
    reach: tuple[float, float] | None = None
    unit: str | None = None

    def require(self, name: str, muscles: int, unit: str) -> None:
        """Raise RecordingError if the recording *name* cannot be one of this joint.

        *muscles* is the number of its muscles, and *unit* that of its position.
        """
        if self.unit is not None and unit != self.unit:
            raise RecordingError(
                f'{name}: the position is in {unit}, and the model moves in {self.unit}: is it a '
                'recording of another joint?'
            )
        if self.p_max and muscles != len(self.p_max):
            raise RecordingError(
                f'{name} is a recording of {muscles} muscle(s), and the joint has '
                f'{len(self.p_max)}'
            )


class Bounded(Protocol):
    """A joint, which knows the bounds of its recordings."""

    @property
    def bounds(self) -> Bounds:
        """What the values of a recording cannot exceed."""


def bounds_of(joint: Any) -> Bounds:
    """Return the bounds of *joint*, None for none; raises ParameterError for other objects."""
    if joint is None:
        return Bounds()
    found = getattr(joint, 'bounds', None)
    if not isinstance(found, Bounds):
        refuse('joint', joint, 'a Joint')
    return found
