# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The first ten minutes without ``ros2``: each line of ``.venv/bin`` on the page, one by one."""

from contextlib import ExitStack
from pathlib import Path

import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from support.commanding import WAIT
from support.harness import Program
from support.pages import DOCS, commands, text_of

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

PAGE = DOCS / 'tutorials' / 'muscle_in_ten_minutes.md'
LINES = [
    [Path(words[0]).name, *words[1:]]
    for words in commands(PAGE)
    if words[0].startswith('.venv/bin/')
]
AT_REST = 2.0  # s, longer than the time-out after which the muscle vents
STILL = 5e-6  # m
CLOSE = 5e-4  # m


class Rig:
    """The newest state of the simulator.

    A queue would hold states from before a command, and a reliable subscriber on a busy machine
    has to wait for states that were lost.
    """

    def __init__(self, peer):
        self._peer = peer
        self._newest = None
        newest = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        peer.node.create_subscription(JointState, 'joint_states', self._take, newest)

    def _take(self, state):
        self._newest = state

    def position(self):
        """Return the position in the next state."""
        self._newest = None
        return self._peer.until(lambda: self._newest, 'a state').position[0]

    def rest(self):
        """Wait until the load has been at rest for ``AT_REST``, and return its position."""
        rest, begun = self.position(), seconds(self._newest)

        def has_rested():
            nonlocal rest, begun
            position, now = self.position(), seconds(self._newest)
            if abs(position - rest) > STILL:
                rest, begun = position, now
            return now > begun + AT_REST

        self._peer.until(has_rested, 'the load to rest')
        return rest


def seconds(state):
    return state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec


def test_the_lines_lead_to_the_results_on_the_page(peer):
    page = text_of(PAGE)
    rig = Rig(peer)
    lines, rests = iter(LINES), []

    def started(name):
        """Return the program of the next line, which is *name*."""
        program, *words = next(lines)
        assert program == name
        given = words[1:] if words[:1] == ['--ros-args'] else ['--', *words]
        patience = WAIT if name == 'pam_command' else ()
        return running.enter_context(Program(name, *given, *patience))

    def command(action):
        """Run the next line, which is an action of pam_command, until it ends."""
        program = started('pam_command')
        assert action in program.process.args
        peer.until(lambda: not program.is_running, f'the end of pam_command {action}')
        assert program.wait() == 0, program.output

    with ExitStack() as running:
        started('pam_sim')
        pressure = started('pam_command')
        peer.until(lambda: 'until Ctrl-C' in pressure.output, 'the pressure')
        plot = started('pam_plot')
        peer.until(lambda: 'open http://' in plot.output, 'the address')
        assert f'{rig.rest():.4f} m' in page
        pressure.interrupt()
        assert pressure.wait() == 0
        assert f'{rig.rest():.4f} m' in page
        command('set')
        command('set')
        for _ in range(4):
            command('pressure')
            rests.append(1e3 * rig.rest())
        command('set')
        peer.until(lambda: rig.position() < 0.0, 'the muscle to vent')
        started('pam_control')
        peer.more(peer.collect(JointState, 'pam_control/state'))  # it controls
        command('position')
        peer.until(lambda: abs(rig.rest() - 0.06) < CLOSE, 'the load at 60 mm')
    assert [*lines] == []
    assert str([round(one, 1) for one in rests[1:]]).replace(',', '') in page
