# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated rig that is excited and recorded, each program a process, in lockstep.

Simulated time waits for each command, and the recorder knows exactly when a command was sent.
Therefore the recording does not depend on the load of the machine.
"""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64
from tqdm import tqdm

from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.stage import PROGRESS, pause_of_bars
from pam_ros.processes.children import Program

RATE = 100.0  # states and commands per simulated second
# With a time on /clock for each state, the recorder knows the time of each command exactly.
LOCKSTEP = {'time_mode': 'lockstep', 'publish_rate': RATE, 'clock_rate': RATE}
TURN = 0.1  # s between two looks at programs that run
LAST = 3  # lines that a failed program printed at its end


class RecordedRig:
    """``pam_sim``, ``pam_record`` and, once it is asked for, ``pam_excite`` in one namespace."""

    def __init__(
        self,
        programs: ExitStack,
        client: Client,
        space: str,
        rig: Mapping[str, Any],
        bag: Path,
    ) -> None:
        """Start the simulator with the parameters *rig*, and the recorder, which writes *bag*.

        *programs* will stop them. All names are in the namespace *space*.
        """
        self._programs, self._client, self._space = programs, client, space
        self._command = f'{space}/pressure_command'
        self._states = f'{space}/rig/joint_states'
        self._clock = f'{space}/clock'
        self._running: list[Program] = []
        self._times: list[Clock] = client.collect(Clock, self._clock)
        where = ('-r', f'__ns:={space}/rig', '-r', f'pressure_command:={self._command}')
        self._start('pam_sim', *where, parameters={**rig, **LOCKSTEP})
        asked = ('-p', 'use_sim_time:=true', '--', self._states, '-o', str(bag))
        self._recorder = self._start('pam_record', '-r', f'__ns:={space}', *asked)
        # The recorder subscribes to topics with a publisher: without this one it would miss the
        # first commands.
        self._publisher = client.node.create_publisher(Float64, self._command, 1)

    def _start(
        self, name: str, *arguments: str, parameters: Mapping[str, Any] | None = None
    ) -> Program:
        # No other node follows this clock.
        clock = ('-r', f'/clock:={self._clock}')
        program = Program(name, *clock, *arguments, parameters=parameters)
        self._running.append(self._programs.enter_context(program))
        return program

    @property
    def is_ready(self) -> bool:
        """Whether the recorder has subscribed to all that it records.

        Raises PamError if a program has ended.
        """
        for program in self._running:
            if not program.is_running:
                raise PamError(f'{program.name} ended: {_last_lines(program)}')
        count = self._client.node.count_subscribers
        # Of the clock: this client, the time of the recorder's node, and the recording.
        return (
            self._publisher.get_subscription_count() > 1
            and count(self._states) > 0
            and count(self._clock) > 2
        )

    def excite(self, parameters: Mapping[str, Any]) -> None:
        """Start ``pam_excite`` with these parameters."""
        self._client.node.destroy_publisher(self._publisher)  # it refuses a rig with another one
        where = ('-r', f'__ns:={self._space}', '-r', f'joint_states:={self._states}')
        given = {**parameters, 'use_sim_time': True}
        self._excite = self._start('pam_excite', *where, parameters=given)

    @property
    def is_excited(self) -> bool:
        """Whether the programme is still being played."""
        return self._excite.is_running

    @property
    def elapsed(self) -> float:
        """Simulated seconds since the start."""
        if not self._times:
            return 0.0
        first, last = (one.clock for one in (self._times[0], self._times[-1]))
        return float(last.sec - first.sec) + 1e-9 * float(last.nanosec - first.nanosec)

    def finish(self) -> None:
        """Complete the recording; raises PamError if the programme stopped early."""
        if self._excite.wait():
            raise PamError(f'pam_excite stopped: {_last_lines(self._excite)}')
        if self._recorder.stop():
            raise PamError(f'pam_record failed: {_last_lines(self._recorder)}')


def _last_lines(program: Program) -> str:
    return ' '.join(program.output.split('\n')[-LAST:]).strip()


def play(
    client: Client, rigs: Sequence[RecordedRig], excitation: Mapping[str, Any], what: str
) -> None:
    """Excite all *rigs* at the same time, with a progress bar, and complete their recordings.

    Raises PamError if a program of a rig ends early.
    """
    client.until(lambda: all(rig.is_ready for rig in rigs), 'the rigs and the recorders')
    for rig in rigs:
        rig.excite(excitation)
    whole = excitation['duration']
    with tqdm(total=whole, desc=what, bar_format=PROGRESS, mininterval=pause_of_bars(5.0)) as bar:
        while any(rig.is_excited for rig in rigs):
            client.work(TURN)
            bar.update(min(*(rig.elapsed for rig in rigs), whole) - bar.n)
    for rig in rigs:
        rig.finish()
