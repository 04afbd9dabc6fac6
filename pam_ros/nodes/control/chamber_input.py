# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pressures in the muscles before control begins, if the rig publishes them.

A controller that begins at the pressure that holds the load does not move it, for any load.
"""

from collections.abc import Callable
from functools import partial
from math import isfinite

from sensor_msgs.msg import FluidPressure
from std_msgs.msg import Float64MultiArray

from pam_ros.control.loop import BLIND, WAITING, Loop
from pam_ros.control.plausibility import fault_of_pressure
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.settings.control import ControlSetup
from pam_ros.timing.interruption import steady_ns
from pam_ros.timing.pace import SECOND

FRESH = SECOND  # ns by which a pressure may be older than the state at which control begins
# Most ns between two calls that count as waiting: in a longer time this process was delayed.
LONGEST_PAUSE = SECOND // 10

Subscribe = Callable[[type, str, Callable[..., None]], None]


class ChamberInput:
    """Takes absolute pressures in Pa from the topics on which ``pam_sim`` publishes them."""

    def __init__(
        self,
        setup: ControlSetup,
        subscribe: Subscribe,
        on_pressure: Callable[[], None],
        on_fault: Callable[[str], None],
    ) -> None:
        """Use *subscribe*(type, topic, callback); *on_pressure* is called after each pressure.

        *on_fault* is called with a sentence on a pressure that is not plausible.
        """
        self._on_pressure, self._on_fault = on_pressure, on_fault
        self._topics = setup.topics.pressures
        self._found: list[tuple[int, int, float] | None] = [None] * len(setup.topics.muscles)
        self._is_published = False  # whether all pressures have been received before
        self._waited = 0
        self._looked = steady_ns()
        if not setup.settings.pressure_wait:
            return
        for i, topic in enumerate(setup.topics.pressures):
            if setup.topics.is_array:
                subscribe(Float64MultiArray, topic, self._take_all)
            else:
                subscribe(FluidPressure, topic, partial(self._take, i))

    def _take(self, muscle: int, message: FluidPressure) -> None:
        self._note(muscle, stamp_of(message), message.fluid_pressure)
        self._on_pressure()

    def _take_all(self, message: Float64MultiArray) -> None:
        if len(message.data) != len(self._found):
            self._on_fault(
                f'{self._topics[0]} has {len(message.data)} values for {len(self._found)} '
                'muscles: not used'
            )
            return
        for muscle, pressure in enumerate(message.data):
            self._note(muscle, 0, pressure)
        self._on_pressure()

    def _note(self, muscle: int, stamp: int, pressure: float) -> None:
        self._found[muscle] = (stamp, steady_ns(), pressure)
        # A sensor that is not connected may give NaN for ever: no start has to wait for it.
        is_usable = all(one and isfinite(one[2]) for one in self._found)
        self._is_published = self._is_published or is_usable

    def forget(self) -> None:
        """Forget all pressures, and wait for them again."""
        self._found = [None] * len(self._found)
        self._waited = 0

    def prepare(
        self,
        loop: Loop,
        stamp: int | None,
        setup: ControlSetup,
        is_seen: Callable[[], bool],
    ) -> None:
        """Set the pressure at which *loop* begins at a state of *stamp* ns, or let the loop wait.

        The age of a pressure follows from the stamps if both messages have one, else from the
        time of its receipt. The loop waits at its first start, and at each later start if the
        pressures were published before, for at most the parameter pressure_wait. This time runs
        while joint states arrive, *is_seen*(), and starts again at 0 after they have stopped.
        """
        if stamp is None or loop.state not in (WAITING, BLIND):
            self._waited = 0
            return
        now = steady_ns()
        self._leave_out_faults(setup)
        fresh = [
            one[2] - setup.settings.ambient_pressure
            for one in self._found
            if one and (abs(stamp - one[0]) if stamp and one[0] else now - one[1]) <= FRESH
        ]
        loop.chambers = setup.law.command_at(fresh) if len(fresh) == len(self._found) else None
        are_states_seen = is_seen()
        self._waited = (
            self._waited + min(now - self._looked, LONGEST_PAUSE) if are_states_seen else 0
        )
        self._looked = now
        is_early = are_states_seen and self._waited < setup.settings.pressure_wait * SECOND
        loop.awaits_chamber = is_early and (loop.state == WAITING or self._is_published)

    def _leave_out_faults(self, setup: ControlSetup) -> None:
        ambient = setup.settings.ambient_pressure
        for muscle, one in enumerate(self._found):
            of = setup.law.joint.muscles[muscle]
            fault = fault_of_pressure(one[2], ambient, (of.p_min, of.p_max)) if one else ''
            if fault:
                self._found[muscle] = None
                topics = setup.topics
                topic = topics.pressures[-1 if topics.is_array else muscle]
                self._on_fault(f'{topic} has {fault}: not used')
