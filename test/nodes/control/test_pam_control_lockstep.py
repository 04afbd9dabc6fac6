# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` of one muscle in lockstep: each run is the same to the bit.

Those of a pair are compared in ``test_closed_loop_in_lockstep.py``, next to busy programs.
"""

import pytest
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool

from support.control_watch import LOSE_NO_TERMS, QUIET, Watch, stamp
from support.harness import Peer, Program

GOAL = 0.06  # m
RIG = {
    'time_mode': 'lockstep',
    'mass': 21.0,  # more than is configured in the controller
    'initial.pressure': 300e3,
    'sensor.position_noise': 1e-5,
}
# Control begins at the pressure that is there, however late that is received.
GIVEN = {'use_sim_time': True, 'state_rate': 500.0, 'pressure_wait': 60.0, **LOSE_NO_TERMS}


def terms_of_a_step():
    """Return the terms by their stamps, of a step that is published before time continues."""
    with Peer() as peer, Program('pam_sim', parameters=RIG):
        watch, states = Watch(peer), peer.collect(JointState, 'joint_states')
        peer.more(states)
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        with Program('pam_control', parameters=GIVEN):
            peer.more(watch.commands)
            watch.refer(GOAL)
            peer.more(watch.arrays, 3)  # by then it is received
            assert peer.call(SetBool, 'pam_sim/pause', data=False).success
            peer.until(lambda: watch.terms and stamp(watch.terms[-1]) >= 3.0, '3 s')
            peer.work(QUIET)
        return {stamp(message): tuple(message.position) for message in watch.terms}


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
def test_two_runs_are_the_same_to_the_bit():
    first, other = terms_of_a_step(), terms_of_a_step()
    received = first.keys() & other.keys()
    assert len(received) > 900
    assert [first[t] for t in received] == [other[t] for t in received]
    reference, position, *_ = first[max(received)]
    assert reference == pytest.approx(GOAL, abs=1e-9)
    assert position == pytest.approx(GOAL, abs=1e-4)
