# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` and ``pam_control`` in lockstep, each a process, and a listener who misses nothing.

Simulated time stands still while something is told, and until all that was before is heard: it
does not run ahead of a listener who is late, so that a busy machine changes nothing.
"""

from contextlib import ExitStack
from types import TracebackType
from typing import Any

from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool

from pam_ros.errors import PamError
from pam_ros.nodes.chapters.stage import Stage
from pam_ros.nodes.children import Program
from pam_ros.nodes.client import Client
from pam_ros.nodes.rig_log import seconds

STILL = 1e-6  # change of a term by which nothing has begun yet
HISTORY = 30_000  # messages kept for a listener who is late: a minute at 500 Hz
PATIENCE = 600.0  # s that a busy machine may take for one of the moves


class Duet:
    """Both programs in the namespace of a stage; ``states`` and ``terms`` are what they say."""

    def __init__(
        self, stage: Stage, rig: dict[str, Any], told: dict[str, Any], topics: tuple[str, ...] = ()
    ) -> None:
        """Make them with parameters of their own; of *rig* no message on *topics* is lost."""
        self._space = stage.namespace
        self._rig = {**rig, 'time_mode': 'lockstep'}
        for topic in ('joint_states', *topics):
            self._rig[f'qos_overrides.{self._space}/{topic}.publisher.depth'] = HISTORY
        # The pressure is told, and control begins once both are listened to.
        follows = {'use_sim_time': True, 'start_enabled': False, 'pressure_wait': PATIENCE / 10}
        self._told = {**told, **follows}
        self._told[f'qos_overrides.{self._space}/pam_control/state.publisher.depth'] = HISTORY
        self._stack = ExitStack()

    def __enter__(self) -> 'Duet':
        """Start them."""
        # Their /clock is nobody else's business.
        space = self._space
        where = ('-r', f'__ns:={space}', '-r', f'/clock:={space}/clock')
        self.client = self._stack.enter_context(Client(space, PATIENCE))
        self._service = self.client.node.create_client(SetBool, 'pam_sim/pause')
        self.states = self.client.collect(JointState, 'joint_states')
        self.terms = self.client.collect(JointState, 'pam_control/state')
        sim = Program('pam_sim', *where, parameters=self._rig)
        control = Program('pam_control', *where, parameters=self._told)
        self._programs = [self._stack.enter_context(one) for one in (sim, control)]
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop them."""
        self._stack.close()

    def passed(self, end: float) -> bool:
        """Say whether both have told of a time after *end* s; PamError where one has ended."""
        for program in self._programs:
            if not program.is_running:
                raise PamError(f'{program.name} ended: {program.output.strip()}')
        is_heard = bool(self.terms and self.states)
        return is_heard and min(seconds(self.terms[-1]), seconds(self.states[-1])) > end

    def begin(self) -> None:
        """Let control begin."""
        self.client.until(lambda: self.passed(0.0) or self.states, 'the first state')
        self.client.call(SetBool, 'pam_control/enable', data=True)
        self.client.until(lambda: self.passed(0.0), 'the first command')

    def stop_after(self, duration: float) -> float:
        """Let so many seconds pass from now on, then let time stand still; return when.

        That is later by what passes while it is asked for: read from the course what was when.
        """
        client, states = self.client, self.states
        begin = seconds(states[-1])
        client.until(lambda: self.passed(begin + duration), f'{duration:g} s to pass')
        self._pause(True)
        # Where time stands still, the state is told again and again: then all is heard.
        client.until(lambda: states[-1].header.stamp == states[-2].header.stamp, 'a stop')
        return seconds(states[-1])

    def _pause(self, is_paused: bool) -> None:
        service = self._service
        self.client.until(service.service_is_ready, 'the service pam_sim/pause')
        self.client.until(service.call_async(SetBool.Request(data=is_paused)).done, 'its answer')

    def tell(self, message: Any, topic: str, term: str = 'reference') -> None:
        """Tell what sets *term* in motion, and let time go on."""
        k = list(self.terms[-1].name).index(term)
        rest = self.terms[-1].position[k]
        self.client.publish(message, topic)
        self._pause(False)
        self.client.until(
            lambda: abs(self.terms[-1].position[k] - rest) > STILL, f'{term} to change'
        )
