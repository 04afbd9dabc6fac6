# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_plot`` as a process next to a simulator: its page, its PNG file, and what it refuses."""

import http.client
import json
import subprocess
import sys

import matplotlib.image
import numpy as np
import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.ends import check_refusals
from support.harness import Program, lose_nothing

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

PAIR = {'muscles': ['flexor', 'extensor'], 'joint': 'antagonistic', 'publish_rate': 50.0}
ONE = {'initial.pressure': 250e3, 'publish_rate': 50.0}
WAIT = ('--wait', '240')  # s; only a program that is broken waits so long


def address_of(peer, program):
    """Return host and port of the page once the program has printed them."""
    peer.until(lambda: 'open http://' in program.output or not program.is_running, 'the address')
    return program.output.partition('open http://')[2].partition('/')[0]


def data_of(address):
    connection = http.client.HTTPConnection(address, timeout=60.0)
    try:
        connection.request('GET', '/data')
        return json.loads(connection.getresponse().read())
    finally:
        connection.close()


def names_of(data):
    return {one['title']: [line['name'] for line in one['lines']] for one in data['panels']}


def test_the_page_shows_a_simulator(peer):
    with Program('pam_sim', parameters=ONE), Program('pam_plot') as program:
        reference = peer.node.create_publisher(Float64, 'position_reference', 10)
        command = peer.node.create_publisher(Float64, 'pressure_command', 10)
        address = address_of(peer, program)

        def all_is_shown():
            reference.publish(Float64(data=0.05))
            command.publish(Float64(data=2e5))
            found = data_of(address)
            return found if sum(map(len, names_of(found).values())) == 7 else None

        found = peer.until(all_is_shown, 'all lines on the page')
        program.interrupt()
        assert program.wait() == 0
    assert names_of(found) == {
        'position, m or rad': ['position_reference', 'pam'],
        'pressure (gauge), Pa': ['pressure_command', 'pressure'],
        'force, N': ['force'],
        'stiffness, N/m': ['stiffness'],
        'damping, N·s/m': ['damping'],
    }
    assert found['end'] - found['start'] == pytest.approx(20.0)
    position, pressure, *_ = found['panels']
    assert set(position['lines'][0]['value']) == {0.05}
    assert set(pressure['lines'][0]['value']) == {2e5}
    # The muscle starts at rest at this gauge pressure.
    assert pressure['lines'][1]['value'][0] == pytest.approx(250e3, rel=0.2)


def test_a_png_file_of_a_joint_of_two_muscles(peer, tmp_path):
    png = tmp_path / 'rig.png'
    arguments = ('-r', '__ns:=/arm', '--', '--png', str(png), '--seconds', '1', *WAIT)
    with (
        Program('pam_sim', '-r', '__ns:=/arm', parameters=PAIR),
        Program('pam_plot', *arguments) as program,
    ):
        peer.until(lambda: not program.is_running, 'the end of the program')
        assert program.wait() == 0, program.output
        assert program.output.splitlines()[-1] == f'wrote {png}'
    pixels = matplotlib.image.imread(png)
    assert pixels.shape[1] == 2160
    assert pixels[..., :3].min() < 0.5
    assert list(tmp_path.iterdir()) == [png]


def test_ctrl_c_draws_what_was_received(peer, tmp_path):
    png = tmp_path / 'rig.png'
    arguments = ('--', '--png', str(png), '--seconds', '3000', *WAIT)
    with Program('pam_plot', *arguments) as program:
        states = peer.node.create_publisher(JointState, 'joint_states', 10)
        peer.until(states.get_subscription_count, 'the program')
        state = JointState(name=['pam'], position=[0.01])
        for _ in range(20):
            states.publish(state)
            peer.work(0.02)
        program.interrupt()
        code = program.wait()
        # On a slow machine the signal may come before the first message.
        assert (code, png.exists()) in ((0, True), (2, False)), program.output


def test_nothing_published_is_one_sentence(tmp_path):
    png = tmp_path / 'rig.png'
    with Program(
        'pam_plot', '-r', '__ns:=/arm', '--', '--png', str(png), '--wait', '1'
    ) as program:
        assert program.wait() == 2
        last = program.output.splitlines()[-1]
    assert last.startswith('pam_plot: nothing was received for 1 s: no node publishes ')
    assert '/arm/joint_states' in last
    assert not png.exists()


def test_a_page_names_what_is_missing_and_continues_to_wait(peer):
    other = peer.node.create_publisher(JointState, 'force', 10)
    with Program('pam_plot') as program:
        address = address_of(peer, program)
        note = peer.until(lambda: data_of(address)['note'], 'the note on the page')
        sentence = 'no topic of the rig has the type that is drawn: '
        peer.until(lambda: sentence in program.output, 'the line in the log')
        states = peer.node.create_publisher(JointState, 'joint_states', 10)

        def is_shown():
            states.publish(JointState(name=['knee'], position=[0.5]))
            return 'position, m or rad' in names_of(data_of(address))

        peer.until(is_shown, 'the joint')
        peer.until(lambda: not data_of(address)['note'] or is_shown(), 'the end of the note')
    assert note
    peer.node.destroy_publisher(other)


def test_time_is_that_of_clock_where_it_is_simulated(peer):
    with Program('pam_plot', '-p', 'use_sim_time:=true') as program:
        address = address_of(peer, program)
        states = peer.node.create_publisher(JointState, 'joint_states', 10)
        clock = peer.node.create_publisher(Clock, '/clock', 10)
        peer.until(lambda: '/clock' in data_of(address)['note'], 'the note on the clock')
        now = Clock()

        def shows(seconds, since):
            """Publish at this simulated time until the page has it."""
            now.clock.sec = seconds
            clock.publish(now)
            states.publish(JointState(name=['knee'], position=[0.5]))
            found = data_of(address)
            return found if found['panels'] and found['now'] == seconds - since else None

        peer.until(lambda: shows(100, 100), 'the first state')
        peer.until(lambda: shows(107, 100), 'a later one')
        # Time that goes back begins again.
        found = peer.until(lambda: shows(5, 5), 'the one after a reset')
    (line,) = found['panels'][0]['lines']
    assert set(line['t']) == {0.0}


PERIOD = 0.02  # s of simulated time
LOCKSTEP = {
    'time_mode': 'lockstep',
    'publish_rate': 1.0 / PERIOD,
    'clock_rate': 1.0 / PERIOD,
    **lose_nothing(),
}


def stamp_of(state):
    return state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec


def answer_states(peer, states, commands, count):
    """Answer *count* states of a simulator in lockstep, each with another pressure, at leisure."""
    after = 0.0
    for k in range(count):

        def is_next(after=after):
            return states[-1] if states and stamp_of(states[-1]) > after else None

        after = stamp_of(peer.until(is_next, 'the next state'))
        peer.work(0.01)  # on the wall; the simulator waits
        commands.publish(Float64(data=1e5 + 1e3 * k))
    peer.until(lambda: stamp_of(states[-1]) > after, 'the last state')


def test_a_rig_in_lockstep_is_drawn_in_its_time_and_commands_at_their_states(peer):
    count = 40
    commands = peer.node.create_publisher(Float64, 'pressure_command', 10)
    with Program('pam_plot') as program:
        address = address_of(peer, program)

        def is_first_shown():
            found = data_of(address)
            titles = len(names_of(found))
            return found['now'] == 0.0 and titles >= 3 and commands.get_subscription_count() > 1

        for _ in range(2):  # a simulation that starts again begins a new plot
            states = peer.collect(JointState, 'joint_states')
            with Program('pam_sim', parameters=LOCKSTEP):
                # The first state is repeated until it is answered.
                peer.until(is_first_shown, 'the first state on the page')
                answer_states(peer, states, commands, count)

                def is_complete():
                    found = data_of(address)
                    return found if abs(found['now'] - count * PERIOD) < 1e-6 else None

                found = peer.until(is_complete, 'the last state on the page')
            lines = {line['name']: line for one in found['panels'] for line in one['lines']}
            assert found['note'] == ''
            assert lines['pam']['t'] == pytest.approx(np.arange(count + 1) * PERIOD)
            # A command has no stamp: it acts from the state on that it answers.
            command, pressure = lines['pressure_command'], lines['pressure']
            assert command['t'] == pytest.approx(np.arange(count) * PERIOD)
            assert command['value'] == pytest.approx(1e5 + 1e3 * np.arange(count))
            assert pressure['value'][1:] == pytest.approx(command['value'])


def test_a_node_on_the_wall_next_to_a_simulated_one_is_one_sentence(peer):
    with Program('pam_plot') as program:
        address = address_of(peer, program)
        states = peer.node.create_publisher(JointState, 'joint_states', 10)
        terms = peer.node.create_publisher(JointState, 'pam_control/state', 10)

        def note():
            state = JointState(name=['knee'], position=[0.5])
            state.header.stamp.sec = 5
            states.publish(state)
            term = JointState(name=['reference'], position=[0.6])
            term.header.stamp = peer.node.get_clock().now().to_msg()
            terms.publish(term)
            found = data_of(address)
            return found if 'simulated time' in found['note'] and found['now'] > 0.5 else None

        found = peer.until(note, 'the note on the page')
        peer.until(lambda: note() and found['note'] in program.output, 'the line in the log')
    # All are on the clock of this machine, side by side.
    ends = [line['t'][-1] for one in found['panels'] for line in one['lines']]
    assert len(ends) == 2
    assert all(0.0 <= found['now'] - end <= 60.0 for end in ends)
    assert found['end'] - found['start'] == pytest.approx(20.0)


WITHOUT_BOKEH = """
import runpy, sys
sys.modules['bokeh'] = None
runpy.run_module('pam_ros.cli.pam_plot', run_name='__main__', alter_sys=True)
"""


def test_a_page_of_a_rig_without_bokeh_is_one_sentence():
    command = [sys.executable, '-c', WITHOUT_BOKEH]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=240)
    assert done.returncode == 2
    last = done.stderr.splitlines()[-1]
    assert last.startswith('pam_plot: the page is drawn by the Python package bokeh, which is not')
    assert 'Traceback' not in done.stderr


def test_bad_arguments_end_it_with_a_sentence(tmp_path):
    there = tmp_path / 'folder.png'
    there.mkdir()
    refused = [
        (['--', '--png', str(there)], ['is a folder']),
        (['--', '--png', str(tmp_path / 'rig.jpg')], ['rig.jpg', '.png']),
        (['--', '--png', str(tmp_path / 'rig.png'), '--port', '8000'], ['--port', '--png']),
        (['--', '--seconds', 'nan'], ['--seconds nan', '0.5 to 3600 s']),
        (['--', '--seconds', '0'], ['--seconds 0', '0.5 to 3600 s']),
        (['--', '--wait', '3'], ['--wait is for --png']),
        (['--', '--port', '-1'], ['--port -1', '1 to 65535']),
        (['--', '--namespace', 'left'], ['--namespace is for --bag', '__ns']),
        (['--', '--nonsense'], ['--nonsense']),
    ]
    check_refusals('pam_plot', refused)
    assert list(tmp_path.iterdir()) == [there]
