# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of a cylinder that a machine moves to and fro, by equations of their own."""

import numpy as np

from pam_ros.recording.recording import Recording

AREA = 0.25 * np.pi * 0.025**2  # m^2
NOISE = 0.3  # N


def to_and_fro(t, stroke=0.036, period=6.0):
    """Return position and velocity of a triangle with rounded corners."""
    phase = 2.0 * np.pi * t / period
    y = stroke * np.arcsin(0.999 * np.sin(phase)) / np.pi
    return y, np.gradient(y, t)


def recording(bar, level=0.0, per_bar=0.0, swing=0.0, seconds=30.0, seed=0):
    """Return 100 Hz of a cylinder with a rubbing seal (N, N/bar), its pressure with a swing (bar).

    The seal is sheared by 0.2 mm before it slides: |F| = g (1 - exp(-distance since the turn /
    0.05 mm)) from wherever it was, which is Dahl's friction and none of the package's.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(round(100.0 * seconds)) / 100.0
    y, _ = to_and_fro(t)
    g, z = level + per_bar * bar, 0.0
    friction = np.empty(t.size)
    for k in range(t.size):
        step = y[k] - y[k - 1] if k else 0.0
        if step != 0.0 and g > 0.0:
            aim = np.sign(step) * g
            z = aim + (z - aim) * np.exp(-abs(step) / 5e-5)
        friction[k] = z
    p = 1e5 * (bar + swing * np.sin(0.5 * t))
    force = AREA * p - friction + NOISE * rng.standard_normal(t.size)
    measured = p + 150.0 * rng.standard_normal(t.size)
    y = y + 5e-6 * rng.standard_normal(t.size)
    return Recording(f'{bar:g}bar.csv', t, None, None, y, None, force, measured, 'held')
