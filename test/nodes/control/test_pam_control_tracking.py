# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` says when it does not reach what it is asked for."""

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Float64MultiArray

from pam_ros.control.signals import term_names
from support.control_watch import Watch
from support.harness import Program, lose_nothing

LASTS = 'does not shrink: check the configured joint, load and muscle against the rig'


@pytest.mark.at_any_pace
def test_a_controller_of_another_kind_of_joint_reports_that_it_does_not_control(peer):
    watch = Watch(peer, term_names(2), Float64MultiArray, 'pressure_commands')
    with (
        Program('pam_sim', parameters={'joint': 'parallel', 'command_timeout': 0.0}),
        Program(
            'pam_control', parameters={'joint': 'antagonistic', 'state_timeout': 60.0}
        ) as control,
    ):
        status = watch.status(lambda s: LASTS in s.message, 'the warning')
        assert status.level == DiagnosticStatus.WARN
        peer.more(watch.arrays, 4)
        last = [s for one in watch.arrays[-2:] for s in one.status if s.name.endswith(' control')]
        assert all(LASTS in status.message for status in last)
        assert control.output.count(LASTS) == 1


@pytest.mark.at_any_pace
def test_large_steps_of_a_configured_joint_are_no_fault(peer):
    watch = Watch(peer)
    rig = {'initial.pressure': 300e3, 'time_mode': 'lockstep', **lose_nothing()}
    shape = {'shape.max_velocity': 1.0}
    with (
        Program('pam_sim', parameters=rig),
        Program('pam_control', parameters={'use_sim_time': True, **shape}) as control,
    ):
        watch.begin()
        for target in (0.02, 0.08, 0.02):
            watch.lead(lambda target=target: watch.refer(target), 4.0)
        assert watch.latest('position') == pytest.approx(0.02, abs=1e-3)
        peer.more(watch.arrays, 2)
        assert {
            s.message for one in watch.arrays for s in one.status if s.name.endswith(' control')
        } <= {'controlling', 'waits for joint_states', 'waits for a measured pressure'}
        assert LASTS not in control.output
