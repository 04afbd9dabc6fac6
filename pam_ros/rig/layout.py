# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where each number stands in the rows that the compiled kernel works on.

A state row is [y, v, p, hidden states of the pressure path..., hidden states of the forces...],
a parameter row [a1..a6, zeta, l0, mass, gravity, parameters of the effects...], all SI. One row
a muscle: several muscles are a matrix.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # effects read the indices below, so that this file must not need them
    from pam_ros.effects.base import Effect

# State row.
Y, V, P = 0, 1, 2
HIDDEN = 3
# Parameter row.
A1, A2, A3, A4, A5, A6, ZETA, L0, MASS, GRAVITY = range(10)
EFFECTS_FROM = 10


@dataclass(frozen=True, eq=False)
class Layout:
    """Offsets of a tuple of effects in both rows, keyed by the effect's name."""

    effects: tuple[Effect, ...]
    state_at: dict[str, int]
    parameter_at: dict[str, int]
    memory_from: int  # first hidden state that belongs to a force, behind those of the pressure
    width: int
    parameters: int


@lru_cache(maxsize=16)
def layout_of(effects: tuple[Effect, ...]) -> Layout:
    """Lay out *effects*: pressure states first, then the others, both in the order given."""
    state_at, parameter_at = {}, {}
    at = HIDDEN
    for effect in effects:
        if effect.pressure is not None:
            state_at[effect.name] = at
            at += len(effect.states)
    memory_from = at
    for effect in effects:
        if effect.pressure is None:
            state_at[effect.name] = at
            at += len(effect.states)
    q_at = EFFECTS_FROM
    for effect in effects:
        parameter_at[effect.name] = q_at
        q_at += len(effect.parameters)
    return Layout(effects, state_at, parameter_at, memory_from, at, q_at)
