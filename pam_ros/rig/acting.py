# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The times at which commands act in the muscles of a joint: stamps plus delays of the effects."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig import layout as at
from pam_ros.rig.layout import Layout

Array = NDArray[np.float64]


def delays_of(layout: Layout, q: Array) -> tuple[float, ...]:
    """Return the delay in s of the commands of each muscle, from the parameters q."""
    delays = [
        (effect.equations.delay, layout.parameter_at[effect.name])
        for effect in layout.library
        if effect.equations.delay is not None
    ]
    return tuple(float(sum(delay(row, j) for delay, j in delays)) for row in q[at.MUSCLE :])


def acting_commands(acts: Sequence[Array], command: Array) -> tuple[Array, Array]:
    """Return the stamps at which a command changes, and the commands (m, muscles) from each on.

    *acts* are the times (m,) at which the rows of *command* (m, muscles) act in each muscle.
    If they differ between muscles, the result has a stamp for each change of any muscle's command.
    """
    if all(np.array_equal(own, acts[0]) for own in acts[1:]):
        return acts[0], command
    stamps = np.unique(np.concatenate(acts))
    columns = [
        command[np.maximum(np.searchsorted(own, stamps, side='right') - 1, 0), i]
        for i, own in enumerate(acts)
    ]
    return stamps, np.ascontiguousarray(np.stack(columns, axis=1))
