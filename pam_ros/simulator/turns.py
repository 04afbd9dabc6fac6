# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Lockstep: which muscles were commanded since the last state, and which nodes command them."""

from collections.abc import Callable, Sequence
from time import monotonic_ns

from pam_ros.timing.pace import SECOND

# ns after which the state is published again for a controller that has not answered
REPEAT = SECOND // 2
PATIENCE = SECOND  # ns of waiting after which the diagnostics report it
SETTLE = SECOND // 4  # ns within which all answers to a repeated state arrive


class Turns:
    """Counts the muscles that were commanded in this period, and watches which nodes command.

    A controller that starts late, or replaces one that ended, has not received the state that
    waits for an answer. This state must be published again until an answer arrives. For a
    controller that has answered, it is never published twice, however long the controller
    computes.

    A controller may have sent more than one command if it was just found, if time continues after
    a pause, or if the rig was reset. Then all commands within SETTLE are one answer, and the last
    one counts.
    """

    def __init__(
        self,
        muscles: int,
        publishers: Callable[[], frozenset[bytes]],
        steady: Callable[[], int] = monotonic_ns,
    ) -> None:
        """Start without commands.

        *publishers* returns an identification of each node that publishes commands at present,
        and *steady* the time in ns of a clock that never jumps.
        """
        self._muscles, self._publishers, self._steady = muscles, publishers, steady
        self._answered: set[int] = set()
        self._known: frozenset[bytes] = frozenset()
        self._has_answered = False
        self._settled = 0  # steady time until which answers are collected, ns
        self.begin()

    def begin(self) -> None:
        """Wait for commands from now on: the state was published."""
        self._answered.clear()
        self._since = self._published = self._steady()

    def take(self, muscles: Sequence[int]) -> None:
        """Note that these muscles were commanded."""
        if not self._has_answered:
            self.settle()
        self._has_answered = True
        self._answered.update(muscles)

    def settle(self) -> None:
        """Collect commands for SETTLE ns, since more than one may arrive."""
        self._settled = self._steady() + SETTLE

    @property
    def is_complete(self) -> bool:
        """Whether all muscles were commanded, and no other command for this state is expected."""
        return len(self._answered) == self._muscles and self._steady() >= self._settled

    @property
    def complaint(self) -> str:
        """A sentence on a long wait for commands, '' if there is none."""
        left, waited = self._muscles - len(self._answered), self._steady() - self._since
        if not left or waited < PATIENCE:
            return ''
        so_far = f'{waited / SECOND:.1f} s so far'
        if not self._known:
            return f'waits for a controller, {so_far}: no node publishes commands'
        return f'waits for commands, {so_far}: {left} of {self._muscles} missing'

    def must_repeat(self) -> bool:
        """Return whether to publish the state again now; to be called a few times per second."""
        known = self._publishers()
        is_new = bool(known - self._known)
        self._known = known
        if is_new or not known:
            self._has_answered = False
        now = self._steady()
        if self._has_answered or not (is_new or now - self._published > REPEAT):
            return False
        self._published = now
        return True
