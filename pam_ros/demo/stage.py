# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The folder, the namespace and the output that each chapter of the demonstration uses."""

import os
import sys
from pathlib import Path

from tqdm import tqdm

from pam_ros.errors import PamError


class DemoStage:
    """A folder for the files of a chapter, a namespace for its nodes, and its printed text."""

    def __init__(self, folder: Path) -> None:
        """Create *folder*; raises PamError if it cannot be made."""
        self.folder = folder
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise PamError(f'{folder} cannot be made: {error.strerror}') from error
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


def progress(duration: float, what: str, pause: float) -> tqdm:
    """Return a progress bar of *duration* s of simulated time.

    It moves on a terminal; in a log it is a line every *pause* s.
    """
    return tqdm(
        total=duration,
        desc=what,
        bar_format='  {desc:<20} {bar:30} {n:4.1f} of {total:g} s',
        mininterval=0.1 if sys.stderr.isatty() else pause,
    )
