# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The fits to every sample: what the thinned runs got wrong is put right."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace

import numpy as np
import pytest

from pam_ros.effects import end_stop
from pam_ros.identification import final
from pam_ros.identification.candidate import fitted, freed
from pam_ros.identification.data.noise import Noise, noise_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.final import polished
from pam_ros.identification.finder import trace
from pam_ros.identification.selection import Search, search
from pam_ros.identification.solve import solve
from support import bench_truth
from support.equations import Equation, equation, unknown
from support.rounds import retuned, setting_of, with_effect_starts
from truth import effect

pytestmark = pytest.mark.needs_numba
NOISE = 20e-6  # m
RAMP, FLAW = np.linspace(1.0, 2.0, 50), 1e-5 * np.cos(np.pi * np.arange(50))
OFF = [0.01, -0.015, 0.005, 0.01, -0.01, 0.015]


def test_an_effect_that_the_fit_to_every_sample_does_not_need_is_dropped():
    model = bench_truth.declared(off=OFF)
    with setting_of(model, effect('viscous_friction'), effect('pressure_lag')) as setting:
        starts = {
            'pressure_lag': {'fill': 0.03, 'vent': 0.03},
            'dead_time': {'delay': 2e-3},
            'viscous_friction': {'coefficient': 50.0},
        }
        thin = with_effect_starts(setting, starts)
        kept = [bench_truth.free(effect('viscous_friction'), effect('pressure_lag'), seed=3)]
        found = Search(setting.declared, retuned(setting), thin, ())
        segments = segments_of(kept, keep_back=True)
        *_, augmented = polished(found, model, segments, setting.noise)
    assert augmented.effects == ('pressure_lag', 'viscous_friction')
    assert augmented.held_error < 1.1 * setting.noise.sigma


@pytest.mark.slow
def test_a_stop_that_long_steps_softened_is_as_stiff_as_it_is_in_the_end():
    """Thinned runs know no difference between stiff pads, and leave them at their bound."""
    stop = effect('end_stop', stop_m=0.065, stop_n_m15=1e7, stop_s_m=1.0)
    found = trace(bench_truth.declared(off=OFF), [bench_truth.free(stop, seed=4)])
    assert [one.name for one in found.effects] == ['end_stop']
    stiffness = found.effects[0].parameters['stiffness']
    assert not stiffness.at_bound
    # Half a millimetre deep the truth pushes back with 1e7 d^1.5 = 112 N.
    assert 5e4 < stiffness.value < 1e6
    assert found.stages[2].held_error < 4.0 * NOISE < 0.1 * found.stages[1].held_error


@pytest.mark.slow
def test_finer_parameters_that_earn_nothing_in_full_are_dropped():
    there = effect('coulomb_friction', coulomb_n=8.0, static_n=8.0, stribeck_m_s=5e-3)
    model = bench_truth.declared(off=OFF)
    friction = next(e for e in model.library if e.name == there.kind)
    segments = segments_of([bench_truth.free(there, seed=4)], keep_back=True)
    noise = noise_of([(s.t, s.target) for s in segments])
    found = search(model, segments, noise, lambda fraction, text: None)
    wide = fitted((there.kind,), freed(found.augmented.solution, model, friction, 4))
    assert wide.solution.u.size > found.augmented.solution.u.size
    *_, augmented = polished(replace(found, augmented=wide), model, segments, noise)
    freed_ones = [u.name for u in augmented.solution.problem.unknowns if 'effects' in u.name]
    assert freed_ones == ['effects.coulomb_friction.level']


def test_a_final_fit_begins_where_a_strength_still_matters():
    """Of a stop that is stiff beyond measure no derivative says that it should be softer."""
    stiffness = unknown('effects.end_stop.stiffness', 0.0, 1.0, 0.0, 1e4)
    known = equation(lambda u: RAMP * (np.tanh(u[0]) - 0.5) + FLAW, [stiffness], 50.0)
    problem = replace(known, active=(end_stop.EFFECT,))
    quiet = Noise(1e-6, 0.0)
    assert solve(problem, np.array([1e3])).u[0] == 1e3
    with ThreadPoolExecutor(1) as pool:
        found = final._settled(problem, np.array([1e3]), 1.0, quiet, pool)
    assert found.u[0] == pytest.approx(np.arctanh(0.5), rel=1e-3)
    assert found.problem is problem


@dataclass(frozen=True, eq=False)
class TwoValleys(Equation):
    """The lower valley, at 0.1, is that of the fitted samples alone; the other one is at 1."""

    def residuals(self, u):
        lower, other = 50.0 * (u[0] - 0.1) ** 2 + 0.4, (u[0] - 1.0) ** 2 + 0.5
        return RAMP * min(lower, other) + FLAW

    def errors(self, u):
        return float(np.sqrt(np.mean(self.residuals(u) ** 2))), 2.0 if u[0] < 0.5 else 0.8


@pytest.mark.parametrize(('keep_back', 'valley'), [(True, 1.0), (False, 0.1)])
def test_of_two_ends_the_one_is_taken_that_carries_over(keep_back, valley):
    strength = unknown('effects.end_stop.stiffness', 0.0, 1.0, 0.0, 1e4)
    plain = equation(None, [strength], 50.0)
    values = {f.name: getattr(plain, f.name) for f in fields(plain) if f.init}
    segments = segments_of([bench_truth.free(duration=10.0)], keep_back=keep_back)
    values |= {'segments': segments, 'active': (end_stop.EFFECT,)}
    with ThreadPoolExecutor(1) as pool:
        found = final._settled(TwoValleys(**values), np.array([1.2]), 1.0, Noise(1e-6, 0.0), pool)
    assert found.u[0] == pytest.approx(valley, abs=0.05)


@dataclass(frozen=True, eq=False)
class Rugged(Equation):
    """A valley about 1 that has more and more ditches as steps become shorter."""

    def residuals(self, u):
        ditches = max(0.0, 4e-3 - self.step) * 250.0 * np.sin(30.0 * (u[0] - 1.0))
        return RAMP * (u[0] - 1.0 + ditches) + FLAW


def test_a_final_fit_that_does_not_arrive_is_led_by_shorter_and_shorter_steps():
    plain = equation(None, ['x'], 50.0)
    rugged = Rugged(**{f.name: getattr(plain, f.name) for f in fields(plain) if f.init})
    start, quiet = np.array([3.0]), Noise(1e-6, 0.0)
    stuck = solve(rugged, start, 10)
    assert np.abs(stuck.u[0] - 1.0) > 0.2
    with ThreadPoolExecutor(1) as pool:
        led = final._settled(rugged, start, 1e-3, quiet, pool)
        left = final._settled(rugged, start, 1e3, quiet, pool)
    assert led.u[0] == pytest.approx(1.0, abs=1e-3)
    assert left.u[0] == stuck.u[0]
