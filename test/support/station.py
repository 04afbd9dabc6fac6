# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulator, a controller and a recorder as processes of which each can fail and come again.

What the load did is judged by the joint states, which the simulator publishes without noise.
"""

import os
import signal
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
import yaml
from sensor_msgs.msg import FluidPressure, JointState

from pam_ros.control.reference.shaping import Shape
from pam_ros.errors import PamError
from support.bags import contents
from support.control_watch import Watch, stamp
from support.harness import Program

# A busy machine holds messages up for less than this; what fails is away for longer.
AWAY = 2.0  # s
RATE = 250.0  # Hz
PARAMETERS = {
    'pam_sim': {'publish_rate': RATE, 'command_timeout': AWAY, 'initial.pressure': 250e3},
    'pam_control': {'rate': RATE, 'command_timeout': AWAY, 'state_timeout': AWAY},
}
ASKED = 'pam_control/state'  # is recorded in addition to the topics of each rig
RECORDED = [
    *('/damping', '/force', '/joint_states', f'/{ASKED}', '/pressure', '/pressure_command'),
    '/stiffness',
]
HELD = 0.05, 0.06  # m, the two positions that the load is moved between
JUMP = 0.5e-3  # m that the load may move in the second after control begins
# m/s of a load that is moved. The law may overshoot by half, also if a busy machine stops the rig
# meanwhile (test_late_states.py).
FASTEST = 1.5 * Shape().max_velocity
STILL = 1e-3  # m/s below which a load is at rest
AMBIENT, VENTED = 101325.0, 1e3  # Pa, and gauge Pa below which a muscle is vented
STOPPING = 0.05  # s at its speed in which the law stops a load that was falling


class Station:
    """The three programs, and their messages; ``bag`` is the one that is recorded now."""

    def __init__(self, peer, folder: Path, **parameters):
        """Start nothing yet; *parameters* are given to all programs."""
        self.peer, self.folder, self.parameters = peer, folder, parameters
        self.watch = Watch(peer)
        self.states = peer.collect(JointState, 'joint_states')
        self.pressures = peer.collect(FluidPressure, 'pressure')
        self.programs = {}
        self.bag = None
        self._bags = 0
        self._stack = ExitStack()

    def __enter__(self):
        """Start all."""
        with ExitStack() as stack:  # they are stopped where one of them does not come
            stack.callback(self._stack.close)
            for name in ('pam_sim', 'pam_control', 'pam_record'):
                self.start(name)
            self.controls_again()
            self.is_commanded()
            stack.pop_all()
        return self

    def __exit__(self, *_):
        """Stop all."""
        self._stack.close()

    def start(self, name):
        """Start a program, after the one of that name has ended."""
        given = {**PARAMETERS.get(name, {}), **self.parameters}
        arguments = ()
        if name == 'pam_record':
            self._bags += 1
            self.bag = self.folder / f'bag_{self._bags}'
            arguments = ('--', '-o', str(self.bag), ASKED)
            options = [word for k, v in given.items() for word in ('-p', f'{k}:={v}')]
            arguments, given = (*options, *arguments), {}
        self.programs[name] = self._stack.enter_context(
            Program(name, *arguments, parameters=given)
        )

    def end(self, name, kind):
        """End a program with a signal, and return its exit code."""
        program = self.programs[name]
        os.kill(program.process.pid, kind)
        return program.wait()

    @contextmanager
    def stopped(self, name):
        """Stop a program meanwhile as a debugger does."""
        pid = self.programs[name].process.pid
        os.kill(pid, signal.SIGSTOP)
        try:
            yield
        finally:
            os.kill(pid, signal.SIGCONT)

    # Waiting -------------------------------------------------------------------------------

    def is_recording(self):
        """Wait until the recorder has messages of all topics on the disk."""

        def has_all():
            return len([count for count in self.counts().values() if count]) == len(RECORDED)

        try:
            self.peer.until(has_all, 'a bag with all topics')
        except PamError as error:
            raise AssertionError(
                f'{error}: {self.counts()}, {self.programs["pam_record"].output}'
            ) from error

    def counts(self):
        """Return how many messages of each topic the recorder has on the disk."""
        file = self.bag / 'metadata.yaml'
        if not file.exists():
            return {}
        about = yaml.safe_load(file.read_text())['rosbag2_bagfile_information']
        return {
            one['topic_metadata']['name']: one['message_count']
            for one in about['topics_with_message_count']
        }

    def mark(self):
        """Return which state and which terms come next."""
        return len(self.states), len(self.watch.terms)

    def vents(self):
        """Wait until the controller is blind and lowers the pressure.

        If the simulator was killed, it does so for 0.2 s only, a tenth of its time to vent.
        """
        held = self.watch.commands[-1].data
        self.peer.until(lambda: self.watch.commands[-1].data < 0.95 * held, 'a command to vent')

    def is_let_down(self):
        """Wait until the valve has vented the muscle and the load rests."""
        self.peer.until(
            lambda: self.pressures[-1].fluid_pressure - AMBIENT < VENTED, 'a vented muscle'
        )
        self.rests()

    def rests(self):
        """Wait until the load has been at rest for half a second of its own time."""
        count = round(0.5 * RATE)

        def does():
            last = self.states[-count:]
            return len(last) == count and all(abs(one.velocity[0]) < STILL for one in last)

        begin = len(self.states)
        self.peer.until(lambda: len(self.states) > begin + count and does(), 'rest')

    def controls_again(self, since=(0, 0)):
        """Wait for states and for control that is newer; return how far the load then jumped.

        That is the largest way in m, in the second after control began, from where the load was
        then. A load that fell until then, because its muscle was vented, is allowed to stop.
        """
        first_state, first_terms = since
        peer, terms = self.peer, self.watch.terms
        peer.until(lambda: len(self.states) > first_state, 'a state')
        seen = stamp(self.states[first_state])

        def later():
            return next((stamp(one) for one in terms[first_terms:] if stamp(one) >= seen), None)

        began = peer.until(later, 'control')
        end = began + 1.0
        for messages in (self.states, self.pressures):
            peer.until(lambda m=messages: m and stamp(m[-1]) > end, 'a second of control')
        states = [one for one in self.states[first_state:] if stamp(one) <= end]
        way = [one.position[0] for one in states if stamp(one) >= began]
        return max(abs(one - way[0]) for one in way) - STOPPING * self._fall(states)

    def _fall(self, states):
        """Return the highest speed in m/s that a load had in *states* while it was vented."""
        vented = {stamp(one) for one in self.pressures if one.fluid_pressure - AMBIENT < VENTED}
        return max((abs(one.velocity[0]) for one in states if stamp(one) in vented), default=0.0)

    def is_commanded(self):
        """Wait until the simulator says that commands arrive.

        The middleware connects either direction for itself, and tries again after seconds if that
        was lost. Meanwhile the controller would press against a load that no command moves.
        """

        def is_said():
            told = (status for array in self.watch.arrays for status in array.status)
            return any(
                status.name == 'pam_sim: commands' and status.message == 'commanded'
                for status in told
            )

        self.peer.until(is_said, 'the simulator to be commanded')

    def is_held(self):
        """Say whether the load is at one of the positions that it is moved between."""
        return any(abs(self.states[-1].position[0] - one) < JUMP for one in HELD)

    def move(self):
        """Move the load to the other position; check that it comes there within the limits."""
        goal = max(HELD, key=lambda one: abs(one - self.watch.latest('reference')))
        first = len(self.states)

        def is_there():
            # Said again and again, as one who drives a rig would: some are refused at a start.
            if abs(self.watch.latest('reference') - goal) > 1e-6:
                self.watch.refer(goal)
            return abs(self.states[-1].position[0] - goal) < JUMP

        self.peer.until(is_there, f'the load at {goal} m')
        self.rests()
        speed = fastest(self.states[first:])
        assert speed < FASTEST, f'{speed} m/s on the way to {goal} m'

    # What was recorded ---------------------------------------------------------------------

    def recorded(self, bag):
        """Return the messages of a bag, after a check that all their numbers are finite."""
        found = contents(bag)
        assert sorted(found) == RECORDED
        for topic, messages in found.items():
            for _, message in messages:
                assert all(np.isfinite(numbers(message))), (topic, message)
        return found


def numbers(message):
    """Return the numbers that a message of a rig carries."""
    if hasattr(message, 'position'):
        return [*message.position, *message.velocity, *message.effort]
    return [message.fluid_pressure if hasattr(message, 'fluid_pressure') else message.data]


def fastest(states):
    """Return the highest speed in m/s."""
    return max(abs(one.velocity[0]) for one in states)
