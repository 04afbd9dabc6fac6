# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the truth plant as a rig would write them.

A command holds from its stamp to the next one; a position, force or pressure stamped t is the
state before a command of the same stamp has acted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .effects import Effect
from .excitation import PROGRAMMES, stamps, working_range
from .muscles import pressure_for
from .plant import TruthPlant
from .sensor import Sensor

FREE_COLUMNS = ('t_s', 'pressure_command_Pa', 'position_m')
HELD_COLUMNS = ('t_s', 'pressure_command_Pa', 'contraction_percent', 'force_N')


@dataclass
class Recording:
    """Arrays (n,) of what sensors read, and in `truth` what was really there.

    t_s, pressure_command_pa (gauge), position_m, force_n (pull on the load, by a force cell),
    pressure_pa (chamber, gauge); held: the length was prescribed, force is the output.
    truth holds position_m, force_n and pressure_pa without noise, and the plant's numbers.
    """

    t_s: np.ndarray
    pressure_command_pa: np.ndarray
    position_m: np.ndarray
    force_n: np.ndarray
    pressure_pa: np.ndarray
    l0: float
    held: bool = False
    truth: dict[str, Any] = field(default_factory=dict)

    def column(self, name: str) -> np.ndarray:
        """Return an array under its CSV name and in its unit."""
        return {
            't_s': self.t_s,
            'pressure_command_Pa': self.pressure_command_pa,
            'position_m': self.position_m,
            'force_N': self.force_n,
            'pressure_Pa': self.pressure_pa,
            'contraction_percent': 100.0 * self.position_m / self.l0,
        }[name]

    def write_csv(self, path: Path, columns: Sequence[str] = ()) -> Path:
        """Write the columns (by default the fewest of this kind of experiment); return path."""
        names = tuple(columns) or (HELD_COLUMNS if self.held else FREE_COLUMNS)
        table = np.column_stack([self.column(name) for name in names])
        np.savetxt(path, table, '%.9g', ',', header=','.join(names), comments='')
        return path

    def part(self, start: float, end: float) -> Recording:
        """Return the stretch with start <= t < end, times kept."""
        keep = (self.t_s >= start) & (self.t_s < end)
        truth = {
            name: value[keep] if isinstance(value, np.ndarray) else value
            for name, value in self.truth.items()
        }
        return Recording(
            self.t_s[keep],
            self.pressure_command_pa[keep],
            self.position_m[keep],
            self.force_n[keep],
            self.pressure_pa[keep],
            self.l0,
            self.held,
            truth,
        )


def play(
    plant: TruthPlant,
    t: np.ndarray,
    u: np.ndarray,
    *,
    y_path: np.ndarray | None = None,
    force_noise: float = 1.0,
    pressure_noise: float = 300.0,
    seed: int = 0,
) -> Recording:
    """Record a plant from where it is: t (n,) s, u (n,) Pa, noise of the other sensors in N, Pa.

    y_path (n,), m, prescribes the length.
    """
    rng = np.random.default_rng([seed, 3])
    start = plant.t
    true = plant.run(t, u, y_path)
    return Recording(
        t_s=np.array(t, dtype=float),
        pressure_command_pa=np.array(u, dtype=float),
        position_m=plant.sensor.read_all(start + t, true.linked),
        force_n=true.force + force_noise * rng.standard_normal(t.size),
        pressure_pa=true.pressure + pressure_noise * rng.standard_normal(t.size),
        l0=float(plant.parameters.l0_m),
        held=y_path is not None,
        truth={
            'position_m': true.y,
            'force_n': true.force,
            'pressure_pa': true.pressure,
            'effects': [one.describe() for one in plant.effects],
            'constants_si': plant.constants,
            'mass_kg': float(plant.parameters.mass_kg),
            'zeta': float(plant.parameters.zeta),
            'noise_m': plant.sensor.noise,
            'noise_rho': plant.sensor.rho,
        },
    )


def record(
    effects: Sequence[Effect] = (),
    *,
    seed: int = 0,
    rate: float = 200.0,
    duration: float = 60.0,
    noise: float = 20e-6,
    rho: float = 0.0,
    programme: str = 'mixture',
    muscle: str | tuple[float, ...] = 'dmsp_20_400n',
    mass: float = 20.0,
    zeta: float = 0.15,
) -> Recording:
    """Record a free load under a programme, from rest, with position noise (m) of colour rho."""
    sensor = Sensor(noise=noise, rho=rho)
    plant = TruthPlant(muscle, mass, zeta, effects=effects, sensor=sensor, seed=seed)
    low, high = working_range(plant.constants, mass)
    rng = np.random.default_rng([seed, 4])
    u = PROGRAMMES[programme](rate, duration, low, high, rng)
    plant.reset(u[0], seed)
    return play(plant, stamps(rate, duration), u, seed=seed)


def held_programme(
    rate: float,
    duration: float,
    rng: np.random.Generator,
    *,
    constants: tuple[float, ...],
    slack: bool = False,
    moving: bool = False,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return t (n,) s, u (n,) Pa, contraction (n,): four lengths, at each pressure up and down.

    At each length the pressure climbs in short pulses, holds, falls and rises in a minor loop and
    holds. It stays where the muscle pulls, unless `slack`. `moving` adds a slow wave of 1 % to
    the length.
    """
    t = stamps(rate, duration)
    quarter = np.minimum((4.0 * t / duration).astype(int), 3)
    phase = 4.0 * t / duration - quarter
    corners_t = np.array([0.0, 0.35, 0.40, 0.55, 0.62, 0.70, 0.82, 0.86, 1.0])
    corners = np.array([0.0, 1.0, 1.0, 0.25, 0.6, 0.25, 0.0, 0.0, 0.0])
    pulse = round(0.5 * rate)
    levels = rng.permutation([0.0, 0.06, 0.12, 0.18])
    flat = levels[quarter]
    ramp = np.clip((phase - 0.9) / 0.1, 0.0, 1.0)
    following = levels[np.minimum(quarter + 1, 3)]
    # The ramp to the next length runs at the lower pressure, which has to do for both.
    taut = np.array([pressure_for(constants, 40.0, k + 0.01) for k in levels])
    floors = np.full(4, 60e3) if slack else np.maximum(taut, 60e3)
    floor = np.maximum(floors, np.append(floors[1:], 0.0))[quarter]
    smooth = floor + (560e3 - floor) * np.interp(phase, corners_t, corners)
    u = np.where(phase < 0.40, np.repeat(smooth[::pulse], pulse)[: t.size], smooth)
    contraction = flat + ramp * (following - flat)
    if moving:
        contraction = contraction + 0.01 * np.sin(2.0 * np.pi * 0.15 * t)
    return t, u, contraction


def held_record(
    effects: Sequence[Effect] = (),
    *,
    seed: int = 0,
    rate: float = 100.0,
    duration: float = 120.0,
    force_noise: float = 2.0,
    moving: bool = False,
    muscle: str | tuple[float, ...] = 'dmsp_20_400n',
) -> Recording:
    """Record the force at prescribed lengths (0 to 18 % contraction) under changing pressure."""
    rng = np.random.default_rng([seed, 5])
    plant = TruthPlant(muscle, effects=effects, seed=seed)
    t, u, contraction = held_programme(
        rate,
        duration,
        rng,
        constants=plant.constants,
        slack=any(one.kind == 'slack' for one in effects),
        moving=moving,
    )
    plant.reset(u[0], seed)
    return play(
        plant, t, u, y_path=contraction * plant.parameters.l0_m, force_noise=force_noise, seed=seed
    )
