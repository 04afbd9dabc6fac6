# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""End stops against an adaptive solver, and what a step of any length must not do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.effects import EndStop
from pam_ros.effects.rows import INERTIA, LENGTH
from pam_ros.errors import ParameterError
from pam_ros.rig.run import simulate
from support import bench


def test_load_bounces_off_the_upper_pad():
    stiffness, damping, m = 2e4, 3.0, bench.MASS
    stop = EndStop(upper=0.05, stiffness=stiffness, damping=damping)
    t = np.linspace(0.0, 0.5, 101)
    run = simulate(bench.cart(stop, mass=m), t, [0.0], [0.0], position=0.0, velocity=0.4)

    def rhs(_, state, u):
        y, v = state
        d = max(y - 0.05, 0.0)
        return v, (u - max(stiffness * d * (1.0 + damping * v), 0.0)) / m

    y, v = bench.solved(rhs, t, (0.0, 0.4), max_step=1e-4)
    np.testing.assert_allclose(run.position, y, atol=2e-5)
    assert y.max() > 0.055
    assert -0.4 < v[-1] < -0.2


def test_load_rests_on_the_lower_pad():
    stiffness = 5e4
    pad = EndStop(lower=0.06, lower_stiffness=stiffness)
    run = simulate(bench.hanging(pad), [0.0, 5.0], [0.0], [0.0], position=0.03)
    y = run.position[1]
    depth = 0.06 * bench.L0 - y
    carried = bench.MASS * bench.G - bench.pull(0.0, y)
    assert stiffness * depth == pytest.approx(carried, rel=2e-5)
    assert abs(run.velocity[1]) < 1e-9


@given(
    y=st.floats(-0.5, 0.5),
    v=st.floats(-50.0, 50.0),
    stiffness=st.floats(1.0, 1e8),
    damping=st.floats(0.0, 1e3),
    step=st.floats(1e-4, 1e-2),
)
def test_pads_push_apart_and_never_pull(y, v, stiffness, damping, step):
    q = np.ones(7)
    q[INERTIA], q[LENGTH] = 2.0, 1.0
    q[2:] = 0.1, stiffness, -0.1, stiffness, damping
    f = EndStop.equations.outside(0.0, 0.0, y, v, 0.0, 0.0, [step], 0, [0.0], q, 2)
    if y > 0.1:
        assert f <= 0.0
    elif y < -0.1:
        assert f >= 0.0
    else:
        assert f == 0.0


@pytest.mark.parametrize('mass', [0.5, 100.0])
@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_hardest_pad_neither_explodes_nor_adds_energy(mass, step):
    pads = EndStop(upper=0.02, stiffness=1e8, lower=-0.02, lower_stiffness=1e8, damping=1e3)
    t = np.linspace(0.0, 5.0, 501)
    run = simulate(
        bench.cart(pads, mass=mass),
        t,
        [0.0],
        [0.0],
        position=0.0,
        velocity=0.3,
        step=step,
    )
    assert np.all(np.abs(run.velocity) <= 0.3 * (1.0 + 1e-9))
    assert np.all(np.abs(run.position) < 0.02 + 0.3 * step * 2.0)


def test_guess_lies_within_the_travel():
    kappa = np.sin(np.linspace(0.0, 20.0, 500)) * 0.1 + 0.1
    kappa[100:200] = np.nan
    for start in EndStop.equations.guess(kappa, kappa, kappa, kappa):
        EndStop(**start)
        where = start.get('upper', start.get('lower'))
        assert 0.0 < where < 0.2


PADS = {'stiffness': 1e4, 'lower_stiffness': 1e4}


@pytest.mark.parametrize(('lower', 'upper'), [(0.2, 0.1), (0.1, 0.1)])
def test_two_pads_leave_a_travel(lower, upper):
    words = rf'^effects\.end_stop\.lower = {lower} is not allowed: give less than .*upper = 0\.1$'
    with pytest.raises(ParameterError, match=words):
        EndStop(lower=lower, upper=upper, **PADS)
    EndStop(lower=lower, upper=upper, stiffness=1e4)  # one pad: the place of the other is unused


@given(
    lower=st.floats(-0.49, 1.0), upper=st.floats(-0.5, 1.0), a=st.floats(0, 1), b=st.floats(0, 1)
)
def test_a_fit_of_two_pads_cannot_cross_them(lower, upper, a, b):
    """Wherever it begins, and wherever within its bounds it ends."""
    near = {'lower': lower, 'upper': upper, 'stiffness': 0.0, 'lower_stiffness': 3e4}
    bounds = EndStop.fit_bounds(near, {'upper', 'stiffness'}, 20.0, 60.0)
    low, high = bounds['lower'], bounds['upper']
    least, most = max(-0.5, high[0]), min(1.0, low[1])
    EndStop(lower=-0.5 + a * (most + 0.5), upper=least + b * (1.0 - least), **PADS)
    if lower < upper - 1e-5:
        assert low[0] <= lower <= low[1]
        assert high[0] <= upper <= high[1]
    assert EndStop.fit_bounds(near, {'upper', 'damping'}, 20.0, 60.0) == {}
