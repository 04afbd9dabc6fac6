# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A rig's topics in bags that another library wrote."""

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.read import read_bag
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from support import bags

LATE = 2e-4


def read(path, topics, rules=(), namespace=None, plugin=StoragePlugin.MCAP):
    bag = bags.write_bag(path / 'bag', topics, plugin)
    return read_bag(bag, read_mapping(rules) if rules else ColumnMapping(), namespace)


def check_rig(series, truth):
    """Compare with the truth on one clock, whose origin is free."""
    origin = series['position'].t[0]
    for name, (t, value) in truth.items():
        one = series['pressure_command' if name == 'command' else name]
        np.testing.assert_allclose(one.t - origin, t, atol=1e-9)
        np.testing.assert_allclose(one.value, value, rtol=1e-14, atol=1e-9)


@pytest.mark.parametrize('plugin', list(StoragePlugin))
def test_our_topics_in_both_storages(tmp_path, plugin):
    topics, truth = bags.rig_topics(late=LATE)
    series, notes = read(tmp_path, topics, plugin=plugin)
    assert notes == []
    assert sorted(series) == ['force', 'position', 'pressure', 'pressure_command', 'velocity']
    check_rig(series, truth)
    assert series['position'].source == '/joint_states.position'
    assert series['force'].source == '/force'


def test_a_single_storage_file(tmp_path):
    topics, truth = bags.rig_topics()
    bag = bags.write_bag(tmp_path / 'bag', topics)
    series, _ = read_bag(bag / 'bag.mcap', ColumnMapping())
    check_rig(series, truth)


def test_topics_of_one_rig_are_found_in_its_namespace(tmp_path):
    topics, truth = bags.rig_topics('/lab/left')
    series, notes = read(tmp_path, topics)
    assert notes == []
    check_rig(series, truth)


def test_of_two_rigs_one_is_chosen(tmp_path):
    left, truth = bags.rig_topics('/left')
    right, _ = bags.rig_topics('/right', duration=3.0)
    with pytest.raises(RecordingError, match='/left, /right: choose one with --namespace'):
        read(tmp_path, {**left, **right})
    series, _ = read_bag(tmp_path / 'bag', ColumnMapping(), 'left')
    check_rig(series, truth)


@pytest.mark.parametrize('namespace', ['left', '/left', '/left/'])
def test_a_namespace_that_is_not_there(tmp_path, namespace):
    topics, _ = bags.rig_topics()
    wanted = 'bag has neither /left/joint_states nor /left/force: it has /force '
    with pytest.raises(RecordingError, match=f'^{wanted}'):
        read(tmp_path, topics, namespace=namespace)


def test_the_namespace_without_a_name_that_is_not_there(tmp_path):
    topics, _ = bags.rig_topics('/right')
    wanted = 'bag has neither /joint_states nor /force: it has /right/force '
    with pytest.raises(RecordingError, match=f'^{wanted}'):
        read(tmp_path, topics, namespace='/')


def test_effort_is_the_force_where_no_force_was_recorded(tmp_path):
    topics, _ = bags.rig_topics()
    del topics['/force']
    _, messages = topics['/joint_states']
    for k, (_, message) in enumerate(messages):
        message.effort[0] = 190.0 + k
    series, notes = read(tmp_path, topics)
    assert notes == []
    assert series['force'].source == '/joint_states.effort'
    np.testing.assert_array_equal(series['force'].value, 190.0 + np.arange(len(messages)))


def test_fields_that_nobody_fills_are_no_signals(tmp_path):
    topics, _ = bags.rig_topics()
    del topics['/force']
    stamps = [stamp for stamp, _ in topics['/joint_states'][1]]
    for velocity in ([], [0.0], [np.nan]):
        messages = [(s, bags.joint(s, [1e-9 * (s - bags.EPOCH)], velocity)) for s in stamps]
        topics['/joint_states'] = (bags.JOINT, messages)
        folder = tmp_path / f'case{len(velocity)}{velocity}'
        folder.mkdir()
        series, _ = read(folder, topics)
        assert sorted(series) == ['position', 'pressure', 'pressure_command']


def test_a_stretch_of_nan_is_refused(tmp_path):
    topics, _ = bags.rig_topics()
    for _, message in topics['/joint_states'][1][200:300]:
        message.position[0] = np.nan
    with pytest.raises(RecordingError, match=r'/joint_states.position has no values from'):
        read(tmp_path, topics)


def test_messages_without_a_stamp_are_taken_at_their_receipt(tmp_path):
    topics, _ = bags.rig_topics()
    kind, messages = topics['/joint_states']
    unset = [(stamp, bags.joint(0, m.position, m.velocity)) for stamp, m in messages]
    topics['/joint_states'] = (kind, unset)
    series, notes = read(tmp_path, topics)
    assert notes == []
    t = series['position'].t - series['force'].t[0]
    np.testing.assert_allclose(t, np.arange(800) / 200 + LATE, atol=1e-9)
    received = {name for name, one in series.items() if one.is_received}
    assert received == {'pressure_command', 'force', 'position', 'velocity'}


def test_where_two_clocks_differ_all_are_taken_at_their_receipt(tmp_path):
    topics, _ = bags.rig_topics()
    kind, messages = topics['/joint_states']
    other = [(stamp, bags.joint(stamp - bags.EPOCH + 10**9, m.position)) for stamp, m in messages]
    topics['/joint_states'] = (kind, other)
    series, (note,) = read(tmp_path, topics)
    assert 'clock 1.75e+09 s behind' in note
    for name in ('position', 'pressure'):
        assert series[name].t[0] - series['force'].t[0] == pytest.approx(LATE, abs=1e-9)


def test_a_simulated_clock_may_tick_behind_the_stamps(tmp_path):
    """Receipts then are those of the clock's ticks; the headers stay the better stamps."""
    topics, _ = bags.rig_topics(duration=4.0)
    ticked = {}
    for topic, (kind, messages) in topics.items():
        ticked[topic] = (kind, [])
        for stamp, message in messages:
            now = (stamp - bags.EPOCH) // 10_000_000 * 10_000_000
            if hasattr(message, 'header'):
                since = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
                message.header = bags.header(since - bags.EPOCH + 1)
            ticked[topic][1].append((now, message))
    series, notes = read(tmp_path, ticked)
    assert notes == []
    np.testing.assert_allclose(np.diff(series['position'].t), 1 / 200, atol=1e-9)


def test_what_other_topics_and_fields_mean(tmp_path):
    ours, truth = bags.rig_topics()
    _, states = ours['/joint_states']
    arm = [
        (stamp, bags.joint(stamp, [9.0, 1e3 * m.position[0]], names=('base', 'elbow')))
        for stamp, m in states
    ]
    topics = {
        '/arm/joint_states': (bags.JOINT, arm),
        '/cell': (bags.WRENCH, [(s, bags.wrench(s, 1e-3 * m.data)) for s, m in ours['/force'][1]]),
        '/valve': (
            bags.FLOAT,
            [(s, bags.number(1e-5 * m.data)) for s, m in ours['/pressure_command'][1]],
        ),
    }
    rules = [
        '/arm/joint_states.position[elbow]=position_mm',
        '/arm/joint_states.velocity=ignore',
        '/arm/joint_states.effort=ignore',
        '/cell.wrench.force.z=force_kN',
        '/valve=pressure_command_bar',
    ]
    series, notes = read(tmp_path, topics, rules)
    assert notes == []
    np.testing.assert_allclose(series['position'].value, truth['position'][1])
    np.testing.assert_allclose(series['force'].value, truth['force'][1])
    np.testing.assert_allclose(series['pressure_command'].value, truth['command'][1])
    by_index = [rule.replace('[elbow]', '[1]') for rule in rules]
    other, _ = read_bag(tmp_path / 'bag', read_mapping(by_index))
    np.testing.assert_array_equal(other['position'].value, series['position'].value)


def two_joints():
    topics, _ = bags.rig_topics()
    _, states = topics['/joint_states']
    arm = [(s, bags.joint(s, [9.0, 1.0], names=('base', 'elbow'))) for s, _ in states]
    return {**topics, '/joint_states': (bags.JOINT, arm)}


def of_two_publishers(namespace=''):
    """Return the topics of a rig whose joint states another node publishes as well."""
    topics, truth = bags.rig_topics()
    kind, states = topics['/joint_states']
    other = [(s + 1, bags.joint(s + 1, [9.0], [8.0], [7.0], ['base'])) for s, _ in states[::2]]
    topics['/joint_states'] = (kind, sorted([*states, *other], key=lambda one: one[0]))
    return topics, truth


def test_of_two_publishers_the_joint_is_chosen_by_its_name(tmp_path):
    topics, truth = of_two_publishers()
    with pytest.raises(RecordingError, match=r'is of several joints \(pam, base\): say which'):
        read(tmp_path, topics)
    bag = tmp_path / 'bag'
    chosen = read_mapping(['/joint_states.position[pam]=position_m'])
    series, notes = read_bag(bag, chosen)
    assert notes == []
    check_rig(series, truth)  # also the velocity is that of this joint
    other, _ = read_bag(bag, read_mapping(['/joint_states.position[base]=position_m']))
    assert {*other['position'].value} == {9.0}
    assert {*other['velocity'].value} == {8.0}
    with pytest.raises(RecordingError, match=r'position\[knee\] is not there: .* name pam, base'):
        read_bag(bag, read_mapping(['/joint_states.position[knee]=position_m']))


def test_joints_whose_order_changes_are_chosen_by_their_names(tmp_path):
    topics, truth = bags.rig_topics()
    kind, states = topics['/joint_states']
    for k, (_, message) in enumerate(states):
        message.name = ['pam', 'base'] if k % 2 else ['base', 'pam']
        for values in (message.position, message.velocity):
            values.resize(2, refcheck=False)
            values[:] = [values[0], 9.0] if k % 2 else [9.0, values[0]]
    topics['/joint_states'] = (kind, states)
    bag = bags.write_bag(tmp_path / 'bag', topics)
    series, _ = read_bag(bag, read_mapping(['/joint_states.position[pam]=position_m']))
    check_rig(series, truth)
    with pytest.raises(RecordingError, match=r'position\[0\] is of several joints \(base, pam\)'):
        read_bag(bag, read_mapping(['/joint_states.position[0]=position_m']))


def test_a_few_exchanged_messages_are_sorted(tmp_path):
    topics, truth = bags.rig_topics()
    _, states = topics['/joint_states']
    for k in (100, 300):
        (a, first), (b, second) = states[k], states[k + 1]
        states[k], states[k + 1] = (a, second), (b, first)
    series, notes = read(tmp_path, topics)
    check_rig(series, truth)
    assert len(notes) == 2  # of the position and of the velocity
    assert notes[0].startswith('2 of 800 messages of /joint_states.position are out of order by')


def forces_as_wrenches():
    topics, _ = bags.rig_topics()
    _, forces = topics['/force']
    return {**topics, '/force': (bags.WRENCH, [(s, bags.wrench(s, m.data)) for s, m in forces])}


@pytest.mark.parametrize(
    ('topics', 'rules', 'words'),
    [
        (two_joints(), [], ['2 values (base, elbow)', "'/joint_states.position[NAME]="]),
        (
            two_joints(),
            ['/joint_states.position[knee]=position_m'],
            ['position[knee]', 'base, elbow'],
        ),
        (two_joints(), ['/joint_states.position[7]=position_m'], ['position[7]', '2 values']),
        (two_joints(), ['/joint_states.angle=position_m'], ['/joint_states.angle', "no 'angle'"]),
        (two_joints(), ['/joint_states.header=position_m'], ['not a number']),
        (forces_as_wrenches(), [], ['/force is a geometry_msgs/msg/WrenchStamped', 'force_N']),
        (bags.rig_topics()[0], ['/cell=force_N'], ["no topic '/cell'", '/pressure_command']),
        (bags.rig_topics()[0], ['/force=t_s'], ['/force', 'time in a bag']),
        (
            {'/chatter': (bags.FLOAT, [(bags.EPOCH, bags.number(1.0))])},
            [],
            ['/chatter', 'neither'],
        ),
        ({}, [], ['neither joint_states nor force']),
        (
            bags.rig_topics()[0],
            ['/joint_states.effort=force_N', '/force=ignore'],
            ['/joint_states.effort has no values'],
        ),
    ],
)
def test_what_is_refused(tmp_path, topics, rules, words):
    with pytest.raises(RecordingError) as caught:
        read(tmp_path, topics, rules)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize('kind', [bags.FLOAT, bags.JOINT, bags.FLUID])
@pytest.mark.parametrize('body', [b'', b'\0\1\0\0', b'\0\1\0\0' + b'\xff' * 7, b'rubbish' * 9])
def test_a_message_that_is_not_of_its_type_is_named(tmp_path, monkeypatch, kind, body):
    topics, _ = bags.rig_topics()
    whole = bags.STORE.serialize_cdr
    bodies = iter([body])

    def spoiled(message, one):
        return next(bodies, whole(message, one)) if one == kind else whole(message, one)

    monkeypatch.setattr(bags.STORE, 'serialize_cdr', spoiled)
    with pytest.raises(RecordingError, match=f'message 1 of .*: not a {kind}'):
        read(tmp_path, topics)


def test_a_receipt_that_no_clock_has(tmp_path):
    topics, _ = bags.rig_topics()
    kind, messages = topics['/force']
    topics['/force'] = (kind, [*messages, (2**63, bags.number(1.0))])
    with pytest.raises(
        RecordingError, match='/force has a message received at 9223372036854775808'
    ):
        read(tmp_path, topics)


def test_an_index_into_a_single_number(tmp_path):
    topics, _ = bags.rig_topics()
    with pytest.raises(RecordingError, match='has one value, without an index'):
        read(tmp_path, topics, ['/force.data[0]=force_N'])


def test_a_topic_of_another_type_can_be_left_out(tmp_path):
    series, _ = read(tmp_path, forces_as_wrenches(), ['/force=ignore'])
    assert sorted(series) == ['position', 'pressure', 'pressure_command', 'velocity']
