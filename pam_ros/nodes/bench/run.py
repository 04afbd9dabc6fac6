# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One run of a controller, as a process, in a scenario, over topics of a DDS domain of its own."""

import gc
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, monotonic_ns

import rclpy
import yaml
from rclpy.context import Context

from pam_ros.bench.controllers import Controller
from pam_ros.bench.outcome import Outcome, Status
from pam_ros.bench.process import ControllerProcess
from pam_ros.bench.runs import Finished
from pam_ros.bench.scenario import Scenario
from pam_ros.bench.scores import scores_of
from pam_ros.bench.trial import Trial
from pam_ros.nodes.bench.rig import BenchRig
from pam_ros.nodes.common.rclpy_internals import EventsExecutor
from pam_ros.nodes.common.spin import LONGEST_WAIT, tick_if_due
from pam_ros.processes.interrupts import held_back

START = 60.0  # s within which a controller must subscribe to the states
SILENCE = 10.0  # s without a command, of a controller that receives states
FOLLOWS = 2.0  # s within which the subscriptions of a controller must be known
FLOOD = 20.0  # times the rate of the states: more commands are a flood
FEW = 1000  # commands that are no flood in any case
AFTER = 0.1  # s after a run in lockstep, in which at most SURPLUS commands may arrive
SURPLUS = 10
FIRST = 20  # states within which a controller stops that waits for time to pass
STUCK = 3.0  # s without a command after which such a controller is run in real time
LOOK = 0.2  # s between two looks at the controller


class _EarlyEndError(Exception):
    """The run has ended early."""

    def __init__(self, status: Status, reason: str) -> None:
        super().__init__(reason)
        self.status, self.reason = status, reason


class _RealTimeNeededError(Exception):
    """The controller does not answer states in lockstep; *time_mode* is the one for it."""

    def __init__(self, time_mode: str) -> None:
        super().__init__(time_mode)
        self.time_mode = time_mode


def run(scenario: Scenario, controller: Controller, seed: int, domain: int) -> Finished:
    """Return what *controller* reaches in *scenario*, in the DDS *domain*, and the trial.

    The simulated time waits for the controller, in lockstep. One that does not subscribe to
    ``/clock`` does not follow simulated time, and one with a timer in simulated time would wait
    for ever: both are run in real time.
    """
    begin = monotonic()
    is_real_time, trial = False, None
    try:
        try:
            trial = _trial(scenario, controller, seed, domain, 'lockstep')
        except _RealTimeNeededError as needs:
            is_real_time = True
            trial = _trial(scenario, controller, seed, domain, needs.time_mode)
        status, reason, scores = Status.COMPLETED, '', scores_of(trial)
    except _EarlyEndError as ended:
        status, reason, scores = ended.status, ended.reason, {}
    (_, setup), *_ = scenario.setups(seed, 'lockstep')
    outcome = Outcome(
        scenario=scenario.name,
        controller=controller.name,
        seed=seed,
        status=status,
        reason=reason,
        scores=scores,
        is_revolute=setup.joints[0].is_revolute,
        is_real_time=is_real_time,
        seconds=monotonic() - begin,
        simulated=scenario.duration if status is Status.COMPLETED else 0.0,
    )
    return Finished(outcome, trial)


def _trial(
    scenario: Scenario, controller: Controller, seed: int, domain: int, time_mode: str
) -> Trial:
    with (
        _parameter_file(scenario) as file,
        _context(domain) as context,
        _rig(scenario, seed, time_mode, context) as rig,
    ):
        rate = rig.setup.settings.publish_rate
        command = controller.command_line(file, rate, is_simulated=time_mode != 'real_time')
        with ControllerProcess(command, {'ROS_DOMAIN_ID': str(domain)}) as process:
            _drive(rig, process, context)
            return rig.trial()


@contextmanager
def _parameter_file(scenario: Scenario) -> Iterator[Path]:
    """Write what is declared of the rig to a parameter file, which exists in the context."""
    values = {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in scenario.declared.items()
    }
    with tempfile.TemporaryDirectory(prefix='pam_bench_') as folder:
        path = Path(folder) / 'declared.yaml'
        content = {'/**': {'ros__parameters': values}}
        path.write_text(yaml.safe_dump(content), encoding='utf-8')
        yield path


@contextmanager
def _context(domain: int) -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    try:
        yield context
    finally:
        rclpy.shutdown(context=context)


@contextmanager
def _rig(scenario: Scenario, seed: int, time_mode: str, context: Context) -> Iterator[BenchRig]:
    rig = BenchRig(scenario, seed, time_mode, context)
    try:
        yield rig
    finally:
        rig.destroy_node()


def _drive(rig: BenchRig, process: ControllerProcess, context: Context) -> None:
    """Let simulated time pass until the scenario is over, or raise _EarlyEndError."""
    executor = EventsExecutor(context=context)
    executor.add_node(rig)
    # Present objects are kept: a collection that checks them would take some 20 ms.
    gc.freeze()
    watch = _Watch(rig, process)
    try:
        rig.start()
        ticker = rig.ticker
        ticker.start(ticker.rate, monotonic_ns())
        while not rig.is_done or watch.is_counting():
            wait = tick_if_due(ticker, rig.tick)
            with held_back():
                executor.spin_once(timeout_sec=min(wait, LONGEST_WAIT))
            watch.look()
        watch.refuse_values()
    finally:
        executor.remove_node(rig)
        executor.shutdown()
        gc.unfreeze()


class _Watch:
    """Ends a run whose controller does not do what it must."""

    def __init__(self, rig: BenchRig, process: ControllerProcess) -> None:
        self._rig, self._process = rig, process
        self._began = self._looked = monotonic()
        self._first = 0.0  # time of the first command
        self._heard = 0.0  # time from which the controller receives states
        self._done: tuple[float, int] | None = None  # time of the end, and commands until then

    def is_counting(self) -> bool:
        """Return whether commands after the end of a run in lockstep are still counted.

        There is none for the last state at the end, and none before the next state. During an
        outage a controller may send commands by its own clock.
        """
        rig, now = self._rig, monotonic()
        if not rig.is_lockstep or rig.is_out:
            return False
        self._done = self._done or (now, rig.commands)
        begin, before = self._done
        if rig.commands > before + SURPLUS:
            raise _EarlyEndError(
                Status.FLOODED, f'sent {rig.commands - before} commands without a state to answer'
            )
        return now < begin + AFTER

    def look(self) -> None:
        """Raise an error if the controller has failed, or needs real time."""
        now = monotonic()
        if now - self._looked < LOOK and not (self._rig.is_waiting and self._rig.commands):
            return
        self._looked = now
        rig, code = self._rig, self._process.exit_code
        if code is not None:
            words = self._process.last_words or 'without a message'
            how = f'with exit code {code}' if code >= 0 else f'by signal {-code}'
            when = f'{rig.time:.3f} s after the start of the scenario'
            raise _EarlyEndError(Status.DIED, f'ended {how} {when}: {words}')
        publishers = len(rig.publishers_of_commands())
        if publishers > rig.most_publishers:
            raise _EarlyEndError(
                Status.SEVERAL_PUBLISHERS, f'{publishers} nodes send commands: is one left over?'
            )
        self.refuse_values()
        rate = rig.setup.settings.publish_rate
        if self._first and rig.commands > FEW + FLOOD * rate * (now - self._first):
            raise _EarlyEndError(
                Status.FLOODED, f'sent {rig.commands} commands within {now - self._first:.1f} s'
            )
        if not rig.commands:
            self._refuse_silence(now)
        elif rig.is_waiting:
            self._decide(now)
        elif rig.is_lockstep and rig.sent < FIRST and rig.waited > STUCK:
            raise _RealTimeNeededError('scaled')
        elif rig.waited > SILENCE:
            raise _EarlyEndError(
                Status.STOPPED_ANSWERING,
                f'sent no command for {SILENCE:g} s, {rig.time:.3f} s after the start',
            )

    def _refuse_silence(self, now: float) -> None:
        """Raise an error for a controller that has sent no command and had time to start."""
        if self._rig.count_subscribers('joint_states'):
            self._heard = self._heard or now
        if self._heard and now - self._heard > SILENCE:
            text = f'sent no command within {SILENCE:g} s of receiving states'
            raise _EarlyEndError(Status.SILENT, text)
        if now - self._began > START:
            text = f'did not subscribe to joint_states within {START:g} s'
            raise _EarlyEndError(Status.SILENT, text)

    def refuse_values(self) -> None:
        """Raise an error if a command was not finite, or the state of the rig is not valid."""
        rig = self._rig
        if rig.fault:
            raise _EarlyEndError(Status.INVALID_STATE, rig.fault)
        if rig.not_finite_at is not None:
            when = f'{rig.not_finite_at:.3f} s after the start of the scenario'
            raise _EarlyEndError(
                Status.NOT_FINITE, f'commanded a pressure that is not finite {when}'
            )

    def _decide(self, now: float) -> None:
        """Let time pass when it is known whether the controller follows simulated time."""
        rig = self._rig
        self._first = self._first or now
        if rig.is_heard:
            rig.go_on()
        elif now - self._first > FOLLOWS:
            if rig.is_lockstep and not rig.count_subscribers('/clock'):
                raise _RealTimeNeededError('real_time')
            rig.go_on()  # it does not use the reference
