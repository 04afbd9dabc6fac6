# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which numbers a fit moves, in what coordinates, between which bounds."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.effects import EFFECTS
from pam_ros.identification.data.segment import segments_of, start_of
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.unknowns import (
    SPECIMEN,
    RunStart,
    effect_unknowns,
    nominal_unknowns,
    onset_unknown,
    run_unknowns,
    time_unknowns,
)
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from support.equations import unknown

RIG = single_muscle_joint(Muscle(), Mass(mass=20.0))
PLACES = places_of(RIG)


@given(st.floats(-5.0, 5.0), st.booleans())
def test_coordinate_undoes_value(u, logarithmic):
    one = unknown('x', base=3.0, scale=0.7, logarithmic=logarithmic)
    expected = 3.0 * np.exp(0.7 * u) if logarithmic else 3.0 + 0.7 * u
    assert one.value(u) == pytest.approx(expected, rel=1e-12)
    assert one.coordinate(one.value(u)) == pytest.approx(u, abs=1e-9)


@given(st.floats(1e-9, 1e9), st.floats(1e-9, 1e9), st.booleans())
def test_a_value_at_its_bound_is_not_past_it(base, span, logarithmic):
    one = unknown('x', base, 0.3, base, base + span, logarithmic=logarithmic)
    low, high = one.bounds
    assert one.value(low) == one.low
    assert one.value(high) <= one.high
    assert one.value(high) == pytest.approx(one.high, rel=1e-9)
    assert one.value(high + 1.0) == one.high


def test_a_logarithm_has_no_bound_at_zero_or_infinity():
    one = unknown('x', 2.0, 1.0, 0.0, np.inf, logarithmic=True)
    assert one.bounds == (-np.inf, np.inf)


def test_constants_and_damping_are_retuned_but_not_what_scale_and_rule_measure():
    found = {one.name: one for one in nominal_unknowns(RIG)}
    assert list(found) == ['a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'zeta']
    q = RIG.parameters().ravel()
    for one in found.values():
        assert one.value(0.0) == q[one.of.indices[0]]
        assert one.prior == 1.0
        assert one.is_parameter
    assert found['a2'].of.indices == (RIG.layout.constant(at.A2),)
    assert found['zeta'].of.indices == (RIG.layout.constant(at.ZETA),)
    assert found['zeta'].bounds[0] == -np.inf
    # A specimen differs by some per cent; a1, a small correction of a5, by more.
    for name in ('a2', 'a3', 'a4', 'a5', 'a6'):
        assert found[name].scale == pytest.approx(SPECIMEN * abs(found[name].base))
    a1, a5 = abs(RIG.muscle.si[0]), abs(RIG.muscle.si[4])
    assert SPECIMEN * a1 < found['a1'].scale < 2.0 * a1
    assert found['a1'].scale < SPECIMEN * a5
    assert 0.01 <= SPECIMEN <= 0.1


def test_what_is_zero_stays_zero():
    drive = single_muscle_joint(
        Muscle(a1=0.0, a2=0.0, a4=0.0, a3=0.0, a6=0.0, zeta=0.0),
        Mass(mass=95.0, mount='horizontal'),
    )
    assert [one.name for one in nominal_unknowns(drive)] == ['a5']


def run(kind):
    t = np.arange(200) / 100.0
    pressure, force = (None, None) if kind == 'free' else (1e5 + t, 5.0 * t)
    recording = Recording(kind, t, t, 1e5 + t, 0.01 + 0.03 * t, None, force, pressure, kind)
    return segments_of([recording])[0]


def test_each_free_run_has_its_own_start():
    found = run_unknowns([run('free'), run('free')], np.inf)
    assert [u.of for u in found] == [RunStart(k, fast) for k in (0, 1) for fast in (False, True)]
    assert [u.name for u in found] == ['y0[0]', 'v0[0]', 'y0[1]', 'v0[1]']
    assert not any(u.is_parameter for u in found)
    assert [u.value(0.0) for u in found] == pytest.approx([0.01, 0.03, 0.01, 0.03], abs=1e-9)
    assert all(u.prior == np.inf for u in found)


def test_when_commands_act_is_unknown_where_another_clock_stamped_them():
    assert time_unknowns([run('free'), run('held')]) == []
    (one,) = time_unknowns([replace(run('free'), drive_spread=1e-3), run('free')])
    assert (one.name, one.value(0.0), one.value(2.0), one.prior) == (
        'command time',
        0.0,
        2e-3,
        1.0,
    )
    assert not one.is_parameter


def test_a_held_run_has_no_start_of_its_own():
    assert run_unknowns([run('held')], 1e-5) == []


def test_a_moment_may_be_anywhere_in_the_recording():
    """Its prior is as wide as that of any time within it, wherever it is looked for."""
    one = onset_unknown([run('free')], 0.4)
    t = run('free').t
    assert one.value(0.0) == 0.4
    assert (one.value(1e9), one.value(-1e9)) == (t[-1], t[0])
    times = np.random.default_rng(0).uniform(t[0], t[-1], 100_000)
    assert one.prior * one.scale == pytest.approx(float(np.std(times)), rel=0.01)
    assert not one.is_parameter


def test_a_start_stays_as_near_as_noise_and_curvature_allow():
    straight = run_unknowns([run('free')], 1e-5)
    assert [u.scale for u in straight] == pytest.approx([2e-5, 2e-3], rel=1e-3)
    assert all(u.prior == 1.0 for u in straight)
    bent = run('free')
    target = bent.target + 1e3 * bent.t**3
    y0, v0 = start_of(bent.t, target)
    bent = replace(bent, target=target, y0=y0, v0=v0)
    wider = run_unknowns([bent], 1e-5)
    assert wider[0].scale > 2.0 * straight[0].scale
    assert wider[1].scale > 2.0 * straight[1].scale


@pytest.mark.parametrize('effect', EFFECTS, ids=lambda effect: effect.name)
def test_what_a_start_names_is_what_moves(effect):
    layout = RIG.layout
    names = [p.name for p in effect.parameters()]
    for start in effect.fit_starts():
        found = effect_unknowns(RIG, PLACES[effect.name], start)
        assert {u.name for u in found} == {f'effects.{effect.name}.{name}' for name in start}
        for one in found:
            name = one.of.parameter
            p = effect.parameters()[names.index(name)]
            assert one.of.indices == (layout.index(effect, names.index(name)),)
            assert one.prior == np.inf
            # The start lies within, and no value can leave what the simulator accepts.
            u = one.coordinate(start[name])
            assert one.bounds[0] <= u <= one.bounds[1]
            assert one.value(u) == pytest.approx(start[name], rel=1e-12, abs=1e-15)
            assert all(p.low <= one.value(bound) <= p.high for bound in one.bounds)
            if p.strength:  # must be able to vanish
                assert not one.logarithmic
                assert one.low <= 0.0 <= one.high
