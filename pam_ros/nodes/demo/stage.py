# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The folder, the namespace and the output that each chapter of the demonstration uses."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

from std_msgs.msg import Float64
from tqdm import tqdm

from pam_ros.nodes.demo.client import Client

COMMAND_PERIOD = 0.02  # s


class Stage:
    """A folder for the files of a chapter, a namespace for its nodes, and its printed text."""

    def __init__(self, folder: Path) -> None:
        """Create *folder*."""
        self.folder = folder
        self.folder.mkdir(parents=True, exist_ok=True)
        # A name of its own, so that no other demonstration and no rig of the user is disturbed.
        self.namespace = f'/pam_demo_{os.getpid()}'

    def say(self, text: str) -> None:
        """Print *text*."""
        print(text, flush=True)

    def wrote(self, path: Path) -> None:
        """Print that a file was written."""
        self.say(f'  wrote {path}')

    def text(self, name: str, content: str) -> None:
        """Print *content*, and write it to a file of this name."""
        self.say(content)
        path = self.folder / name
        path.write_text(content + '\n', encoding='utf-8')
        self.wrote(path)


def hold_pressure(
    client: Client, pressure: float, seconds: float, now: Callable[[], float], what: str
) -> None:
    """Command *pressure* in Pa for some seconds of simulated time, with a progress bar.

    *now* returns the time. The command is repeated, so that no timeout vents the muscle.
    """
    begin = passed = now()
    form = '  {desc:<20} {bar:30} {n:4.1f} of {total:g} s'
    # A bar that moves on a terminal, or at most one line a second in a log.
    pause = 0.1 if sys.stderr.isatty() else 1.0
    with tqdm(total=seconds, desc=what, bar_format=form, mininterval=pause) as bar:
        while passed < begin + seconds:
            client.publish(Float64(data=pressure), 'pressure_command')
            client.work(COMMAND_PERIOD)
            before, passed = passed, min(now(), begin + seconds)
            bar.update(passed - before)
