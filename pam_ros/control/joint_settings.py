# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of control whose units and defaults depend on the joint.

The defaults of forces and pressures are in proportion to those of the muscles
(:mod:`pam_ros.sizes`). Those of lengths, velocities and accelerations are the same on rigs of all
sizes, since they are of the sensor and of the desired motion.
"""

from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from pam_ros.arguments import instance
from pam_ros.constructors import RefusesUnknownNames
from pam_ros.errors import ParameterError
from pam_ros.parameters import Parameter, check_all, described
from pam_ros.rig.joint import Joint
from pam_ros.sizes import REFERENCE, Sizes, tuned_sizes_of

T = TypeVar('T', bound='JointSettings')


def described_for(
    cls: type, sizes: Sizes, *, revolute: bool
) -> dict[str, tuple[type, Any, Parameter]]:
    """Return the described fields of a dataclass with the defaults of a rig of these *sizes*."""
    scale = replace(sizes, length=1.0)
    return {
        name: (kind, scale.factor(about.unit) * default if kind is float else default, about)
        for name, (kind, default, about) in described(cls, revolute=revolute).items()
    }


def defaults_of(cls: type, sizes: Sizes, *, revolute: bool) -> dict[str, Any]:
    """Return the described fields of a dataclass with their defaults on a rig of these *sizes*."""
    table = described_for(cls, sizes, revolute=revolute)
    return {name: default for name, (_, default, _) in table.items()}


@dataclass(frozen=True)
class JointSettings(metaclass=RefusesUnknownNames):
    """Described parameters: in m and N for a prismatic joint, in rad and N m for a revolute one.

    The constructor has the defaults of a prismatic joint of the reference rig; :meth:`for_joint`
    has those of the kind of the joint and of the sizes of its muscles. Raises ParameterError for
    a value out of range.
    """

    is_revolute: bool = field(default=False, kw_only=True)

    @classmethod
    def for_joint(cls: type[T], joint: Joint, **given: Any) -> T:
        """Return the defaults for *joint*, with the values *given* in its units."""
        is_revolute = instance('joint', joint, Joint, 'a Joint').is_revolute
        own = defaults_of(cls, tuned_sizes_of(joint), revolute=is_revolute)
        return cls(**{**own, 'is_revolute': is_revolute, **given})

    @classmethod
    def revolute(cls: type[T], **given: Any) -> T:
        """Return the defaults for a revolute joint, with the values *given* in rad and N m."""
        return cls(**{**defaults_of(cls, REFERENCE, revolute=True), 'is_revolute': True, **given})

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
