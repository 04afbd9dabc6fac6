# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` says when a muscle contracts further than its maker permits."""

import re

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.harness import Program

LENGTH = 0.4  # m, l0 of the muscle that is simulated by default
BEYOND = 'more than the 25.0 % that it permits (kappa_max)'


@pytest.mark.at_any_pace
def test_each_contraction_beyond_the_permitted_one_is_reported_once(peer):
    arrays = peer.collect(DiagnosticArray, '/diagnostics')
    states = peer.collect(JointState, 'joint_states')

    def becomes(level):
        def find():
            last = [s for one in arrays[-1:] for s in one.status if 'contraction' in s.name]
            return [s for s in last if s.level == level]

        return peer.until(find, f'a contraction of level {level!r}')[0]

    rig = {'mass': 1.0, 'command_timeout': 0.0, 'initial.pressure': 200e3}
    with Program('pam_sim', parameters=rig) as sim:
        assert becomes(DiagnosticStatus.OK).message == 'within kappa_max'
        for count in (1, 2):
            peer.publish(Float64(data=600e3), 'pressure_command')
            status = becomes(DiagnosticStatus.WARN)
            assert status.message.startswith('muscle pam contracts by ')
            assert BEYOND in status.message
            peer.more(arrays, 3)
            assert sim.output.count(BEYOND) == count
            peer.publish(Float64(data=100e3), 'pressure_command')
            becomes(DiagnosticStatus.OK)
        values = {pair.key: pair.value for pair in becomes(DiagnosticStatus.OK).values}
        assert values['times beyond kappa_max'] == '2'
    largest = 100.0 * max(one.position[0] for one in states) / LENGTH
    reported = float(re.search(r'contracts by ([0-9.]+) %', status.message)[1])
    assert reported == pytest.approx(largest, abs=0.5)
