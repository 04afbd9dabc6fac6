# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure programmes that bring a muscle's and a rig's properties out.

Every programme is a function (rate Hz, duration s, low Pa, high Pa, rng) -> u (n,) in Pa, one
value per sample and n = round(rate * duration), within [low, high] and so within 0..600 kPa.
`stamps` gives the times, `working_range` the pressures.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.random import Generator

from .muscles import GRAVITY, P_MAX, pressure_for

Programme = Callable[[float, float, float, float, Generator], np.ndarray]


def stamps(
    rate: float, duration: float, jitter: float = 0.0, rng: Generator | None = None
) -> np.ndarray:
    """Return times in s, counted and not accumulated, early or late by jitter of a period."""
    k = np.arange(round(rate * duration), dtype=float)
    if rng is not None and jitter > 0.0:
        k[1:] += jitter * rng.uniform(-0.5, 0.5, k.size - 1)
    return k / rate


def working_range(
    constants: tuple[float, ...],
    mass: float,
    kappa: tuple[float, float] = (0.03, 0.18),
    mount: str = 'vertical',
) -> tuple[float, float]:
    """Return the pressures in Pa that hold a mass (kg) at the two contractions, in 20..580 kPa."""
    force = mass * GRAVITY if mount == 'vertical' else 0.0
    low, high = (pressure_for(constants, force, k) for k in kappa)
    return max(low, 20e3), min(high, P_MAX - 20e3)


def steps(rate: float, duration: float, low: float, high: float, rng: Generator) -> np.ndarray:
    """Return random levels, at most a third of the range apart, each held for 1 to 4 s."""
    u = np.empty(round(rate * duration))
    k, level = 0, 0.5 * (low + high)
    while k < u.size:
        end = k + round(rate * rng.uniform(1.0, 4.0))
        u[k:end] = level
        k = end
        change = rng.uniform(0.1, 0.33) * (high - low) * rng.choice((-1.0, 1.0))
        if not low <= level + change <= high:
            change = -change
        level = min(high, max(low, level + change))
    return u


def triangle(
    rate: float,
    duration: float,
    low: float,
    high: float,
    rng: Generator,
    *,
    period: float | None = None,
) -> np.ndarray:
    """Return a triangle through the range with a minor loop on the way up and on the way down.

    Without a period, one slow cycle takes the first two thirds and two fast ones the last.
    """
    if period is None:
        slow = round(rate * duration) * 2 // 3
        fast = round(rate * duration) - slow
        return np.concatenate(
            [
                triangle(rate, slow / rate, low, high, rng, period=slow / rate),
                triangle(rate, fast / rate, low, high, rng, period=0.5 * fast / rate),
            ]
        )
    corners = np.array([0.0, 0.65, 0.35, 1.0, 0.4, 0.7, 0.0])
    corners[1:3] += rng.uniform(-0.1, 0.1)
    corners[4:6] += rng.uniform(-0.1, 0.1)
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(corners)))])
    phase = (np.arange(round(rate * duration)) / rate / period) % 1.0
    return low + (high - low) * np.interp(phase * along[-1], along, corners)


def cycle(rate: float, duration: float, low: float, high: float, rng: Generator) -> np.ndarray:
    """Return one slow rise from the lowest pressure and the fall back, as a ramp or a cosine."""
    x = np.linspace(0.0, 1.0, round(rate * duration))
    if rng.random() < 0.5:
        return low + (high - low) * (1.0 - np.abs(1.0 - 2.0 * x))
    return low + (high - low) * 0.5 * (1.0 - np.cos(2.0 * np.pi * x))


def multisine(rate: float, duration: float, low: float, high: float, rng: Generator) -> np.ndarray:
    """Return twelve sines of 0.1 to 6 Hz about the middle, smaller where the load resonates."""
    t = np.arange(round(rate * duration)) / rate
    frequency = np.geomspace(0.1, 6.0, 12) * rng.uniform(0.95, 1.05, 12)
    weight = 1.0 / (1.0 + frequency)
    phase = rng.uniform(0.0, 2.0 * np.pi, 12)
    wave = np.sum(
        weight[:, None] * np.sin(2.0 * np.pi * frequency[:, None] * t + phase[:, None]), axis=0
    )
    return 0.5 * (low + high) + 0.3 * (high - low) * wave / np.max(np.abs(wave))


def chirp(rate: float, duration: float, low: float, high: float, rng: Generator) -> np.ndarray:
    """Return chirps of 0.3 to 10 Hz, one after the other at three mean pressures."""
    out = []
    count = round(rate * duration)
    edges = [0, count // 3, 2 * count // 3, count]
    for mean, start, end in zip(
        rng.permutation([0.25, 0.5, 0.75]), edges[:-1], edges[1:], strict=True
    ):
        t = np.arange(end - start) / rate
        length = (end - start) / rate
        growth = np.log(10.0 / 0.3)
        phase = 2.0 * np.pi * 0.3 * length / growth * np.expm1(growth * t / length)
        out.append(low + (high - low) * (mean + 0.05 * np.sin(phase)))
    return np.concatenate(out)


def vents(rate: float, duration: float, low: float, high: float, rng: Generator) -> np.ndarray:
    """Return sudden vents to no pressure from random levels, each filled again by a ramp.

    A light load then falls slower than a model muscle that pushes would have it.
    """
    out: list[np.ndarray] = []
    count, size = round(rate * duration), 0
    while size < count:
        level = low + (high - low) * rng.uniform(0.4, 1.0)
        ramp = np.linspace(0.0, level, round(rate * 0.6))
        piece = [ramp, np.full(round(rate * rng.uniform(0.8, 2.0)), level)]
        piece.append(np.zeros(round(rate * rng.uniform(0.2, 1.2))))
        out += piece
        size += sum(part.size for part in piece)
    return np.concatenate(out)[:count]


def mixture(rate: float, duration: float, low: float, high: float, rng: Generator) -> np.ndarray:
    """Return steps, triangles, a multisine, chirps, and the first segment once more."""
    shares = ((steps, 0.30), (triangle, 0.25), (multisine, 0.15), (chirp, 0.18))
    out = [part(rate, share * duration, low, high, rng) for part, share in shares]
    count = round(rate * duration) - sum(part.size for part in out)
    out.append(out[0][:count].copy())
    ramp = np.linspace(0.0, 1.0, round(0.4 * rate))
    for before, part in pairwise(out):
        part[: ramp.size] = before[-1] + ramp * (part[: ramp.size] - before[-1])
    return np.concatenate(out)


def mixture_with_vents(
    rate: float, duration: float, low: float, high: float, rng: Generator
) -> np.ndarray:
    """Return a mixture whose second half is vents."""
    first = mixture(rate, 0.5 * duration, low, high, rng)
    rest = (round(rate * duration) - first.size) / rate
    return np.concatenate([first, vents(rate, rest, low, high, rng)])


PROGRAMMES: dict[str, Programme] = {
    'steps': steps,
    'triangle': triangle,
    'cycle': cycle,
    'multisine': multisine,
    'chirp': chirp,
    'vents': vents,
    'mixture': mixture,
    'mixture_with_vents': mixture_with_vents,
}
