# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The PID baseline: the same interface, no windup, no bump."""

import numpy as np
import pytest

from pam_ros.control.limits import Limits
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.signals import Reference
from pam_ros.rig.joint import one_muscle
from support.closed_loop import close_loop, declared, step_target, truth

pytest.importorskip('simple_pid', reason='the PID law needs simple-pid')
DT = 2e-3


def test_it_reaches_a_step_and_rests():
    run = close_loop(Pid(declared(), PidGains()), truth('nominal'), step_target(0.02), 4.0)
    assert np.max(np.abs(run.error[run.last(1.0)])) < 10e-6
    assert np.ptp(run.pressure[run.last(1.0)]) < 3e3
    settled = np.abs(run.error) < 0.02 * 0.02
    assert np.all(settled[run.t > 1.0 + 0.6])  # of a step that takes 0.4 s


@pytest.mark.parametrize('goal', [0.045, 0.055, 0.075])
def test_it_settles_at_all_places(goal):
    plant = truth('nominal', noise=0.0)
    run = close_loop(Pid(declared(), PidGains()), plant, step_target(goal - plant.y), 4.0)
    assert np.max(np.abs(run.error[run.t > 3.0])) < 20e-6


def test_it_starts_at_the_pressure_that_is_there():
    law = Pid(one_muscle(), PidGains())
    law.start(0.0644, (310e3,))
    assert law.update(DT, Reference(0.0644), 0.0644) == pytest.approx((310e3,))
    law.start(0.0644)
    (held,) = law.update(DT, Reference(0.0644), 0.0644)
    assert held == pytest.approx(
        one_muscle().muscle.pressure_for_force(20 * 9.80665, 0.161), rel=1e-6
    )


def test_it_does_not_wind_up_at_a_limit():
    law = Pid(one_muscle(), PidGains(), Limits(pressure_high=320e3))
    law.start(0.06, (290e3,))
    for _ in range(2000):  # the load is held down by something
        (pressure,) = law.update(DT, Reference(0.07), 0.06)
    assert pressure == 320e3
    assert law.terms.saturated
    freed = [law.update(DT, Reference(0.06), 0.0605)[0] for _ in range(100)]
    assert min(freed) < 300e3
