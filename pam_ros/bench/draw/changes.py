# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of the rig that are drawn: a load, the supply, or a push from outside."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from pam_ros.bench.draw.dice import Dice, digits
from pam_ros.bench.draw.effects import Given, Sizes
from pam_ros.bench.draw.rig import Rig

PROBABILITY = 0.35  # of a change, unless the reference holds: then there is always one


class Change(NamedTuple):
    """A change of the rig.

    ``text`` describes it, ``uses`` is the effect that does it, with the values ``start`` from the
    start on. ``then`` are the parameters that change, each time with the delay in s.
    """

    text: str
    uses: str
    start: Given
    then: tuple[tuple[float, Mapping[str, float]], ...]


def picked_up(dice: Dice, rig: Rig, sizes: Sizes) -> Change:
    """Draw a load of 5 to 25 % of the declared one that is picked up."""
    mass = digits(sizes.mass * dice.between(0.05, 0.25))
    then = ((0.0, {'effects.payload.mass': mass}),)
    return Change(f'a load of {mass:.3g} kg is picked up', 'payload', {}, then)


def dropped(dice: Dice, rig: Rig, sizes: Sizes) -> Change:
    """Draw a load of 5 to 25 % of the declared one that is dropped."""
    mass = digits(sizes.mass * dice.between(0.05, 0.25))
    text = f'a payload of {mass:.3g} kg, which is not declared, is dropped'
    return Change(text, 'payload', {'mass': mass}, ((0.0, {'effects.payload.mass': 0.0}),))


def supply_falls(dice: Dice, rig: Rig, sizes: Sizes) -> Change:
    """Draw a supply with which the chambers receive 2 to 8 % less than commanded."""
    share = dice.between(0.02, 0.08)
    text = f'the supply falls, so that the chambers receive {100.0 * share:.2g} % less'
    then = ((0.0, {'effects.pressure_offset.gain': -share}),)
    return Change(text, 'pressure_offset', {}, then)


def push(dice: Dice, rig: Rig, sizes: Sizes) -> Change:
    """Draw a force of 1 to 4 % of that of a muscle, for 0.1 to 1 s.

    It is a disturbance of 0 Hz on one of two antagonistic muscles: on both it would cancel.
    """
    force = digits(sizes.force * dice.signed(0.01, 0.04))
    name, where = 'effects.periodic_disturbance', ''
    if len(rig.muscles) > 1:
        where = ' at one muscle' if rig.is_revolute else ' at each muscle'
        name = f'{rig.muscles[0]}.{name}' if rig.is_revolute else name
    time = dice.decade(0.1, 1.0)
    on = {f'{name}.frequency': 0.0, f'{name}.force_cos': force}
    text = f'a force of {abs(force):.3g} N{where} pushes for {time:.2g} s'
    off = {f'{name}.force_cos': 0.0}
    return Change(text, 'periodic_disturbance', {}, ((0.0, on), (time, off)))


KINDS: Mapping[Callable[[Dice, Rig, Sizes], Change], float] = {
    picked_up: 1.0,
    dropped: 1.0,
    supply_falls: 1.0,
    push: 1.0,
}


def draw_change(dice: Dice, rig: Rig, sizes: Sizes, *, must: bool) -> Change | None:
    """Return a change, or None; there *must* be one if nothing else moves."""
    if not (must or dice.chance(PROBABILITY)):
        return None
    return dice.one_of(KINDS)(dice, rig, sizes)


def timed(change: Change, time: float) -> list[dict[str, Any]]:
    """Return the *change* at this *time* in s, as in a scenario."""
    return [{'time': round(time + delay, 3), **values} for delay, values in change.then]
