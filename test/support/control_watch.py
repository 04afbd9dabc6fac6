# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A test that watches a controller over DDS, and one that stands in for its rig."""

import math

import numpy as np
from builtin_interfaces.msg import Duration
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import TERMS

# For a controller in lockstep whose terms are all to be received, however late.
LOSE_NO_TERMS = {'qos_overrides./pam_control/state.publisher.depth': 20_000}
SOON = 0.05  # s of simulated time in which a setting shows, but on a busy machine
LONGEST = 10.0  # s of it that a setting may take to show
QUIET = 0.2  # s without a message after which none is under way any more


class Watch:
    """What a controller commands, its terms and its diagnostics."""

    def __init__(self, peer, names=TERMS, kind=Float64, topic='pressure_command'):
        self.peer, self.names = peer, names
        self.terms = peer.collect(JointState, 'pam_control/state')
        self.commands = peer.collect(kind, topic)
        self.arrays = peer.collect(DiagnosticArray, '/diagnostics')

    def latest(self, name):
        return self.terms[-1].position[self.names.index(name)]

    def refer(self, position):
        self.peer.publish(Float64(data=position), 'position_reference')

    def lead(self, action, seconds, term='reference'):
        """Call *action*; return the terms of *seconds* s from the first change of *term* on.

        In lockstep: time stands still during the action, and in intervals until all earlier terms
        have been received, so that a late subscriber misses nothing.
        """
        self._stop()
        i, k = self.names.index(term), len(self.terms) - 1
        rest = self.terms[k].position[i]
        action()
        begin = stamp(self.terms[k])
        while self.terms[k].position[i] == rest:
            assert stamp(self.terms[k]) < begin + LONGEST, f'{term} stays at {rest}'
            self._pass(seconds + SOON)
            while k < len(self.terms) - 1 and self.terms[k].position[i] == rest:
                k += 1
        while (left := stamp(self.terms[k]) + seconds - stamp(self.terms[-1])) > 0.0:
            self._pass(left)
        self.peer.call(SetBool, 'pam_sim/pause', data=False)
        return self.terms[k:]

    def _pass(self, seconds):
        """Let so much time pass, at least, and stop."""
        end = stamp(self.terms[-1]) + seconds
        self.peer.call(SetBool, 'pam_sim/pause', data=False)
        self.peer.until(lambda: stamp(self.terms[-1]) >= end, f'{seconds} s')
        self._stop()

    def _stop(self):
        """Let time stand still, and hear all that was before."""
        self.peer.call(SetBool, 'pam_sim/pause', data=True)
        count = -1
        while count != (count := len(self.terms)):
            self.peer.work(QUIET)

    def rests(self, term, count=100):
        """Wait until a term has not changed for so many messages; return it."""
        i = self.names.index(term)

        def found():
            last = self.terms[-count:]
            return len(last) == count and last[0].position[i] == last[-1].position[i]

        self.peer.until(found, f'{term} to rest')
        return self.latest(term)

    def status(self, condition, what, part='control'):
        """Wait for a status of this *part* that fulfils *condition*."""

        def find():
            for array in reversed(self.arrays):
                for status in array.status:
                    if status.name == f'pam_control: {part}' and condition(status):
                        return status
            return None

        return self.peer.until(find, what)

    def stops_publishing(self):
        """Wait until no command comes from one word of the diagnostics to the next but one."""
        count = -1
        while count != (count := len(self.commands)):
            self.peer.more(self.arrays, 2)

    def steady_command(self):
        """Return what is commanded once it is the same for two words of the diagnostics."""
        last = None
        while last != (last := self.commands[-1].data):
            self.peer.more(self.arrays, 2)
        return last

    def begin(self):
        """Wait until it controls; return where it holds the load."""
        self.peer.more(self.terms, 3)
        self.peer.until(lambda: self.commands, 'a command')
        return self.latest('reference')


class Simulation:
    """Joint states that the test publishes itself: of a load that does not move."""

    def __init__(self, peer, name='pam'):
        self.peer, self.name, self.count = peer, name, 0

    def tell(self, position=0.06, **more):
        self.count += 1
        message = JointState(name=[self.name], position=[position], **more)
        message.header.stamp.sec = 10 + self.count
        self.peer.publish(message, 'joint_states')

    def tell_until(self, condition, what, position=0.06):
        def tell():
            self.tell(position)
            return condition()

        return self.peer.until(tell, what)


def stamp(message):
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


def columns(messages, names=TERMS):
    """Return the times in s since the first of *messages*, and each term by its name."""
    t = np.array([stamp(m) for m in messages])
    values = np.array([m.position for m in messages])
    return t - t[0], {name: values[:, i] for i, name in enumerate(names)}


def sine(middle, swing, joint='pam', end=4.0):
    """Return a 0.5 Hz sine as a trajectory that begins and ends softly, as robot stacks send."""
    points = []
    for t in np.linspace(0.02, end, round(end / 0.02)):
        share = min(t, end - t, 1.0)
        at = middle + swing * math.sin(0.5 * math.pi * share) ** 2 * math.sin(math.pi * t)
        time = Duration(sec=int(t), nanosec=int(t % 1.0 * 1e9))
        points.append(JointTrajectoryPoint(positions=[at], time_from_start=time))
    return JointTrajectory(joint_names=[joint], points=points)
