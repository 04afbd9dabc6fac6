# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Angle and stiffness of a pair on the truth plant and on the rig: tracking, limits, starts."""

import math

import numpy as np
import pytest

from pam_ros.control.gains import SUPER_TWISTING, Gains
from pam_ros.control.limits import Limits
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import RangeError
from pam_ros.rig import co_contraction
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from pam_ros.rig.transmissions import Pulley
from support.joint_models import pair
from support.pair_loop import LAG, close_pair, declared
from truth.pair import TruthPair, pair_plant

DT = 2e-3
DEGREE = math.radians(1.0)


def sine(t):
    return 15.0 * DEGREE * math.sin(math.pi * t)


def on_rig(law, joint, reference, seconds, begin=0.0, torque=lambda t: 0.0):
    """Run *law* on the package's own rig; return t, error, sliding variable and commands."""
    rig = Rig([joint])
    law.start(begin)
    rig.reset(law.terms.pressures, [begin], [0.0])
    rows = []
    for n in range(round(seconds / DT)):
        t = n * DT
        now = reference(t)
        p = law.update(DT, now, float(rig.position[0]))
        rows.append((t, now.position - rig.position[0], law.terms.surface, *p))
        # An outside torque is a change of both pressures against each other.
        one, two = law.sharing.gains(float(rig.position[0]))
        share = torque(t) / (one - two)
        rig.command([p[0] + share, p[1] - share])
        rig.advance(2)
    return np.array(rows).T


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('plant', 'effects'),
    [
        ('nominal', None),
        ('payload', None),
        ('friction', None),
        ('payload and friction', None),
        ('quick lag', None),
        ('lag', LAG),
    ],
)
def test_a_sine_is_tracked_within_a_fifth_of_a_degree(plant, effects):
    law = SlidingMode(declared(effects), Gains.turning())
    run = close_pair(law, pair_plant(plant, seed=7), sine, 10.0)
    end = run.last(4.0)
    assert np.ptp(run.angle[end]) > 29.0 * DEGREE
    assert np.sqrt(np.mean(run.error[end] ** 2)) < 0.2 * DEGREE


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('plant', ['nominal', 'payload', 'payload and friction', 'all'])
def test_the_stiffness_is_what_is_set_while_the_angle_holds(plant):
    law = SlidingMode(declared(), Gains.turning())

    def stiffness(t):
        return 18.0 if t < 4.0 else 36.0

    goal = 10.0 * DEGREE
    run = close_pair(law, pair_plant(plant, seed=3), lambda t: goal, 9.0, stiffness)
    # By differences of the pulls of the truth plant's muscles, and by the closed form.
    for t, wanted in ((3.9, 18.0), (8.9, 36.0)):
        n = np.searchsorted(run.t, t)
        assert run.stiffness[n] == pytest.approx(wanted, rel=1e-3)
        assert abs(run.error[n]) < 0.03 * DEGREE
    if plant == 'nominal':
        expected = co_contraction.pressures(declared(), goal, 36.0)
        np.testing.assert_allclose(run.pressure[:, -1], expected, rtol=2e-3)
    assert np.max(np.abs(run.error[run.t > 3.0])) < 0.03 * DEGREE


@pytest.mark.needs_numba
def test_it_is_calm_at_rest():
    law = SlidingMode(declared(), Gains.turning())
    run = close_pair(law, pair_plant('payload and friction'), lambda t: 0.2, 10.0)
    end = run.last(2.0)
    assert np.max(np.abs(run.error[end])) < 0.01 * DEGREE
    assert np.max(np.ptp(run.pressure[:, end], axis=1)) < 1e3


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('rate', [200.0, 1000.0])
def test_it_works_at_other_rates(rate):
    law = SlidingMode(declared(), Gains.turning())
    run = close_pair(law, pair_plant('payload'), sine, 8.0, rate=rate)
    assert np.sqrt(np.mean(run.error[run.last(4.0)] ** 2)) < 0.2 * DEGREE


@pytest.mark.needs_numba
def test_a_heavier_arm_that_begins_away_from_rest_is_caught():
    plant = TruthPair(mass=2.0, seed=1)
    law = SlidingMode(declared(), Gains.turning())
    run = close_pair(law, plant, lambda t: 0.4, 6.0, begin=0.4)
    assert np.max(np.abs(run.error)) < 3.0 * DEGREE
    assert np.max(np.abs(run.error[run.last(1.0)])) < 0.01 * DEGREE


def test_a_torque_within_the_bound_keeps_the_surface_within_the_layer():
    gains = Gains.turning(observer=False, rest_factor=1.0, velocity_bandwidth=500.0)
    law = SlidingMode(pair(), gains)
    k = law.model.stiffness(law.terms.pressures, 0.0) + law.model.gravity_stiffness(0.0)
    frequency = math.sqrt(k / law.model.inertia)
    disturbance = 1.0
    _, e, s, *_ = on_rig(
        law,
        pair(),
        lambda t: Reference(0.1),
        8.0,
        0.1,
        lambda t: math.copysign(disturbance, math.sin(frequency * t)),
    )
    width = disturbance / (law.model.inertia * gains.bandwidth)
    assert np.max(np.abs(s)) < 1.1 * width
    assert np.max(np.abs(e)) > 0.1 * DEGREE


def test_integral_action_needs_no_observer():
    law = SlidingMode(pair(), Gains.turning(observer=False))
    _, e, *_ = on_rig(
        law, pair(), lambda t: Reference(0.1), 8.0, 0.1, lambda t: 0.5 if t > 0.5 else 0.0
    )
    assert np.max(np.abs(e)) > 0.1 * DEGREE
    assert np.max(np.abs(e[-500:])) < 0.01 * DEGREE


def test_super_twisting_holds_and_follows():
    law = SlidingMode(pair(), Gains.turning(switching=SUPER_TWISTING))
    _, e, _, p1, _ = on_rig(
        law, pair(), lambda t: Reference(0.1), 6.0, 0.1, lambda t: 0.3 * math.sin(2.0 * t)
    )
    late = slice(1500, None)
    assert np.max(np.abs(e[late])) < 0.1 * DEGREE
    assert np.max(np.abs(np.diff(p1[late]))) < 1e3  # it does not chatter


@pytest.mark.parametrize('observer', [True, False])
def test_the_first_commands_are_the_pressures_that_are_there(observer):
    law = SlidingMode(pair(), Gains.turning(observer=observer))
    for pressures in ((2e5, 1.5e5), (3e5, 3e5), (4.5e5, 2e5)):
        law.start(0.05, pressures)
        found = law.update(DT, Reference(0.05), 0.05)
        np.testing.assert_allclose(found, pressures, atol=300.0)
    law.start(0.05)
    found = law.update(DT, Reference(0.05), 0.05)
    assert law.model.effort(found, 0.05) == pytest.approx(law.model.gravity(0.05), abs=1e-6)


@pytest.mark.parametrize('hanging_at', [-0.8, 0.0, 0.6])
def test_an_arm_that_hangs_on_vented_muscles_stays_where_it_is(hanging_at):
    # Slack muscles hold nothing, where the bare law would let them push.
    slack = Actuator(effects={'slack': {'share': 1.0}}, contraction=0.1)
    joint = Joint((slack, slack), Arm(hanging_at=hanging_at), Pulley())
    begin = rest(joint, [0.0, 0.0])
    assert begin == pytest.approx(hanging_at, abs=0.01)
    law, rig = SlidingMode(joint, Gains.turning()), Rig([joint])
    law.start(begin, (0.0, 0.0))
    rig.reset([0.0, 0.0], [begin], [0.0])
    errors = []
    for _ in range(1000):
        rig.command(law.update(DT, Reference(begin), float(rig.position[0])))
        rig.advance(2)
        errors.append(begin - rig.position[0])
    assert np.max(np.abs(errors)) < 0.1 * DEGREE
    assert law.terms.stiffness == pytest.approx(law.terms.co_contraction, rel=1e-3)


def test_commands_stay_within_limits_of_pressure_and_rate():
    law = SlidingMode(pair(), Gains.turning(), Limits(100e3, 400e3, 1e6))
    law.start(0.0)
    rng, last = np.random.default_rng(0), law.terms.pressures
    for n in range(2000):
        goal = math.copysign(2.0, math.sin(0.01 * n))
        pressures = law.update(DT, Reference(goal), 1e-2 * rng.standard_normal())
        for now, before in zip(pressures, last, strict=True):
            assert 100e3 <= now <= 400e3
            assert abs(now - before) <= 1e6 * DT + 1e-6
        last = pressures


def test_it_does_not_wind_up_at_a_limit():
    joint = declared()
    law = SlidingMode(joint, Gains.turning(), Limits(pressure_high=350e3))
    far = law.sharing.reach[1] + 0.5

    def too_far_for_a_while(t):
        return Reference(far if 0.5 < t < 4.0 else 0.0)

    t, e, _, p1, _ = on_rig(law, joint, too_far_for_a_while, 6.0)
    stuck = (t > 2.0) & (t < 4.0)
    assert np.all(p1[stuck] == 350e3)
    # It leaves the limit at once, and is back as after a step.
    assert p1[np.searchsorted(t, 4.0) + 2] < 350e3
    assert np.max(np.abs(e[t > 5.5])) < 0.1 * DEGREE


def test_a_stiffness_out_of_reach_is_refused_and_the_last_one_holds():
    law = SlidingMode(declared(), Gains.turning())
    law.start(0.2)
    law.stiffen(20.0)
    for bad in (500.0, 0.0, -3.0, math.nan, math.inf):
        with pytest.raises(RangeError, match='co-contraction'):
            law.stiffen(bad)
    for _ in range(500):
        law.update(DT, Reference(0.2), 0.2)
    assert law.terms.co_contraction == 20.0


def test_a_stiffness_that_the_angle_does_not_leave_gives_way_and_comes_back():
    law = SlidingMode(declared(), Gains.turning())
    most = law.sharing.stiffness_range(0.0)[1]
    law.start(0.0)
    law.stiffen(most)

    def there_and_back(t):
        w, x = math.pi, math.pi * (t - 2.0)
        if t < 2.0:
            return Reference(0.0)
        return Reference(0.3 - 0.3 * math.cos(x), 0.3 * w * math.sin(x), 0.3 * w * w * math.cos(x))

    rig = Rig([law.joint])
    rig.reset(law.terms.pressures, [0.0], [0.0])
    found, errors = [], []
    for n in range(round(4.0 / DT)):
        now = there_and_back(n * DT)
        rig.command(law.update(DT, now, float(rig.position[0])))
        rig.advance(2)
        found.append(law.terms.stiffness)
        errors.append(now.position - rig.position[0])
    assert min(found[1200:]) < 0.95 * most
    assert found[-1] == pytest.approx(most, rel=0.01)
    assert np.max(np.abs(errors)) < 0.2 * DEGREE


def test_gains_and_stiffness_can_change_in_flight_without_a_jump():
    law = SlidingMode(declared(), Gains.turning())
    law.start(0.2)
    for _ in range(500):
        before = law.update(DT, Reference(0.201), 0.2)
    law.set_gains(Gains.turning(bandwidth=30.0))
    law.stiffen(35.0)
    after = law.update(DT, Reference(0.201), 0.2)
    np.testing.assert_allclose(after, before, atol=2e3)


def test_measured_velocity_is_used_where_the_gains_say_so():
    for used, expected in ((True, 0.123), (False, 0.0)):
        law = SlidingMode(declared(), Gains.turning(use_measured_velocity=used))
        law.start(0.1)
        law.update(DT, Reference(0.1), 0.1, 0.123)
        assert law.terms.velocity == pytest.approx(expected, abs=1e-9)


def test_two_runs_are_the_same_to_the_bit():
    runs = [
        close_pair(
            SlidingMode(declared(), Gains.turning()), pair_plant('friction', seed=2), sine, 1.0
        )
        for _ in range(2)
    ]
    assert runs[0].pressure.tobytes() == runs[1].pressure.tobytes()
