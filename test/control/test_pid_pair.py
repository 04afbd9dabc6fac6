# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The PID baseline on joints that turn: at rest where it shall, with the stiffness that is set."""

import math

import numpy as np
import pytest

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.limits import Limits
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError
from pam_ros.rig import statics
from pam_ros.rig.joint import one_muscle
from support.joint_loop import JOINTS, close_joint
from support.pair_loop import close_pair, declared
from truth.pair import pair_plant

pytest.importorskip('simple_pid', reason='the PID law needs simple-pid')
DT = 2e-3
DEGREE = math.radians(1.0)


def sine(t):
    return 15.0 * DEGREE * math.sin(math.pi * t)


def test_a_joint_that_turns_has_gains_of_its_own():
    assert PidGains.for_joint(declared()) == PidGains.turning() == Pid(declared()).gains
    assert PidGains.for_joint(one_muscle()) == PidGains()
    assert PidGains.turning(integral=0.0).integral == 0.0


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('plant', ['nominal', 'payload and friction', 'lag', 'hysteresis', 'all'])
def test_a_pair_reaches_a_step_and_rests(plant):
    run = close_pair(
        Pid(declared()), pair_plant(plant, seed=4), lambda t: 0.2 if t > 0.5 else 0.0, 8.0
    )
    assert np.all(np.isfinite(run.pressure))
    end = run.last(1.0)
    assert np.max(np.abs(run.error[end])) < 0.03 * DEGREE
    assert np.max(np.ptp(run.pressure[:, end], axis=1)) < 4e3  # of noise of 400 Pa
    # The static part sets the stiffness, and the law does not change it.
    assert run.stiffness[-1] == pytest.approx(run.wanted[-1], rel=0.01)


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(('plant', 'most'), [('nominal', 0.25), ('payload', 0.3), ('all', 2.5)])
def test_a_pair_follows_a_sine(plant, most):
    run = close_pair(Pid(declared()), pair_plant(plant, seed=4), sine, 8.0)
    assert np.sqrt(np.mean(run.error[run.last(4.0)] ** 2)) < most * DEGREE


@pytest.mark.needs_numba
@pytest.mark.parametrize('goal', [-1.0, -0.6, 0.8])
def test_a_lever_rests_where_it_shall_also_where_a_muscle_is_at_its_limit(goal):
    joint = JOINTS['lever']
    heavy = type(joint)(
        joint.actuators, joint.load, joint.transmission, {'payload': {'mass': 0.2}}
    )
    law = Pid(joint)
    run = close_joint(law, heavy, lambda t: goal if t > 0.5 else 0.0, 6.0, begin=0.0)
    assert np.all(np.isfinite(run.pressure))
    assert np.max(np.abs(run.error[run.last(1.0)])) < 0.01 * DEGREE


def test_the_stiffness_is_set_and_one_out_of_reach_refused():
    law = Pid(declared(), co_contraction=CoContraction(20.0))
    for wanted in (20.0, 35.0):
        if wanted != 20.0:
            law.stiffen(wanted)
        law.start(0.1)
        pressures = law.update(DT, Reference(0.1), 0.1)
        assert statics.stiffness(declared(), pressures, 0.1) == pytest.approx(wanted)
        assert law.terms.co_contraction == wanted
    with pytest.raises(RangeError, match='co-contraction 90 N m/rad'):
        law.stiffen(90.0)


def test_what_one_muscle_gets_the_other_loses():
    law = Pid(declared())
    law.start(0.1)
    before = law.update(DT, Reference(0.1), 0.1)
    for _ in range(20):
        after = law.update(DT, Reference(0.1), 0.09)
    one, two = (b - a for a, b in zip(before, after, strict=True))
    assert one > 1e3
    assert two == pytest.approx(-one)


def test_it_starts_at_the_pressures_that_are_there():
    law = Pid(declared())
    law.start(0.1, (3e5, 1.5e5))
    found = law.update(DT, Reference(0.1), 0.1)
    # The static part has the stiffness that is set; what moves the arm is as it was.
    torque = [law.model.effort(p, 0.1) for p in (found, (3e5, 1.5e5))]
    assert torque[0] == pytest.approx(torque[1], rel=0.05)


def test_it_does_not_wind_up_at_a_limit():
    law = Pid(declared(), limits=Limits(pressure_high=3e5))
    law.start(0.0)
    for _ in range(2000):  # the arm is held by something
        pressures = law.update(DT, Reference(0.3), 0.0)
    assert pressures[0] == 3e5
    assert law.terms.saturated
    freed = [law.update(DT, Reference(0.0), 0.02)[0] for _ in range(100)]
    assert min(freed) < 2.5e5
