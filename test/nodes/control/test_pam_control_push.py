# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A load that is pushed while ``pam_control`` holds it, over topics, in lockstep."""

import numpy as np
import pytest
from sensor_msgs.msg import JointState

from support.control_watch import LOSE_NO_TERMS, Watch, stamp
from support.harness import Peer, Program, lose_nothing

# An 8 N sine of 1 Hz that is not configured: it moves the load by 1.3 mm at a held pressure.
RIG = {
    'time_mode': 'lockstep',
    'mass': 20.0,
    'initial.pressure': 300e3,
    'sensor.position_noise': 2e-5,
    'effects.periodic_disturbance.force_sin': 8.0,
    'effects.periodic_disturbance.frequency': 1.0,
    **lose_nothing(),
}
GIVEN = {'use_sim_time': True, 'pressure_wait': 60.0, **LOSE_NO_TERMS}
SECONDS = 7.0


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
def test_a_load_is_held_against_a_push():
    with Peer() as peer, Program('pam_sim', parameters=RIG):
        watch, states = Watch(peer), peer.collect(JointState, 'joint_states')
        with Program('pam_control', parameters=GIVEN):
            peer.until(lambda: watch.terms and stamp(watch.terms[-1]) >= SECONDS, 'the push')
            peer.until(lambda: stamp(states[-1]) >= SECONDS, 'the states')
    late = [s.position[0] for s in states if SECONDS - 2.0 < stamp(s) <= SECONDS]
    # The range of the noise itself is some seven of its standard deviations.
    assert 0.5 * (np.ptp(late) - 7.0 * 2e-5) < 0.15e-3
    terms = watch.terms[-1]
    assert terms.position[terms.name.index('rejection')] > 0.5
