# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A rig as declared: a muscle, the load that it moves, and the effects that are present."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import check_all, parameter
from pam_ros.rig import layout as at
from pam_ros.rig.layout import Layout, layout_of

Array = NDArray[np.float64]
EffectValues = Mapping[str, Mapping[str, float]]
GRAVITY = 9.80665  # m/s^2, standard


@dataclass(frozen=True)
class Load:
    """The mass that the muscle moves, and how it is mounted.

    ``vertical`` is the paper's pendulum: the mass hangs on the muscle. ``horizontal`` slides
    without gravity (the paper's future work; friction of its guide is an effect).
    """

    mass: float = parameter(20.0, 'mass of the load', 'kg', low=0.0, high=1e4, above_low=True)
    mount: str = parameter(
        'vertical',
        'vertical: the load hangs on the muscle; horizontal: it slides without gravity',
        choices=('vertical', 'horizontal'),
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)

    @property
    def gravity(self) -> float:
        """Acceleration in m/s^2 with which gravity stretches the muscle."""
        return GRAVITY if self.mount == 'vertical' else 0.0


@dataclass(frozen=True)
class RigModel:
    """A muscle, its load and its effects: all that the equations of motion need.

    ``effects`` maps an effect's name to its parameters in SI; what is not given has its default,
    absent. ``library`` are the effects that the kernel knows. Raises ParameterError for unknown
    effects or parameters, values out of range, and a load that the muscle cannot hold.
    """

    muscle: Muscle = field(default_factory=Muscle)
    load: Load = field(default_factory=Load)
    effects: EffectValues = field(default_factory=dict)
    library: tuple[Effect, ...] = EFFECTS

    def __post_init__(self) -> None:
        """Check the effects, and that there is an equilibrium over the range of pressure."""
        known = {effect.name: effect for effect in self.library}
        for name, given in self.effects.items():
            if name not in known:
                raise ParameterError(
                    f'effects.{name} is not known: give one of ' + ', '.join(known)
                )
            known[name].values(dict(given))
        if self.muscle.is_load_only:
            return
        for p in (self.muscle.p_min, self.muscle.p_max):
            try:
                self.muscle.equilibrium(p, self.weight)
            except RangeError as error:
                raise ParameterError(
                    f'mass = {self.load.mass:g} kg and this muscle make no rig: {error}'
                ) from error

    @property
    def weight(self) -> float:
        """Force in N with which gravity stretches the muscle, undeclared payload included."""
        return self.moved_mass * self.load.gravity

    @property
    def moved_mass(self) -> float:
        """Mass in kg after the effects that change it."""
        q = self.row()
        m = self.load.mass
        for effect in self.library:
            if effect.mass is not None:
                m = float(effect.mass(m, q, self.layout.parameter_at[effect.name]))
        return m

    @property
    def delay(self) -> float:
        """Time in s by which commands act late."""
        q = self.row()
        return sum(
            float(effect.delay(q, self.layout.parameter_at[effect.name]))
            for effect in self.library
            if effect.delay is not None
        )

    @property
    def layout(self) -> Layout:
        """Offsets of the effects in the kernel's rows."""
        return layout_of(self.library)

    @property
    def present(self) -> tuple[Effect, ...]:
        """The effects that are present: those with a strength that is not zero."""
        return tuple(
            effect
            for effect in self.library
            if effect.is_present(dict(self.effects.get(effect.name, {})))
        )

    @property
    def active(self) -> tuple[Effect, ...]:
        """The effects that the kernel must step: all of the library as soon as one is present.

        Two machine codes, without effects and with all, instead of one for each subset.
        """
        return self.library if self.present else ()

    def row(self) -> Array:
        """Return the kernel's parameter row, SI, shape (layout.parameters,)."""
        q = np.empty(self.layout.parameters)
        q[at.A1 : at.A6 + 1] = self.muscle.si
        q[at.ZETA], q[at.L0] = self.muscle.zeta, self.muscle.l0
        q[at.MASS], q[at.GRAVITY] = self.load.mass, self.load.gravity
        for effect in self.library:
            j = self.layout.parameter_at[effect.name]
            values = effect.values(dict(self.effects.get(effect.name, {})))
            q[j : j + len(values)] = values
        return q

    @property
    def longest_step(self) -> float:
        """Step in s at which the rig's fastest motion turns by 1 rad.

        That is where the muscle is stiffest: in the working range, or where the load stretches
        it to when it is vented at kappa_max and falls. The integrator is stable to 2.6 rad, with
        critical damping to 1.3 rad. A force source without a muscle sets no limit. The drag of
        effects counts as damping; those with memory bring their own updates.
        """
        m, k = self.muscle, 0.0
        if not m.is_load_only:
            p, kappa = np.meshgrid((m.p_min, m.p_max), (self._deepest(), m.kappa_max))
            k = float(np.max(m.stiffness(p, kappa)))  # as the least, the largest is at a corner
        square = k / self.moved_mass
        decay = m.zeta * math.sqrt(square) + 0.5 * self._drag() / self.moved_mass
        fastest = max(math.sqrt(square), decay + math.sqrt(max(decay * decay - square, 0.0)))
        return 1.0 / fastest if fastest > 0.0 else math.inf

    def _drag(self) -> float:
        """Return the largest force per velocity in N s/m that effects add to the muscle's."""
        speed = 10.0  # m/s: fast, so that dry friction counts for nothing
        q, most = self.row(), 0.0
        x = start_row(self.layout, q, 0.0, 0.0, 0.0)
        for p in (self.muscle.p_min, self.muscle.p_max):
            for v in (-speed, speed):
                c = 0.0
                for effect in self.present:
                    j, i = self.layout.parameter_at[effect.name], self.layout.state_at[effect.name]
                    if effect.damping is not None:
                        c = float(effect.damping(c, p, 0.0, v, q, j))
                    if effect.outside is not None:
                        f = effect.outside(0.0, p, 0.0, v, 0.0, 0.0, x, i, x.copy(), q, j)
                        c -= float(f) / v
                most = max(most, c)
        return most

    def _deepest(self) -> float:
        """Return the least contraction of an undamped fall from kappa_max at p_min."""
        m = self.muscle
        kappa = np.linspace(m.kappa_max, m.kappa_min - 0.3, 500)
        energy = self.weight * m.l0 * kappa - m.potential(m.p_min, kappa)
        landed = (energy >= energy[0]) & (kappa < m.kappa_min)
        return float(kappa[np.argmax(landed)]) if np.any(landed) else float(kappa[-1])

    def check_step(self, step: float) -> None:
        """Raise ParameterError when *step* in s is too long for this rig's fastest motion."""
        drag = self._drag()
        braked = f' with a drag of {drag:.4g} N s/m' if drag > 0.0 else ''
        moved = f'a mass of {self.moved_mass:g} kg on this muscle{braked}'
        check_step(step, self.longest_step, moved, 'mass')

    def rest(self, p: float) -> float:
        """Return the position y in m at which the declared model rests at *p* Pa.

        The paper's static model with the moved mass; 0 for a load without a muscle.
        """
        if self.muscle.is_load_only:
            return 0.0
        return self.muscle.equilibrium(p, self.weight) * self.muscle.l0


def check_step(step: float, longest: float, moved: str, more: str) -> None:
    """Raise ParameterError when *step* is none, or longer than *longest*, both in s."""
    if not step > 0.0:
        raise ParameterError(f'a physics step of {step:g} s is not allowed: give more than 0')
    if step > longest:
        raise ParameterError(
            f'a physics step of {step * 1e3:g} ms does not resolve {moved}: give at least '
            f'{math.ceil(1.0 / longest)} steps a second, or more {more}'
        )


def start_row(layout: Layout, q: Array, p: float, y: float, v: float) -> Array:
    """Return a state row at position *y* m, velocity *v* m/s after a long rest at *p* Pa there.

    *q* is the parameter row; hidden states are those of their effect's ``start``.
    """
    x = np.zeros(layout.width)
    x[at.Y], x[at.V] = y, v
    x[at.P] = start_effects(layout.effects, layout, q, x, p)
    return x


def start_effects(
    effects: tuple[Effect, ...], layout: Layout, q: Array, x: Array, p: float
) -> float:
    """Set the hidden states of *effects* in the state row x as after a long rest where x is.

    *p* in Pa is what their pressure path is fed with; returns what it passes on.
    """
    kappa: Any = x[at.Y] / q[at.L0]
    for effect in layout.effects:
        if effect.contraction is not None:
            kappa = effect.contraction(kappa, q, layout.parameter_at[effect.name])
    for effect in effects:
        i, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
        if effect.start is not None:
            x[i : i + len(effect.states)] = effect.start(q, j, p, kappa, x[at.Y])
        if effect.pressure is not None:
            p = effect.pressure(p, 0.0, 0.0, x, i, x.copy(), q, j)
    return p
