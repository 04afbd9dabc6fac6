# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state of a joint after a long rest: coordinates, pressures and hidden states."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import instance, number
from pam_ros.compiled import broadcast
from pam_ros.effects.base import ENOUGH, Effect
from pam_ros.errors import ParameterError
from pam_ros.rig import layout as at
from pam_ros.rig.layout import Layout

Array = NDArray[np.float64]


def start_state(
    layout: Layout,
    q: Array,
    pressures: Sequence[float] | Array,
    s: float,
    v: float,
    present: Sequence[type[Effect]] | None = None,
) -> Array:
    """Return the state x at the coordinate s and velocity v after a long rest there.

    *q* are the parameters (rows, parameters), *pressures* the commanded ones in Pa, one for each
    muscle; hidden states are those of their effect's ``start``. If *present* is given, the hidden
    states of other effects remain 0, since nothing reads them.
    """
    x = layout.state()
    x[at.JOINT, at.S], x[at.JOINT, at.V] = s, v
    effects = layout.library if present is None else present
    others = behind_reservoir(effects)
    start_joint(layout, q, x, [effect for effect in effects if effect not in others])
    limit = _supplied(layout, q, x, effects)
    for i, pressure in enumerate(pressures):
        start_muscle(layout, q, x, i, min(float(pressure), limit), effects)
    start_joint(layout, q, x, others)
    return x


def behind_reservoir(effects: Sequence[type[Effect]]) -> list[type[Effect]]:
    """Return those of *effects* that act if the pressures at the muscles are given.

    Measured pressures have passed the reservoir, which does not limit them again.
    """
    return [effect for effect in effects if effect.equations.reservoir is None]


def start_muscle(
    layout: Layout, q: Array, x: Array, i: int, pressure: float, effects: Sequence[type[Effect]]
) -> None:
    """Set the hidden states of those of *effects* that act in muscle i, and its pressure.

    *pressure* in Pa is the input of its pressure path. The muscle is at the joint's position.
    """
    row, own = at.MUSCLE + i, q[at.MUSCLE + i]
    y = position(layout, q, x, i)
    kappa = effective_contraction(layout, q, i, y)
    for effect in effects:
        if effect.acts_on_joint():
            continue
        k, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
        _rest(layout, effect, x[row], own, pressure, kappa, y)
        pressure = _behind(effect, pressure, x[row], k, own, j)
    x[row, at.P] = pressure


def start_joint(layout: Layout, q: Array, x: Array, effects: Sequence[type[Effect]]) -> None:
    """Set the hidden states of those of *effects* that act on the joint."""
    own, s = q[at.JOINT], float(x[at.JOINT, at.S])
    mean = float(np.mean(x[at.MUSCLE :, at.P]))
    for effect in effects:
        if effect.acts_on_joint():
            _rest(layout, effect, x[at.JOINT], own, mean, s / float(own[at.LENGTH]), s)


def _rest(
    layout: Layout,
    effect: type[Effect],
    x: Array,
    q: Array,
    pressure: float,
    kappa: float,
    y: float,
) -> None:
    """Set the hidden states of *effect* in its row x to those after a long rest."""
    if effect.equations.start is not None:
        k, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
        x[k : k + len(effect.states)] = effect.equations.start(q, j, pressure, kappa, y)


def begin_effects(
    layout: Layout, q: Array, x: Array, begun: Sequence[Sequence[type[Effect]]]
) -> None:
    """Set the hidden states of effects that begin to act on a moving joint.

    *begun* are those on the joint, then those in each muscle; in the parameters q (rows,
    parameters) they are still absent. Their memories are at rest at the present position, and the
    chambers keep their pressures.
    """
    on_joint, *in_muscles = begun
    for i, effects in enumerate(in_muscles):
        row, own = at.MUSCLE + i, q[at.MUSCLE + i]
        y = position(layout, q, x, i)
        kappa = effective_contraction(layout, q, i, y)
        for effect in effects:
            _rest(layout, effect, x[row], own, float(x[row, at.P]), kappa, y)
    start_joint(layout, q, x, on_joint)


def effective_contraction(layout: Layout, q: Array, i: int, y: float) -> float:
    """Return the effective contraction of muscle i with its end at y m."""
    own = q[at.MUSCLE + i]
    kappa = y / float(own[at.L0])
    for effect in layout.library:
        if effect.equations.contraction is not None:
            kappa = effect.equations.contraction(kappa, own, layout.parameter_at[effect.name])
    return kappa


def position(layout: Layout, q: Array, x: Array, i: int) -> float:
    """Return the position of the end of muscle i in m."""
    s = float(x[at.JOINT, at.S])
    travel = layout.transmission.travel(s, i, q[at.JOINT], layout.transmission_at)
    return float(q[at.MUSCLE + i, at.AT_ZERO] + travel)


def disturb(
    layout: Layout,
    q: Array,
    x: Array,
    pressures: Sequence[float] | Array,
    away: Mapping[str, Mapping[str, float]],
    present: Sequence[type[Effect]],
) -> None:
    """Add *away* to the hidden states of x, which are those of a long rest at *pressures* Pa.

    *away* maps the name of an effect to the names of its states and the change of each, in the
    state's unit; an effect in muscles is changed in all of them equally. The chambers then have
    the pressures of the changed states. Raises ParameterError for an effect without hidden
    states, one that is not among those that are *present*, or a state that it does not have.
    """
    known = {effect.name: effect for effect in layout.library if effect.states}
    here = [effect.name for effect in known.values() if effect in present]
    instance('hidden', away, Mapping, 'the effects with the changes of their hidden states')
    for name, changes in away.items():
        if name not in known:
            raise ParameterError(
                f'effect {name} has no hidden states: give one of ' + ', '.join(known)
            )
        if name not in here:
            raise ParameterError(
                f'effect {name} is absent from this joint: hidden may be of '
                + (', '.join(here) or 'none')
            )
        effect = known[name]
        names = [state.name for state in effect.states]
        rows = [at.JOINT] if effect.acts_on_joint() else range(at.MUSCLE, layout.rows)
        instance(f'hidden.{name}', changes, Mapping, 'its hidden states with the change of each')
        for which, change in changes.items():
            if which not in names:
                raise ParameterError(
                    f'effect {name} has no hidden state {which}: give one of ' + ', '.join(names)
                )
            x[rows, layout.state_at[name] + names.index(which)] += number(
                f'hidden.{name}.{which}', change
            )
    fill_chambers(layout, q, x, pressures, present)


def fill_chambers(
    layout: Layout,
    q: Array,
    x: Array,
    pressures: Sequence[float] | Array,
    present: Sequence[type[Effect]],
) -> None:
    """Set the chambers to the pressures that result from *pressures* Pa and the hidden states.

    The other effects than those that are *present* must be absent in the parameters q.
    """
    limit = _supplied(layout, q, x, present)
    for i, pressure in enumerate(pressures):
        inlet = min(float(pressure), limit)
        x[at.MUSCLE + i, at.P] = _in_chamber(layout, q, x, i, inlet, present)


def _supplied(layout: Layout, q: Array, x: Array, effects: Sequence[type[Effect]]) -> float:
    """Return the present pressure in Pa of the reservoir beyond which no chamber is filled."""
    limit, row, own = ENOUGH, x[at.JOINT], q[at.JOINT]
    for effect in effects:
        if effect.equations.reservoir is not None:
            k, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
            reservoir = _in_python(effect.equations.reservoir)
            limit = min(limit, float(reservoir(0.0, 0.0, row, k, row.copy(), own, j)))
    return limit


def _in_chamber(
    layout: Layout, q: Array, x: Array, i: int, pressure: float, effects: Sequence[type[Effect]]
) -> float:
    """Return the present pressure in the chamber of muscle i, with *pressure* Pa at its inlet."""
    row, own = at.MUSCLE + i, q[at.MUSCLE + i]
    for effect in effects:
        k, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
        pressure = _behind(effect, pressure, x[row], k, own, j)
    return pressure


def _behind(effect: type[Effect], pressure: float, x: Array, k: int, q: Array, j: int) -> float:
    """Return the present pressure after an effect of the path, with *pressure* Pa before it."""
    if effect.equations.pressure is None:
        return pressure
    return float(_in_python(effect.equations.pressure)(pressure, 0.0, 0.0, x, k, x.copy(), q, j))


@lru_cache
def _in_python(function: Callable[..., float]) -> Callable[..., float]:
    """Return *function* without compiled parts: for one call per run, compilation is too slow."""
    return broadcast(function)
