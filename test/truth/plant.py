# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The truth plant: a muscle, a load and what the paper's model lacks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .compiled import element
from .effects import Effect
from .forces import law, tendon
from .kernel import hold, run
from .layout import ELEMENTS, new_parameters, new_state
from .muscles import GRAVITY, constants_si
from .pneumatics import KNEE_WIDTH
from .sensor import Sensor

OUTPUTS = ('y', 'v', 'force', 'pressure', 'linked')

SUBSTEP = 5e-5  # s


class TruthPlant:
    """A muscle that lifts a mass, stepped from pressure commands.

    Position y = kappa l0 in m, contraction (load up) positive; gauge Pa; N; s.

    muscle    name in muscles.PUBLISHED, or the six constants in SI (Pa, fraction)
    mass      configured load, kg (a payload effect adds to it)
    zeta      damping ratio of the paper's equation 4 (a choice: the paper prints none)
    l0        rest length, m
    mount     'vertical' (gravity pulls the load) or 'horizontal' (no gravity)
    effects   what is added to the paper's model, see effects.effect
    dt        largest substep, s
    sensor    noise, offset, latency and quantisation of measured positions; ideal if None
    seed      of the sensor's noise and of random forces
    p0        command in Pa at which it rests at the start
    """

    def __init__(
        self,
        muscle: str | tuple[float, ...] = 'dmsp_20_400n',
        mass: float = 20.0,
        zeta: float = 0.15,
        l0: float = 0.4,
        mount: str = 'vertical',
        effects: Sequence[Effect] = (),
        dt: float = SUBSTEP,
        sensor: Sensor | None = None,
        seed: int = 0,
        p0: float = 300e3,
    ) -> None:
        self.constants = constants_si(muscle) if isinstance(muscle, str) else tuple(muscle)
        self.effects = tuple(effects)
        self.sensor = sensor or Sensor()
        self._parameters = new_parameters()
        self.parameters = P = element(self._parameters)
        P.a1, P.a2, P.a3, P.a4, P.a5, P.a6 = self.constants
        P.mass_kg, P.zeta, P.l0_m, P.dt = mass, zeta, l0, dt
        P.gravity = {'vertical': GRAVITY, 'horizontal': 0.0}[mount]
        self._set(self.effects)
        # A damping ratio of 0.2 for the bristle alone: sticks without ringing.
        P.bristle_ns_m = 0.4 * math.sqrt(P.bristle_n_m * mass)
        self.reset(p0, seed)

    def reset(self, p0: float, seed: int = 0) -> float:
        """Put the plant at rest under a command of p0 (Pa) with virgin memory; return y in m."""
        P = self.parameters
        self._states = new_state()
        self.state = S = element(self._states)
        self._walks = P.walk_n_rs > 0.0
        self._walked = 0.0
        self._rng = np.random.default_rng([seed, 1])
        self.sensor.reset(seed)
        S.u = p0
        S.p = p0 * P.regulator_gain + P.regulator_pa
        if P.overlap_pa > 0.0:
            S.p = max(S.p - P.overlap_pa, 0.0)
        if P.fill_s > 0.0 and P.leak_per_s > 0.0:
            S.p /= 1.0 + P.leak_per_s * P.fill_s
        S.p_mem = S.plag_1 = S.plag_2 = S.p
        shares = np.geomspace(0.05, 1.0, ELEMENTS)
        for i in range(ELEMENTS):
            S.slip_reach[i] = P.hyst_reach_m * shares[i]
            S.pslip_reach[i] = P.hyst_reach_pa * shares[i]
        S.y = self._rest_position(S.p)
        S.y_mem = S.link = S.strain_1 = S.strain_2 = S.y
        S.lag_1 = S.lag_2 = self._static(S.p, S.y)
        S.pull = tendon(P, S.lag_1)
        return float(S.y)

    def _set(self, effects: Sequence[Effect]) -> None:
        for one in effects:
            for name, value in one.values.items():
                setattr(self.parameters, name, value)

    def begin(self, effects: Sequence[Effect]) -> None:
        """Let more effects act from now on; the rig goes on from where it is.

        For effects whose memory is a state that the rig has without them, too.
        """
        self.effects = (*self.effects, *effects)
        self._set(effects)

    def _static(self, p: float, y: float) -> float:
        """Pull in N of the muscle at rest, creep run out, memory virgin, no slack."""
        P = self.parameters
        if P.saturation != 0.0:
            over = p - P.knee_pa
            p -= P.saturation * 0.5 * (over + math.hypot(over, KNEE_WIDTH))
        if P.bladder_pa > 0.0:
            p = max(p - P.bladder_pa, 0.0)
        kappa = y / P.l0_m + P.kappa_offset
        return float(law(P, p, kappa)[0] + P.cross_n_pa * kappa * kappa * p)

    def _rest_position(self, p: float) -> float:
        """Position in m at which the static pull carries the load, by bisection."""
        P = self.parameters
        weight = (P.mass_kg + P.payload_kg) * P.gravity
        low, high = -0.15 * P.l0_m, 0.45 * P.l0_m
        for _ in range(60):
            mid = 0.5 * (low + high)
            stop = P.stop_n_m15 * max(0.0, mid - P.stop_m) ** 1.5 if P.stop_n_m15 > 0.0 else 0.0
            if tendon(P, self._static(p, mid)) > weight + stop:
                low = mid
            else:
                high = mid
        return 0.5 * (low + high)

    def step(self, u: float, h: float, push: float = 0.0) -> float:
        """Hold a command (Pa) for h seconds; return the position measured at the end, m.

        push is a force in N that lifts the load meanwhile.
        """
        force = push + (float(self._walk(np.array([h]))[0]) if self._walks else 0.0)
        t, y = hold(self._parameters, self._states, float(u), force, h)
        return self.sensor.read(t, y)

    def measure(self) -> float:
        """Return the position sensor's reading now, m. Each call draws new noise."""
        return self.sensor.read(self.state.t, self.state.link)

    def run(self, t: np.ndarray, u: np.ndarray, y_path: np.ndarray | None = None) -> Any:
        """Play a programme; a record of true arrays y, v, force, pressure, linked.

        t (n,) stamps in s, u (n,) Pa, held from stamp to stamp. Values at t[k] are those before
        u[k] acts. y_path (n,), m, prescribes the position (held length) instead of the load.
        """
        t = np.ascontiguousarray(t, dtype=np.float64)
        u = np.ascontiguousarray(u, dtype=np.float64)
        out = np.zeros((t.size, len(OUTPUTS)))
        P, S = self.parameters, self.state
        path = np.zeros(0)
        P.held = 0.0
        if y_path is not None:
            path = np.ascontiguousarray(y_path, dtype=np.float64)
            P.held = 1.0
            S.y = S.y_mem = S.link = S.strain_1 = S.strain_2 = path[0]
            S.lag_1 = S.lag_2 = self._static(S.p, path[0])
            S.pull = tendon(P, S.lag_1)
        run(self._parameters, self._states, t, u, self._walk(np.diff(t, append=t[-1])), path, out)
        return np.rec.fromarrays(out.T, names=list(OUTPUTS))

    def _walk(self, h: np.ndarray) -> np.ndarray:
        """Random-walk force in N on the load in each hold of h seconds."""
        if not self._walks:
            return np.zeros(h.size)
        steps = np.sqrt(h) * self._rng.standard_normal(h.size)
        walk = self._walked + self.parameters.walk_n_rs * np.cumsum(steps)
        self._walked = float(walk[-1])
        return walk

    @property
    def t(self) -> float:
        """Time since the reset, s."""
        return float(self.state.t)

    @property
    def y(self) -> float:
        """True position, m."""
        return float(self.state.y)

    @property
    def v(self) -> float:
        """True velocity, m/s."""
        return float(self.state.v)

    @property
    def force(self) -> float:
        """Pull of the muscle on the load as a force cell between them reads it, N."""
        return float(self.state.pull)

    @property
    def pressure(self) -> float:
        """True chamber pressure, gauge Pa."""
        return float(self.state.p)
