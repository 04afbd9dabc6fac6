# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The places where an effect can be added to a joint: in all muscles, in one, or on the joint.

The typical sizes of an effect, its ranges, and the starting values of a fit are those of a
reference rig, and are scaled to the sizes of the joint (:mod:`pam_ros.sizes`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.cached_property import cached_property
from pam_ros.effects.base import Effect, HiddenState, Starts
from pam_ros.effects.names import EffectName, parsed
from pam_ros.effects.parameter import EffectParameter
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout
from pam_ros.sizes import (
    REFERENCE,
    Revolute,
    Sizes,
    revolute_of,
    sizes_of,
)

Array = NDArray[np.float64]
INITIAL = 'initial'  # the parameter for the memory of an effect at the start


@dataclass(frozen=True, eq=False)
class Place:
    """An effect at a place of a joint.

    ``muscles`` are the numbers of the muscles in which it acts, with the same parameters; none for
    an effect on the joint. ``names`` are the names of these muscles if the joint has several.
    ``sizes`` are those of the rig, and ``revolute`` are further ones for an effect on a revolute
    joint.
    """

    effect: type[Effect]
    muscles: tuple[int, ...]
    names: tuple[str, ...] = ()
    sizes: Sizes = REFERENCE
    revolute: Revolute | None = None

    @cached_property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """The parameters of the effect, with their units, sizes and ranges at this place."""
        is_revolute = self.revolute is not None
        pairs = zip(
            self.effect.parameters(revolute=is_revolute), self.effect.parameters(), strict=True
        )
        return tuple(
            p.sized(self.sizes.factor(plain.unit), self._factor(plain.unit)) for p, plain in pairs
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
        return tuple(
            replace(s, spread=self._factor(s.unit) * s.spread) for s in self.effect.states
        )

    def guess(self, t: Array, p: Array, position: Array, residual: Array, unit: str) -> Starts:
        """Return the starting values that the effect derives from a recording, see its equations.

        *position* is the contraction of a single muscle in line with a load, else the angle, and
        *residual* is in *unit*.
        """
        if self.effect.equations.guess is None:
            return ()
        kappa = position if self.revolute is None else self.revolute.contraction(position)
        at_reference = t, p / self.sizes.pressure, kappa, residual / self.sizes.factor(unit)
        return tuple(map(self._sized, self.effect.equations.guess(*at_reference)))

    def _factor(self, unit: str) -> float:
        """Return the size at this place of 1 *unit* on the reference rig."""
        turned = 1.0 if self.revolute is None else self.revolute.factor(unit)
        return self.sizes.factor(unit) * turned

    def _sized(self, values: Mapping[str, float]) -> dict[str, float]:
        units = {p.name: p.unit for p in self.effect.parameters()}
        return {name: self._factor(units[name]) * value for name, value in values.items()}

    @property
    def muscle(self) -> str:
        """The name of the muscle if it acts in one of several, otherwise empty."""
        return self.names[0] if len(self.names) == 1 else ''

    @property
    def name(self) -> str:
        """Its name: that of the effect, after that of the muscle if it acts in one of several."""
        return f'{self.muscle}.{self.effect.name}' if self.muscle else self.effect.name

    @property
    def rows(self) -> tuple[int, ...]:
        """The rows of the kernel's matrices in which it acts."""
        return tuple(at.MUSCLE + i for i in self.muscles) or (at.JOINT,)

    def flat(self, parameter: str) -> str:
        """Return the name of one of its parameters in a file of parameters."""
        flat = EffectName(self.effect.name, parameter).flat
        return f'{self.muscle}.{flat}' if self.muscle else flat

    def indices(self, layout: Layout, parameter: int) -> list[int]:
        """Return the indices of parameter number *parameter* in q, counted through all rows."""
        return [layout.index(self.effect, parameter, i) for i in self.muscles or (0,)]

    def split(self, layout: Layout, parameter: int) -> list[tuple[str, tuple[int, ...]]]:
        """Return names and indices in q of the numbers that a fit may change for a parameter.

        This is one number for all muscles. Only the initial memory is separate for each muscle: of
        two antagonistic muscles one was shortened while the other was lengthened.
        """
        name = self.parameters[parameter].name
        indices = self.indices(layout, parameter)
        if name != INITIAL or len(indices) == 1:
            return [(self.flat(name), tuple(indices))]
        flat = EffectName(self.effect.name, name).flat
        pairs = zip(self.names, indices, strict=True)
        return [(f'{muscle}.{flat}', (index,)) for muscle, index in pairs]

    def overlaps(self, other: 'Place') -> bool:
        """Return whether both are the same effect in the same row."""
        is_same = self.effect.name == other.effect.name
        return is_same and bool({*self.rows} & {*other.rows})


def effect_of(name: str) -> str:
    """Return the name of the effect of a place called *name*."""
    return name.rpartition('.')[2]


def muscle_of(name: str) -> str:
    """Return the name of the muscle in the *name* of a place, empty if there is none."""
    return name.rpartition('.')[0]


def place_of(flat: str) -> str:
    """Return the name of the place of a parameter by its *flat* name; empty if of no effect."""
    name = parsed(flat)
    if name is not None:
        return name.effect
    muscle, _, rest = flat.partition('.')
    name = parsed(rest)
    return '' if name is None else f'{muscle}.{name.effect}'


def spelled(name: str) -> str:
    """Return a place's *name* as in a sentence: ``pressure_lag of agonist``."""
    muscle = muscle_of(name)
    return f'{effect_of(name)} of {muscle}' if muscle else name


def names_of_muscles(joint: Joint, given: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the names of the muscles of *joint*: those *given*, or made from their numbers."""
    return tuple(given) or tuple(f'muscle_{i + 1}' for i in range(len(joint.muscles)))


def places_of(joint: Joint, muscles: Sequence[str] = ()) -> dict[str, Place]:
    """Return by name every place at which an effect of the joint's library can act.

    *muscles* are the names of its muscles. An effect in muscles can act in all of several muscles,
    or in each of them alone.
    """
    every = tuple(range(len(joint.muscles)))
    found = []
    names = names_of_muscles(joint, muscles) if len(every) > 1 else ()
    sizes, revolute = sizes_of(joint), revolute_of(joint)
    for effect in joint.library:
        if effect.acts_on_joint():
            found.append(Place(effect, (), (), sizes, revolute))
            continue
        found.append(Place(effect, every, names, sizes))
        found += [Place(effect, (i,), (name,), sizes) for i, name in enumerate(names)]
    return {place.name: place for place in found}
