# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two muscles against each other on a pulley with an arm: a truth plant that turns.

With the muscles' ends at x1 = k1 l0 + r q and x2 = k2 l0 - r q, q the angle, the energy
E = J q'^2 / 2 - m g l cos(q - q_h) changes by the work of the muscles and the friction of the
pivot. Muscles, chambers and friction are those of the truth plant with one muscle; the integrator
is its splitting, second order, dissipation implicit in the middle of a substep.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from .compiled import blank, element, jit
from .effects import Effect, effect
from .forces import bend_bristle, damping, friction, law, memory, tendon
from .layout import ELEMENTS, new_parameters, new_state
from .muscles import GRAVITY, constants_si
from .pneumatics import push_command, receive, working_pressure
from .reservoir import RESERVOIR, Reservoir, fill
from .sensor import Sensor

PAIR = ('radius', 'inertia', 'moment', 'hanging_at', 'x1', 'x2', 'q', 'rate', 'push', *RESERVOIR)


@jit
def pull_of(P, S, mass, v, d):
    """Pull in N of a muscle whose end moves at v, in the middle of a substep of d seconds."""
    p = working_pressure(P, S, d)
    static, slope = law(P, p, S.y / P.l0_m + P.kappa_offset)
    static -= memory(P, S, d)
    return static, damping(P, mass, p, slope, v)


@jit
def pair_substep(P1, S1, P2, S2, PL, SL, G, d):
    """Advance by d seconds; PL, SL are the pivot's friction."""
    receive(S1)
    receive(S2)
    fill(P1, S1, P2, S2, G, S1.t, 0.5 * d)
    G.q += 0.5 * d * G.rate
    if PL.bristle_n_m > 0.0:
        bend_bristle(PL, SL, G.rate, 0.5 * d)
    S1.y = G.x1 + G.radius * G.q
    S2.y = G.x2 - G.radius * G.q

    mass = G.inertia / (2.0 * G.radius * G.radius)
    f1, c1 = pull_of(P1, S1, mass, G.radius * G.rate, d)
    f2, c2 = pull_of(P2, S2, mass, -G.radius * G.rate, d)
    rate = G.rate
    for _ in range(3):
        v = G.radius * rate
        S1.pull = tendon(P1, f1 - c1 * v)
        S2.pull = tendon(P2, f2 + c2 * v)
        torque = G.radius * (S1.pull - S2.pull) - friction(PL, SL, rate)
        torque += G.push - G.moment * math.sin(G.q - G.hanging_at)
        rate = G.rate + 0.5 * d * torque / G.inertia
    G.rate = 2.0 * rate - G.rate

    S1.y_mem, S2.y_mem = S1.y, S2.y
    S1.p_mem, S2.p_mem = S1.p, S2.p
    if PL.bristle_n_m > 0.0:
        bend_bristle(PL, SL, G.rate, 0.5 * d)
    G.q += 0.5 * d * G.rate
    fill(P1, S1, P2, S2, G, S1.t + 0.5 * d, 0.5 * d)
    S1.t += d
    S2.t += d


@jit
def hold_pair(parameters, states, geometry, u1, u2, h, dt):
    """Hold both commands (Pa) for h seconds, in equal substeps no longer than dt."""
    P1, P2, PL = parameters[0][0], parameters[1][0], parameters[2][0]
    S1, S2, SL = states[0][0], states[1][0], states[2][0]
    start = S1.t
    push_command(P1, S1, u1)
    push_command(P2, S2, u2)
    count = max(1, math.ceil(h / dt - 1e-6))
    for _ in range(count):
        pair_substep(P1, S1, P2, S2, PL, SL, geometry[0], h / count)
    S1.t = S2.t = start + h


@jit
def torque_at(parameters, states, geometry, q):
    """Torque in N m of both muscles at the angle q, the pressures being what they are."""
    G = geometry[0]
    total = 0.0
    for i in range(2):
        P, S, sign = parameters[i][0], states[i][0], 1.0 - 2.0 * i
        end = (G.x1 if i == 0 else G.x2) + sign * G.radius * q
        total += sign * G.radius * law(P, S.p, end / P.l0_m)[0]
    return total


@jit
def stiffness_now(parameters, states, geometry):
    """Stiffness in N m/rad by a difference of torques."""
    h, q = 1e-6, geometry[0].q
    above = torque_at(parameters, states, geometry, q + h)
    return -(above - torque_at(parameters, states, geometry, q - h)) / (2.0 * h)


class TruthPair:
    """An antagonistic pair, stepped from two pressure commands; rad, N m, gauge Pa, s.

    muscles      names in muscles.PUBLISHED
    radius       of the pulley, m; inertia of pulley and arm, kg m^2
    mass, arm    of the load, kg and m from the pivot; it points down at hanging_at, rad
    contraction  of both muscles at angle 0
    payload      kg that nobody declares
    in_muscles   effects of both muscles; friction effects act at the pivot, in N m and rad/s
    in_each      effects of the first muscle alone, and of the second alone
    constants    a1..a6 in SI of each muscle, in the place of those published
    reservoir    from which both muscles fill; None: the supply always suffices
    dt           largest substep, s
    """

    def __init__(
        self,
        muscles: tuple[str, str] = ('dmsp_20_400n', 'dmsp_20_400n'),
        lengths: tuple[float, float] = (0.4, 0.4),
        radius: float = 0.04,
        inertia: float = 0.02,
        mass: float = 1.0,
        arm: float = 0.25,
        hanging_at: float = 0.0,
        contraction: tuple[float, float] = (0.1, 0.1),
        zeta: float = 0.15,
        payload: float = 0.0,
        in_muscles: Sequence[Effect] = (),
        at_pivot: Sequence[Effect] = (),
        in_each: tuple[Sequence[Effect], Sequence[Effect]] = ((), ()),
        constants: tuple[tuple[float, ...], tuple[float, ...]] | None = None,
        reservoir: Reservoir | None = None,
        dt: float = 5e-5,
        sensor: Sensor | None = None,
        seed: int = 0,
    ) -> None:
        self.reservoir = reservoir
        self.dt, self.seed, self.sensor = dt, seed, sensor or Sensor()
        self._parameters = tuple(new_parameters() for _ in range(3))
        self._states = tuple(new_state() for _ in range(3))
        self._first = element(self._states[0])
        self._geometry = blank('pair', PAIR, {})
        self.state = G = element(self._geometry)
        G.radius, G.hanging_at = radius, hanging_at
        G.inertia = inertia + (mass + payload) * arm * arm
        G.moment = (mass + payload) * GRAVITY * arm
        G.x1, G.x2 = (k * length for k, length in zip(contraction, lengths, strict=True))
        for i, (name, length) in enumerate(zip(muscles, lengths, strict=True)):
            P = element(self._parameters[i])
            own = constants_si(name) if constants is None else constants[i]
            P.a1, P.a2, P.a3, P.a4, P.a5, P.a6 = own
            P.zeta, P.l0_m = zeta, length
            _give(P, (*in_muscles, *in_each[i]))
        pivot = element(self._parameters[2])
        _give(pivot, at_pivot)
        pivot.bristle_ns_m = 0.4 * math.sqrt(pivot.bristle_n_m * G.inertia)
        self.reset(0.0, (3e5, 3e5))

    def reset(self, angle: float, p0: tuple[float, float]) -> None:
        """Put it at an angle in rad, at rest, with chambers at p0 (Pa) and virgin memory.

        The noise begins again with its seed.
        """
        self.sensor.reset(self.seed)
        G = self.state
        G.q, G.rate = angle, 0.0
        if self.reservoir:
            self.reservoir.put_into(G)
        for i, p in enumerate((*p0, 0.0)):
            S, P = element(self._states[i]), element(self._parameters[i])
            S.t = S.head = S.tail = 0.0
            S.u = S.p = S.p_mem = p
            S.y = S.y_mem = (G.x1 + G.radius * angle, G.x2 - G.radius * angle, angle)[i]
            S.bristle = 0.0
            S.plag_1 = S.plag_2 = p
            S.strain_1 = S.strain_2 = S.y
            for k in range(ELEMENTS):
                S.slip[k] = S.pslip[k] = 0.0
                share = 20.0 ** (k / (ELEMENTS - 1) - 1.0)
                S.slip_reach[k] = P.hyst_reach_m * share
                S.pslip_reach[k] = P.hyst_reach_pa * share

    def step(self, u: tuple[float, float], h: float, push: float = 0.0) -> float:
        """Hold both commands (Pa) for h seconds; return the angle measured at the end, rad.

        push is a torque in N m on the joint meanwhile.
        """
        parameters, states = self._parameters, self._states
        self.state.push = push
        hold_pair(parameters, states, self._geometry, float(u[0]), float(u[1]), h, self.dt)
        return self.measure()

    def measure(self) -> float:
        """Return the sensor's reading now, rad. Each call draws new noise."""
        return self.sensor.read(float(self._first.t), self.angle)

    @property
    def angle(self) -> float:
        """True angle, rad."""
        return float(self.state.q)

    @property
    def rate(self) -> float:
        """True angular velocity, rad/s."""
        return float(self.state.rate)

    @property
    def pressures(self) -> tuple[float, float]:
        """True chamber pressures, Pa."""
        one, two = (float(element(states).p) for states in self._states[:2])
        return one, two

    def stiffness(self) -> float:
        """Stiffness in N m/rad that the muscles give the joint, by a difference of their pulls."""
        return float(stiffness_now(self._parameters, self._states, self._geometry))


def _give(P: Any, effects: Sequence[Effect]) -> None:
    for one in effects:
        for name, value in one.values.items():
            setattr(P, name, value)


FEEDBACK_NOISE = math.radians(0.02)  # of an encoder with some 10 000 steps a turn
_FRICTION = effect(
    'coulomb_friction', coulomb_n=0.15, static_n=0.22, stribeck_m_s=0.05, bristle_n_m=150.0
)
_LAG = effect('pressure_lag', 'two_times', fill_s=0.050, vent_s=0.070)
_QUICK = effect('pressure_lag', 'two_times', fill_s=0.020, vent_s=0.030)
_HYSTERESIS = effect('hysteresis', 'slip', hyst_n=15.0, hyst_reach_m=4e-3)
_DEAD = effect('dead_time', dead_time_s=0.010)
_ZONE = effect('regulator_dead_zone', 'play', dead_zone_pa=6e3)
_LONG = effect('dead_time', dead_time_s=0.040)

# What is there and nobody declares: 0.3 kg more on 1 kg, N m at the pivot, N in each muscle.
PAIR_PLANTS: dict[str, dict[str, Any]] = {
    'nominal': {},
    'payload': {'payload': 0.3},
    'friction': {'at_pivot': (_FRICTION,)},
    'payload and friction': {'payload': 0.3, 'at_pivot': (_FRICTION,)},
    'quick lag': {'in_muscles': (_QUICK,)},
    'lag': {'in_muscles': (_LAG,)},
    'dead zone': {'in_muscles': (_LAG, _ZONE)},
    'dead time': {'in_muscles': (_LONG,)},
    'hysteresis': {'in_muscles': (_HYSTERESIS,)},
    'all': {
        'payload': 0.3,
        'at_pivot': (_FRICTION,),
        'in_muscles': (_LAG, _HYSTERESIS, _DEAD),
    },
}


def pair_plant(name: str, *, noise: float = FEEDBACK_NOISE, seed: int = 0) -> TruthPair:
    """Return a benchmark plant by name: muscles of 400 mm, a load of 1 kg on an arm of 250 mm."""
    return TruthPair(**PAIR_PLANTS[name], sensor=Sensor(noise=noise), seed=seed)
