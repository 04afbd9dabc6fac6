# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A law in service: starts, time-outs, silence, clocks."""

import pytest

from pam_ros.control.limits import Limits
from pam_ros.control.loop import (
    BLIND,
    DISABLED,
    HOLD,
    RUNNING,
    VENT,
    VENTING,
    WAITING,
    Loop,
    Measurement,
)
from pam_ros.control.pid import Pid
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.sliding_mode import SlidingMode
from support import closed_loop
from support.recorded_loop import BOUNDS, PERIOD, Recorder, first, recorded_loop, seen


@pytest.fixture
def loop():
    return recorded_loop()


def test_it_commands_nothing_before_it_sees(loop):
    assert loop.tick(0.0) is None
    assert loop.state == WAITING
    assert loop.age(0.0) is None


def test_it_starts_where_the_load_is_at_the_pressure_that_is_there(loop):
    loop.chambers = (123e3,)
    loop.see(Measurement(1.0, 0.05, 0.001))
    assert loop.tick(1.001) == first(1)
    assert loop.law.starts == [(0.05, (123e3,))]
    (call,) = loop.law.calls
    assert call == (pytest.approx(PERIOD), 0.05, 0.05, 0.001, pytest.approx(0.001))
    assert loop.state == RUNNING


def test_it_waits_for_the_pressure_that_is_there(loop):
    loop.awaits_chamber = True
    assert seen(loop, 1.0) is None
    assert loop.state == WAITING
    loop.chambers = (123e3,)
    assert loop.tick(1.002) == first(1)
    assert loop.law.starts == [(0.05, (123e3,))]


@pytest.mark.parametrize('chambers', [None, (40e3,)], ids=['unknown', 'not vented yet'])
def test_without_states_it_vents_and_begins_again_at_what_is_measured(loop, chambers):
    loop.safe = VENT
    seen(loop, 1.0)
    assert loop.tick(1.2) == (0.0,)
    loop.chambers = chambers
    seen(loop, 1.3, 0.01)
    assert loop.law.starts[-1] == (0.01, chambers or (0.0,))


def test_a_measurement_is_used_once_and_an_old_one_never(loop):
    seen(loop, 1.0)
    loop.tick(1.002)
    loop.see(Measurement(0.999, 0.07))
    loop.tick(1.004)
    loop.see(Measurement(1.005, 0.06))
    loop.tick(1.006)
    assert [call[2] for call in loop.law.calls] == [0.05, None, None, 0.06]


def test_steps_are_as_long_as_they_were(loop):
    for t in (1.0, 1.002, 1.0035, 1.03, 1.03):
        loop.see(Measurement(t, 0.05))
        loop.tick(t)
    lengths = [call[0] for call in loop.law.calls]
    assert lengths == pytest.approx([0.002, 0.002, 0.0015, 0.0265, 0.0002])


def test_without_states_the_pressure_is_held_and_control_restarts_later(loop):
    assert seen(loop, 1.0) == first(1)
    assert loop.tick(1.09) == first(2)
    assert loop.tick(1.11) == first(2)
    assert loop.state == BLIND
    seen(loop, 2.0, 0.03)
    assert loop.law.starts[-1] == (0.03, first(2))
    assert (loop.state, loop.starts) == (RUNNING, 2)


def test_a_rig_that_returns_later_finds_no_command_to_vent(loop):
    loop.safe = VENT
    seen(loop, 1.0)
    assert loop.tick(2.0) == (0.0,)
    assert loop.tick(2.0 + 0.9 * VENTING) == (0.0,)
    assert loop.tick(2.0 + 1.1 * VENTING) is None
    assert loop.state == BLIND
    assert seen(loop, 3.0, 0.03) == first(2)
    assert loop.tick(4.0) == (0.0,)  # and again for a while where states stay away again


def test_it_vents_slowly_and_in_proportion(loop):
    loop.safe, loop.vent_time = VENT, 2.0
    loop.law.update = lambda *_: (300e3, 100e3)
    seen(loop, 1.0)
    assert loop.tick(1.5) == (300e3, 100e3)
    assert loop.tick(2.5) == pytest.approx((150e3, 50e3))
    assert loop.tick(3.5) == (0.0, 0.0)
    assert loop.tick(3.5 + 0.9 * VENTING) == (0.0, 0.0)
    assert loop.tick(3.5 + 1.1 * VENTING) is None


def test_venting_is_suspended_while_the_rig_receives_no_commands(loop):
    loop.safe, loop.vent_time = VENT, 2.0
    loop.law.update = lambda *_: (300e3,)
    seen(loop, 1.0)
    assert loop.tick(1.5) == (300e3,)
    assert loop.tick(2.0) == pytest.approx((225e3,))
    loop.is_received = False
    assert loop.tick(2.1) is None
    assert loop.tick(9.0) is None
    loop.is_received = True
    assert loop.tick(9.2) == pytest.approx((195e3,))
    assert loop.tick(10.5) == (0.0,)
    assert loop.tick(10.5 + 1.1 * VENTING) is None


def test_seen_again_while_it_vents_it_begins_at_the_pressure_that_is_left(loop):
    loop.safe, loop.vent_time = VENT, 2.0
    seen(loop, 1.0)
    loop.tick(1.5)
    (left,) = loop.tick(2.0)
    assert left == pytest.approx(0.75 * first(1)[0])
    seen(loop, 2.1, 0.04)
    assert loop.law.starts[-1] == (0.04, (left,))
    assert loop.tick(3.0) == first(2)  # and from there where states stay away again
    assert loop.tick(4.0) == pytest.approx((0.5 * first(2)[0],))


@pytest.mark.parametrize(
    ('vent_time', 'time', 'share'), [(2.0, 0.5, 0.75), (2.0, 9.0, 0.0), (0.0, 0.0, 0.0)]
)
def test_what_is_left_of_pressures(loop, vent_time, time, share):
    loop.vent_time = vent_time
    assert loop.vented((300e3, 100e3), time) == (share * 300e3, share * 100e3)


def test_a_rig_that_is_left_finds_no_command_until_it_is_seen(loop):
    loop.safe, loop.vent_time = VENT, 2.0
    seen(loop, 1.0)
    assert loop.tick(1.5) == first(1)
    loop.leave()
    assert loop.tick(1.6) is None
    assert seen(loop, 2.0, 0.03) == first(2)
    assert loop.tick(2.5) == first(2)  # the next rig is not left


def test_it_vents_as_long_each_time_that_states_stay_away(loop):
    """Also where it has waited for a pressure between, without having begun."""
    loop.safe = VENT
    seen(loop, 1.0)
    loop.tick(2.0)
    loop.awaits_chamber = True
    assert seen(loop, 3.0, 0.03) is None
    assert loop.tick(4.0) == (0.0,)
    assert loop.tick(4.0 + 1.1 * VENTING) is None


@pytest.mark.parametrize(('safe', 'meanwhile'), [(VENT, None), (HOLD, first(1))])
def test_where_states_return_it_waits_for_the_pressure_that_is_there_now(loop, safe, meanwhile):
    loop.safe = safe
    seen(loop, 1.0)
    loop.tick(2.0)
    loop.awaits_chamber = True
    assert seen(loop, 3.0, 0.03) == meanwhile
    loop.chambers = (123e3,)
    assert loop.tick(3.002) == first(2)
    assert loop.law.starts[-1] == (0.03, (123e3,))


def test_disabled_it_publishes_nothing_and_enabled_it_restarts(loop):
    seen(loop, 1.0)
    loop.enable(False)
    assert loop.tick(1.002) is None
    assert loop.state == DISABLED
    loop.enable(False)
    loop.enable(True)
    assert loop.tick(1.004) is None  # it has not seen anything since
    seen(loop, 1.006, 0.04)
    assert [position for position, _ in loop.law.starts] == [0.05, 0.04]


def test_a_clock_that_jumped_back_is_a_new_beginning(loop):
    seen(loop, 100.0)
    loop.forget()
    seen(loop, 1.0, 0.06)
    assert loop.state == RUNNING
    assert loop.law.starts[-1][0] == 0.06
    assert loop.law.calls[-1][0] == pytest.approx(PERIOD)


def test_another_law_takes_over_in_flight(loop):
    last = seen(loop, 1.0)
    other = Recorder()
    loop.change(other, ReferenceSource(Shape(), (-1.0, 1.0)))
    assert other.starts == [(0.05, last)]
    assert loop.source.reference.position == 0.05


def test_another_law_that_cannot_hold_the_reference_starts_at_the_load(loop):
    last = seen(loop, 1.0)
    loop.law.terms.position = 0.049
    other, source = Recorder(), ReferenceSource(Shape(), (-1.0, 0.02))
    sentence = loop.change(other, source)
    assert 'reference 0.05 m is out of reach' in sentence
    assert other.starts == [(0.049, last)]
    assert source.reference.position == 0.049
    assert source.target == 0.02


@pytest.mark.parametrize('law', [SlidingMode, Pid])
@pytest.mark.parametrize('lasts', [0.05, 0.2, 3.0])
def test_a_load_that_sank_with_less_pressure_is_not_thrown_with_more(law, lasts):
    """As by limits.pressure_high at run time: lowered for a while and then raised again."""
    joint, plant = closed_loop.nominal(), closed_loop.truth('nominal', p0=300e3)

    def part(high):
        limits = Limits(pressure_high=high)
        made = law(joint, limits=limits)
        return made, ReferenceSource(Shape(), made.allocation.reach)

    made, source = part(600e3)
    loop = Loop(made, source, PERIOD, Plausibility(bounds_of(made.allocation)))
    loop.chambers, now = (300e3,), 10.0
    begin = plant.measure()

    def run(seconds):
        nonlocal now
        found = []
        for _ in range(round(seconds / PERIOD)):
            now += PERIOD
            loop.see(Measurement(now, plant.measure()))
            (pressure,) = loop.tick(now)
            plant.step(pressure, PERIOD)
            found.append(plant.y)
        return found

    run(1.0)
    assert 'is out of reach' in loop.change(*part(200e3))
    run(lasts)
    assert loop.state == RUNNING
    sunk = plant.y
    assert loop.change(*part(600e3)) == ''
    found = run(3.0)
    # A load that still sinks swings when it is stopped, but not to where it was before.
    assert max(found) < (sunk + 1e-3 if lasts > 1.0 else begin)
    assert found[-1] < begin - 5e-3
    assert found[-1] == pytest.approx(loop.source.reference.position, abs=0.5e-3)


def test_pressures_of_several_muscles_are_handled_alike():
    class Two(Recorder):
        def update(self, *args, **kwargs):
            return 2 * super().update(*args, **kwargs)

    source = ReferenceSource(Shape.revolute(), (-1.0, 1.0), 'rad')
    loop = Loop(Two(), source, PERIOD, Plausibility(BOUNDS))
    loop.safe, loop.chambers = VENT, (123e3, 150e3)
    assert seen(loop, 1.0) == loop.pressures == 2 * first(1)
    assert loop.law.starts == [(0.05, (123e3, 150e3))]
    assert loop.tick(1.2) == loop.pressures == (0.0, 0.0)
