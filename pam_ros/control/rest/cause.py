# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Find out whether the feedback causes an oscillation, from the swings without feedback.

An unstable loop and a force from outside at its frequency give the same error. They differ without
feedback: the oscillation of the loop then decays with the damping of the joint itself, and the
response to the force does not. So the swings after the feedback is switched off are compared with
the last one before, and with each other. When the feedback ends, the joint rings as well.
Therefore a large swing alone says nothing, and the test lasts until the swings are small or
constant.
"""

from dataclasses import dataclass

from pam_ros.control.tuning import number


@dataclass(frozen=True)
class CauseTuning:
    """When a swing without feedback is small, and when it is constant."""

    decays: float = number(
        0.5, '', 'times the swing with feedback, below which the loop was the cause'
    )
    stays: float = number(
        0.9,
        '',
        'times the swing two periods before, above which the cause is outside of the loop: with a '
        'damping ratio above 0.01 the joint itself decays faster',
    )
    longest: int = number(12, '', 'swings after which one that still decays is of the loop')
    patience: float = number(
        1.7, '', 'half periods of the loop without a swing, after which it has decayed'
    )


class CauseTest:
    """The swings without feedback after an oscillation.

    Swings are in m, or in rad for a revolute joint.
    """

    def __init__(self, tuning: CauseTuning, swing: float) -> None:
        """Begin after the last *swing* with feedback."""
        self._tuning, self.before = tuning, swing
        self._swings: list[float] = []
        self._waited = 0.0

    def see(self, dt: float, swing: float | None, half_period: float) -> float | None:
        """Wait for *dt* s; take in a *swing* if one has ended.

        Return None if the cause is not known yet, 0 if it is the loop, and the swing without
        feedback if it is outside. *half_period* is that of the loop in s.
        """
        tuning = self._tuning
        self._waited += dt
        if swing is None:
            return 0.0 if self._waited > tuning.patience * half_period else None
        self._waited = 0.0
        self._swings.append(swing)
        swings = self._swings[1:]  # the first one has begun with feedback
        if not swings:
            return None
        if swing < tuning.decays * min(self.before, swings[0]) or len(swings) > tuning.longest:
            return 0.0
        is_constant = len(swings) > 4 and swing > tuning.stays * swings[-5]
        return swing if is_constant else None
