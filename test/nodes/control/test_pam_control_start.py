# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How ``pam_control`` begins: at the pressure that is there, whatever the load is."""

import numpy as np
import pytest
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

from pam_ros.control.signals import TERMS
from support.harness import Program, lose_nothing

PRESSURE, AMBIENT = 300e3, 101325.0
HEAVY = {'mass': 25.0, 'initial.pressure': PRESSURE, **lose_nothing()}  # 20 kg are configured
LOCKSTEP = {**HEAVY, 'time_mode': 'lockstep'}
FOLLOWING = {'use_sim_time': True, 'state_rate': 500.0, 'pressure_wait': 60.0}
ENABLE = 'pam_control/enable'


def term(message, name):
    return message.position[TERMS.index(name)]


def states_of(position, stamp):
    """Return a joint state and the pressure as a rig publishes them, *stamp* in s."""
    state = JointState(name=['pam'], position=[position])
    pressure = FluidPressure(fluid_pressure=AMBIENT + 250e3)
    for message in (state, pressure):
        message.header.stamp.sec = stamp
    return state, pressure


@pytest.mark.parametrize(
    'mode', [pytest.param('lockstep', marks=pytest.mark.at_any_pace), 'real_time']
)
def test_a_load_that_nobody_configured_stays_where_it_is(peer, mode):
    states = peer.collect(JointState, 'joint_states')
    terms = peer.collect(JointState, 'pam_control/state')
    # However long a busy machine holds them up.
    given = {**FOLLOWING, 'use_sim_time': mode == 'lockstep', 'state_timeout': 60.0}
    rig = {**HEAVY, 'time_mode': mode, 'command_timeout': 0.0}
    with Program('pam_sim', parameters=rig):
        peer.more(states)
        with Program('pam_control', parameters=given):
            peer.more(terms, 500)
    positions = np.array([message.position[0] for message in states])
    assert np.ptp(positions) < 1e-6  # m; the controller's own guess would move it by 8 mm
    assert term(terms[0], 'pressure') == pytest.approx(PRESSURE, rel=1e-6)


@pytest.mark.at_any_pace
def test_it_does_not_wait_for_ever_for_a_pressure_that_nobody_tells(peer):
    commands = peer.collect(Float64, 'pressure_command')
    with Program('pam_control', parameters={'pressure_wait': 0.2}):
        count = 0

        def commanded():
            nonlocal count
            count += 1
            peer.publish(states_of(0.06, 10 + count)[0], 'joint_states')
            return commands

        assert peer.until(commanded, 'a command')


# The command to a regulator with a known offset is reduced by it.
@pytest.mark.at_any_pace
@pytest.mark.parametrize('offset', [0.0, 10e3])
def test_it_waits_for_the_pressure_and_begins_there(peer, offset):
    commands = peer.collect(Float64, 'pressure_command')
    given = {'pressure_wait': 60.0, 'effects.pressure_offset.offset': offset}
    with Program('pam_control', parameters=given):
        count = 0

        def tell(with_pressure):
            nonlocal count
            count += 1
            state, pressure = states_of(0.06, 10 + count)
            peer.publish(state, 'joint_states')
            if with_pressure:
                peer.publish(pressure, 'pressure')

        for _ in range(20):
            tell(with_pressure=False)
            peer.work(0.02)
        assert not commands
        peer.until(lambda: tell(with_pressure=True) or commands, 'a command')
    assert commands[0].data == pytest.approx(250e3 - offset, rel=1e-6)


@pytest.mark.at_any_pace
def test_in_lockstep_it_is_enabled_at_the_state_that_waits(peer):
    states = peer.collect(JointState, 'joint_states')
    terms = peer.collect(JointState, 'pam_control/state')
    given = {**FOLLOWING, 'start_enabled': False}
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=given):
        peer.more(states)
        assert peer.call(SetBool, ENABLE, data=True).success
        peer.more(terms, 100)
        # And again after others, who have had it, have left.
        assert peer.call(SetBool, ENABLE, data=False).success
        assert peer.call(SetBool, ENABLE, data=True).success
        peer.more(terms, 500)
        positions = np.array([message.position[0] for message in states])
        assert np.ptp(positions) < 1e-6
