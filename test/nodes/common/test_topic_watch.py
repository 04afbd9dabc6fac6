# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Programs say who else publishes their topics, and that nobody subscribes to their commands."""

import signal
from types import SimpleNamespace

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

from pam_ros.health.topics import LASTING
from pam_ros.nodes.common import topic_watch
from pam_ros.nodes.common.sampler import Sample
from pam_ros.nodes.common.topic_watch import SAMPLED, TopicWatch, Watched
from support.control_watch import Simulation
from support.harness import Program

STATES, COMMANDS = '/joint_states has ', '/pressure_command has '
ALONE = 'no subscriber'
LOOKS = 6  # of a node at its topics, one a second: twice as many as a warning takes


class Topics:
    """What the programs say of their topics."""

    def __init__(self, peer):
        self.peer, self.arrays = peer, peer.collect(DiagnosticArray, '/diagnostics')

    def of(self, node):
        """Return all that *node* has said of its topics, the newest last."""
        return [s for one in self.arrays for s in one.status if s.name == f'{node}: topics']

    def warns(self, node, text):
        """Wait until *node* warns with a message that has *text*; return the message."""

        def find():
            last = self.of(node)[-1:]
            return [s for s in last if s.level == DiagnosticStatus.WARN and text in s.message]

        return self.peer.until(find, f'{node} to warn of {text}')[0].message

    def is_calm(self, node):
        """Wait until *node* does not warn any more."""

        def find():
            return self.of(node) and self.of(node)[-1].level == DiagnosticStatus.OK

        self.peer.until(find, f'{node} to be calm')

    def looks(self, node, topic, publishers, count=LOOKS):
        """Wait for *count* looks of *node* that find so many *publishers*; return the levels."""
        wanted = str(publishers)

        def find():
            found = [
                status
                for status in self.of(node)
                if {pair.key: pair.value for pair in status.values}[f'publishers of {topic}']
                == wanted
            ]
            return found if len(found) >= count else None

        return {s.level for s in self.peer.until(find, f'{publishers} publishers of {topic}')}


@pytest.fixture
def topics(peer):
    return Topics(peer)


@pytest.mark.at_any_pace
def test_two_simulators_and_then_one(topics):
    with (
        Program('pam_control') as control,
        Program('pam_sim', '-r', '__node:=first') as first,
    ):
        with Program('pam_sim', '-r', '__node:=second') as second:
            for node in ('pam_control', 'first', 'second'):
                message = topics.warns(node, STATES)
                assert '2 publishers (/first, /second)' in message
                assert 'sends the joint pam: stop all but one' in message
                topics.warns(node, '/pressure has 2 publishers')
            second.stop()
        topics.is_calm('pam_control')
        topics.is_calm('first')
        assert control.output.count(STATES) == 1
        assert first.output.count(STATES) == 1


@pytest.mark.at_any_pace
def test_two_controllers_unless_one_of_them_is_disabled(topics):
    with (
        Program('pam_sim') as sim,
        Program('pam_control', '-r', '__node:=first') as first,
        Program('pam_control', '-r', '__node:=second', parameters={'start_enabled': False}),
    ):
        # It has a publisher, but sends nothing.
        for node in ('pam_sim', 'first', 'second'):
            assert topics.looks(node, '/pressure_command', 2) == {DiagnosticStatus.OK}
        topics.peer.call(SetBool, 'second/enable', data=True)
        for node in ('pam_sim', 'first', 'second'):
            assert '2 publishers (/first, /second)' in topics.warns(node, COMMANDS)
        topics.peer.call(SetBool, 'first/enable', data=False)
        for node in ('pam_sim', 'first', 'second'):
            topics.is_calm(node)
        assert sim.output.count(COMMANDS) == first.output.count(COMMANDS) == 1


@pytest.mark.at_any_pace
def test_another_joint_on_the_same_topic_is_no_fault(topics):
    peer = topics.peer
    with Program('pam_sim') as sim, Program('pam_control') as control:
        publisher = peer.node.create_publisher(JointState, 'joint_states', 10)
        other = JointState(name=['left_pam', 'pam_2'], position=[1.0, 2.0])
        other.header.frame_id = 'pam'
        peer.node.create_timer(0.02, lambda: publisher.publish(other))
        for node in ('pam_sim', 'pam_control'):
            assert topics.looks(node, '/joint_states', 2) == {DiagnosticStatus.OK}
        assert STATES not in sim.output + control.output
        # The same joint is one: only then does the second publisher count.
        other.name = ['left_pam', 'pam']
        for node in ('pam_sim', 'pam_control'):
            assert 'sends the joint pam' in topics.warns(node, STATES)


@pytest.mark.at_any_pace
def test_a_simulator_that_was_killed_and_started_again_is_one(topics):
    with Program('pam_control') as control:
        with Program('pam_sim') as killed:
            topics.peer.until(lambda: topics.of('pam_sim'), 'the simulator')
            killed.interrupt(signal.SIGKILL)
            killed.process.wait()
        with Program('pam_sim') as sim:
            # The graph has both until the lease of the first one ends, after 20 s.
            found = topics.looks('pam_control', '/joint_states', 2, LASTING + 1)
            assert found == {DiagnosticStatus.OK}
            assert STATES not in sim.output + control.output


@pytest.mark.at_any_pace
def test_commands_that_nobody_receives(topics):
    peer = topics.peer
    rig = Simulation(peer)
    arguments = ('-r', 'pressure_command:=left/valve')
    with Program('pam_control', *arguments, parameters={'state_timeout': 60.0}) as control:
        rig.tell_until(lambda: len(topics.of('pam_control')) > 1, 'the first diagnostics')
        message = topics.warns('pam_control', ALONE)
        assert message.startswith('commands on /left/valve have no subscriber')
        tool = Node('_tool', context=peer.context)
        tool.create_subscription(Float64, 'left/valve', lambda message: None, 10)
        peer.until(lambda: peer.node.count_subscribers('left/valve'), 'the tool')
        peer.more(topics.arrays, 3)
        assert ALONE in topics.warns('pam_control', ALONE)
        tool.destroy_node()
        peer.collect(Float64, 'left/valve')
        topics.is_calm('pam_control')
        assert control.output.count(ALONE) == 1


@pytest.mark.at_any_pace
def test_a_controller_and_its_rig_start_and_stop_without_a_warning(topics):
    with Program('pam_control') as control, Program('pam_sim') as sim:
        for node in ('pam_sim', 'pam_control'):
            assert topics.looks(node, '/joint_states', 1) == {DiagnosticStatus.OK}
            assert {status.level for status in topics.of(node)} == {DiagnosticStatus.OK}
        # A controller that only waits commands nothing.
        assert ALONE not in control.output + sim.output


# Without other programs --------------------------------------------------------------------------


class Graph:
    """A node that sees two publishers of each topic, and nodes of these names subscribe."""

    def __init__(self, *subscribers):
        self.subscribers, self.warnings = subscribers, []

    def resolve_topic_name(self, name):
        return f'/{name}'

    def count_publishers(self, topic):
        return 2

    def get_publishers_info_by_topic(self, topic):
        return [SimpleNamespace(node_namespace='/left', node_name=n) for n in ('a', 'b')]

    def get_subscriptions_info_by_topic(self, topic):
        return [SimpleNamespace(node_name=name) for name in self.subscribers]

    def get_logger(self):
        return SimpleNamespace(warning=self.warnings.append)


def test_only_some_topics_are_sampled_at_a_time(monkeypatch):
    sampled = set()

    class Sampler:
        def __init__(self, node):
            pass

        def take(self, kind, topic):
            sampled.add(topic)
            return [Sample(b'', 1), Sample(b'', 1)]

        def leave(self, topic):
            sampled.discard(topic)

    monkeypatch.setattr(topic_watch, 'Sampler', Sampler)
    graph = Graph()
    watch = TopicWatch(graph, [Watched(Float64, f't{i}') for i in range(2 * SAMPLED)])
    for _ in range(LASTING):
        health = watch.health()
    assert sampled == {f'/t{i}' for i in range(SAMPLED)}
    assert len(graph.warnings) == SAMPLED
    assert '/t0 has 2 publishers (/left/a, /left/b)' in health.message
    assert len(health.values) == 2 * SAMPLED


@pytest.mark.parametrize(
    ('subscribers', 'is_reported'),
    [
        ((), True),
        (('_ros2cli_1', '_pam_control_sampler'), True),
        (('_ros2cli_1', 'valve'), False),
        (('_NODE_NAME_UNKNOWN_',), False),
    ],
)
def test_hidden_nodes_receive_no_commands(monkeypatch, subscribers, is_reported):
    graph = Graph(*subscribers)
    monkeypatch.setattr(graph, 'count_publishers', lambda topic: 1)
    watch = TopicWatch(graph, [Watched(Float64, 'valve', is_command=True)], lambda: True)
    for _ in range(LASTING):
        watch.health()
    assert bool(graph.warnings) == is_reported
