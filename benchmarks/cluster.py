# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What many workers bring: overhead a task, two workers against one, and a simulated cluster.

Empty tasks show the overhead of processes of this machine, and of a Dask cluster with a real
scheduler and workers. Simulations of about a second, each on one core, are done by one worker and
by two. Last, a cluster is *simulated*, which is not measured: workers take blind trials of the
identification as long as some that are measured here, from a scheduler that needs the measured
overhead for each.
Options: ``--tasks N`` (default 400 empty ones), ``--simulations N`` (default 16), ``--workers N``
and ``--draws N`` of the simulated cluster (default 100 and 10000).
"""

import argparse
import heapq
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from benchmarks import tracing
from pam_ros.parallel.cluster import ClusterPool
from pam_ros.parallel.local import LocalPool
from pam_ros.parallel.tasks import Failure, Pool, run_tasks
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from support.dask_cluster import DaskCluster

KINDS, SEED = ('noise_only', 'coulomb_friction', 'payload'), 21  # trials, a draw that is known
STEPS = 10_000_000  # of a simulation


def nothing(task: int) -> int:
    """Return *task*."""
    return task


def simulation(task: int) -> float:
    """Return the position of a muscle with a load after many steps."""
    rig = Simulation([Joint((Actuator(),), Mass(mass=20.0))], 1e-3)
    rig.advance(STEPS)
    return float(rig.position[0])


@contextmanager
def dask(workers: int) -> Iterator[ClusterPool]:
    """Start a scheduler and so many workers."""
    with tempfile.TemporaryDirectory() as folder, DaskCluster(Path(folder)) as cluster:
        cluster.start_scheduler()
        for _ in range(workers):
            cluster.start_worker()
        yield ClusterPool(cluster.address)


def times_of(function: Any, tasks: list[Any], pool: Pool, warm: list[Any]) -> tuple[float, Any]:
    """Return the time in s for all *tasks* and their results, after the tasks *warm*.

    The processes start, and compile, in the warm-up.
    """
    found, begin = [], time.perf_counter()
    for _, result in run_tasks(function, [*warm, *tasks], pool):
        if isinstance(result, Failure):
            sys.exit(result.reason)
        found.append(result)
        if len(found) == len(warm):
            begin = time.perf_counter()
    return time.perf_counter() - begin, found[len(warm) :]


def simulated(workers: int, durations: np.ndarray, overhead: float) -> float:
    """Return the time in s in which *workers* do tasks of these *durations* in s, (n,).

    Each task is given out by one scheduler, which needs *overhead* s for it.
    """
    free = [0.0] * workers
    scheduler = 0.0
    for duration in durations:
        scheduler = max(scheduler, heapq.heappop(free)) + overhead
        heapq.heappush(free, scheduler + float(duration))
    return max(free)


def main() -> None:
    """Measure, simulate, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--tasks', type=int, default=400)
    parser.add_argument('--simulations', type=int, default=16)
    parser.add_argument('--workers', type=int, default=100)
    parser.add_argument('--draws', type=int, default=10_000)
    given = parser.parse_args()
    print(f'{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\n')
    empty, work = list(range(given.tasks)), list(range(given.simulations))
    overhead, walls = {}, {}
    for workers in (1, 2):
        with dask(workers) as pool:
            for kind, one in (('processes', LocalPool(workers)), ('dask', pool)):
                name = f'{kind}, {workers}'
                spent, _ = times_of(nothing, empty, one, empty[:workers])
                overhead[name] = spent / given.tasks
                walls[name], _ = times_of(simulation, work, one, work[:workers])
    trials = [tracing.Job(kind, SEED, 'blind') for kind in KINDS]
    seconds = [row['seconds'] for row in times_of(tracing.run_trial, trials, LocalPool(1), [])[1]]
    print('| workers | overhead a task, ms | simulations, s | of one worker |\n|---|---|---|---|')
    for name, wall in walls.items():
        alone = walls[f'{name.split(",")[0]}, 1']
        print(f'| {name} | {1e3 * overhead[name]:.2f} | {wall:.1f} | {alone / wall:.2f} |')
    durations = np.random.default_rng(0).choice(seconds, given.draws)
    alone = simulated(1, durations, overhead['dask, 1'])
    print(f'\nsimulated, {given.draws} draws, a trial takes {np.mean(seconds):.1f} s (mean):')
    print('| workers | time, h | of one worker |\n|---|---|---|')
    for workers in (1, given.workers // 10, given.workers, 10 * given.workers):
        wall = simulated(max(workers, 1), durations, overhead['dask, 1'])
        print(f'| {max(workers, 1)} | {wall / 3600.0:.2f} | {alone / wall:.0f} |')


if __name__ == '__main__':
    main()
