# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of control whose units and defaults depend on the kind of joint."""

from dataclasses import dataclass, field
from typing import Any, TypeVar

from pam_ros.arguments import instance
from pam_ros.errors import ParameterError
from pam_ros.parameters import check_all, turning_defaults
from pam_ros.rig.joint import Joint

T = TypeVar('T', bound='JointSettings')


@dataclass(frozen=True)
class JointSettings:
    """Described parameters: in m and N for a prismatic joint, in rad and N m for a revolute one.

    The constructor gives those of a prismatic joint; :meth:`for_joint` gives those of the kind
    of the joint. Raises ParameterError for a value out of range.
    """

    is_turning: bool = field(default=False, kw_only=True)

    @classmethod
    def for_joint(cls: type[T], joint: Joint, **given: Any) -> T:
        """Return the defaults for the kind of *joint*, with the values *given* in its units."""
        is_turning = instance('joint', joint, Joint, 'a Joint').is_revolute
        return cls.turning(**given) if is_turning else cls(**given)

    @classmethod
    def turning(cls: type[T], **given: Any) -> T:
        """Return the defaults for a revolute joint, with the values *given* in rad and N m."""
        return cls(**{**turning_defaults(cls), 'is_turning': True, **given})

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self, turning=self.is_turning)

    def require(self, *, turning: bool) -> None:
        """Raise ParameterError if these are settings for the other kind of joint."""
        if self.is_turning is not turning:
            own, other = (
                ('turns (rad, N m)', 'slides (m, N)')
                if turning
                else ('slides (m, N)', 'turns (rad, N m)')
            )
            name = type(self).__name__
            raise ParameterError(
                f'the joint {own} and {name} has the units of one that {other}: make it with '
                f'{name}.for_joint(joint, ...)'
            )
