# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that nobody should send, to all topics of the running programs: 20, or 400 with --full.

Numbers that are none or cannot be, arrays of other lengths, other names, stamps of any time, and
bytes that are no message. The load is moved within the limits or not at all, and all goes on.
"""

import numpy as np
import pytest
from builtin_interfaces.msg import Duration, Time
from rclpy.serialization import serialize_message
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from support.station import FASTEST, Station, fastest, numbers

EACH = 20  # messages of a turn
SOON = 0.02  # s between two of them, some periods of the controller
NAN, INF = float('nan'), float('inf')
# None of them can be the position of a load that is held at 50 or 60 mm, in m.
FALSE = (NAN, INF, -INF, -1.0, -0.3, 0.0, 0.3, 1.0, 1e300, -1e300)
# What may be asked for; those within the reach are followed within the limits.
ASKED = (*FALSE, 0.02, 0.055, 0.07)
PRESSURES = (NAN, INF, -INF, 0.0, -1e300, 1e300)  # Pa absolute
NO_COMMANDS = (NAN, INF, -INF)  # others are commands, however high
NAMES = (['pam'], [], [''], ['other'], ['pam', 'other'], ['other', 'pam'], ['\x1b[2J' * 50])
KINDS = {
    'joint_states': JointState,
    'pressure': FluidPressure,
    'joint_trajectory': JointTrajectory,
    'position_reference': Float64,
    'pressure_command': Float64,
}
SECONDS = (-(2**31), -1, 0, 1, 2**31 - 1)

pytestmark = pytest.mark.usefixtures('turn')


class Draws:
    """Messages by chance, from a seed."""

    def __init__(self, seed):
        self._rng = np.random.default_rng(seed)

    def one(self, values):
        return values[self._rng.integers(len(values))]

    def some(self, values, most=3):
        return [self.one(values) for _ in range(self._rng.integers(most + 1))]

    def stamp(self):
        return Time(sec=self.one(SECONDS), nanosec=int(self._rng.integers(2**32)))

    def state(self):
        message = JointState(name=self.one(NAMES))
        message.header.stamp = self.stamp()
        message.position, message.velocity = self.some(FALSE), self.some(FALSE)
        message.effort = self.some(FALSE)
        return message

    def pressure(self):
        message = FluidPressure(fluid_pressure=self.one(PRESSURES), variance=self.one(FALSE))
        message.header.stamp = self.stamp()
        return message

    def trajectory(self):
        message = JointTrajectory(joint_names=self.one(NAMES))
        message.header.stamp = self.one([Time(), self.stamp()])
        for _ in range(self._rng.integers(6)):
            point = JointTrajectoryPoint(positions=self.some(ASKED, 2))
            point.velocities, point.accelerations = self.some(ASKED, 1), self.some(FALSE, 1)
            point.time_from_start = Duration(
                sec=int(self._rng.integers(-1, 5)), nanosec=int(self._rng.integers(2**32))
            )
            message.points.append(point)
        return message

    def message(self):
        """Return a topic, and a message or bytes for it."""
        topic, make = self.one(
            [
                ('joint_states', self.state),
                ('pressure', self.pressure),
                ('joint_trajectory', self.trajectory),
                ('position_reference', lambda: Float64(data=self.one(ASKED))),
                ('pressure_command', lambda: Float64(data=self.one(NO_COMMANDS))),
            ]
        )
        message = make()
        if self._rng.random() < 0.7:
            return topic, message
        data = bytearray(serialize_message(message))
        # A changed byte can make a position or a command that is as good as any.
        for _ in range(0 if topic in ('joint_states', 'pressure_command') else 3):
            data[self._rng.integers(len(data))] = self._rng.integers(256)
        return topic, bytes(data[: self._rng.integers(len(data))])


@pytest.fixture(scope='module')
def station(module_peer, tmp_path_factory):
    with Station(module_peer, tmp_path_factory.mktemp('bags')) as running:
        running.move()
        yield running


@pytest.fixture(scope='module')
def publishers(station):
    """Return what publishes messages, and bytes as if they were some."""
    node = station.peer.node
    made = {topic: node.create_publisher(kind, topic, 10) for topic, kind in KINDS.items()}
    for topic, one in made.items():
        station.peer.until(one.get_subscription_count, f'a subscriber of {topic}')
    return made


def of_rig(messages):
    """Leave those of the rig, whose stamps are of today, in the list; return them."""
    messages[:] = [one for one in messages if 1 < one.header.stamp.sec < SECONDS[-1]]
    return messages


def test_messages_that_nobody_should_send(station, publishers, turn):
    peer, watch, draws = station.peer, station.watch, Draws(turn)
    first, refused = len(of_rig(station.states)), 0
    no_numbers = len(watch.commands)
    for _ in range(EACH):
        topic, message = draws.message()
        publishers[topic].publish(message)
        refused += topic == 'pressure_command' and isinstance(message, Float64)
        peer.work(SOON)
    peer.more(watch.arrays, 4)  # diagnostics of both nodes, twice
    for name, program in station.programs.items():
        assert program.is_running, (name, program.output)
        assert 'Traceback' not in program.output
    states, pressures = of_rig(station.states), of_rig(station.pressures)
    for one in (*states[first:], *pressures, *watch.terms):
        assert np.all(np.isfinite(numbers(one)))
    # The test hears its own commands as well; the controller sends none of these.
    found = [one.data for one in watch.commands[no_numbers:] if not np.isfinite(one.data)]
    assert len(found) == refused
    print(f'fastest {1e3 * fastest(states[first:]):.3f} mm/s')
    assert fastest(states[first:]) < FASTEST
    station.move()
