# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Muscles in other sizes."""

from dataclasses import replace


def scaled_muscle(muscle, force, pressure, length):
    """Return a *muscle* of other sizes, with the same force in its own size."""
    by_pressure = {name: getattr(muscle, name) * force / pressure for name in ('a1', 'a4', 'a5')}
    by_force = {name: getattr(muscle, name) * force for name in ('a2', 'a6', 'force_max')}
    sizes = {'l0': muscle.l0 * length, 'p_max': muscle.p_max * pressure}
    return replace(muscle, **by_pressure, **by_force, **sizes)
