# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commands act at the step at which a plant without faults would receive them, or never."""

import numpy as np
import pytest

from pam_ros.bench.faults import Draws, Outage
from pam_ros.bench.remote_plant import RemotePlant
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.plant import Plant

PERIODS, STEPS = 60, 2  # of 2 ms, each of two steps
HELD = 300e3
RNG = np.random.default_rng(5)
COMMANDS = HELD + 20e3 * RNG.standard_normal(PERIODS)


def setup_of(**more):
    values = {'muscle': 'dmsp_20_400n', 'initial.pressure': HELD, **more}
    scene = Scene(values)
    return scene.build(checked(scene.table(), values))


def faults(lost=(), delays=0.0):
    is_lost = np.isin(np.arange(PERIODS), lost)
    return Draws(np.zeros(PERIODS, bool), is_lost, np.broadcast_to(delays, PERIODS).astype(float))


def positions(plant):
    """Return the positions in m before each command, and at the end."""
    found = []
    for k, command in enumerate(COMMANDS):
        plant.advance(k * STEPS)
        found.append(plant.position[0])
        plant.take((command,), (0,))
    plant.advance(PERIODS * STEPS)
    return np.array([*found, plant.position[0]])


def expected(arrivals):
    """Return the positions of a plain plant whose commands arrive at these *arrivals* (steps)."""
    plant, found = Plant(setup_of()), []
    for step in range(PERIODS * STEPS + 1):
        plant.advance(step)
        if step % STEPS == 0:
            found.append(plant.position[0])
        for k in np.flatnonzero(np.asarray(arrivals) == step):
            plant.take((COMMANDS[k],), (0,))
    return np.array(found)


SENT = STEPS * np.arange(PERIODS)
JITTER = RNG.integers(0, 9, PERIODS)  # ms, one step each


def without(arrivals, *steps):
    """Return *arrivals* in which those at *steps* never come."""
    return np.where(np.isin(arrivals, steps), -1, arrivals)


@pytest.mark.parametrize(
    ('given', 'outages', 'arrivals'),
    [
        (faults(), (), SENT),
        (faults(delays=0.007), (), SENT + 7),
        (faults(delays=1e-3 * JITTER), (), np.maximum.accumulate(SENT + JITTER)),
        (faults(lost=(3, 4, 20)), (), without(SENT, 6, 8, 40)),
        (
            faults(delays=0.007),
            (Outage('freeze', 0.03, 0.02), Outage('freeze', 0.0705, 0.01)),
            without(SENT + 7, *range(30, 50), *range(71, 81)),
        ),
    ],
    ids=['none', 'delay', 'jitter', 'lost', 'freeze'],
)
def test_commands_that_are_lost_or_delayed(given, outages, arrivals):
    plant = RemotePlant(setup_of(), given, outages)
    np.testing.assert_array_equal(positions(plant), expected(arrivals))
    plant.begin()
    np.testing.assert_array_equal(positions(plant), expected(arrivals))


def pressure_at(plant, seconds):
    for step in range(plant.step, round(1000 * seconds) + 1):
        plant.advance(step)
    return plant.read().pressure[0]


@pytest.mark.parametrize('kind', ['freeze', 'restart', 'stop'])
def test_valves_during_an_outage_and_after_it(kind):
    """They vent at 300 kPa in 2 s from 0.5 s on, or keep their pressure without a time-out."""
    end = () if kind == 'stop' else (1.5,)
    plant = RemotePlant(setup_of(vent_time=2.0), faults(), (Outage(kind, 0.5, *end),))
    plant.take((HELD,), (0,))
    assert pressure_at(plant, 0.499) == HELD
    left = HELD if kind == 'freeze' else 0.4 * HELD
    assert pressure_at(plant, 1.7) == pytest.approx(left, rel=2e-3)
    plant.take((200e3,), (0,))
    assert plant.is_out
    assert pressure_at(plant, 1.9) == pytest.approx(left - (kind != 'freeze') * 30e3, rel=2e-3)
    pressure_at(plant, 2.1)
    assert plant.is_out is (kind == 'stop')
    plant.take((200e3,), (0,))
    assert pressure_at(plant, 2.2) == (pytest.approx(45e3, rel=2e-3) if plant.is_out else 200e3)
    if kind == 'freeze':  # the time-out of the valve counts from the last command
        assert pressure_at(plant, 3.05) == 200e3
        assert pressure_at(plant, 3.3) < 200e3
