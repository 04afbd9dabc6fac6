# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The first ten minutes without ``ros2``: each line of ``.venv/bin`` on the page, one by one."""

from contextlib import ExitStack
from pathlib import Path

import pytest
from sensor_msgs.msg import JointState

from support.harness import Program
from support.pages import DOCS, commands, text_of

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

PAGE = DOCS / 'tutorials' / 'muscle_in_ten_minutes.md'
LINES = [
    [Path(words[0]).name, *words[1:]]
    for words in commands(PAGE)
    if words[0].startswith('.venv/bin/')
]
# Few states: a test that falls behind reads those from before a command.
QUICK = {'time_mode': 'scaled', 'speed_factor': 4.0, 'publish_rate': 100.0}
FOLLOWS = {'use_sim_time': True, 'rate': 100.0}
SETTLED = 8.0  # s after which the load rests


def seconds(state):
    return state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec


def later(peer, states):
    """Return the state after a load has had the time to come to rest."""
    peer.more(states)
    begun = seconds(states[-1])
    peer.until(lambda: seconds(states[-1]) > begun + SETTLED, 'the load to rest')
    return states[-1]


def test_the_lines_lead_to_the_results_on_the_page(peer):
    page = text_of(PAGE)
    states = peer.collect(JointState, 'joint_states')
    lines, rests = iter(LINES), []

    def started(name, parameters):
        """Return the program of the next line, which is *name*, with further *parameters*."""
        program, *words = next(lines)
        assert program == name
        given = words[1:] if words[:1] == ['--ros-args'] else ['--', *words]
        return running.enter_context(Program(name, *given, parameters=parameters))

    def command(action):
        """Run the next line, which is an action of pam_command, until it ends."""
        program = started('pam_command', None)
        assert action in program.process.args
        peer.until(lambda: not program.is_running, f'the end of pam_command {action}')
        assert program.wait() == 0, program.output

    with ExitStack() as running:
        started('pam_sim', QUICK)
        pressure = started('pam_command', None)
        peer.until(lambda: 'until Ctrl-C' in pressure.output, 'the pressure')
        plot = started('pam_plot', None)
        peer.until(lambda: 'open http://' in plot.output, 'the address')
        assert f'{later(peer, states).position[0]:.4f} m' in page
        pressure.interrupt()
        assert pressure.wait() == 0
        assert f'{later(peer, states).position[0]:.4f} m' in page
        command('set')
        command('set')
        for _ in range(4):
            command('pressure')
            rests.append(1e3 * later(peer, states).position[0])
        command('set')
        peer.until(lambda: states[-1].position[0] < 0.0, 'the muscle to vent')
        started('pam_control', FOLLOWS)
        peer.more(peer.collect(JointState, 'pam_control/state'))  # it controls
        command('position')
        assert later(peer, states).position[0] == pytest.approx(0.06, abs=5e-4)
    assert [*lines] == []
    assert str([round(one, 1) for one in rests[1:]]).replace(',', '') in page
