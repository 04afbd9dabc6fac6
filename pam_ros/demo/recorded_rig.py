# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated rig that is excited and recorded, each program a process, in lockstep.

Simulated time waits for each command, and the recorder determines exactly when a command was
sent. Therefore the recording does not depend on the load of the machine.
"""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from pam_ros.errors import PamError
from pam_ros.processes.children import Program

RATE = 100.0  # states and commands per simulated second
# With a time on /clock for each state, the time of each command is recorded exactly.
LOCKSTEP = {'time_mode': 'lockstep', 'publish_rate': RATE, 'clock_rate': RATE}
LAST = 3  # lines that a failed program printed at its end


class RecordedRig:
    """``pam_sim``, ``pam_record`` and, from :meth:`excite` on, ``pam_excite`` in one namespace."""

    def __init__(
        self,
        programs: ExitStack,
        count_subscribers: Callable[[str], int],
        space: str,
        rig: Mapping[str, Any],
        bag: Path,
    ) -> None:
        """Start the simulator with the parameters *rig*, and the recorder, which writes *bag*.

        *programs* will stop them. *count_subscribers* returns the number of subscribers of a
        topic. All names are in the namespace *space*; ``clock`` is the topic of the simulated
        time.
        """
        self._programs, self._count, self._space = programs, count_subscribers, space
        self._states = f'{space}/rig/joint_states'
        self.clock = f'{space}/clock'
        self._running: list[Program] = []
        where = ('-r', f'__ns:={space}/rig', '-r', f'pressure_command:={space}/pressure_command')
        self._start('pam_sim', *where, parameters={**rig, **LOCKSTEP})
        given = ('-p', 'use_sim_time:=true', '--', self._states, '-o', str(bag))
        self._recorder = self._start('pam_record', '-r', f'__ns:={space}', *given)

    def _start(
        self, name: str, *arguments: str, parameters: Mapping[str, Any] | None = None
    ) -> Program:
        # No other node follows this clock.
        clock = ('-r', f'/clock:={self.clock}')
        program = Program(name, *clock, *arguments, parameters=parameters)
        self._running.append(self._programs.enter_context(program))
        return program

    @property
    def is_ready(self) -> bool:
        """Whether the recorder has subscribed to all that the simulator publishes.

        Raises PamError if a program has ended.
        """
        for program in self._running:
            if not program.is_running:
                raise PamError(f'{program.name} ended: {_last_lines(program)}')
        # Of the clock there are two: the time of the recorder's node, and the recording.
        return self._count(self._states) > 0 and self._count(self.clock) > 1

    def excite(self, parameters: Mapping[str, Any]) -> None:
        """Start ``pam_excite`` with these parameters.

        The recorder subscribes to its commands as soon as it finds them, and with 2 as
        ``subscribers`` none is sent before.
        """
        where = ('-r', f'__ns:={self._space}', '-r', f'joint_states:={self._states}')
        given = {**parameters, 'use_sim_time': True}
        self._excite = self._start('pam_excite', *where, parameters=given)

    @property
    def is_excited(self) -> bool:
        """Whether the programme is still being played."""
        return self._excite.is_running

    def finish(self) -> None:
        """Complete the recording; raises PamError if the programme stopped early."""
        if self._excite.wait():
            raise PamError(f'pam_excite stopped: {_last_lines(self._excite)}')
        if self._recorder.stop():
            raise PamError(f'pam_record failed: {_last_lines(self._recorder)}')


def _last_lines(program: Program) -> str:
    return ' '.join(program.output.split('\n')[-LAST:]).strip()
