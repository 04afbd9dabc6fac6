# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_record`` as a process: every message in a bag that another library reads."""

import signal
from itertools import product

import numpy as np
import pytest
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosbags.highlevel import AnyReader
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, String

from support.bags import contents, written
from support.ends import check_refusals
from support.harness import DEADLINE, Program
from support.marks import at_release

pytestmark = pytest.mark.usefixtures('domain')

DEEP = QoSProfile(depth=20_000)  # so that the publisher of the test drops nothing either


def recorder(path, *arguments):
    return Program('pam_record', '--', '-o', str(path), *arguments)


def connected(peer, kind, topic, qos=DEEP):
    """Return a publisher once the recorder listens."""
    publisher = peer.node.create_publisher(kind, topic, qos)
    peer.until(publisher.get_subscription_count, f'the recorder on {topic}')
    return publisher


def delivered(*publishers):
    for publisher in publishers:
        assert publisher.wait_for_all_acked(Duration(seconds=DEADLINE))


def stamp_of(message):
    """Return the stamp of a state in ns."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def on_disk(bag):
    """Return the number of messages that the bag on disk says it has."""
    return sum(written(bag).values())


def has_all_of_a_rig(bag):
    """Say whether the bag on disk has messages of each topic of a simulator.

    The middleware connects each topic for itself. What is published while it does so is lost.
    """
    count = written(bag)
    topics = ('damping', 'force', 'joint_states', 'pressure', 'stiffness')
    return all(count.get(f'/{topic}', 0) >= 300 for topic in topics)


@pytest.mark.at_any_pace
@pytest.mark.parametrize(
    'kind', [signal.SIGINT, *map(at_release, (signal.SIGTERM, signal.SIGHUP))]
)
def test_all_messages_of_a_rig_are_in_the_bag(peer, tmp_path, kind):
    count = 3000
    bag = tmp_path / 'rig'
    with recorder(bag) as program:
        floats = {
            topic: connected(peer, Float64, topic)
            for topic in ('pressure_command', 'force', 'stiffness', 'damping')
        }
        joints = connected(peer, JointState, 'joint_states')
        fluid = connected(peer, FluidPressure, 'pressure')
        state = JointState(name=['pam'], position=[0.0], velocity=[1.0], effort=[2.0])
        for k in range(count):
            state.header.stamp = peer.node.get_clock().now().to_msg()
            state.position[0] = float(k)
            joints.publish(state)
            fluid.publish(FluidPressure(header=state.header, fluid_pressure=1e5 + k))
            for publisher in floats.values():
                publisher.publish(Float64(data=float(k)))
        delivered(joints, fluid, *floats.values())
        program.interrupt(kind)
        assert program.wait() == 0
        output = program.output
    found = contents(bag)
    expected = list(range(count))
    for topic in floats:
        assert [message.data for _, message in found[f'/{topic}']] == expected
    assert [message.position[0] for _, message in found['/joint_states']] == expected
    assert [message.fluid_pressure for _, message in found['/pressure']] == [
        1e5 + k for k in expected
    ]
    for topic in found:
        stamps = [stamp for stamp, _ in found[topic]]
        assert stamps == sorted(stamps)
        assert f'{topic} ' in output
    assert output.count(f'{count} messages') == 6
    assert 'lost' not in output
    for stamp, message in found['/joint_states']:
        assert stamp >= stamp_of(message)


@pytest.mark.at_any_pace
def test_what_is_recorded_describes_itself(peer, tmp_path):
    """The reader checks the definitions in the bag against the hashes of the types."""
    bag = tmp_path / 'rig'
    with recorder(bag):
        joints = connected(peer, JointState, 'joint_states', QoSProfile(depth=7))
        joints.publish(JointState())
        delivered(joints)
    with AnyReader([bag]) as reader:
        (connection,) = reader.connections
        assert connection.digest == (
            'RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e'
        )
        assert 'MSG: builtin_interfaces/Time' in connection.msgdef.data
        (profile,) = connection.ext.offered_qos_profiles
        assert profile.reliability.name == 'RELIABLE'
        assert profile.durability.name == 'VOLATILE'
        assert (profile.deadline.sec, profile.deadline.nsec) == (9223372036, 854775807)


@pytest.mark.at_any_pace
def test_topics_that_come_late_and_topics_that_are_named(peer, tmp_path):
    bag = tmp_path / 'rig'
    with recorder(bag, 'notes', '/other/level', 'silent') as program:
        force = connected(peer, Float64, 'force')
        force.publish(Float64(data=1.0))
        notes = connected(peer, String, 'notes')
        notes.publish(String(data='now it creaks'))
        level = connected(peer, Float64, '/other/level')
        level.publish(Float64(data=2.0))
        ignored = peer.node.create_publisher(Float64, 'unasked', 10)
        connected(peer, Float64, 'damping')
        delivered(force, notes, level)
        assert ignored.get_subscription_count() == 0
        program.interrupt()
        assert program.wait() == 0
        assert '/silent' in program.output
        assert 'was not published' in program.output
        (idle,) = (line for line in program.output.splitlines() if line.startswith('  /damping'))
        assert idle.endswith('0.0 Hz  no message was received')
    found = contents(bag)
    assert sorted(found) == ['/damping', '/force', '/notes', '/other/level']
    assert found['/notes'][0][1].data == 'now it creaks'


@pytest.mark.at_any_pace
def test_a_rig_in_a_namespace_and_remapped(peer, tmp_path):
    bag = tmp_path / 'rig'
    arguments = ('-r', '__ns:=/left', '-r', 'force:=cell')
    with Program('pam_record', *arguments, '--', '-o', str(bag)):
        force = connected(peer, Float64, '/left/cell')
        force.publish(Float64(data=1.0))
        delivered(force)
    assert sorted(contents(bag)) == ['/left/cell']


@pytest.mark.at_any_pace
def test_publishers_of_every_quality_of_service_are_received(peer, tmp_path):
    """And what was published before, where the publisher keeps it."""
    bag = tmp_path / 'rig'
    qualities = {
        topic: QoSProfile(depth=5, reliability=reliability, durability=durability)
        for topic, (reliability, durability) in zip(
            ('pressure_command', 'force', 'stiffness', 'damping'),
            product(
                (ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT),
                (DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL),
            ),
            strict=True,
        )
    }
    kept = peer.node.create_publisher(
        Float64, 'kept', QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    )
    kept.publish(Float64(data=4.0))
    with recorder(bag, 'kept'):
        publishers = [connected(peer, Float64, topic, qos) for topic, qos in qualities.items()]

        def are_written():
            for publisher in publishers:
                publisher.publish(Float64(data=3.0))
            return sum(map(bool, written(bag).values())) == 5

        peer.until(are_written, 'a message of each')
    found = contents(bag)
    for topic in qualities:
        assert found[f'/{topic}'][0][1].data == 3.0
    assert [message.data for _, message in found['/kept']] == [4.0]


@pytest.mark.at_any_pace
def test_a_recorder_that_is_killed_leaves_a_whole_bag(peer, tmp_path):
    bag = tmp_path / 'rig'
    sent = 0
    with recorder(bag) as program:
        force = connected(peer, Float64, 'force')

        def publish():
            nonlocal sent
            for _ in range(20):
                force.publish(Float64(data=float(sent)))
                sent += 1

        peer.until(lambda: [publish(), on_disk(bag) >= 200][1], 'two hundred messages on disk')
        at_least = on_disk(bag)
        program.interrupt(signal.SIGKILL)
        assert program.wait() == -signal.SIGKILL
    for path in (bag, bag / 'rig_0.mcap'):
        numbers = [message.data for _, message in contents(path)['/force']]
        assert numbers == list(range(len(numbers)))
        assert len(numbers) >= at_least


def test_a_recorder_that_is_held_up_has_what_the_simulator_published_meanwhile(peer, tmp_path):
    """It stands still for 0.6 s, which is more than the middleware's memory holds, three times."""
    bag = tmp_path / 'rig'
    with recorder(bag) as program, Program('pam_sim', parameters={'command_timeout': 0.0}):
        peer.until(lambda: has_all_of_a_rig(bag), 'some messages of each topic')
        for _ in range(3):
            program.interrupt(signal.SIGSTOP)
            peer.work(0.6)
            program.interrupt(signal.SIGCONT)
            before = on_disk(bag)
            peer.until(lambda n=before: on_disk(bag) >= n + 5000, 'two seconds of messages more')
        program.interrupt()
        assert program.wait() == 0
        assert 'lost' not in program.output
    found = contents(bag)
    counts = [len(found[f'/{topic}']) for topic in ('joint_states', 'force', 'pressure')]
    assert min(counts) > 3500
    assert np.ptp(counts) < 100  # all began at about the same time
    late = [time - stamp_of(message) for time, message in found['/joint_states']]
    assert max(late) < 0.3e9  # half of the time for which it was stopped


def test_a_recorder_that_was_held_up_at_its_end_has_what_was_published_until_then(peer, tmp_path):
    """What the middleware lost meanwhile is sent again later: the recorder waits for it."""
    bag = tmp_path / 'rig'
    states = peer.collect(JointState, 'joint_states')
    with recorder(bag) as program, Program('pam_sim', parameters={'command_timeout': 0.0}):
        peer.until(lambda: has_all_of_a_rig(bag), 'some messages of each topic')
        program.interrupt(signal.SIGSTOP)
        peer.work(1.0)
        last = stamp_of(states[-1])
        program.interrupt(signal.SIGCONT)
        program.interrupt()
        assert program.wait() == 0
        assert 'lost' not in program.output
    found = contents(bag)
    for topic in ('joint_states', 'pressure'):
        stamps = np.array([stamp_of(message) for _, message in found[f'/{topic}']])
        assert stamps[-1] >= last, topic
        assert np.diff(stamps).max() < 0.5e9, topic  # a busy machine may stop the simulator


@pytest.mark.at_any_pace
def test_a_directory_that_is_renamed_ends_it_with_one_sentence(peer, tmp_path):
    bag = tmp_path / 'rig'
    with recorder(bag) as program:
        force = connected(peer, Float64, 'force')
        peer.until(lambda: [force.publish(Float64()), on_disk(bag) > 0][1], 'a message on disk')
        bag.rename(tmp_path / 'gone')
        peer.until(lambda: [force.publish(Float64()), not program.is_running][1], 'its end')
        assert program.wait() == 2
        last = program.output.splitlines()[-1]
    assert last == (
        f'pam_record: {bag} was deleted or renamed while it was recorded: nothing more is recorded'
    )
    assert contents(tmp_path / 'gone')['/force']


@pytest.mark.at_any_pace
def test_where_time_is_simulated_it_is_what_is_recorded(peer, tmp_path):
    bag = tmp_path / 'rig'
    with Program('pam_record', '-p', 'use_sim_time:=true', '--', '-o', str(bag)):
        force = connected(peer, Float64, 'force')
        clock = peer.node.create_publisher(Clock, '/clock', 10)
        now = Clock()
        now.clock.sec = 5

        def is_recorded():
            clock.publish(now)
            force.publish(Float64())
            if on_disk(bag) < 1:
                return False
            stamps = [stamp for stamp, _ in contents(bag)['/force']]
            return stamps[-1] == 5 * 10**9

        peer.until(is_recorded, 'a message of simulated time')
    stamps = np.array([stamp for stamp, _ in contents(bag)['/force']])
    assert set(stamps) <= {0, 5 * 10**9}


@pytest.mark.at_any_pace
def test_bad_arguments_end_it_with_a_sentence(tmp_path):
    (tmp_path / 'there').mkdir()
    out = ['--', '-o', str(tmp_path / 'rig')]
    refused = [
        (['--', '-o', str(tmp_path / 'there')], ['there exists already']),
        *(([*out, bad], [bad]) for bad in ('--nonsense', 'two words', '1st')),
    ]
    check_refusals('pam_record', refused)
    assert list(tmp_path.rglob('*')) == [tmp_path / 'there']
