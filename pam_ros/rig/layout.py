# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The place of each number in the arrays that the compiled kernels work on.

A joint has a state x and parameters q. Each is a matrix with a row for the joint itself, followed
by one row for each of its muscles, all SI:

    x[JOINT]         coordinate s, velocity v, hidden states of the effects on the joint
    x[MUSCLE + i]    chamber pressure, hidden states of the pressure path, those of the forces
    q[JOINT]         inertia, length, mass, effects on the joint, numbers of load and transmission
    q[MUSCLE + i]    a1..a6, zeta, l0, position at coordinate 0, effects in the muscle

The scratch matrix xn that belongs to x has WORK more columns, for values that the stages of a step
share.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.effects.rows import A1, A2, A3, A4, A5, A6, INERTIA, L0, LENGTH, ZETA
from pam_ros.rig.loads import Load, LoadEquations
from pam_ros.rig.transmissions import Transmission, TransmissionEquations

__all__ = ['A1', 'A2', 'A3', 'A4', 'A5', 'A6', 'INERTIA', 'L0', 'LENGTH', 'ZETA', 'Layout']

Array = NDArray[np.float64]
Size = Callable[[type[Effect]], int]

JOINT, MUSCLE = 0, 1  # rows: the joint's, and that of its first muscle
# State of the joint, and of a muscle.
S, V, JOINT_HIDDEN = 0, 1, 2
P, HIDDEN = 0, 1
# Parameters of the joint and of a muscle, after those that effects read.
MASS, JOINT_EFFECTS = LENGTH + 1, LENGTH + 2
AT_ZERO, MUSCLE_EFFECTS = L0 + 1, L0 + 2
# Scratch of a muscle, counted from the width of a state: the chamber pressure at the start, in the
# middle and at the end of a step.
START, MIDDLE, END = 0, 1, 2
WORK = 3
# Outputs of a muscle: force, stiffness, damping, acceleration of its end, contraction; of a joint:
# effort, stiffness, acceleration.
CONTRACTION, OUTPUTS, JOINT_OUTPUTS = 4, 5, 3
# Columns of a run: coordinate, velocity, then pressure and force of each muscle.
RUN_S, RUN_V, RUN_P, RUN_F = 0, 1, 2, 3


@dataclass(frozen=True, eq=False)
class Layout:
    """Places of the effects of a *library* in the rows of joints of one kind.

    ``state_at`` and ``parameter_at`` map the name of an effect to the index at which its hidden
    states or its parameters begin, in the row in which it acts. ``memory_from`` is the first
    hidden state of a muscle that belongs to a force, after those of the pressure path.
    ``load_at`` and ``transmission_at`` are the indices at which the numbers of load and
    transmission begin. ``width`` and ``parameters`` are the widths of x and q.
    """

    library: tuple[type[Effect], ...]
    transmission: TransmissionEquations
    load: LoadEquations
    muscles: int
    state_at: dict[str, int]
    parameter_at: dict[str, int]
    memory_from: int
    load_at: int
    transmission_at: int
    width: int
    parameters: int

    @property
    def rows(self) -> int:
        """Number of rows: one of the joint and one of each muscle."""
        return MUSCLE + self.muscles

    @property
    def run_columns(self) -> int:
        """Number of columns of a run."""
        return RUN_P + 2 * self.muscles

    def state(self) -> Array:
        """Return an empty state x."""
        return np.zeros((self.rows, self.width))

    def scratch(self) -> Array:
        """Return an empty scratch matrix xn."""
        return np.zeros((self.rows, self.width + WORK))

    def index(self, effect: type[Effect], parameter: int = 0, muscle: int = 0) -> int:
        """Return the index of a parameter of *effect* in q, counted through all rows.

        *muscle* is the number of the muscle, for an effect that acts in a muscle.
        """
        row = JOINT if effect.acts_on_joint() else MUSCLE + muscle
        return row * self.parameters + self.parameter_at[effect.name] + parameter

    def constant(self, which: int, muscle: int = 0) -> int:
        """Return the index in q of a constant of a muscle, such as A1 or ZETA."""
        return (MUSCLE + muscle) * self.parameters + which


@lru_cache(maxsize=32)
def layout_of(
    library: tuple[type[Effect], ...],
    transmission: TransmissionEquations,
    load: LoadEquations,
    muscles: int,
) -> Layout:
    """Lay out joints of *muscles* muscles, with these equations and effects.

    In a muscle the states of the pressure path come first, since they are computed before the
    forces of a step; otherwise states and parameters are in the order of the library. In a joint
    the effects come before load and transmission, so that their places are the same in every
    kind of joint.
    """
    on_joint = [effect for effect in library if effect.acts_on_joint()]
    in_muscle = [effect for effect in library if not effect.acts_on_joint()]
    path = [effect for effect in in_muscle if effect.equations.pressure is not None]
    forces = [effect for effect in in_muscle if effect.equations.pressure is None]
    state_at: dict[str, int] = {}
    parameter_at: dict[str, int] = {}
    joint_width = _place(state_at, on_joint, JOINT_HIDDEN, _states)
    memory_from = _place(state_at, path, HIDDEN, _states)
    muscle_width = _place(state_at, forces, memory_from, _states)
    load_at = _place(parameter_at, on_joint, JOINT_EFFECTS, _parameters)
    transmission_at = load_at + load.numbers
    muscle_row = _place(parameter_at, in_muscle, MUSCLE_EFFECTS, _parameters)
    return Layout(
        library,
        transmission,
        load,
        muscles,
        state_at,
        parameter_at,
        memory_from,
        load_at,
        transmission_at,
        max(joint_width, muscle_width),
        max(transmission_at + transmission.numbers, muscle_row),
    )


def _states(effect: type[Effect]) -> int:
    return len(effect.states)


def _parameters(effect: type[Effect]) -> int:
    return len(effect.parameters())


def _place(places: dict[str, int], effects: list[type[Effect]], at: int, size: Size) -> int:
    """Give each effect its place, the first at *at*; return the index after the last one."""
    for effect in effects:
        places[effect.name] = at
        at += size(effect)
    return at


def delays_of(layout: Layout, q: Array) -> tuple[float, ...]:
    """Return the delay in s of the commands of each muscle, from the parameters q."""
    delays = [
        (effect.equations.delay, layout.parameter_at[effect.name])
        for effect in layout.library
        if effect.equations.delay is not None
    ]
    return tuple(float(sum(delay(row, j) for delay, j in delays)) for row in q[MUSCLE:])


def fill_load(row: Array, layout: Layout, load: Load, transmission: Transmission) -> None:
    """Write the numbers of *load* and *transmission* into the joint's own row of q."""
    row[INERTIA] = load.equations.inertia(load.mass, load.numbers, 0)
    row[MASS] = load.mass
    row[layout.load_at : layout.load_at + len(load.numbers)] = load.numbers
    numbers = transmission.numbers
    row[layout.transmission_at : layout.transmission_at + len(numbers)] = numbers
