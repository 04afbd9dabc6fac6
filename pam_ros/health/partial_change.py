# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Notices when parameters that were sent together are set only in part.

``ros2 param load`` and rqt set the parameters of a file one by one. If some are refused, because
they do not fit to those that are not yet set, the node keeps a mixture, such as the constants of
two muscles.
"""

from collections.abc import Callable, Iterable
from time import monotonic

from pam_ros.health.start_line import listed

TOGETHER = 0.5  # s between two changes of one request; two commands of a person are farther apart
REMEDY = (
    'start the program with the file, or set parameters together by the service '
    '~/set_parameters_atomically'
)


class PartialChange:
    """Keeps what was set and refused within the last request, one parameter after the other."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        """Read the time in s from *clock*."""
        self._clock = clock
        self._last = float('-inf')
        # Names in their order, each once: a program may set one again and again.
        self._set: dict[str, None] = {}
        self._refused: dict[str, None] = {}
        self._is_said = False

    def refuse(self, names: Iterable[str]) -> str:
        """Note that *names* are refused; return a sentence, once for a request, if others are set.

        These were set before, within the same request.
        """
        self._begin()
        self._refused |= dict.fromkeys(names)
        return self._mixture()

    def accept(self, names: Iterable[str]) -> str:
        """Note that *names* are set; return a sentence as :meth:`refuse` does."""
        self._begin()
        self._set |= dict.fromkeys(names)
        return self._mixture()

    def _begin(self) -> None:
        now = self._clock()
        if now - self._last > TOGETHER:
            self._set, self._refused, self._is_said = {}, {}, False
        self._last = now

    def _mixture(self) -> str:
        # The same parameter again and again, as from a slider, is no mixture.
        if self._is_said or not self._refused or self._set.keys() <= self._refused.keys():
            return ''
        self._is_said = True
        return (
            f'of one request {listed(self._set)} took effect and {listed(self._refused)} did not: '
            f'the values may not belong together; {REMEDY}'
        )
