# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` and ``pam_control`` in lockstep, each a process, with a client between them.

The client receives each state and forwards each command. Therefore simulated time waits for the
client, too, and stands still while the client keeps a command. The result does not depend on
the load of the machine.
"""

import math
from contextlib import ExitStack
from types import TracebackType
from typing import Any

from rclpy.duration import Duration
from sensor_msgs.msg import JointState

from pam_ros.demo.stage import DemoStage
from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.rig_log import seconds
from pam_ros.processes.children import Program

STILL = 1e-6  # change of a term up to which it counts as at rest
RATE = 250.0  # Hz of states and commands
PATIENCE = 600.0  # s that a busy machine may need for one of the motions, or to compile kernels


class LockstepPair:
    """Both programs in the namespace of a stage; ``states`` and ``terms`` are their messages."""

    def __init__(
        self,
        stage: DemoStage,
        rig: dict[str, Any],
        controller: dict[str, Any],
        command: tuple[type, str],
    ) -> None:
        """Prepare both with their own parameters; *command* is the type and topic of commands."""
        self._space, self._command = stage.namespace, command
        self._rig = {**rig, 'time_mode': 'lockstep', 'publish_rate': RATE}
        self._controller = {**controller, 'use_sim_time': True, 'rate': RATE}
        self._stack = ExitStack()
        self._end = 0.0  # simulated time in s at which time stands still
        self._held: Any = None  # the command that is not forwarded meanwhile

    def __enter__(self) -> 'LockstepPair':
        """Start both programs."""
        # Their /clock is in their namespace: no other node follows it.
        space, (kind, topic) = self._space, self._command
        where = ('-r', f'__ns:={space}', '-r', f'/clock:={space}/clock')
        remap = ('-r', f'{topic}:=requested_command')
        sim = Program('pam_sim', *where, parameters=self._rig)
        control = Program('pam_control', *where, *remap, parameters=self._controller)
        self._programs = [self._stack.enter_context(one) for one in (sim, control)]
        self.client = self._stack.enter_context(Client(space, PATIENCE))
        self.states = self.client.collect(JointState, 'joint_states')
        self.terms = self.client.collect(JointState, 'pam_control/state')
        self._commands = self.client.node.create_publisher(kind, topic, 10)
        self.client.node.create_subscription(kind, 'requested_command', self._pass_on, 10)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop both programs."""
        self._stack.close()

    def _pass_on(self, command: Any) -> None:
        if self.states and seconds(self.states[-1]) >= self._end:
            self._held = command
        else:
            self._commands.publish(command)

    def _until(self, condition: Any, what: str) -> None:
        """Wait for *condition*; raise PamError if a program has ended."""

        def is_so() -> bool:
            for program in self._programs:
                if not program.is_running:
                    raise PamError(f'{program.name} ended: {program.output.strip()}')
            return bool(condition())

        self.client.until(is_so, what)

    def begin(self, *received: list[Any]) -> None:
        """Wait for the first command, and for a message in each of the lists *received*."""
        # Not for terms: they arrive once with the first command, which may be before we subscribe.
        lists = (self.states, *received)
        self._until(lambda: self._held is not None and all(lists), 'the first command')

    def stop_after(self, duration: float) -> float:
        """Let simulated time pass for *duration* s, then let it stand still; return when, in s."""
        self._go_on(seconds(self.states[-1]) + duration)
        self._until(lambda: self._held is not None, f'{duration:g} s to pass')
        return seconds(self.states[-1])

    def publish(self, message: Any, topic: str, term: str = 'reference') -> None:
        """Publish a message that changes *term*, and let time continue until *term* changes."""
        k = list(self.terms[-1].name).index(term)
        rest = self.terms[-1].position[k]
        self.client.publish(message, topic)
        self.client.delivered(topic, Duration(seconds=PATIENCE))
        self._go_on(math.inf)
        self._until(lambda: abs(self.terms[-1].position[k] - rest) > STILL, f'{term} to change')

    def _go_on(self, end: float) -> None:
        """Let time continue until *end* s."""
        self._end, held, self._held = end, self._held, None
        if held is not None:
            self._commands.publish(held)
