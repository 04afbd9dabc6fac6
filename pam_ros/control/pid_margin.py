# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The share of the PID gains that a nominal joint allows: bounded sensitivity everywhere.

Near a reference the joint is J s'' + c s' + k s = G p, where k includes the stiffness of gravity
and G is the effort per pressure. With the PID law, its filter of bandwidth a and a delay T the
loop is

    L = (Kp + Ki / x + Kd x) (a / (x + a))^2 G e^(-T x) / (J x^2 + c x + k)

The default gains have the least error after a load, with a bounded largest sensitivity
|1 / (1 + L)|, on one muscle and on one pair. The same bounds are applied here to every nominal
joint. A share is one factor for all three gains and another one for the integral gain. Of all
shares within the bounds, the one with the most integral gain is used, since the integral of the
error after a load is its inverse (Astrom & Hagglund, Advanced PID Control, 2006, sections 4.4 and
7.1).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from pam_ros.control.tuning import number


class LinearPlant(NamedTuple):
    """A joint near one place: inertia, damping, stiffness with gravity, effort per pressure."""

    inertia: float
    damping: float
    stiffness: float
    gain: float


class Share(NamedTuple):
    """Share of all three gains, and of the integral gain."""

    all: float
    integral: float


@dataclass(frozen=True)
class MarginTuning:
    """The bounds of the sensitivity, and where they are evaluated."""

    peak: float = number(1.6, '', 'of the sensitivity of the nominal joint: as of the defaults')
    late_peak: float = number(2.0, '', 'of the sensitivity with the lag: as of the defaults')
    lag: float = number(0.06, 's', 'of the pressure, not configured: as of the defaults')
    delay: float = number(0.003, 's', 'of the loop: a sample and a half at 500 Hz')
    slowest: float = number(
        0.03, 'rad/s', 'lowest frequency: far below 1/s, the slowest decay of an error'
    )
    quickest: float = number(2e4, 'rad/s', 'highest frequency: far above the filter, L is about 0')
    frequencies: int = number(160, '', 'at a constant ratio of 1.088, finer than a peak of 2.0')
    halvings: int = number(7, '', 'down to 1/128 of the gains')
    steps: int = number(2, '', 'shares in a halving: each is 1.41 times the next')
    at_once: int = number(10, '', 'shares that are evaluated together: affects only the speed')


TUNING = MarginTuning()
_ORDER = 5  # of the loop without the lag: the load, the filter and the integral


def share(gains: Sequence[float], plant: LinearPlant) -> Share | None:
    """Return the share of *gains* that the bounds allow at *plant*.

    *gains* are Kp, Ki, Kd in Pa and m or rad, and the bandwidth of the filter in rad/s. If no
    share is within the bounds, it is the stable one with the least sensitivity; None if no
    share is stable.
    """
    if plant.gain <= 0.0:
        return None
    t = TUNING
    x, late = _frequencies()
    kp, ki, kd, a = gains
    load = plant.inertia * x * x + plant.damping * x + plant.stiffness
    # Both are multiplied by x, to remove the pole at 0, and divided by the filter of the loop.
    opened = x * load * ((x + a) / a) ** 2
    delayed = plant.gain * np.exp(-t.delay * x)
    even, integral = (kp + kd * x) * x * delayed, ki * delayed
    least, found = np.inf, None
    candidates = _candidates()
    for first in range(0, len(candidates), t.at_once):
        some = candidates[first : first + t.at_once]
        law = some[:, :1] * (even + some[:, 1:] * integral)
        stable: Any = True
        excess: Any = 0.0
        for path, order, most in ((1.0, _ORDER, t.peak), (late, _ORDER + 1, t.late_peak)):
            closed = opened * path + law
            stable = stable & _is_stable(closed, order)
            peak = np.max(np.abs(opened * path / closed), axis=1)
            excess = np.maximum(excess, peak / most)
        excess = np.where(stable, excess, np.inf)
        within = np.flatnonzero(excess <= 1.0)
        best = int(within[0]) if within.size else int(np.argmin(excess))
        if excess[best] < least:
            least, found = excess[best], Share(float(some[best, 0]), float(some[best, 1]))
        if within.size:
            break
    return found


@cache
def _frequencies() -> tuple[Any, Any]:
    """Return x = j w, and the divisor of a loop with the lag."""
    t = TUNING
    x = 1j * np.geomspace(t.slowest, t.quickest, t.frequencies)
    return x, t.lag * x + 1.0


@cache
def _candidates() -> Any:
    """Return shares (n, 2), the greatest integral gain first, then the greatest share of all."""
    t = TUNING
    powers = np.arange(t.halvings * t.steps + 1)
    of_all, of_integral = (a.ravel() for a in np.meshgrid(powers, powers, indexing='ij'))
    order = np.lexsort((of_all, of_all + of_integral))
    return 2.0 ** (-np.stack((of_all[order], of_integral[order]), axis=1) / t.steps)


def _is_stable(characteristic: Any, order: int) -> Any:
    """Return for each row whether its zeros have negative real parts: Mikhailov's criterion.

    The phase of such a function of x = j w of this *order* goes from 0 to order pi / 2 with w.
    Each zero with a positive real part reduces it by pi. This is also true with a delay that is
    not in the term of highest order (Bellman & Cooke, Differential-Difference Equations, 1963,
    chapter 13).
    """
    phase = np.unwrap(np.angle(characteristic), axis=1)
    return phase[:, -1] > (order - 1) * 0.5 * np.pi
