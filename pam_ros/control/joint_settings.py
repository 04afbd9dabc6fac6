# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of control whose units and defaults depend on the kind of joint."""

from dataclasses import dataclass, field
from typing import Any, TypeVar

from pam_ros.arguments import instance
from pam_ros.errors import ParameterError
from pam_ros.parameters import check_all, revolute_defaults
from pam_ros.rig.joint import Joint

T = TypeVar('T', bound='JointSettings')


@dataclass(frozen=True)
class JointSettings:
    """Described parameters: in m and N for a prismatic joint, in rad and N m for a revolute one.

    The constructor has the defaults of a prismatic joint; :meth:`for_joint` has those of the kind
    of the joint. Raises ParameterError for a value out of range.
    """

    is_revolute: bool = field(default=False, kw_only=True)

    @classmethod
    def for_joint(cls: type[T], joint: Joint, **given: Any) -> T:
        """Return the defaults for the kind of *joint*, with the values *given* in its units."""
        is_revolute = instance('joint', joint, Joint, 'a Joint').is_revolute
        return cls.revolute(**given) if is_revolute else cls(**given)

    @classmethod
    def revolute(cls: type[T], **given: Any) -> T:
        """Return the defaults for a revolute joint, with the values *given* in rad and N m."""
        return cls(**{**revolute_defaults(cls), 'is_revolute': True, **given})

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self, revolute=self.is_revolute)

    def require(self, *, revolute: bool) -> None:
        """Raise ParameterError if these are settings for the other kind of joint."""
        if self.is_revolute is not revolute:
            own, other = (
                ('revolute (rad, N m)', 'prismatic one (m, N)')
                if revolute
                else ('prismatic (m, N)', 'revolute one (rad, N m)')
            )
            name = type(self).__name__
            raise ParameterError(
                f'the joint is {own} and {name} has the units of a {other}: make it with '
                f'{name}.for_joint(joint, ...)'
            )
