# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A joint: its load, its muscles, the transmission that connects them, and the effects."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import instance, sequence
from pam_ros.cached_property import cached_property
from pam_ros.constructors import RefusesUnknownNames
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import Parameter
from pam_ros.recording.bounds import Bounds
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.effect_values import (
    begun,
    checked_effects,
    library_of,
    onsets,
    split_effects,
)
from pam_ros.rig.layout import Layout, fill_load, layout_of
from pam_ros.rig.loads import Load, LoadEquations, Mass
from pam_ros.rig.transmissions import Straight, Transmission, TransmissionEquations
from pam_ros.similar_names import not_known

Array = NDArray[np.float64]
CONTRACTION = Parameter('contraction at coordinate 0', 'fraction', -0.5, 0.9)


@dataclass(frozen=True)
class Actuator(metaclass=RefusesUnknownNames):
    """A muscle of a joint, with the effects in it and in its pressure path.

    ``contraction`` is that of the muscle at the coordinate 0, as a fraction from -0.5 to 0.9.
    Raises ParameterError if one of the three is not valid.
    """

    muscle: Muscle = field(default_factory=Muscle)
    effects: Sequence[Effect] = ()
    contraction: float = 0.0

    def __post_init__(self) -> None:
        """Check the types; the joint checks whether the effects are allowed here."""
        instance('muscle', self.muscle, Muscle, 'a Muscle')
        object.__setattr__(self, 'effects', checked_effects(self.effects))
        contraction = CONTRACTION.check('contraction', self.contraction, float)
        object.__setattr__(self, 'contraction', contraction)


@dataclass(frozen=True)
class Joint(metaclass=RefusesUnknownNames):
    """A load that one or more muscles move along one coordinate: all that its equations need.

    ``actuators`` are the muscles in order. ``transmission`` connects them to the coordinate.
    ``load`` is what they move: a ``Mass`` by a ``Straight`` transmission, an ``Arm`` by a
    ``Pulley``, a ``Lever`` or a custom one. ``effects`` are those on the joint, such as friction,
    in the joint's units. ``library`` are the effects for which the kernel has places.
    :func:`pam_ros.single_muscle_joint` creates the paper's rig, one muscle on a mass.

    An effect with an ``onset`` in s, ``Leak(rate=0.1, onset=20.0)``, begins to act at this time
    of a simulation. Before this time it is absent, and at this time no pressure and no position
    jumps. Everything else here describes the joint on which all effects act.

    Raises ParameterError for effects that are unknown, out of range or at the wrong place, and
    for a joint that has no equilibrium over the range of pressures.
    """

    # Created by functions, so that help() does not print all their contents.
    actuators: tuple[Actuator, ...] = field(default_factory=lambda: (Actuator(),))
    load: Load = field(default_factory=Mass)
    transmission: Transmission = field(default_factory=Straight)
    effects: Sequence[Effect] = ()
    library: tuple[type[Effect], ...] = field(default_factory=lambda: EFFECTS, repr=False)

    def __post_init__(self) -> None:
        """Check that the parts fit, then the effects, and that there are equilibria."""
        self._check_kinds()
        if not self.actuators:
            raise ParameterError('a joint needs a muscle: actuators is empty')
        if self.load.equations.revolute is not self.transmission.equations.revolute:
            raise ParameterError(
                f'{type(self.transmission).__name__} cannot move {type(self.load).__name__}: a '
                'prismatic load needs a transmission in m, a revolute load one in rad'
            )
        for effect in self.effects:
            self._check_place(effect, on_joint=True)
            effect.check(mass=self.load.mass, revolute=self.is_revolute)
        for actuator in self.actuators:
            for effect in actuator.effects:
                self._check_place(effect, on_joint=False)
        if not self.is_driven:
            self._check_equilibria()
        _ = self.stages  # each stage must be a valid joint, too

    def _check_kinds(self) -> None:
        actuators = sequence(
            'actuators', self.actuators, Actuator, 'an Actuator, such as Actuator(Muscle())'
        )
        object.__setattr__(self, 'actuators', actuators)
        load, transmission = self.load, self.transmission
        instance('load', load, Load, 'a Load, such as Mass() or Arm()')
        instance(
            'transmission',
            transmission,
            Transmission,
            'a Transmission, such as Straight() or Pulley()',
        )
        for name, part, kind in (
            ('load', load, LoadEquations),
            ('transmission', transmission, TransmissionEquations),
        ):
            given = getattr(part, 'equations', None)
            instance(f'{name}.equations', given, kind, f'{kind.__name__}, as a field of its class')
        object.__setattr__(self, 'effects', checked_effects(self.effects))
        object.__setattr__(self, 'library', library_of(self.library))

    def _check_place(self, effect: Effect, *, on_joint: bool) -> None:
        """Raise ParameterError for an effect that is not in the library, or acts elsewhere."""
        if type(effect) not in self.library:
            names = [known.name for known in self.library]
            raise not_known(f'effects.{effect.name}', effect.name, names)
        if effect.acts_on_joint() is not on_joint:
            where = 'on the load' if effect.acts_on_joint() else 'in a muscle'
            raise ParameterError(f'effects.{effect.name} acts {where}: give it there')

    def _check_equilibria(self) -> None:
        for i, muscle in enumerate(self.muscles):
            if muscle.is_load_only:
                raise ParameterError(
                    f'muscle {i + 1} of this joint has no stiffness: a1, a2 and a4 are 0, which '
                    'is only allowed for one muscle on a mass'
                )
        if not statics.is_direct(self):
            low, high = statics.span(self)
            if low >= high:
                raise ParameterError(
                    'the muscles of this joint are never within kappa_min and kappa_max at the '
                    'same time: correct contraction_1, contraction_2 or the lengths l0'
                )
        try:
            for p in itertools.product(*((m.p_min, m.p_max) for m in self.muscles)):
                statics.equilibrium(self, p)
        except RangeError as error:
            raise ParameterError(
                f'mass = {self.load.mass:g} kg and '
                f'{"this muscle" if len(self.actuators) == 1 else "these muscles"} do not fit '
                f'together: {error}'
            ) from error

    # Properties ------------------------------------------------------------------------------

    @property
    def is_revolute(self) -> bool:
        """Whether it is revolute: the coordinate is in rad, the effort is a torque in N m."""
        return self.transmission.equations.revolute

    @property
    def is_driven(self) -> bool:
        """Whether a known force, and not a muscle, moves a mass: no spring, no equilibrium."""
        return statics.is_direct(self) and self.muscles[0].is_load_only

    @cached_property
    def position_range(self) -> tuple[float, float]:
        """The positions, m or rad, at which all muscles have a length: least and greatest."""
        return statics.position_range(self)

    @cached_property
    def bounds(self) -> Bounds:
        """What the values of a recording of this joint cannot exceed."""
        is_single = statics.is_direct(self)
        return Bounds(
            # A known force on a load, which replaces a muscle, has no length.
            l0=self.muscle.l0 if is_single and not self.is_driven else None,
            p_max=tuple(muscle.p_max for muscle in self.muscles),
            reach=None if is_single else self.position_range,
            unit=self.transmission.equations.unit,
        )

    @cached_property
    def muscles(self) -> tuple[Muscle, ...]:
        """The muscles in order."""
        return tuple(actuator.muscle for actuator in self.actuators)

    @cached_property
    def at_zero(self) -> tuple[float, ...]:
        """The position of each muscle's end at the coordinate 0, m."""
        return tuple(one.contraction * one.muscle.l0 for one in self.actuators)

    @cached_property
    def moved_mass(self) -> float:
        """Mass in kg after the effects that change it."""
        m, q = self.load.mass, self._joint_row()
        for effect in self.library:
            if effect.equations.mass is not None:
                m = float(effect.equations.mass(m, q, self.layout.parameter_at[effect.name]))
        return float(m)

    @cached_property
    def inertia(self) -> float:
        """Inertia of the coordinate in kg or kg m^2, with the moved mass."""
        return self.load.equations.inertia(self.moved_mass, self.load.numbers, 0)

    def with_effects(self, *effects: Effect) -> 'Joint':
        """Return this joint with *effects* in addition, such as ``CoulombFriction(level=8.0)``.

        An effect of a muscle is added to each muscle, an effect of the load to the joint. It
        replaces one of the same class. For muscles with different effects make a ``Joint`` of
        several ``Actuator``. Raises ParameterError as Joint does.
        """
        in_muscle, on_joint = split_effects(effects)

        def added(present: Sequence[Effect], new: Sequence[Effect]) -> tuple[Effect, ...]:
            kinds = {type(effect) for effect in new}
            return (*(effect for effect in present if type(effect) not in kinds), *new)

        actuators = tuple(
            replace(actuator, effects=added(actuator.effects, in_muscle))
            for actuator in self.actuators
        )
        return replace(self, actuators=actuators, effects=added(self.effects, on_joint))

    def with_load(self, **changes: Any) -> 'Joint':
        """Return this joint with *changes* of the parameters of its load, such as ``mass=10.0``.

        A ``Mass`` has mass (kg) and mount; an ``Arm`` has inertia (kg m^2), mass (kg), arm (m),
        hanging_at (rad) and plane. Raises ParameterError for a parameter that the load does not
        have, and as Joint does.
        """
        load: Any = self.load
        names = [item.name for item in fields(load)]
        for name, value in changes.items():
            if name not in names:
                kind = type(self.load).__name__
                raise ParameterError(
                    f'{name} = {value!r} is not a parameter of {kind}: give {", ".join(names)}'
                )
        return replace(self, load=replace(load, **changes))

    def map_effects(self, changed: Callable[[Sequence[Effect]], Sequence[Effect]]) -> 'Joint':
        """Return the joint with the effects that *changed* makes of those in each place."""
        actuators = tuple(
            replace(actuator, effects=changed(actuator.effects)) for actuator in self.actuators
        )
        return replace(self, actuators=actuators, effects=changed(self.effects))

    # When effects begin ------------------------------------------------------------------------

    @cached_property
    def stages(self) -> tuple[tuple[float, 'Joint'], ...]:
        """The stages (start in s, joint without effects that begin later), the first from 0 s."""
        each = [self.effects, *(actuator.effects for actuator in self.actuators)]
        times = set().union(*map(onsets, each))
        if not times:
            return ((0.0, self),)
        return tuple((time, self._at(time)) for time in sorted({0.0, *times}))

    def _at(self, time: float) -> 'Joint':
        """Return the joint with the effects that act at *time* s, with their onsets set to 0."""
        return self.map_effects(lambda effects: begun(effects, time))

    @property
    def at_start(self) -> 'Joint':
        """The joint before any effect with an onset begins to act."""
        return self.stages[0][1]

    # One muscle on a mass ----------------------------------------------------------------------

    @property
    def muscle(self) -> Muscle:
        """The muscle of a joint with one muscle; raises ParameterError if it has several."""
        if len(self.actuators) > 1:
            raise ParameterError(f'this joint has {len(self.actuators)} muscles, not one')
        return self.actuators[0].muscle

    @property
    def all_effects(self) -> tuple[Effect, ...]:
        """The effects of a joint with one muscle: those in the muscle and those on the joint."""
        return (*self.actuators[0].effects, *self.effects)

    # Data for the kernel -----------------------------------------------------------------------

    @cached_property
    def layout(self) -> Layout:
        """Places of the effects in the kernel's matrices."""
        return layout_of(
            self.library,
            self.transmission.equations,
            self.load.equations,
            len(self.actuators),
        )

    @cached_property
    def present(self) -> tuple[tuple[type[Effect], ...], ...]:
        """The effects that are present on the joint, then those in each muscle, by row."""
        each = [self.effects, *(actuator.effects for actuator in self.actuators)]
        present = [{type(effect) for effect in row if effect.is_present} for row in each]
        return tuple(tuple(e for e in self.library if e in row) for row in present)

    @property
    def all_present(self) -> tuple[type[Effect], ...]:
        """The effects that are present anywhere, in the order of the library."""
        return tuple(e for e in self.library if any(e in row for row in self.present))

    @property
    def active(self) -> tuple[type[Effect], ...]:
        """The effects that the kernel computes: the whole library if one is present, else none.

        So only two kernels are compiled for each kind of joint, without effects and with all
        effects, and not one for each subset.
        """
        return self.library if any(self.present) else ()

    def parameters(self) -> Array:
        """Return the matrix q of all parameters, SI; see :mod:`pam_ros.rig.layout`."""
        layout = self.layout
        q = np.zeros((layout.rows, layout.parameters))
        q[at.JOINT] = self._joint_row()
        for i, actuator in enumerate(self.actuators):
            row = q[at.MUSCLE + i]
            row[at.A1 : at.A6 + 1] = actuator.muscle.si
            row[at.ZETA], row[at.L0] = actuator.muscle.zeta, actuator.muscle.l0
            row[at.AT_ZERO] = self.at_zero[i]
            self._fill(row, actuator.effects, on_joint=False)
        return q

    def _joint_row(self) -> Array:
        """Return the joint's own row."""
        row = np.zeros(self.layout.parameters)
        row[at.LENGTH] = 1.0 if self.is_revolute else self.actuators[0].muscle.l0
        fill_load(row, self.layout, self.load, self.transmission)
        self._fill(row, self.effects, on_joint=True)
        return row

    def _fill(self, row: Array, effects: Sequence[Effect], *, on_joint: bool) -> None:
        given = {type(effect): effect.row for effect in effects}
        for effect in self.library:
            if effect.acts_on_joint() is on_joint:
                j = self.layout.parameter_at[effect.name]
                absent = tuple(p.default for p in effect.parameters())
                row[j : j + len(absent)] = given.get(effect, absent)
