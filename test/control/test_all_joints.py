# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Each law of each kind of joint: stable from all of its reach to all of its reach.

``make bench ARGS=all_joints`` has more places and loads.
"""

import numpy as np
import pytest

from pam_ros.control.pid import Pid
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.rig.arrangements import ARRANGEMENTS
from support.joint_grid import BEYOND, REACHED, SLACK, nominal, visits
from support.joint_loop import close_joint

pytestmark = pytest.mark.needs_numba
LAWS = pytest.mark.parametrize('law', [Pid, SlidingMode], ids=lambda law: law.__name__)
KINDS = [kind.name for kind in ARRANGEMENTS]


def check(law, kind, load, effects, places):
    joint = nominal(kind, load, effects)
    for visit in visits(law(joint), joint, places):
        assert visit.error < REACHED[law.__name__], visit
        assert visit.farthest < BEYOND[law.__name__], visit


@LAWS
@pytest.mark.parametrize('kind', KINDS)
def test_it_reaches_all_places_from_all_places(law, kind):
    check(law, kind, 1.0, (), 2)


@LAWS
@pytest.mark.parametrize('load', [0.5, 3.0])
def test_a_crank_reaches_them_with_other_loads_and_a_muscle_that_cannot_push(law, load):
    check(law, 'crank', load, SLACK, 2)


@LAWS
def test_an_arm_that_hangs_on_a_slack_muscle_does_not_wind_it_up(law):
    """The law takes the muscle for one that pushes, and is asked to push for 7 s."""
    pushing, slack = nominal('crank'), nominal('crank', effects=SLACK)
    run = close_joint(
        law(pushing),
        slack,
        lambda t: 0.0 if t < 0.5 else -0.5 if t < 8.0 else 0.3,
        13.0,
        begin=0.0,
    )
    assert np.max(np.abs(run.error[run.last(1.0)])) < 1e-3


@pytest.mark.parametrize('kind', KINDS)
def test_the_surface_does_not_wind_up_while_something_holds_the_load(kind):
    """The switching term is at its limit long before the pressure is."""
    law = SlidingMode(nominal(kind))
    low, high = law.allocation.reach
    begin, goal = 0.5 * (low + high), 0.6 * high + 0.4 * low
    law.start(begin)
    found = []
    for _ in range(6000):
        law.update(2e-3, Reference(goal), begin)
        found.append(abs(law.terms.surface * law.terms.bandwidth))
    most = law.gains.switching_gain(law.model.inertia)
    # The velocity that the observer expected while it began is in the integral as well.
    assert max(found[3000:]) < 2.0 * most
    assert max(found[3000:]) < 1.01 * found[1000]
