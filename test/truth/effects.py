# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects at a magnitude, given or drawn from the catalogue."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from .catalogue import FORMS, forms_of


@dataclass(frozen=True)
class Effect:
    """An effect at a magnitude: its kind, its form and the plant's fields that it sets."""

    kind: str
    form: str
    values: dict[str, float]

    def describe(self) -> dict[str, object]:
        """Return the effect as plain data."""
        return {'kind': self.kind, 'form': self.form, **self.values}


def effect(kind: str, form: str | None = None, **values: float) -> Effect:
    """Return an effect by name, with the table's defaults for what is not given.

    The static friction left out is 1.5 times Coulomb's.
    """
    chosen = FORMS[(kind, form or forms_of(kind)[0])]
    unknown = set(values) - set(chosen.ranges)
    if unknown:
        raise ValueError(f'{kind} ({chosen.form}) has no {sorted(unknown)}')
    full = {name: values.get(name, r.default) for name, r in chosen.ranges.items()}
    if 'static_n' in full and 'static_n' not in values:
        full['static_n'] = 1.5 * full['coulomb_n']
    return Effect(kind, chosen.form, {**full, **chosen.fixed})


def draw_effect(
    kind: str,
    rng: Generator,
    *,
    stroke: tuple[float, float],
    pressures: tuple[float, float],
    duration: float,
    held: bool = False,
) -> Effect:
    """Return an effect of a kind with form and magnitude drawn from the table.

    stroke (m) and pressures (Pa) are the ranges that the record of a duration in s will run
    through: an end stop, a knee and a drift lie within them.
    """
    # A joint of two muscles shows what a load on one muscle does not.
    forms = forms_of(kind, held=held) or forms_of(kind, held=True)
    chosen = FORMS[(kind, forms[rng.integers(len(forms))])]
    values = {name: r.draw(rng) for name, r in chosen.ranges.items()}
    if kind == 'coulomb_friction':
        values['static_n'] *= values['coulomb_n']
    if kind == 'end_stop':
        values['stop_m'] = stroke[0] + values['stop_m'] * (stroke[1] - stroke[0])
    if kind == 'saturation':
        values['knee_pa'] = pressures[0] + values['knee_pa'] * (pressures[1] - pressures[0])
    if kind == 'temperature_drift':
        values['drift_mid_s'] *= duration
        values['drift_width_s'] *= duration
    return Effect(kind, chosen.form, {**values, **chosen.fixed})
