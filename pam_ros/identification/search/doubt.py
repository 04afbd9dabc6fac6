# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with recordings that cannot support a verdict."""

from typing import NamedTuple


class Doubt(NamedTuple):
    """The reason why recordings cannot support a verdict, as a clause, and a remedy.

    The remedy is a sentence; '' if a longer or better recording is needed.
    """

    reason: str
    remedy: str = ''
