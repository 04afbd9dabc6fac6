# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The one table of what a truth plant may have in addition to its muscle, with magnitudes.

A kind may come in several forms: other equations for the same physical effect. `small` and
`large` bound what a blind trial draws, log-uniformly when both are positive. What
draw_effect scales to the record at hand is bounded as a share: the static friction of
Coulomb's, a stop of the stroke, a knee of the pressure range, a drift of the duration.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from numpy.random import Generator


@dataclass(frozen=True)
class Range:
    """One number of an effect: the value it takes when not said, and what trials draw from."""

    default: float
    small: float
    large: float
    signed: bool = False

    def draw(self, rng: Generator) -> float:
        """Return a value between small and large, of either sign where both make sense."""
        if self.small > 0.0:
            value = self.small * (self.large / self.small) ** rng.random()
        else:
            value = self.small + (self.large - self.small) * rng.random()
        return -value if self.signed and rng.random() < 0.5 else value


@dataclass(frozen=True)
class Form:
    """One formulation of a kind: the plant's fields that it sets."""

    kind: str
    form: str
    ranges: dict[str, Range]
    fixed: dict[str, float] = field(default_factory=dict)
    held: bool = False  # seen at held length, too
    free: bool = True  # seen with a free load
    brings: tuple[str, ...] = ()  # other kinds that these equations are as well
    called: str = ''  # the package's effect, where it has another one for each form of a kind

    @property
    def names(self) -> frozenset[str]:
        """The effects of the package by which it may be named: its equations can be two."""
        return frozenset((self.called or self.kind, *self.brings))


R = Range
_FORMS = (
    # ---- kinds that the package has, by other equations where there are others
    Form('slack', 'hard', {}, {'slack': 1.0}, held=True),
    Form('slack', 'toe', {'toe_n': R(25.0, 10.0, 60.0)}, {'slack': 1.0}, held=True),
    Form(
        'hysteresis',  # Maxwell slip in the contraction
        'slip',
        {'hyst_n': R(20.0, 2.0, 60.0), 'hyst_reach_m': R(4e-3, 2e-3, 12e-3)},
    ),
    Form(
        'hysteresis',  # generalised Prandtl-Ishlinskii in the pressure
        'pressure',
        {'hyst_pa': R(10e3, 2e3, 20e3), 'hyst_reach_pa': R(60e3, 30e3, 120e3)},
        held=True,
        called='pressure_hysteresis',
    ),
    Form(
        'coulomb_friction',  # LuGre
        'lugre',
        {
            'coulomb_n': R(15.0, 2.5, 25.0),
            'static_n': R(22.5, 1.1, 2.0),
            'stribeck_m_s': R(10e-3, 3e-3, 30e-3),
            'bristle_n_m': R(1e6, 3e5, 2e6),
        },
    ),
    Form('viscous_friction', 'linear', {'viscous_ns_m': R(60.0, 25.0, 200.0)}),
    Form(
        'creep',  # two shares of the pressure act late
        'pressure',
        {
            'late_1': R(0.03, 0.01, 0.05),
            'creep_1_s': R(1.0, 0.5, 2.5),
            'late_2': R(0.03, 0.01, 0.05),
            'creep_2_s': R(12.0, 6.0, 25.0),
        },
        held=True,
    ),
    Form(
        'creep',  # two shares of the force come late; a constant load hardly shows it
        'force',
        {
            'creep_1': R(0.02, 0.01, 0.03),
            'creep_1_s': R(1.0, 0.5, 2.5),
            'creep_2': R(0.02, 0.01, 0.03),
            'creep_2_s': R(12.0, 6.0, 25.0),
        },
        held=True,
        free=False,
    ),
    Form(
        'creep',  # two Maxwell branches next to the muscle
        'strain',
        {
            'maxwell_1_n_m': R(600.0, 200.0, 1500.0),
            'creep_1_s': R(1.0, 0.5, 2.5),
            'maxwell_2_n_m': R(600.0, 200.0, 1500.0),
            'creep_2_s': R(12.0, 6.0, 25.0),
        },
    ),
    Form(
        'softening',  # with the work done
        'work',
        {'soft_share': R(0.03, 0.012, 0.06), 'soft_work_j': R(200.0, 80.0, 400.0)},
    ),
    Form(
        'softening',  # with the pressure cycles run through
        'cycles',
        {'soft_share': R(0.03, 0.012, 0.06), 'soft_path_pa': R(4e6, 2e6, 8e6)},
        held=True,
    ),
    Form(
        'pressure_lag',
        'two_times',
        {'fill_s': R(0.05, 0.02, 0.13), 'vent_s': R(0.07, 0.02, 0.13)},
        held=True,
    ),
    Form(
        'pressure_lag',  # ISO 6358 flow through a proportional valve
        'iso_6358',
        {
            'conductance_fill': R(0.8, 0.3, 2.0),  # l/(s bar)
            'conductance_vent': R(0.8, 0.3, 2.0),
            'volume_l': R(0.15, 0.1, 0.25),
            'valve_band_pa': R(60e3, 30e3, 120e3),
        },
        held=True,
    ),
    Form('dead_time', 'transport', {'dead_time_s': R(0.01, 5e-3, 40e-3)}, held=True),
    Form(
        'pressure_offset',
        'affine',
        {'regulator_pa': R(6e3, 2e3, 12e3, signed=True), 'regulator_gain': R(1.0, 0.97, 1.03)},
        held=True,
    ),
    Form(  # a valve whose spool overlaps its ports; a constant load hardly shows it
        'dead_band',
        'overlap',
        {'overlap_pa': R(100e3, 80e3, 150e3)},
        held=True,
        free=False,
    ),
    Form(  # a regulator whose command must change by so much before its valve opens
        'regulator_dead_zone',
        'play',
        {'dead_zone_pa': R(6e3, 3e3, 15e3)},
        held=True,
        free=False,  # trials draw one kind for each effect of the package, which it has already
        called='pressure_hysteresis',
    ),
    Form(  # a bladder that must stretch to meet the braid
        'dead_band',
        'bladder',
        {'bladder_pa': R(100e3, 80e3, 150e3)},
        held=True,
        free=False,
    ),
    Form('payload', 'mass', {'payload_kg': R(5.0, 1.5, 6.0)}),
    Form(
        'pressure_dependent_damping',
        'two_ways',
        {
            'damping_up_ns_m_bar': R(30.0, 8.0, 80.0),
            'damping_down_ns_m_bar': R(50.0, 8.0, 80.0),
        },
    ),
    Form(
        'end_stop',  # Hunt and Crossley
        'hunt_crossley',
        {
            'stop_m': R(0.07, 0.6, 0.92),
            'stop_n_m15': R(2e7, 5e6, 5e7),
            'stop_s_m': R(1.0, 0.3, 2.0),
        },
    ),
    Form(
        'leak',  # the regulator's valve closes between command changes
        'closed_valve',
        {'leak_per_s': R(0.02, 6e-3, 0.08), 'valve_open_s': R(0.2, 0.1, 0.3)},
        held=True,
    ),
    Form(
        'leak',  # against a refill of limited flow
        'refill',
        {
            'leak_per_s': R(0.6, 0.3, 1.5),
            'fill_s': R(0.08, 0.05, 0.15),
            'vent_s': R(0.05, 0.03, 0.1),
            'refill_pa_s': R(6e5, 4e5, 9e5),
        },
        held=True,
        brings=('pressure_lag',),
    ),
    Form(
        'periodic_disturbance',
        'force',
        {
            'ripple_n': R(6.0, 2.0, 15.0),
            'ripple_hz': R(3.0, 0.7, 12.0),
            'ripple_rad': R(0.0, 0.0, 6.28),
        },
    ),
    Form(
        'periodic_disturbance',  # of the supply
        'supply',
        {
            'ripple_pa': R(4e3, 1.5e3, 8e3),
            'ripple_hz': R(3.0, 0.7, 12.0),
            'ripple_rad': R(0.0, 0.0, 6.28),
        },
        held=True,
    ),
    Form('length_offset', 'rest', {'kappa_offset': R(0.01, 4e-3, 0.03, signed=True)}, held=True),
    # ---- kinds that are in no library
    Form('quadratic_drag', 'drag', {'drag_ns2_m2': R(1500.0, 700.0, 3000.0)}),
    Form('cogging', 'guide', {'cog_n': R(10.0, 5.0, 20.0), 'cog_m': R(10e-3, 6e-3, 25e-3)}),
    Form('cross_coupling', 'kappa2_p', {'cross_n_pa': R(6e-3, 3e-3, 9e-3)}, held=True),
    Form(
        'temperature_drift',
        'tanh',
        {
            'drift_share': R(0.02, 0.01, 0.04, signed=True),
            'drift_mid_s': R(30.0, 0.4, 0.7),
            'drift_width_s': R(6.0, 0.05, 0.15),
        },
        held=True,
    ),
    Form('backlash', 'linkage', {'play_m': R(0.5e-3, 0.2e-3, 1.5e-3)}),
    Form(
        'second_mode',
        'sprung_mass',
        {
            'second_kg': R(4.0, 2.0, 7.0),
            'second_hz': R(5.0, 3.0, 9.0),
            'second_zeta': R(0.02, 0.01, 0.05),
        },
    ),
    Form('random_walk', 'force', {'walk_n_rs': R(3.0, 1.5, 6.0)}),
    Form(
        'saturation',
        'pressure_gain',
        {'saturation': R(0.2, 0.1, 0.4), 'knee_pa': R(250e3, 0.3, 0.7)},
        held=True,
    ),
)
FORMS = {(form.kind, form.form): form for form in _FORMS}

OUT_OF_LIBRARY = (
    'quadratic_drag',
    'cogging',
    'cross_coupling',
    'temperature_drift',
    'backlash',
    'second_mode',
    'random_walk',
    'saturation',
)
# Kinds of the library that a free load shows.
KINDS = tuple(dict.fromkeys(f.kind for f in _FORMS if f.free and f.kind not in OUT_OF_LIBRARY))


def forms_of(kind: str, *, held: bool = False) -> list[str]:
    """Return the names of a kind's forms that a free load, or a held length, shows."""
    return [f.form for f in _FORMS if f.kind == kind and (f.held if held else f.free)]
