# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The replay of the closed loop: three rigs on one clock, and their errors."""

import numpy as np
import pytest

from pam_ros.demo import loop
from pam_ros.demo.loop import Replay, read_replay
from pam_ros.errors import PamError
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.rig import RigParameters
from support.bags import FLOAT, JOINT, joint, ns, number, write_bag


@pytest.fixture
def replay():
    t = np.arange(5000) / 250.0
    measured = 0.05 + 0.02 * np.sin(t)
    wave = np.where(np.arange(t.size) % 2, 1.0, -1.0)
    return Replay(t, measured, measured - 3e-3 * wave, measured - 1e-4 * wave)


def write_replays(folder, *, first=0, other=0.0):
    """Write three bags of rigs that start at 1 s; all show y = t after their first state.

    The commands before number *first* are missing in the second bag; *other* is added to the last
    command of the third.
    """
    for name, start, rate in (('rig', 1.0, 200), ('nominal', 1.0, 250), ('identified', 3.0, 125)):
        stamps = start + np.arange(round(10 * rate)) / rate
        states = [(ns(s), joint(ns(s), [s - start], [0.0], [0.0])) for s in stamps]
        sent = [(ns(start + 0.1 * k), number(k)) for k in range(99)]
        if name == 'nominal':
            sent = sent[first:]
        if name == 'identified':
            sent[-1] = (sent[-1][0], number(98 + other))
        topics = {'/a/pressure_command': (FLOAT, sent), '/a/rig/joint_states': (JOINT, states)}
        write_bag(folder / name, topics)
    return [folder / name for name in ('rig', 'nominal', 'identified')]


@pytest.mark.parametrize('first', [0, 5])
def test_three_rigs_are_compared_from_their_first_states_on(tmp_path, first):
    """Each starts at a time of its own, at a rate of its own; a recorder may have begun late."""
    found = read_replay(*write_replays(tmp_path, first=first))
    assert found.t[0] == 0.0
    assert found.t[-1] == pytest.approx(10.0, abs=0.01)
    for y in (found.measured, found.nominal, found.identified):
        assert y == pytest.approx(found.t, abs=1e-6)


def test_rigs_that_received_different_commands_are_not_compared(tmp_path):
    with pytest.raises(PamError, match='identified received different commands'):
        read_replay(*write_replays(tmp_path, other=1.0))


def test_sizes_are_those_of_the_two_models(replay):
    assert replay.size(0).rmse == pytest.approx(3e-3)
    assert replay.size(2).rmse == pytest.approx(1e-4)
    assert replay.size(2).maximum == pytest.approx(1e-4)


def test_table_has_errors_and_the_hidden_next_to_the_identified_values(replay):
    level = {'value': 11.9, 'low': 11.7, 'high': 12.2, 'unit': 'N', 'at_bound': False}
    report = {
        'verdict': 'effect_found',
        'parameters': {'augmented': {'effects.coulomb_friction.level': level}},
    }
    rows = {line.split('  ')[0]: line.split() for line in loop.table(replay, report).splitlines()}
    assert rows['nominal'][1:3] == ['3.00', '3.00']
    assert rows['identified'][1:3] == ['0.100', '0.100']
    friction = rows['coulomb_friction.level [N]']
    assert friction[2:] == ['12', '11.9', '11.7', 'to', '12.2']
    assert rows['pressure_lag.fill'] == ['pressure_lag.fill', '0.04']
    assert rows['effect_found: the RMS error fell to 1/30']


def test_figure_shows_the_rig_and_both_models(replay):
    above, below, alone = loop.figure(replay).axes
    assert len(above.lines) == 3
    assert below.lines[0].get_ydata().max() == pytest.approx(3.0)
    assert alone.lines[0].get_ydata().max() == pytest.approx(0.1)


def test_what_is_hidden_makes_a_rig_that_is_not_the_nominal_one():
    nominal = nominal_joint(loop.MUSCLE)
    given = {k: v for k, v in {**nominal.flat(), **loop.HIDDEN}.items() if k != 'muscle'}
    (rig,) = RigParameters({}).build_joints(given)
    assert {effect.name for effect in rig.all_present} == {'coulomb_friction', 'pressure_lag'}
    assert not nominal.joint.all_present
    assert rig.muscle.a5 != nominal.joint.muscle.a5
