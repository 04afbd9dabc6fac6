# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated rig without ROS: its motion by other equations, its valves, its sensors."""

import math

import numpy as np
import pytest

from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.plant import Plant
from support.paper import moved, spring

RELEASED = {'initial.pressure': 600e3, 'initial.at_rest': False, 'initial.position': 0.0}
STATE = ('position', 'velocity', 'pressure', 'force', 'stiffness', 'damping')


def simulation(given):
    scene = Scene(given)
    return scene.build(checked(scene.table(), given))


def plant(**given):
    return Plant(simulation({name.replace('__', '.'): value for name, value in given.items()}))


def pressures(rig):
    return rig.read().pressure


def row(rig):
    """Return position, velocity, pressure, force, stiffness and damping of one muscle."""
    reading = rig.read()
    return tuple(getattr(reading, name)[0] for name in STATE)


def readings(rig, steps, stride=2):
    """Step a rig of one muscle; return rows of position ... damping."""
    rows = [row(rig)]
    for step in range(stride, steps + 1, stride):
        rig.advance(step)
        rows.append(row(rig))
    return np.array(rows).T


# The integrator is of fourth order: four times the rate, 256 times the accuracy.
@pytest.mark.parametrize(('rate', 'tolerance'), [(1000.0, 2e-9), (4000.0, 1e-11)])
def test_a_released_load_moves_as_in_the_adaptive_solver(rate, tolerance):
    rig = Plant(simulation({**RELEASED, 'physics_rate': rate}))
    y, v, p, force, stiffness, _ = readings(rig, round(3 * rate))
    expected = moved(600e3, 0.0, 0.0, np.arange(y.size) * 2.0 / rate)
    assert np.max(np.abs(y - expected[0])) < tolerance
    assert np.max(np.abs(v - expected[1])) < 100.0 * tolerance
    assert np.ptp(y) > 0.05  # it did move
    f, k = np.array([spring(600e3, position) for position in y]).T
    np.testing.assert_allclose(force, f, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(stiffness, k, rtol=1e-10)
    assert set(p) == {600e3}


def test_a_command_acts_from_its_step_on():
    rig = plant(initial__pressure=200e3)
    start = row(rig)[0]
    rig.advance(100)
    rig.take([400e3], [0])
    assert row(rig)[0] == pytest.approx(start, abs=1e-12)
    rig.advance(400)
    y, v, p, *_ = row(rig)
    expected = moved(400e3, start, 0.0, np.array([0.0, 0.3]))[:, -1]
    assert (y, v) == pytest.approx(tuple(expected), abs=2e-9)
    assert p == 400e3


def test_the_effort_of_a_joint_of_one_muscle_is_its_force():
    rig = Plant(simulation(RELEASED))
    rig.advance(200)
    reading = rig.read()
    assert reading.effort[0] == reading.force[0] != 0.0


# Valves ------------------------------------------------------------------------------------------


@pytest.mark.parametrize('is_array', [False, True])
@pytest.mark.parametrize(
    ('value', 'applied', 'is_refused', 'word'),
    [
        (math.nan, 300e3, True, 'nan is not finite'),
        (math.inf, 300e3, True, 'inf is not finite'),
        (-math.inf, 300e3, True, '-inf is not finite'),
        (-5.0, 0.0, False, '-5 Pa is outside 0 to 600000'),
        (601e3, 600e3, False, '601000 Pa is outside 0 to 600000'),
    ],
)
def test_a_bad_command_is_clamped_or_refused_and_named(is_array, value, applied, is_refused, word):
    rig = plant(muscles=['left', 'right'], command_timeout=0.0)

    def tell(number):
        return rig.take([100e3, number], [0, 1]) if is_array else rig.take([number], [1])

    assert rig.take([100e3], [0]) is None
    assert tell(300e3) is None
    bad = tell(value)
    assert (bad.muscle, bad.is_refused) == (1, is_refused)
    assert bad.reason.startswith('right: ')
    assert word in bad.reason
    rig.advance(2)
    assert pressures(rig) == [100e3, applied]


@pytest.mark.parametrize(('on_timeout', 'left'), [('vent', 0.0), ('hold', 400e3)])
def test_a_timeout_vents_or_holds_its_muscle_alone_and_a_new_command_is_followed(on_timeout, left):
    rig = plant(muscles=['a', 'b'], command_timeout=0.3, on_timeout=on_timeout, vent_time=0.0)
    rig.take([400e3, 300e3], range(len(rig.inputs)))
    for step in range(50, 1000, 50):
        rig.take([300e3], [1])
        rig.advance(step)
        is_late = rig.time > 0.3 + 1e-9
        assert rig.has_timed_out == [is_late, False]
        rig.advance(step + 1)
        assert pressures(rig) == [left if is_late else 400e3, 300e3]
    rig.take([200e3], [0])
    rig.advance(1000)
    assert rig.has_timed_out == [False, False]
    assert rig.timeouts == 1
    assert pressures(rig) == [200e3, 300e3]


@pytest.mark.parametrize('stride', [1, 20, 500])
@pytest.mark.parametrize('physics_rate', [500.0, 1000.0, 4000.0])
def test_a_muscle_without_commands_vents_at_the_same_rate_however_often_it_is_read(
    physics_rate, stride
):
    rig = plant(physics_rate=physics_rate, publish_rate=1.0, command_timeout=0.5, vent_time=1.0)
    rig.take([400e3], [0])
    seconds = np.arange(1, round(2.0 * physics_rate) + 1) / physics_rate
    found = []
    for step in range(stride, seconds.size + 1, stride):
        rig.advance(step)
        found += pressures(rig)
    began = next(k for k, p in enumerate(found) if p < 400e3) * stride / physics_rate
    # A silence is found when the muscle is read.
    assert 0.5 <= began <= 0.5 + max(stride, 2) / physics_rate
    expected = 400e3 * np.clip(1.0 - (seconds[stride - 1 :: stride] - began), 0.0, 1.0)
    assert np.max(np.abs(found - expected)) < 400e3 * max(1e-3, 1.0 / physics_rate) * 1.01


@pytest.mark.parametrize(
    ('given', 'pressure'),
    [
        ({}, 300e3),
        ({}, 500e3),
        ({'mass': 5.0}, 500e3),
        ({'mass': 40.0}, 500e3),
        ({'joint': 'antagonistic'}, (600e3, 150e3)),
        ({'joint': 'lever'}, (400e3, 100e3)),
        ({'joint': 'crank'}, 300e3),
        ({'joint': 'parallel'}, 500e3),
    ],
)
def test_no_load_is_dropped_when_commands_stop(given, pressure):
    def fastest(**more):
        rig = Plant(simulation({**given, **more}))
        pressures = np.broadcast_to(pressure, len(rig.inputs)).tolist()
        speeds = []
        for step in range(100, 16_000, 4):
            if step <= 12_000:  # until it rests
                rig.take(pressures, range(len(rig.inputs)))
            rig.advance(step)
            speeds.append(abs(rig.read().velocity[0]))
        return max(speeds[-1000:])

    turns = given.get('joint') in ('antagonistic', 'lever', 'crank')
    limit = 2.5 if turns else 0.15  # rad/s or m/s; bounds of a reference are 2 and 0.1
    assert fastest() < limit
    assert fastest(vent_time=0.0) > 3.0 * limit


def test_a_bad_command_does_not_reset_the_timeout():
    rig = plant(command_timeout=0.3, vent_time=0.0)
    rig.take([400e3], [0])
    for step in range(10, 401, 10):
        rig.take([math.nan], [0])
        rig.advance(step)
    assert rig.has_timed_out == [True]
    assert pressures(rig) == [0.0]


def test_the_initial_pressure_stands_until_a_first_command():
    rig = plant(initial__pressure=250e3, command_timeout=0.05)
    assert set(readings(rig, 2000, 100)[2]) == {250e3}


def test_a_lower_limit_lowers_the_pressure_in_force():
    given = {'command_timeout': 0.0}
    rig = Plant(simulation(given))
    rig.take([500e3], [0])
    rig.advance(100)
    rig.change(simulation({**given, 'p_max': 450e3}))
    rig.advance(102)
    assert pressures(rig) == [450e3]


def test_other_parameters_act_from_the_present_state():
    rig = plant(mass=20.0)
    rig.advance(100)
    rig.change(simulation({'mass': 12.5}))
    rig.advance(20_000)
    assert row(rig)[3] == pytest.approx(12.5 * 9.80665, abs=1e-6)


def test_a_lost_load_is_no_reading():
    # No muscle holds that.
    rig = plant(initial__at_rest=False, initial__velocity=-100.0)
    rig.read()
    rig.advance(1000)
    with pytest.raises(ArithmeticError, match='pam is out of its reach, contracted by '):
        rig.read()
    rig.begin()
    rig.read()


# Sensors -----------------------------------------------------------------------------------------


def test_noise_and_offset_are_those_that_are_set():
    rig = plant(
        initial__pressure=250e3,
        sensor__position_offset=0.01,
        sensor__position_noise=20e-6,
        sensor__pressure_noise=500.0,
    )
    y, _, p, *_ = readings(rig, 2000, 1)
    rest = row(plant(initial__pressure=250e3))[0]
    assert np.std(y) == pytest.approx(20e-6, rel=0.1)  # 6 standard errors
    assert np.mean(y) == pytest.approx(rest + 0.01, abs=3e-6)
    assert np.std(p) == pytest.approx(500.0, rel=0.1)
    assert np.mean(p) == pytest.approx(250e3, abs=70.0)


def test_from_the_start_it_runs_again_to_the_bit():
    rig = Plant(simulation({**RELEASED, 'sensor.force_noise': 3.0, 'sensor.seed': 7}))
    first = readings(rig, 300)
    rig.begin()
    assert readings(rig, 300).tobytes() == first.tobytes()
    assert np.std(np.diff(first[3] - first[3].mean())) > 1.0
