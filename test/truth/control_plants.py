# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The plants on which the position controller is judged, each by name."""

from __future__ import annotations

from .effects import Effect, effect
from .plant import TruthPlant
from .sensor import Sensor

FEEDBACK_NOISE = 20e-6

_HYSTERESIS = effect('hysteresis', 'slip', hyst_n=40.0, hyst_reach_m=4e-3)
_FRICTION = effect('coulomb_friction', coulomb_n=15.0, static_n=25.0, stribeck_m_s=10e-3)
_LAG = effect('pressure_lag', 'two_times', fill_s=0.050, vent_s=0.070)
_PAYLOAD = effect('payload', payload_kg=5.0)
_DEAD = effect('dead_time', dead_time_s=0.010)
_ZONE = effect('regulator_dead_zone', 'play', dead_zone_pa=6e3)
_LONG = effect('dead_time', dead_time_s=0.080)

CONTROL_PLANTS: dict[str, tuple[Effect, ...]] = {
    'nominal': (),
    'payload': (_PAYLOAD,),
    'hysteresis': (_HYSTERESIS,),
    'friction': (_FRICTION,),
    'lag': (_LAG,),
    'dead zone': (_LAG, _ZONE),
    'dead time': (_LONG,),
    'all': (_LAG, _HYSTERESIS, _FRICTION, _PAYLOAD, _DEAD),
}


def control_plant(
    name: str, *, noise: float = FEEDBACK_NOISE, p0: float = 300e3, seed: int = 0
) -> TruthPlant:
    """Return a benchmark plant: 20 kg, zeta 0.15, at rest at p0 (Pa), white position noise (m)."""
    return TruthPlant(effects=CONTROL_PLANTS[name], sensor=Sensor(noise=noise), p0=p0, seed=seed)
