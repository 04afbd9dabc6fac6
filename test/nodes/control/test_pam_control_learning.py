# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` shows in its diagnostics what it has learned from the motion."""

import pytest

from support.control_watch import Watch, sine
from support.harness import Program, lose_nothing

FRICTION = 15.0  # N, not configured in the controller


@pytest.mark.at_any_pace
def test_friction_of_the_rig_appears_in_the_diagnostics(peer):
    watch = Watch(peer)
    rig = {
        'initial.pressure': 300e3,
        'time_mode': 'lockstep',
        'effects.coulomb_friction.level': FRICTION,
        **lose_nothing(),
    }
    with (
        Program('pam_sim', parameters=rig),
        Program('pam_control', parameters={'use_sim_time': True}),
    ):
        begin = watch.begin()
        what = 'has learned nothing: the load has not moved yet'
        watch.status(lambda s: s.message == what, 'the diagnostics', 'learning')
        wave = sine(begin, 0.01, end=10.0)
        watch.lead(lambda: peer.publish(wave, 'joint_trajectory'), 10.0)
        peer.more(watch.arrays, 2)
        what = 'compensates what was learned'
        status = watch.status(lambda s: s.message == what, what, 'learning')
        values = {value.key: value.value for value in status.values}
        assert float(values['friction and hysteresis (N)']) == pytest.approx(FRICTION, abs=4.0)
        assert float(values['time of motion (s)']) > 2.0
        assert float(values['weight']) > 0.5
