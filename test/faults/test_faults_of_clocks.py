# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A ``/clock`` that leaps by an hour, goes back by one, or stops: the load stays where it is.

The test publishes the time that the three programs follow, so that it passes only while all of
them keep up: nothing here depends on how fast the machine is.
"""

from time import monotonic

import pytest
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

from support.control_watch import stamp
from support.harness import lose_nothing
from support.station import JUMP, RATE, Station

SECOND, HOUR = 10**9, 3600 * 10**9
PERIOD = round(SECOND / RATE)
BEGIN = 10_000 * SECOND
STANDS = 50  # messages in which a clock that has stopped says the same again and again
PATIENCE, TURN = 0.02, 5e-4  # s that a turn waits for a command, and between two looks for it

pytestmark = [pytest.mark.usefixtures('turn'), pytest.mark.at_any_pace]


class OwnClock:
    """A client whose time passes by a period with each of its turns, once that is answered."""

    def __init__(self, peer):
        self.peer, self.now, self.is_stopped = peer, BEGIN, False
        self._commands = peer.collect(Float64, 'pressure_command')
        self._publisher = peer.node.create_publisher(Clock, '/clock', QoSProfile(depth=1))

    def __getattr__(self, name):
        return getattr(self.peer, name)

    def tick(self):
        """Say the time; it passes unless the clock is stopped."""
        self.now += 0 if self.is_stopped else PERIOD
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(self.now, SECOND)
        self._publisher.publish(message)
        end, received = monotonic() + PATIENCE, len(self._commands)
        while len(self._commands) == received and monotonic() < end:
            self.peer.work(TURN)

    def until(self, condition, what):
        """Let time pass until *condition*."""

        def passes():
            self.tick()
            return condition()

        return self.peer.until(passes, what)


@pytest.fixture(scope='module')
def running(module_peer, tmp_path_factory):
    clock = OwnClock(module_peer)
    folder = tmp_path_factory.mktemp('bags')
    given = {'use_sim_time': 'true', **lose_nothing()}
    with Station(clock, folder, **given) as station:
        yield station


@pytest.fixture
def station(running):
    """Return the three programs, the load at rest where it was moved to."""
    if not running.is_held():
        running.move()
    return running


def check_still(station, first):
    """Check that the load was held all the time since state number *first*, and can be moved."""
    positions = [one.position[0] for one in station.states[first:]]
    jump = max(positions) - min(positions)
    print(f'jump {1e3 * jump:.4f} mm')
    assert jump < JUMP
    station.move()


def goes_on(station):
    """Wait until some of the present time has been simulated and controlled."""
    begin = station.peer.now / SECOND

    def do():
        newest = stamp(station.states[-1]), stamp(station.watch.terms[-1])
        return all(begin + 0.5 < one < begin + 1000.0 for one in newest)

    station.peer.until(do, 'control at the new time')


@pytest.mark.parametrize('leap', [HOUR, -HOUR])
def test_a_clock_that_leaps(station, leap):
    station.is_recording()
    first, bag = len(station.states), station.bag
    before = station.peer.now
    # States from before the leap can still be on their way.
    newest = stamp(station.states[-1])
    station.peer.now += leap
    goes_on(station)
    earliest = min(newest, (before + leap) / SECOND)
    assert min(stamp(one) for one in station.states[first:]) >= earliest
    check_still(station, first)
    assert station.programs['pam_record'].stop() == 0
    station.start('pam_record')
    times = [time for time, _ in station.recorded(bag)['/joint_states']]
    assert min(times) < min(before, before + leap) + SECOND
    assert max(times) > max(before, before + leap) - SECOND


def test_a_clock_that_stops(station):
    clock, first = station.peer, len(station.states)
    clock.is_stopped = True
    for _ in range(STANDS):
        clock.tick()
    assert stamp(station.states[-1]) <= clock.now / SECOND
    clock.is_stopped = False
    goes_on(station)
    check_still(station, first)
