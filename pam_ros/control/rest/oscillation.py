# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Detect from the error alone that a loop is unstable and oscillates.

A delay that the model does not have makes a fast loop oscillate at about its own bandwidth, with
an amplitude that does not fall. A disturbance from outside is slower, or its response decays. So
the error is divided into swings from one reversal to the next, as in rainflow counting. Successive
swings that are quick and do not fall are an oscillation, and so are slow ones that grow by a
constant factor over some periods, as those of an unstable loop do until a limit is reached.
Stability observers of haptic devices detect the same in windows of the spectrum (Ryu, Song, Kang &
Kim 2008), which takes several periods; this method takes one and a half for quick swings.
"""

from dataclasses import dataclass
from math import pi, sqrt

from pam_ros.control.tuning import number

MEMORY = 8  # swings: four periods


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
    grown: float = number(
        2.0,
        '',
        'least growth of slow swings in two or in four periods, with at least its square root in '
        'the later half: the response to a disturbance that begins grows less and less',
    )
    rising: float = number(1.2, '', 'least growth in two periods of swings that rise')
    quickest: float = number(
        4.5,
        '',
        'times the bandwidth of the loop: quicker swings are not those of the loop; a load that '
        'bounces on a stop has 7 to 15 times, a loop with a dead time of 30 to 80 ms 0.9 to 2.9 '
        'times (tests test_sliding_mode and test_unconfigured_delay)',
    )


class Oscillation:
    """Watches the error of a loop.

    quiet
        time since the last quick swing that may be one of an oscillation, s
    swing, count
        size of the last swing of any kind, and how many there were
    has_grown
        whether the swings until the last one grew by a constant factor
    """

    def __init__(self, tuning: OscillationTuning) -> None:
        """Begin without an error."""
        self._tuning = tuning
        self.start()

    @property
    def is_rising(self) -> bool:
        """Whether the swings rise, over two periods."""
        before = self._before
        return len(before) > 4 and before[-1] > self._tuning.rising * before[-5]

    def start(self) -> None:
        """Begin again without an error."""
        self.quiet = 0.0
        self._side = 1.0  # direction of the present swing
        self._turned = self._extreme = 0.0  # error at the last reversal, and the extreme since
        self._lasted = self._reached = 0.0  # time since the reversal: now, and at the extreme
        self._was_cut = self.has_grown = False
        self._swings, self.swing, self.count = 0, 0.0, 0
        self._before: list[float] = []  # the last swings in turn that did not fall

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
        lasts = swing >= max(least, tuning.lasting * self.swing)
        self._before = [*self._before[-MEMORY:], swing] if lasts else []
        self.has_grown = shortest <= lasted and self._has_grown()
        self._turned, self._extreme = self._extreme, error
        self._lasted -= self._reached
        self._reached, self._was_cut = self._lasted, False
        self._side, self.swing = -self._side, swing
        self.count += 1
        self._swings = self._swings + 1 if is_quick and lasts else 0
        if self._swings > 0:
            self.quiet = 0.0
        if self._swings < tuning.swings and not self.has_grown:
            return False
        self._swings, self.quiet = 0, 0.0
        return True

    def _has_grown(self) -> bool:
        """Return whether the swings grow exponentially over two or over four periods."""
        before, grown = self._before, self._tuning.grown
        return any(
            len(before) > n
            and before[-1] >= grown * before[-1 - n]
            and before[-1] >= sqrt(grown) * before[-1 - n // 2]
            for n in (MEMORY // 2, MEMORY)
        )
