# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The range of a coordinate in which a condition holds."""

from collections.abc import Callable

PLACES = 400  # intervals between tested coordinates: a range shorter than one may be missed
HALVINGS = 20  # of an interval, to find the end of the range in it


def stretch(
    within: tuple[float, float], holds: Callable[[float], bool]
) -> tuple[float, float] | None:
    """Return the least and the greatest coordinate *within* at which *holds* is true, or None.

    It is assumed that it holds at all places between these.
    """
    low, high = within
    if low >= high:
        return None
    places = [low + (high - low) * k / PLACES for k in range(PLACES + 1)]
    held = [k for k, s in enumerate(places) if holds(s)]
    if not held:
        return None
    first, last = places[held[0]], places[held[-1]]
    if held[0] > 0:
        first = _end(first, places[held[0] - 1], holds)
    if held[-1] < PLACES:
        last = _end(last, places[held[-1] + 1], holds)
    return first, last


def _end(inside: float, outside: float, holds: Callable[[float], bool]) -> float:
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        if holds(middle):
            inside = middle
        else:
            outside = middle
    return inside
