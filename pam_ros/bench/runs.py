# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All runs of a bench, side by side in processes, each in a DDS domain of its own."""

import os
import socket
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from pam_ros.bench.controllers import Controller
from pam_ros.bench.domains import claim_domain
from pam_ros.bench.outcome import Outcome
from pam_ros.bench.scenario import Scenario
from pam_ros.bench.trial import Trial
from pam_ros.parallel.tasks import Failure, Pool, run_tasks


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
    jobs: Sequence[Job], run: Run, pool: Pool, domain: int | None = None
) -> Generator[tuple[Job, Finished | Failure], None, None]:
    """Yield each of *jobs* once with what it gave, as they end in the processes of *pool*.

    Only trials with the first seed are returned. run(scenario, controller, seed, domain) performs
    one job; it must be a function of a module. All jobs have the DDS *domain*, if one is given,
    which then must be the only one that runs. Closing the generator ends all controllers.
    """
    prepare = partial(_begin, domain)
    with closing(run_tasks(partial(_run, run), jobs, pool, prepare)) as results:
        for number, found in results:
            yield jobs[number], found


def _begin(domain: int | None) -> None:
    """Prepare a process for runs."""
    # No rig on another machine is reached: neither from here nor by the controllers.
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    _Worker.domain, _Worker.lock = claim_domain(domain)


def _run(run: Run, job: Job) -> Finished:
    outcome, trial = run(job.scenario, job.controller, job.seed, _Worker.domain)
    return Finished(outcome, None if job.seed else trial)
