# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All runs of a bench, side by side in processes, each in a DDS domain of its own."""

import multiprocessing
import os
import socket
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import NamedTuple

from pam_ros.bench.controllers import Controller
from pam_ros.bench.domains import claim_domain
from pam_ros.bench.outcome import Outcome
from pam_ros.bench.scenario import Scenario
from pam_ros.bench.trial import Trial
from pam_ros.errors import PamError
from pam_ros.processes.interrupts import raise_on_signal


class Finished(NamedTuple):
    """The outcome of a run, and its trial if it was completed and is wanted."""

    outcome: Outcome
    trial: Trial | None


Run = Callable[[Scenario, Controller, int, int], Finished]


@dataclass(frozen=True, eq=False)
class Job:
    """A run: a scenario, a controller, and the seed of the sensors."""

    scenario: Scenario
    controller: Controller
    seed: int


class _Worker:
    """The DDS domain of this process, held by a socket until the process ends."""

    domain = 0
    lock: socket.socket


def jobs_of(
    scenarios: Sequence[Scenario], controllers: Sequence[Controller], seeds: int
) -> list[Job]:
    """Return all runs: of each scenario all controllers, with the seeds 0 to *seeds* - 1."""
    return [
        Job(scenario, controller, seed)
        for scenario in scenarios
        for controller in controllers
        for seed in range(seeds)
    ]


def run_all(
    jobs: Sequence[Job], run: Run, workers: int, domain: int | None = None
) -> Iterator[Finished]:
    """Yield what each of *jobs* gave as they end, run by so many *workers* at once.

    Only trials with the first seed are returned. run(scenario, controller, seed, domain) performs
    one job; it must be a function of a module. With one worker the DDS *domain* can be given. An
    interrupt ends all controllers. Raises PamError if a worker is killed.
    """
    # A new process for each worker: a forked one would share the state of rclpy.
    context = multiprocessing.get_context('spawn')
    pool = ProcessPoolExecutor(workers, context, initializer=_begin, initargs=(domain,))
    try:
        futures = [pool.submit(_run, run, job) for job in jobs]
        for future in as_completed(futures):
            yield future.result()
    except BrokenProcessPool:
        raise PamError('a process of the bench was killed: is there enough memory?') from None
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _begin(domain: int | None) -> None:
    """Prepare a worker: a signal to end must still stop the controller that runs."""
    raise_on_signal()
    # No rig on another machine is reached: neither from here nor by the controllers.
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    _Worker.domain, _Worker.lock = claim_domain(domain)


def _run(run: Run, job: Job) -> Finished:
    outcome, trial = run(job.scenario, job.controller, job.seed, _Worker.domain)
    return Finished(outcome, None if job.seed else trial)
