# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a controller reaches its reference: errors and saturations that last.

The absolute error is averaged over intervals of one second. Therefore noise and a large step that
ends soon do not count. An oscillation about the reference does count, although its error passes
through zero.
"""

from collections import deque

from pam_ros.control.loop import RUNNING, Loop
from pam_ros.health.persistence import Persistence

# s. The reference rests for 0.5 s before a motion counts as over, and the bandwidth then falls
# within 0.3 s (StandstillTuning): after a second, the transient of a motion has ended.
INTERVAL = 1.0
# Consecutive intervals. The integral and the observer of a law act within a second: three of them
# without effect mean that they cannot act.
LASTING = 3
# Largest ratio of the last interval's error to that of the first that counts as approach: the time
# constant is then below 2 s / ln(1 / 0.8) = 9 s, slower than any valve that fills a muscle.
APPROACH = 0.8
# Multiple of the allowance of plausibility, which is one two-hundredth of the travel: an error of
# a tenth of the travel. The largest errors that the page on the controller lists, with unmodelled
# friction, hysteresis and lag, are below a fiftieth.
LARGE = 20.0


class Tracking:
    """Checks each step of a loop; ``warning`` is a sentence on a lasting fault, '' if none."""

    def __init__(self) -> None:
        """Start without any steps."""
        self._large = Persistence(1, LASTING)
        self._saturation = Persistence(1, LASTING)
        self._starts = -1
        self.warning = ''

    def record(self, loop: Loop) -> None:
        """Note the step that *loop* has just done."""
        if loop.state != RUNNING:
            return
        if loop.starts != self._starts:
            self._begin(loop)
        terms = loop.law.terms
        self._sum += abs(terms.error)
        self._steps += 1
        self._saturations += terms.saturated
        if loop.time - self._since >= INTERVAL:
            self._close(loop)

    def _begin(self, loop: Loop) -> None:
        self._starts = loop.starts
        self._errors: deque[float] = deque(maxlen=LASTING)
        self._saturated: deque[bool] = deque(maxlen=LASTING)
        self._large.clear()
        self._saturation.clear()
        self.warning = ''
        self._begin_interval(loop)

    def _begin_interval(self, loop: Loop) -> None:
        self._since = loop.time
        self._sum, self._steps, self._saturations = 0.0, 0, 0

    def _close(self, loop: Loop) -> None:
        """Evaluate the last intervals, at the end of one of them."""
        errors, allowance = self._errors, loop.plausibility.bounds.allowance
        errors.append(self._sum / self._steps)
        remains = len(errors) == LASTING and errors[-1] > APPROACH * errors[0]
        # A saturation without a significant error is harmless.
        self._saturated.append(self._saturations == self._steps and errors[-1] > allowance)
        self._saturation.look(
            self._saturated[-1] and (self._saturation.lasts or (remains and all(self._saturated)))
        )
        is_large = errors[-1] > LARGE * allowance
        self._large.look(
            is_large and (self._large.lasts or (remains and min(errors) > LARGE * allowance))
        )
        if not (self._saturation.lasts or self._large.lasts):
            self.warning = ''
        elif self._saturated[-1] or is_large:
            self.warning = self._sentence(loop)
        self._begin_interval(loop)

    def _sentence(self, loop: Loop) -> str:
        bounds = loop.plausibility.bounds
        seconds = f'for more than {LASTING * INTERVAL:g} s'
        error = f'{self._errors[-1]:.3g} {bounds.unit}'
        advice = 'check the configured joint, load and muscle against the rig'
        if self._saturation.lasts:
            return (
                f'the command is at a limit of pressure {seconds}, and an error of {error} does '
                f'not shrink: {advice}'
            )
        return (
            f'the error is larger than {LARGE * bounds.allowance:.3g} {bounds.unit}, a tenth '
            f'of the travel, {seconds}, now {error}: {advice}'
        )
