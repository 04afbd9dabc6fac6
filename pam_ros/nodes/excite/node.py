# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node ``pam_excite``: waits for the rig, plays the programme, watches the joint."""

import argparse
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from tqdm import tqdm

from pam_ros.excitation.guard import Guard
from pam_ros.excitation.programme import write_csv
from pam_ros.excitation.programme_pacing import Received, programme_pacing
from pam_ros.health.absence import Absence
from pam_ros.health.start_line import command_pace, listed
from pam_ros.nodes.common.commands import commands_of
from pam_ros.nodes.common.node_parameters import NodeParameters
from pam_ros.nodes.common.qos import DEPTH, open_qos, states_reliability
from pam_ros.nodes.common.rclpy_internals import overrides_of
from pam_ros.nodes.common.spin import TickingNode
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.settings.excite import Experiment, settings_of
from pam_ros.timing.pacing import Reply
from pam_ros.timing.ticker import Ticker

Array = NDArray[np.float64]

STOPPED = 1  # exit code
UNNAMED = '_NODE_NAME_UNKNOWN_'  # name of a node until it is completely discovered
LONGEST_PAUSE = 0.1  # s: longest pause between commands that counts for the pressure rate
LAST_READ = 5.0  # s in which a delayed recorder reads the last commands
LAST = 0.2  # s for which 0 Pa is commanded after an emergency stop


class PamExcite(TickingNode):
    """Plays a programme: waits, counts down, plays, vents.

    If ROS time is the system's clock, the node commands at its own rate. With use_sim_time, time
    follows the stamps of the joint states: each new state is answered with one command.
    """

    def __init__(self, csv: Path | None, is_dry: bool) -> None:
        """Create the programme that the parameters describe."""
        super().__init__('pam_excite')
        parameters = NodeParameters(self, *settings_of(overrides_of(self)), _nothing_live)
        self._now = parameters.built
        parameters.refuse_mistyped()
        if csv is not None:
            write_csv(self._now.programme, csv, self._now.topics.muscles)
        self._is_dry = is_dry
        self._commands: Any = None  # after the start
        self._pressure = np.zeros(len(self._now.topics.muscles))  # last command
        self._remaining = round(LAST * self._now.settings.rate)  # remaining commands of 0 Pa
        self._pacing = programme_pacing(
            lambda: self.get_clock().now().nanoseconds,
            is_simulated=bool(self.get_parameter('use_sim_time').value),
        )
        self.keeps_wall_time = self._pacing.keeps_wall_time
        self._segment = ''
        self._absence = Absence(self.get_logger(), 'the rig is found')
        self._bar = tqdm(disable=True)
        self._do = self._wait
        self.ticker = Ticker(self._now.settings.rate)

    @classmethod
    def add_arguments(cls, parser: argparse.ArgumentParser) -> None:
        """Add the options for a plan without a rig, and for a file."""
        parser.add_argument(
            '--dry-run', action='store_true', help='print the plan and play nothing'
        )
        parser.add_argument(
            '--csv',
            type=Path,
            metavar='FILE',
            help='write the commands as well: t_s,pressure_command_Pa, of several muscles with '
            'the name of the muscle: t_s,flexor.pressure_command_Pa,extensor.pressure_command_Pa',
        )

    @classmethod
    def of_arguments(cls, arguments: argparse.Namespace) -> 'PamExcite':
        """Create the node with the options of the command line."""
        return cls(arguments.csv, arguments.dry_run)

    def start(self) -> None:
        """Print the plan and subscribe to the states of the rig."""
        super().start()
        print(self._now.plan(), flush=True)
        if self._is_dry:
            self.exit_code = 0
            return
        self._log_plan()
        self._begun = time.monotonic()
        silence, unit = self._now.settings.silence, self._now.unit
        self._guard = Guard(*self._now.window, unit, silence, self._pacing.now())
        self._misread = ''
        self._commands = commands_of(self, self._now.topics)
        reliability = states_reliability(are_answered=self._pacing.answers_states)
        self.create_subscription(
            JointState,
            'joint_states',
            self._see,
            QoSProfile(depth=DEPTH, reliability=reliability),
            qos_overriding_options=open_qos(),
        )

    def _log_plan(self) -> None:
        commands = listed(map(self.resolve_topic_name, self._now.topics.commands))
        states = self.resolve_topic_name('joint_states')
        settings = self._now.settings
        pace = command_pace(settings.rate, has_sim_time=self._pacing.answers_states)
        self.get_logger().info(
            f'plays a programme of {self._now.programme.duration:.1f} s; commands: {commands}, '
            f'{pace}; states: {states}; begins {settings.countdown:g} s after the rig is found'
        )

    def tick(self) -> None:
        """Run the current phase of the programme."""
        if self.exit_code is None:
            self._do()

    def _see(self, message: JointState) -> None:
        names, wanted = list(message.name), self._now.settings.joint_name
        if wanted and wanted not in names:
            self._misread = f'joint_states has no joint {wanted!r}: it has {", ".join(names)}'
        elif not wanted and len(names) != 1:
            self._misread = f'joint_states has {len(names)} joints ({", ".join(names)}): choose '
            self._misread += 'one with the parameter joint_name'
        elif len(message.position) != len(names):
            self._misread = 'joint_states has no positions'
        else:
            at = names.index(wanted) if wanted else 0
            received = self._pacing.receive(stamp_of(message))
            self._guard.record(message.position[at], received.time)
            if self._do == self._play:
                self._reply(received)

    def _reply(self, received: Received) -> None:
        """Send the command that a state requires while the programme is played."""
        if received.reply is Reply.COMMAND:
            self._play_at(received.time)
        elif received.reply is Reply.LAST_COMMAND:
            self._command(self._pressure)

    # Before --------------------------------------------------------------------------------

    def _wait(self) -> None:
        """Wait until the rig is found and no other node commands it."""
        if self._misread:
            self._refuse(self._misread)
            return
        others = self._other_nodes()
        if others and UNNAMED not in others:
            self._refuse(f'{" and ".join(others)} commands pressures as well: stop it first')
            return
        missing = {
            **self._lacking_subscribers(),
            'joint_states is not published': self._guard.position is None,
            'use_sim_time is set and /clock is not published': self._pacing.now() == 0.0,
            'another node commands pressures': bool(others),
        }
        problems = ', '.join(text for text, is_so in missing.items() if is_so)
        self._absence.look(f'waits for the rig: {problems}' if problems else '', time.monotonic())
        if not problems:
            self._play_from = time.monotonic() + self._now.settings.countdown
            self._do = self._count_down
        elif time.monotonic() - self._begun > self._now.settings.patience:
            self._refuse(f'{problems}: is the rig running?')

    def _lacking_subscribers(self) -> dict[str, bool]:
        """Return a sentence for each topic of commands, and whether it has too few subscribers."""
        needed = self._now.settings.subscribers
        sentences = {}
        for topic, publisher in zip(
            self._now.topics.commands, self._commands.publishers, strict=True
        ):
            found = publisher.get_subscription_count()
            sentences[f'{topic} has no subscriber'] = not found
            sentences[f'{topic} has {found} of {needed} subscribers'] = 0 < found < needed
        return sentences

    def _other_nodes(self) -> list[str]:
        """Return the other nodes that publish commands of the muscles."""
        own, others = self.get_fully_qualified_name(), []
        for topic in self._now.topics.every_command:
            names = [
                info.node_namespace.rstrip('/') + '/' + info.node_name
                for info in self.get_publishers_info_by_topic(topic)
            ]
            if own in names:
                names.remove(own)
            others += [UNNAMED if UNNAMED in name else name for name in names]
        return list(dict.fromkeys(others))

    def _count_down(self) -> None:
        problem = self._problem()
        if problem:
            self._refuse(problem)
        elif time.monotonic() >= self._play_from:
            self._origin = self._last = self._pacing.start
            self._bar = tqdm(
                total=round(self._now.programme.duration, 1),
                unit='s',
                bar_format='{l_bar}{bar}| {n:.1f}/{total} s',
                disable=not sys.stderr.isatty(),
            )
            self._do = self._play
            self._play_at(self._origin)  # also answers the state that waits for a command

    def _problem(self) -> str:
        """Return the reason to stop, or ''."""
        return (
            self._pacing.silence(self._now.settings.patience)
            or self._misread
            or self._guard.problem(self._pacing.silent_until)
        )

    def _refuse(self, why: str) -> None:
        print(f'pam_excite: {why}', file=sys.stderr, flush=True)
        self.exit_code = STOPPED

    # While it plays ------------------------------------------------------------------------

    def _play(self) -> None:
        """Continue to play; if time follows the states, only check whether the states stop."""
        if self._pacing.keeps_wall_time or self._problem():
            self._play_at(self._pacing.now())

    def _play_at(self, now: float) -> None:
        elapsed, since = now - self._origin, now - self._last
        self._last = now
        problem = self._problem()
        if since < 0.0:
            problem = 'the clock went back'
        if problem:
            self._bar.close()
            print(
                f'pam_excite: {problem}: stopped after {elapsed:.1f} s, venting',
                file=sys.stderr,
                flush=True,
            )
            self._do = self._vent
            return
        if elapsed >= self._now.programme.duration and not self._is_pressed:
            self._bar.close()
            print(f'played {self._now.programme.duration:.1f} s, vented', flush=True)
            self.exit_code = 0
            return
        # After a pause of this process the pressure approaches the programme without a jump.
        step = self._now.settings.pressure_rate * min(since, LONGEST_PAUSE)
        wanted = self._now.programme.at(elapsed)
        self._command(np.clip(wanted, self._pressure - step, self._pressure + step))
        self._show(elapsed)

    @property
    def _is_pressed(self) -> bool:
        """Whether there was pressure in a muscle at the last command."""
        return bool(np.any(self._pressure > 0.0))

    def _command(self, pressure: Array) -> None:
        self._pressure = pressure
        self._pacing.note_command()
        self._commands.publish(pressure.tolist())

    def _show(self, elapsed: float) -> None:
        self._bar.update(elapsed - self._bar.n)
        name = self._now.programme.segment_at(elapsed).name
        if name != self._segment:
            self._segment = name
            self._bar.set_description(name)
            if self._bar.disable:
                print(f'{elapsed:6.1f} s  {name}', flush=True)

    # The end -------------------------------------------------------------------------------

    def _vent(self) -> None:
        """Send one command that lowers the pressures as fast as is allowed."""
        self._command(self._next_lower())
        if not self._is_pressed:
            self._remaining -= 1
            if self._remaining <= 0:
                self.exit_code = STOPPED

    def _next_lower(self) -> Array:
        settings = self._now.settings
        return np.maximum(self._pressure - settings.pressure_rate / settings.rate, 0.0)

    def finish(self) -> None:
        """Vent if there is pressure left, and wait until all commands were received."""
        try:
            if self._is_pressed:  # the node was requested to stop
                self._bar.close()
                print('pam_excite: stop requested, venting', file=sys.stderr, flush=True)
        finally:  # also if the output can no longer be printed
            self._vent_completely()

    def _vent_completely(self) -> None:
        while self._is_pressed:
            self._command(self._next_lower())
            time.sleep(1.0 / self._now.settings.rate)
        for publisher in self._commands.publishers if self._commands else ():
            # What is not received before this process ends is lost.
            publisher.wait_for_all_acked(Duration(seconds=LAST_READ))


def _nothing_live(built: Experiment) -> None:
    """Do nothing: every parameter is read-only while the programme is played."""
