# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where an effect can be added to a joint: in all muscles alike, in one of them, on the joint.

The typical sizes of an effect, and the values from which a fit begins, are those of a load that
slides. On a joint that turns they are scaled by the arm of its muscles, so that they do to the
joint what they do to such a load.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect, HiddenState, Starts
from pam_ros.effects.names import EffectName, parsed
from pam_ros.effects.parameter import EffectParameter
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout
from pam_ros.units import ARM_POWER

Array = NDArray[np.float64]
INITIAL = 'initial'  # the parameter that says where an effect's memory stands at the start


@dataclass(frozen=True)
class Turned:
    """A joint that turns: the mean arm of its muscles, and their mean length, both in m."""

    arm: float
    length: float

    def contraction(self, angle: Array) -> Array:
        """Return the contraction of a muscle that an *angle* in rad is."""
        return angle * self.arm / self.length

    def factor(self, unit: str) -> float:
        """Return the size there of 1 *unit* on a load that slides.

        A force at the arm is a torque, a length along the motion is an angle; a contraction is one
        of a muscle of this length.
        """
        if unit == 'fraction':
            return self.length / self.arm
        return float(self.arm ** ARM_POWER.get(unit, 0))


@dataclass(frozen=True, eq=False)
class Place:
    """An effect at a place of a joint.

    ``muscles`` are the numbers of the muscles in which it acts, with the same parameters; none for
    an effect on the joint. ``names`` are the names of these muscles where the joint has several.
    Of an effect on a joint that turns, ``turned`` gives the sizes.
    """

    effect: type[Effect]
    muscles: tuple[int, ...]
    names: tuple[str, ...] = ()
    turned: 'Turned | None' = None

    @cached_property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """The parameters of the effect, with the units and sizes that they have there."""
        if self.turned is None:
            return self.effect.parameters()
        return tuple(
            replace(p, scale=self.turned.factor(plain.unit) * p.scale)
            for p, plain in zip(
                self.effect.parameters(turning=True), self.effect.parameters(), strict=True
            )
        )

    @cached_property
    def fit_starts(self) -> Starts:
        """Values from which a fit begins."""
        return tuple(map(self._sized, self.effect.fit_starts()))

    @cached_property
    def example(self) -> dict[str, float]:
        """Values with which the effect is clearly present."""
        return self._sized(self.effect.example().given)

    @cached_property
    def states(self) -> tuple[HiddenState, ...]:
        """The hidden states of the effect."""
        if self.turned is None:
            return self.effect.states
        return tuple(
            replace(s, spread=self.turned.factor(s.unit) * s.spread) for s in self.effect.states
        )

    def guess(self, t: Array, p: Array, position: Array, residual: Array) -> Starts:
        """Return the values that the effect reads from a recording, as its equations describe.

        *position* is the contraction of the one muscle in line with a load, else the angle.
        """
        if self.effect.equations.guess is None:
            return ()
        kappa = position if self.turned is None else self.turned.contraction(position)
        return tuple(map(self._sized, self.effect.equations.guess(t, p, kappa, residual)))

    def _sized(self, values: Mapping[str, float]) -> dict[str, float]:
        if self.turned is None:
            return dict(values)
        units = {p.name: p.unit for p in self.effect.parameters()}
        return {name: self.turned.factor(units[name]) * value for name, value in values.items()}

    @property
    def muscle(self) -> str:
        """The name of the one muscle of several in which it acts, empty in all other cases."""
        return self.names[0] if len(self.names) == 1 else ''

    @property
    def name(self) -> str:
        """Its name: that of the effect, behind the name of a muscle where it is in one alone."""
        return f'{self.muscle}.{self.effect.name}' if self.muscle else self.effect.name

    @property
    def rows(self) -> tuple[int, ...]:
        """The rows of the kernel's matrices in which it acts."""
        return tuple(at.MUSCLE + i for i in self.muscles) or (at.JOINT,)

    def flat(self, parameter: str) -> str:
        """Return the name that a parameter of it has in a file of parameters."""
        flat = EffectName(self.effect.name, parameter).flat
        return f'{self.muscle}.{flat}' if self.muscle else flat

    def indices(self, layout: Layout, parameter: int) -> list[int]:
        """Return where parameter number *parameter* stands in q, counted through all rows."""
        return [layout.index(self.effect, parameter, i) for i in self.muscles or (0,)]

    def split(self, layout: Layout, parameter: int) -> list[tuple[str, tuple[int, ...]]]:
        """Return the names and the places in q of what a fit may change of a parameter.

        That is one number for all muscles alike, but where a memory stands at the start is each
        muscle's own: of two against each other one was shortened while the other was lengthened.
        """
        name = self.parameters[parameter].name
        indices = self.indices(layout, parameter)
        if name != INITIAL or len(indices) == 1:
            return [(self.flat(name), tuple(indices))]
        flat = EffectName(self.effect.name, name).flat
        pairs = zip(self.names, indices, strict=True)
        return [(f'{muscle}.{flat}', (index,)) for muscle, index in pairs]

    def overlaps(self, other: 'Place') -> bool:
        """Say whether both are the same effect in the same row."""
        is_same = self.effect.name == other.effect.name
        return is_same and bool({*self.rows} & {*other.rows})


def effect_of(name: str) -> str:
    """Return the name of the effect of a place called *name*."""
    return name.rpartition('.')[2]


def muscle_of(name: str) -> str:
    """Return the name of the one muscle of a place called *name*, empty where there is none."""
    return name.rpartition('.')[0]


def place_of(flat: str) -> str:
    """Return the name of the place of a parameter by its *flat* name; empty for no effect's."""
    name = parsed(flat)
    if name is not None:
        return name.effect
    muscle, _, rest = flat.partition('.')
    name = parsed(rest)
    return '' if name is None else f'{muscle}.{name.effect}'


def spelled(name: str) -> str:
    """Return a place's *name* as a sentence has it: ``pressure_lag of agonist``."""
    muscle = muscle_of(name)
    return f'{effect_of(name)} of {muscle}' if muscle else name


def names_of_muscles(joint: Joint, given: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the names of the muscles of *joint*: those *given*, or made of their numbers."""
    return tuple(given) or tuple(f'muscle_{i + 1}' for i in range(len(joint.muscles)))


def places_of(joint: Joint, muscles: Sequence[str] = ()) -> dict[str, Place]:
    """Return by name every place at which an effect of the joint's library can act.

    *muscles* are the names of its muscles. What acts in muscles can be in all of several alike or
    in each alone.
    """
    every = tuple(range(len(joint.muscles)))
    found = []
    names = names_of_muscles(joint, muscles) if len(every) > 1 else ()
    turned = turned_of(joint)
    for effect in joint.library:
        if effect.acts_on_joint():
            found.append(Place(effect, (), turned=turned))
            continue
        found.append(Place(effect, every, names))
        found += [Place(effect, (i,), (name,)) for i, name in enumerate(names)]
    return {place.name: place for place in found}


def turned_of(joint: Joint) -> Turned | None:
    """Return the sizes of a *joint* that turns, None for a load that slides."""
    if not joint.is_revolute:
        return None
    arm = float(np.mean(np.abs(statics.middle_arms(joint))))
    return Turned(arm, float(np.mean([m.l0 for m in joint.muscles])))
