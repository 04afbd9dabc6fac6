# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A parser of command lines whose errors are one sentence."""

import argparse
from typing import NoReturn

from pam_ros.errors import shown

BAD_INPUT = 2


class SentenceParser(argparse.ArgumentParser):
    """Reports an error of the command line in one sentence."""

    def error(self, message: str) -> NoReturn:
        """Print the sentence and exit."""
        self.exit(BAD_INPUT, f'{self.prog}: {shown(message)} (see --help)\n')
