# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Errors that come from commands whose times are known only to the period of the samples."""

import numpy as np

from pam_ros.identification.result import Conclusion, Verdict
from pam_ros.recording.recording import Recording

MOST = 2.0  # times the expected error, up to which an error may be due to these times


def of_command_times(answer: Conclusion) -> list[str]:
    """Return a warning if times of commands may cause the error that no effect explains.

    Many loggers write the last command into the row of each sample. A command may then have acted
    at any time within a period T before its row. If this time is uniformly distributed, and v is
    the velocity of the load, the position differs by v T / sqrt(3) (root mean square).
    """
    if answer.verdict != Verdict.UNEXPLAINED_STRUCTURE or answer.quantity != 'position':
        return []
    if not all(_is_in_rows(recording) for recording in answer.recordings):
        return []
    period = max(recording.period for recording in answer.recordings)
    last = answer.stages[-1]
    rates = [
        np.gradient(run, segment.t)
        for segment, run in zip(answer.segments, last.simulated, strict=True)
    ]
    speed = float(np.sqrt(np.mean(np.concatenate(rates) ** 2)))
    expected = speed * period / np.sqrt(3.0)
    if last.held_error > MOST * expected:
        return []
    return [
        'each row has a command: if it is the last one before the sample, its time is known to '
        f'{1e3 * period:.3g} ms only, which can cause an error of {1e3 * expected:.2g} '
        f'm{answer.unit} at the speed of this motion: record each command with its own time'
    ]


def _is_in_rows(recording: Recording) -> bool:
    """Return whether all commands have the stamps of samples, and each sample has one."""
    at = recording.command_t
    return at is not None and np.array_equal(at[at >= recording.t[0]], recording.t)
