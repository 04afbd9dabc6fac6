# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings whose input and outputs were stamped by two clocks."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.recording import OUTPUTS, Recording, interpolated

Array = NDArray[np.float64]


def has_measured_input(recording: Recording) -> bool:
    """Return whether the measured pressure is the input of the model, not the command."""
    is_known = recording.pressure is not None
    return recording.command is None or (recording.kind == 'held' and is_known)


def with_earlier_input(recording: Recording, offset: float) -> Recording:
    """Return *recording* with an input that acts *offset* s earlier than its stamps, 0 or more.

    The outputs keep their stamps. The input is the command; without a command, or at a prescribed
    length, it is the measured pressure, which is interpolated. Samples for which the input is not
    known then, at the end and before gaps, are left out.
    """
    commands = recording.command_t
    is_measured = has_measured_input(recording)
    later = recording.t + offset
    if is_measured or commands is None:
        kept = later <= recording.t[-1]
    else:
        kept = later <= max(recording.t[-1], commands[-1])
    for start, end in recording.gaps:
        is_known = commands is not None and bool(((commands > start) & (commands < end)).any())
        if is_measured or not is_known:
            # A sample after the gap stays; one before it has its input in the gap.
            kept &= ~((recording.t <= start) & (later > start))
    changes: dict[str, Any] = {
        name: None if value is None else value[kept]
        for name in OUTPUTS
        for value in (getattr(recording, name),)
    }
    t = recording.t[kept]
    if is_measured:
        assert recording.pressure is not None
        changes['pressure'] = interpolated(later[kept], recording.t, recording.pressure)
    elif commands is not None and recording.command is not None:
        stamps = commands - offset
        first = max(int(np.searchsorted(stamps, t[0], side='right')) - 1, 0)
        changes |= {'command_t': stamps[first:], 'command': recording.command[first:]}
    return replace(recording, t=t, gaps=_gaps(recording, t), **changes)


def _gaps(recording: Recording, t: Array) -> tuple[tuple[float, float], ...]:
    """Return the gaps of *recording* with only the samples at *t* (n,)."""
    edges = [(int(np.searchsorted(t, start, side='right')), end) for start, end in recording.gaps]
    return tuple((float(t[k - 1]), end) for k, end in edges if 0 < k < t.size)
