# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The law on the rig itself and on the truth plant: bounds, limits, starts, the table's rows."""

import math

import numpy as np
import pytest

from pam_ros.control.gains import SUPER_TWISTING, Gains
from pam_ros.control.limits import Limits
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from support.bench import cart
from support.closed_loop import LAG, close_loop, declared, sine_target, step_target, truth

DT = 2e-3
PLAIN = Gains(learning=False, observer=False, rest_factor=1.0)


def on_rig(law, joint, reference, seconds, force=lambda t: 0.0, p0=300e3):
    """Run *law* on the package's own rig under an outside *force*; return t, e and s."""
    rig = Rig([joint])
    y0 = rest(joint, p0)
    rig.reset([p0], [y0], [0.0])
    law.start(y0, (p0,))
    rows = []
    for n in range(round(seconds / DT)):
        t = n * DT
        now = reference(t, y0)
        (pressure,) = law.update(DT, now, float(rig.position[0]))
        rows.append((t, now.position - rig.position[0], law.terms.surface, pressure))
        # An outside force is a change of pressure, as dF = (dF/dp) dp.
        (gain,) = law.sharing.gains(float(rig.position[0]))
        rig.command([pressure + force(t) / gain])
        rig.advance(2)
    return np.array(rows).T


def held(t, y0):
    return Reference(y0)


def test_the_error_stays_within_the_bound_of_the_boundary_layer():
    joint = one_muscle(Muscle(zeta=0.15), Mass(mass=20.0))
    gains = Gains(**{**PLAIN.__dict__, 'disturbance_bound': 60.0, 'velocity_bandwidth': 500.0})
    law = SlidingMode(joint, gains)
    frequency = math.sqrt(law.model.stiffness((300e3,), rest(joint, 300e3)) / 20.0)
    disturbance = 30.0
    # The worst there is: it changes sign with the surface's own frequency.
    worst = lambda t: math.copysign(disturbance, math.sin(frequency * t))  # noqa: E731
    _, e, s, _ = on_rig(law, joint, held, 12.0, worst)
    width = gains.boundary_width(20.0) * disturbance / gains.disturbance_bound
    bound = gains.error_bound(disturbance, 20.0, frequency)
    assert np.max(np.abs(s)) < 1.1 * width
    assert 0.1 * bound < np.max(np.abs(e)) < 1.1 * bound


@pytest.mark.parametrize('scale', [0.5, 1.5])
def test_coefficients_that_are_wrong_by_half_leave_no_error_at_rest(scale):
    # Lilly & Quesada 2004: the boundary layer holds under +-50 % of the model's coefficients.
    true = one_muscle(Muscle(zeta=0.15), Mass(mass=20.0))
    m = true.muscle
    wrong = Muscle(
        scale * m.a1, scale * m.a2, m.a3, scale * m.a4, scale * m.a5, scale * m.a6, zeta=0.15
    )
    law = SlidingMode(one_muscle(wrong, Mass(mass=15.0)), Gains())
    _, e, _, pressure = on_rig(law, true, lambda t, y0: Reference(y0 + 0.005), 8.0)
    assert np.max(np.abs(e[-500:])) < 1e-6
    assert np.ptp(pressure[-500:]) < 100.0


def test_integral_action_needs_no_observer():
    joint = one_muscle(Muscle(zeta=0.15), Mass(mass=20.0))
    law = SlidingMode(joint, Gains(observer=False, learning=False))
    _, e, *_ = on_rig(law, joint, held, 8.0, lambda t: -20.0 if t > 0.5 else 0.0)
    assert np.max(np.abs(e)) > 0.1e-3
    assert np.max(np.abs(e[-500:])) < 5e-6


def test_super_twisting_holds_and_follows():
    joint = one_muscle(Muscle(zeta=0.15), Mass(mass=20.0))
    law = SlidingMode(joint, Gains(switching=SUPER_TWISTING, learning=False))
    _, e, _, pressure = on_rig(law, joint, held, 6.0, lambda t: 10.0 * math.sin(2.0 * t))
    late = slice(1500, None)
    assert np.max(np.abs(e[late])) < 0.3e-3
    assert np.max(np.abs(np.diff(pressure[late]))) < 500.0  # it does not chatter


@pytest.mark.parametrize('observer', [True, False])
def test_the_first_command_is_the_pressure_that_is_there(observer):
    law = SlidingMode(one_muscle(), Gains(observer=observer))
    for pressure in (200e3, 300e3, 450e3):
        law.start(0.06, (pressure,))
        assert law.update(DT, Reference(0.06), 0.06) == pytest.approx((pressure,), rel=1e-9)
    law.start(0.06)
    held = law.update(DT, Reference(0.06), 0.06)
    weight = float(statics.weight(law.joint, 0.06))
    assert law.model.effort(held, 0.06) == pytest.approx(weight, rel=1e-9)


def test_commands_stay_within_limits_of_pressure_and_rate():
    law = SlidingMode(one_muscle(), Gains(), Limits(100e3, 400e3, 1e6))
    law.start(0.06, (300e3,))
    rng, last = np.random.default_rng(0), 300e3
    for n in range(2000):
        goal = 0.3 * math.copysign(1.0, math.sin(0.01 * n))
        (pressure,) = law.update(DT, Reference(0.06 + goal), 0.06 + 1e-3 * rng.standard_normal())
        assert 100e3 <= pressure <= 400e3
        assert abs(pressure - last) <= 1e6 * DT + 1e-6
        last = pressure


def test_it_does_not_wind_up_at_a_limit():
    joint = one_muscle(Muscle(zeta=0.15), Mass(mass=20.0))
    law = SlidingMode(joint, Gains(learning=False), Limits(pressure_high=350e3))

    def too_high_for_a_while(t, y0):
        return Reference(y0 + (0.03 if 0.5 < t < 6.0 else 0.0))

    t, e, _, pressure = on_rig(law, joint, too_high_for_a_while, 9.0)
    stuck = (t > 2.0) & (t < 6.0)
    assert np.all(pressure[stuck] == 350e3)
    assert law.terms.cut == 0.0
    # It leaves the limit at once: the error is that of a step, not of four seconds of windup.
    assert pressure[np.searchsorted(t, 6.0) + 2] < 350e3
    back = t > 6.0
    assert np.min(e[back]) > -0.02
    assert np.max(np.abs(e[t > 7.5])) < 0.1e-3


def test_a_load_without_a_spring_is_held_by_the_surface_alone():
    joint = cart(mass=10.0)
    law = SlidingMode(joint, Gains(learning=False, disturbance_bound=100.0))
    rig = Rig([joint])
    rig.reset([0.0], [0.0], [0.0])
    law.start(0.0, (0.0,))
    for n in range(6000):
        goal = Reference(0.01 if n > 250 else 0.0)
        (pressure,) = law.update(DT, goal, float(rig.position[0]))
        rig.command([pressure - 2.0])  # N: what pulls it back, as nothing here can push
        rig.advance(2)
    assert rig.position[0] == pytest.approx(0.01, abs=1e-6)


def test_measured_velocity_is_used_where_the_gains_say_so():
    for used, expected in ((True, 0.123), (False, 0.0)):
        law = SlidingMode(one_muscle(), Gains(use_measured_velocity=used))
        law.start(0.06, (300e3,))
        law.update(DT, Reference(0.06), 0.06, 0.123)
        assert law.terms.velocity == pytest.approx(expected, abs=1e-9)


def test_gains_can_change_in_flight_without_a_jump():
    law = SlidingMode(one_muscle(), Gains(learning=False))
    law.start(0.06, (300e3,))
    for _ in range(500):
        before = law.update(DT, Reference(0.0601), 0.06)
    law.set_gains(Gains(learning=False, bandwidth=20.0))
    after = law.update(DT, Reference(0.0601), 0.06)
    assert after == pytest.approx(before, abs=1e3)


def test_two_runs_are_the_same_to_the_bit():
    runs = [
        close_loop(SlidingMode(declared(), Gains()), truth('friction'), step_target(0.01), 2.0)
        for _ in range(2)
    ]
    assert runs[0].pressure.tobytes() == runs[1].pressure.tobytes()


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('plant', 'effects', 'rest', 'sine'),
    [
        ('nominal', None, 0.01, 0.02),
        ('payload', None, 0.01, 0.02),
        ('lag', LAG, 0.01, 0.05),
        ('hysteresis', None, 0.03, 0.15),
    ],
)
def test_it_reaches_what_is_claimed(plant, effects, rest, sine):
    law = SlidingMode(declared(effects=effects), Gains())
    step = close_loop(law, truth(plant, seed=7), step_target(0.02), 8.0)
    end = step.last(2.0)
    assert np.max(np.abs(step.error[end])) < rest * 1e-3
    assert np.ptp(step.pressure[end]) < 3e3
    if plant == 'nominal':
        assert np.all(np.abs(step.error[step.t > 2.0]) < 0.02 * 0.02)
    swing = close_loop(law, truth(plant, seed=7), sine_target(0.01, 0.5), 12.0)
    assert np.sqrt(np.mean(swing.error[swing.last(4.0)] ** 2)) < sine * 1e-3


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('plant', ['nominal', 'lag', 'all'])
def test_it_is_calm_at_rest_without_noise(plant):
    law = SlidingMode(declared(), Gains())
    run = close_loop(law, truth(plant, noise=0.0), step_target(0.02), 12.0)
    assert np.ptp(run.pressure[run.last(2.0)]) < 1e3
    assert np.max(np.abs(run.error[run.last(2.0)])) < 0.06e-3


@pytest.mark.needs_numba
@pytest.mark.parametrize('rate', [200.0, 1000.0])
def test_it_works_at_other_rates(rate):
    law = SlidingMode(declared(), Gains())
    run = close_loop(law, truth('payload'), step_target(0.02), 6.0, rate)
    assert np.max(np.abs(run.error[run.last(2.0)])) < 0.01e-3
