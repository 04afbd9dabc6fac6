# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The waves of an excitation as levels between 0 and 1, one for each command of a muscle.

Each function returns arrays of round(rate * duration) levels, the same for the same arguments:
rate in Hz, duration in s.
"""

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Levels of the staircase: both ends, and steps of many sizes, up and down from most levels. No
# step is so large that a lightly damped load overshoots far. The seed changes the inner levels
# slightly.
LEVELS = (0.5, 0.8, 0.6, 0.75, 1.0, 0.7, 0.35, 0.55, 0.2, 0.0, 0.3, 0.15, 0.45)
SHIFT = 0.04
LONG = 3.0  # factor by which the highest and lowest levels are held longer, to show creep
SINES = 14
SLOWEST = 0.1  # Hz
MEANS = (0.25, 0.5, 0.75)  # of the chirps
PASSAGE = 0.6  # s of the transition from one mean to the next


def steps(rate: float, duration: float, rng: Generator) -> Array:
    """Return a staircase over the whole range, up and down in steps of many sizes.

    The onsets show lag and dead time, the oscillation after them shows damping and mass, and the
    long holds at both ends show creep.
    """
    levels = np.array(LEVELS)
    inner = (levels > 0.0) & (levels < 1.0)
    levels[inner] += rng.uniform(-SHIFT, SHIFT, np.count_nonzero(inner))
    hold = np.where(inner, 1.0, LONG)
    ends = np.round(np.cumsum(hold) / hold.sum() * round(rate * duration)).astype(int)
    wave: Array = np.repeat(levels, np.diff(ends, prepend=0))
    return wave


def triangle(rate: float, duration: float, rng: Generator, minor_loops: bool) -> Array:
    """Return one triangle through the range, at a constant rate of change.

    With *minor_loops* it reverses three times on the way up and three times on the way down,
    by a third of the range and less: hysteresis depends on the positions of the reversals,
    friction only on the fact that there was a reversal. At another rate hysteresis remains the
    same, creep does not.
    """
    corners = [0.0]
    if minor_loops:
        for peak, back in ((0.3, 0.08), (0.55, 0.18), (0.85, 0.33)):
            at = peak + rng.uniform(-0.05, 0.05)
            corners += [at, at - back]
        up = np.array([*corners, 1.0])
        corners = [*up.tolist(), *(1.0 - up[1:]).tolist()]
    else:
        corners = [0.0, 1.0, 0.0]
    path = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(corners)))))
    along = np.linspace(0.0, path[-1], round(rate * duration))
    wave: Array = np.interp(along, path, corners)
    return wave


def multisine(
    rate: float, duration: float, rng: Generator, fastest: float, muscles: int = 1
) -> Array:
    """Return sines from 0.1 Hz to *fastest* Hz at random phases about the middle of the range.

    Whole periods fit into the duration; faster sines are smaller, since the load resonates. The
    columns are for *muscles* muscles: each next one has its phases 180 degrees / *muscles* later,
    so that the commands of two muscles are not correlated.
    """
    t = np.arange(round(rate * duration)) / rate
    cycles = np.unique(np.round(np.geomspace(SLOWEST, fastest, SINES) * duration))
    frequency = np.maximum(cycles, 1.0) / duration
    weight = 1.0 / (1.0 + frequency)
    best = np.zeros_like(frequency)
    crest = np.inf
    for _ in range(20):
        phase = rng.uniform(0.0, 2.0 * np.pi, frequency.size)
        wave = weight @ np.sin(2.0 * np.pi * frequency[:, None] * t + phase[:, None])
        peak = float(np.max(np.abs(wave)))
        if peak < crest:
            best, crest = phase, peak
    waves = []
    for i in range(muscles):
        phase = best + np.pi * i / muscles
        wave = weight @ np.sin(2.0 * np.pi * frequency[:, None] * t + phase[:, None])
        waves.append(0.5 + 0.35 * wave / np.max(np.abs(wave)))
    return np.column_stack(waves)


def chirp(rate: float, duration: float, fastest: float) -> tuple[Array, Array]:
    """Return the mean and the sines of three small logarithmic chirps at three mean levels.

    They go from 0.3 Hz to *fastest* Hz. The mean pressures distinguish damping that depends on
    pressure from other damping; the phase distinguishes lag from dead time.
    """
    count = round(rate * duration)
    edges = [round(count * k / 3) for k in range(4)]
    means: list[Array] = []
    sines: list[Array] = []
    before = MEANS[0]
    for mean, start, end in zip(MEANS, edges[:-1], edges[1:], strict=True):
        t = np.arange(end - start) / rate
        # A smooth transition from the last mean pressure, then the chirp, faded in and out.
        ramp = 0.5 - 0.5 * np.cos(np.pi * np.clip(t / PASSAGE, 0.0, 1.0))
        length = max(end - start, 1) / rate - PASSAGE
        x = np.clip(t - PASSAGE, 0.0, length)
        growth = np.log(fastest / 0.3)
        phase = 2.0 * np.pi * 0.3 * length / growth * np.expm1(growth * x / length)
        fade = np.clip(np.minimum(x, length - x) / 0.25, 0.0, 1.0)
        means.append(before + (mean - before) * ramp)
        sines.append(0.04 * fade * np.sin(phase))
        before = mean
    return np.concatenate(means), np.concatenate(sines)
