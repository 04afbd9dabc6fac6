# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The progress of an identification on standard error, with the time that is left."""

import sys
from collections.abc import Callable

from pam_ros.errors import shown
from pam_ros.identification.wording import time_span

INTERRUPTED = (
    'interrupted: the report of the best model so far follows, a second Ctrl-C ends at once'
)


class ProgressBar:
    """Shows the current step and the time left: a bar on a terminal, else a line for each step.

    When the time is known for the first time, a line states it, followed by the *size* of the
    work. As soon as *is_interrupted* returns true, another one states what follows.
    """

    def __init__(self, size: str, is_interrupted: Callable[[], bool]) -> None:
        """Start at 0 %."""
        from tqdm import tqdm

        self._size, self._is_interrupted, self._is_noted = size, is_interrupted, False
        self._text = self._left = ''
        self._is_shown = sys.stderr.isatty()
        self._bar = tqdm(
            total=1.0,
            disable=not self._is_shown,
            leave=False,
            bar_format='{percentage:3.0f} % |{bar:24}| {desc}',
        )

    def __call__(self, fraction: float, text: str) -> None:
        """Show the progress (0 to 1) and the current step."""
        if self._is_interrupted() and not self._is_noted:
            self._is_noted = True
            self.say(INTERRUPTED)
        line = f'{text}, {self._left} left' if self._left and fraction < 1.0 else text
        if text != self._text and not self._is_shown:
            print(f'{100.0 * fraction:3.0f} %  {line}', file=sys.stderr, flush=True)
        self._text = text
        self._bar.set_description_str(line, refresh=False)
        self._bar.update(fraction - self._bar.n)
        self._bar.refresh()

    def time_left(self, low: float, high: float) -> None:
        """Take the time in s that the rest takes at least and at most."""
        span = time_span(low, high)
        if not self._left:
            self.say(f'{span} on {self._size}')
        self._left = span

    def say(self, text: str) -> None:
        """Print a line above the bar."""
        self._bar.write(shown(text), file=sys.stderr)

    def close(self) -> None:
        """Remove the bar from the terminal."""
        self._bar.close()
