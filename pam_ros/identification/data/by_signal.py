# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recording of a joint with measured pressures, divided at the chambers.

From the commands to the chambers nothing depends on muscles and load, and what is behind the
chambers does not depend on the commands if the pressures there are known.
"""

from collections.abc import Sequence
from dataclasses import replace

from pam_ros.recording.recording import Recording


def have_pressures(recordings: Sequence[Recording]) -> bool:
    """Return whether all *recordings* have commands, measured pressures and a free motion."""
    return all(
        one.kind == 'free' and one.command is not None and one.pressure is not None
        for one in recordings
    )


def of_chambers(recording: Recording) -> Recording:
    """Return the recording of the pressures in the chambers under the commands."""
    return replace(recording, kind='pressure', position=None, velocity=None, force=None)


def behind_chambers(recording: Recording) -> Recording:
    """Return the recording of the motion under the measured pressures."""
    return replace(recording, command_t=None, command=None, command_spread=0.0)
