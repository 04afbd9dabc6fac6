# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A joint as declared: its load, the muscles that drive it, and the effects on all of them."""

import itertools
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig import settle, statics, swing
from pam_ros.rig.joints import JOINTS, mass
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.rig.joints.base import Joint, acts_in_muscle, acts_on_load
from pam_ros.rig.layout import Layout, layout_of
from pam_ros.rig.model import EffectValues, check_step

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Actuator:
    """A muscle of a joint, with the effects in it and in its pressure path."""

    muscle: Muscle = field(default_factory=Muscle)
    effects: EffectValues = field(default_factory=dict)


@dataclass(frozen=True)
class JointModel:
    """A load that several muscles move with one coordinate: all that its equations need.

    ``load`` is what a joint of :mod:`pam_ros.rig.joints` declares: a ``PulleyArm`` for an
    antagonistic pair, a ``ParallelLoad`` for two muscles side by side. (One muscle with its
    load is a :class:`~pam_ros.rig.model.RigModel`.) ``actuators`` are the muscles in the joint's
    order. ``effects`` are those on the load, such as friction, in the joint's units (see
    ``Joint.on_load``). ``library`` are the effects that the kernel knows. Raises
    ParameterError for a wrong number of muscles, for effects that are unknown, out of range or
    at the wrong place, and for a joint that has no equilibrium over the range of pressures.
    """

    load: Any = field(default_factory=PulleyArm)
    actuators: tuple[Actuator, ...] = (Actuator(), Actuator())
    effects: EffectValues = field(default_factory=dict)
    library: tuple[Effect, ...] = field(default=EFFECTS, repr=False)

    def __post_init__(self) -> None:
        """Check the muscles, the effects, and that there are equilibria."""
        if len(self.actuators) != self.joint.muscles:
            raise ParameterError(
                f'{len(self.actuators)} muscles make no {self.joint.name}: give '
                f'{self.joint.muscles}'
            )
        for name, given in self.effects.items():
            self._known(name, acts_on_load, 'acts in a muscle').values(dict(given))
        for actuator in self.actuators:
            for name, given in actuator.effects.items():
                self._known(name, acts_in_muscle, 'acts on the load').values(dict(given))
        self._check_reach()

    def _known(self, name: str, is_here: Any, elsewhere: str) -> Effect:
        """Return the effect with the units that it has here, or say why it is none."""
        found = [effect for effect in self.library if effect.name == name]
        if not found:
            raise ParameterError(
                f'effects.{name} is not known: give one of '
                + ', '.join(effect.name for effect in self.library if is_here(effect))
            )
        if not is_here(found[0]) or (acts_on_load(found[0]) and acts_in_muscle(found[0])):
            raise ParameterError(f'effects.{name} {elsewhere}: give it there')
        return self.joint.on_load(found[0]) if acts_on_load(found[0]) else found[0]

    def _check_reach(self) -> None:
        for i, muscle in enumerate(self.muscles):
            if muscle.is_load_only:
                raise ParameterError(
                    f'muscle {i + 1} of {self.joint.name} has no stiffness: a1, a2 and a4 are 0'
                )
        low, high = self.travel
        if low >= high:
            raise ParameterError(
                f'the muscles of {self.joint.name} are never within kappa_min and kappa_max '
                'together: mend contraction_1, contraction_2 or the lengths l0'
            )
        try:
            for p in itertools.product(*((m.p_min, m.p_max) for m in self.muscles)):
                statics.equilibrium(self, p)
        except RangeError as error:
            raise ParameterError(
                f'mass = {self.load.mass:g} kg and these muscles make no {self.joint.name}: '
                f'{error}'
            ) from error

    @cached_property
    def joint(self) -> Joint:
        """The kind of joint."""
        return JOINTS[self.kind]

    @cached_property
    def kind(self) -> int:
        """Index of the kind of joint among JOINTS."""
        for kind, joint in enumerate(JOINTS):
            if type(self.load) is joint.declared and joint is not mass.JOINT:
                return kind
        raise ParameterError(
            f'{type(self.load).__name__} is the load of no joint: give one of '
            + ', '.join(joint.declared.__name__ for joint in JOINTS if joint is not mass.JOINT)
        )

    @property
    def muscles(self) -> tuple[Muscle, ...]:
        """The muscles in the joint's order."""
        return tuple(actuator.muscle for actuator in self.actuators)

    @cached_property
    def geometry(self) -> tuple[float, ...]:
        """The joint's own numbers: g of its equations."""
        return self.joint.row(self.load, self.muscles)

    @cached_property
    def moved_mass(self) -> float:
        """Mass in kg after the effects that change it."""
        m, q = self.load.mass, self._load_row()
        for effect in self.library:
            if effect.mass is not None:
                m = float(effect.mass(m, q, self.layout.parameter_at[effect.name]))
        return float(m)

    @cached_property
    def inertia(self) -> float:
        """What resists acceleration in kg or kg m^2, with the moved mass."""
        return self.joint.inertia(self.moved_mass, self.geometry)

    @property
    def travel(self) -> tuple[float, float]:
        """Coordinates between which all muscles have a contraction that is permissible."""
        return statics.span(self)

    def each(self, p: ArrayLike) -> list[float]:
        """Return pressures in Pa, one a muscle, of as many or of one for all."""
        return [float(one) for one in np.broadcast_to(np.asarray(p, float), len(self.actuators))]

    def rest(self, p: ArrayLike) -> float:
        """Return the coordinate at which the joint rests at *p* Pa, effects included."""
        return settle.rest(self, p)

    @cached_property
    def longest_step(self) -> float:
        """Step in s at which the joint's fastest motion turns by 1 rad."""
        return swing.longest_step(self)

    def check_step(self, step: float) -> None:
        """Raise ParameterError when *step* in s is too long for this joint's fastest motion."""
        if self.joint.revolute:
            moved, more = f'an inertia of {self.inertia:g} kg m^2', 'inertia'
        else:
            moved, more = f'a mass of {self.inertia:g} kg', 'mass'
        check_step(step, self.longest_step, f'{moved} on these muscles', more)

    # What the kernel gets --------------------------------------------------------------------

    @property
    def layout(self) -> Layout:
        """Offsets of the effects in the kernel's rows."""
        return layout_of(self.library)

    @property
    def present(self) -> tuple[tuple[Effect, ...], ...]:
        """The effects that are present in each muscle, and last those on the load."""
        each = [actuator.effects for actuator in self.actuators] + [self.effects]
        return tuple(
            tuple(e for e in self.library if e.is_present(dict(given.get(e.name, {}))))
            for given in each
        )

    @property
    def active(self) -> tuple[Effect, ...]:
        """The effects that the kernel must step: all of the library as soon as one is present."""
        return self.library if any(self.present) else ()

    def rows(self) -> Array:
        """Return the parameter rows of the muscles and of the load, (muscles + 1, parameters)."""
        rows = []
        for i, actuator in enumerate(self.actuators):
            row = np.zeros(self.layout.parameters)
            arm = self.joint.arm(0.0, i, self.geometry)
            row[at.MASS] = self.inertia / (len(self.actuators) * arm * arm)
            row[at.A1 : at.A6 + 1] = actuator.muscle.si
            row[at.ZETA], row[at.L0] = actuator.muscle.zeta, actuator.muscle.l0
            self._fill(row, actuator.effects)
            rows.append(row)
        return np.array([*rows, self._load_row()])

    def _load_row(self) -> Array:
        """Return the load's row: its inertia for a mass; lengths as the coordinate has them."""
        row = np.zeros(self.layout.parameters)
        row[at.MASS] = self.joint.inertia(self.load.mass, self.geometry)
        row[at.L0] = 1.0 if self.joint.revolute else self.muscles[0].l0
        self._fill(row, self.effects)
        return row

    def _fill(self, row: Array, effects: EffectValues) -> None:
        for effect in self.library:
            j = self.layout.parameter_at[effect.name]
            given = effects.get(effect.name, {})
            values = [given.get(p.name, p.default) for p in effect.parameters]
            row[j : j + len(values)] = values
