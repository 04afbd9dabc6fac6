# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Detect from the error alone that a loop is unstable and oscillates.

A delay that the model does not have makes a fast loop oscillate at about its own bandwidth, with
an amplitude that does not fall. A disturbance from outside is slower, or its response decays. So
the error is divided into swings from one reversal to the next, as in rainflow counting. Successive
swings that are quick and do not fall are an oscillation. Stability observers of haptic devices
detect the same in windows of the spectrum (Ryu, Song, Kang & Kim 2008), which takes several
periods; this method takes one and a half.
"""

from dataclasses import dataclass
from math import inf, pi

from pam_ros.control.tuning import number


@dataclass(frozen=True)
class OscillationTuning:
    """Criteria for an oscillation of the loop."""

    swings: int = number(3, '', 'in turn that are an oscillation: a damped response has two')
    lasting: float = number(
        0.75, '', 'least ratio of a swing to the one before: it excludes damping ratios above 0.09'
    )
    quick: float = number(
        0.9,
        '',
        'times the bandwidth of the loop: slower swings are those of a disturbance; with the '
        'unconfigured lag of 50/70 ms in the benchmark disturbance, swings are 1.1 to 1.3 times '
        'as quick as the loop',
    )
    quickest: float = number(
        inf, '', 'times the bandwidth of the loop: quicker swings are not those of the loop'
    )


class Oscillation:
    """Watches the error of a loop.

    quiet
        time since the last swing of an oscillation, s
    """

    def __init__(self, tuning: OscillationTuning) -> None:
        """Begin at the error 0; see :meth:`start`."""
        self._tuning = tuning
        self.start(0.0)

    def start(self, error: float) -> None:
        """Start again at this *error*, without swings."""
        self.quiet = 0.0
        self._side = 1.0  # direction of the present swing
        self._turned = self._extreme = error  # error at the last reversal, and the extreme since
        self._lasted = self._reached = 0.0  # time since the reversal: now, and at the extreme
        self._was_cut = False
        self._swings, self._swing = 0, 0.0

    def see(
        self, dt: float, error: float, least: float, bandwidth: float, *, is_cut: bool
    ) -> bool:
        """Take in the *error* for *dt* s; return whether it completes an oscillation.

        Reversals of less than *least* are noise, and swings of less than twice *least* do not
        count; *bandwidth* is that of the loop in rad/s. While a limit cuts the command (*is_cut*),
        an oscillation is slower, so that each swing counts as quick.
        """
        self.quiet += dt
        self._lasted += dt
        self._was_cut = self._was_cut or is_cut
        ahead = (error - self._extreme) * self._side
        if ahead >= 0.0:
            self._extreme, self._reached = error, self._lasted
        elif -ahead >= least:
            return self._turn(error, 2.0 * least, bandwidth)
        return False

    def _turn(self, error: float, least: float, bandwidth: float) -> bool:
        """End a swing at its extreme error; return whether it completes an oscillation."""
        tuning = self._tuning
        swing, lasted = abs(self._extreme - self._turned), self._reached
        longest, shortest = pi / (tuning.quick * bandwidth), pi / (tuning.quickest * bandwidth)
        is_quick = shortest <= lasted and (self._was_cut or lasted < longest)
        lasts = swing >= max(least, tuning.lasting * self._swing)
        self._turned, self._extreme = self._extreme, error
        self._lasted -= self._reached
        self._reached, self._was_cut = self._lasted, False
        self._side, self._swing = -self._side, swing
        if not (is_quick and lasts):
            self._swings = 0
            return False
        self.quiet = 0.0
        self._swings += 1
        if self._swings < tuning.swings:
            return False
        self._swings = 0
        return True
