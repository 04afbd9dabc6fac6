# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The PID baseline: the same interface, no windup, no bump, the stiffness that is set."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.limits import Limits
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.signals import Reference
from pam_ros.effects import Payload
from pam_ros.errors import RangeError
from pam_ros.rig import statics
from pam_ros.rig.standard_joints import single_muscle_joint
from support.joint_loop import JOINTS, close_joint
from support.kinds import EACH_KIND, ONE, PAIR, at_end, rms

DT = 2e-3


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('kind', 'plant', 'error', 'swing'),
    [
        (ONE, 'nominal', 0.01, 3e3),
        # Of noise of 400 Pa.
        *(
            (PAIR, plant, 0.03, 4e3)
            for plant in ('nominal', 'payload and friction', 'lag', 'hysteresis', 'all')
        ),
    ],
    ids=str,
)
def test_a_step_is_reached_and_then_it_rests(kind, plant, error, swing):
    """Errors in mm or degrees, swings of the pressure in Pa, over the last second."""
    seconds = 4.0 if kind is ONE else 8.0
    run = kind.close(Pid(kind.nominal()), kind.truth(plant, seed=4), kind.step, seconds)
    assert np.all(np.isfinite(run.pressure))
    found = at_end(kind, run, 1.0)
    assert found[0] < error
    assert found[1] < swing
    if kind is ONE:
        settled = np.abs(run.error) < 0.02 * 0.02
        assert np.all(settled[run.t > 1.0 + 0.6])  # of a step that takes 0.4 s
    else:
        # The static part sets the stiffness, and the law does not change it.
        assert run.stiffness[-1] == pytest.approx(run.wanted[-1], rel=0.01)


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(('plant', 'most'), [('nominal', 0.25), ('payload', 0.3), ('all', 2.5)])
def test_a_pair_follows_a_sine(plant, most):
    run = PAIR.close(Pid(PAIR.nominal()), PAIR.truth(plant, seed=4), PAIR.swing, 8.0)
    assert rms(PAIR, run) < most


@pytest.mark.needs_numba
@pytest.mark.parametrize('goal', [-1.0, -0.6, 0.8])
def test_a_lever_rests_where_it_shall_also_where_a_muscle_is_at_its_limit(goal):
    joint = JOINTS['lever']
    heavy = replace(joint, effects=[Payload(mass=0.2)])
    run = close_joint(Pid(joint), heavy, lambda t: goal if t > 0.5 else 0.0, 6.0, begin=0.0)
    assert np.all(np.isfinite(run.pressure))
    assert np.max(np.abs(run.error[run.last(1.0)])) < 0.01 * PAIR.unit


def test_the_stiffness_is_set_and_one_out_of_reach_refused():
    law = Pid(PAIR.nominal(), co_contraction=CoContraction(20.0))
    for wanted in (20.0, 35.0):
        if wanted != 20.0:
            law.stiffen(wanted)
        law.start(0.1)
        pressures = law.update(DT, Reference(0.1), 0.1)
        assert statics.stiffness(PAIR.nominal(), pressures, 0.1) == pytest.approx(wanted)
        assert law.terms.co_contraction == wanted
    with pytest.raises(RangeError, match='co-contraction 90 N m/rad'):
        law.stiffen(90.0)


def test_what_one_muscle_gets_the_other_loses():
    law = Pid(PAIR.nominal())
    law.start(0.1)
    before = law.update(DT, Reference(0.1), 0.1)
    for _ in range(20):
        after = law.update(DT, Reference(0.1), 0.09)
    one, two = (b - a for a, b in zip(before, after, strict=True))
    assert one > 1e3
    assert two == pytest.approx(-one)


def test_its_pressure_is_that_of_the_parallel_form_with_a_filtered_error():
    gains = PidGains(bounded=False)
    law = Pid(single_muscle_joint(), gains)
    law.start(0.06)
    (static,) = law.terms.pressures
    random = np.random.default_rng(1)
    positions = 0.06 + 2e-5 * np.cumsum(random.normal(size=200))
    found = np.array([law.update(DT, Reference(0.06), p)[0] for p in positions])
    pole = np.exp(-gains.filter_bandwidth * DT)
    error = 0.06 - positions
    for _ in range(2):
        error = lfilter([1.0 - pole], [1.0, -pole], error)
    rate = np.diff(error, prepend=error[0]) / DT
    expected = gains.proportional * error + gains.derivative * rate
    expected += static + gains.integral * DT * np.cumsum(error)
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    assert np.ptp(found) > 500.0


def test_it_starts_at_the_pressures_that_are_there():
    law = Pid(single_muscle_joint())
    law.start(0.0644, (310e3,))
    assert law.update(DT, Reference(0.0644), 0.0644) == pytest.approx((310e3,))
    law.start(0.0644)
    (held,) = law.update(DT, Reference(0.0644), 0.0644)
    weight = 20 * 9.80665
    assert held == pytest.approx(
        single_muscle_joint().muscle.pressure_for_force(weight, 0.161), rel=1e-6
    )
    law = Pid(PAIR.nominal())
    law.start(0.1, (3e5, 1.5e5))
    found = law.update(DT, Reference(0.1), 0.1)
    # The static part has the stiffness that is set; what moves the arm is as it was.
    torque = [law.model.effort(p, 0.1) for p in (found, (3e5, 1.5e5))]
    assert torque[0] == pytest.approx(torque[1], rel=0.05)


@EACH_KIND
def test_it_does_not_wind_up_at_a_limit(kind):
    limit, begin, goal, back = {
        ONE: (320e3, 0.06, 0.07, 0.0605),
        PAIR: (300e3, 0.0, 0.3, 0.02),
    }[kind]
    law = Pid(kind.nominal(), limits=Limits(pressure_high=limit))
    law.start(begin)
    for _ in range(2000):  # the load is held by something
        pressures = law.update(DT, Reference(goal), begin)
    assert pressures[0] == limit
    assert law.terms.saturated
    freed = [law.update(DT, Reference(begin), back)[0] for _ in range(100)]
    assert min(freed) < limit - (20e3 if kind is ONE else 50e3)
