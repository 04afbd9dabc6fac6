# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The moment at which unknown effects begin, as an unknown."""

from dataclasses import dataclass


@dataclass(frozen=True)
class OnsetTime:
    """The moment in s, on the clock of the recording, at which all unknown effects begin."""

    name: str = 'onset'
