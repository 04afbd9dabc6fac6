# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials in parallel: the options of the command line, the loop, a line for each trial."""

import argparse
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from pam_ros.parallel.cluster import ClusterPool
from pam_ros.parallel.local import LocalPool
from pam_ros.parallel.tasks import Failure, run_tasks

Job = TypeVar('Job')


def options(about: str | None, seeds: int) -> argparse.ArgumentParser:
    """Return the parser of the options of all trials; *seeds* is their default number."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument('--seeds', type=int, default=seeds)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--kinds', default='')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--dask', metavar='ADDRESS', help='of the scheduler of a Dask cluster')
    parser.add_argument('--log', type=Path)
    return parser


def chosen(given: argparse.Namespace, kinds: Iterable[str]) -> list[tuple[str, int]]:
    """Return kind and seed of each trial to be run; *kinds* are those without --kinds."""
    names = given.kinds.split(',') if given.kinds else [*kinds]
    seeds = range(given.first, given.first + given.seeds)
    return [(kind, seed) for seed in seeds for kind in names]


def run_all(
    run_trial: Callable[[Job], dict[str, Any]], jobs: list[Job], given: argparse.Namespace
) -> list[dict[str, Any]]:
    """Run the trials, print and log a line for each, and return their rows in order.

    Trials that could not be run are printed, and are no rows.
    """
    rows: dict[int, dict[str, Any]] = {}
    pool = ClusterPool(given.dask) if given.dask else LocalPool(given.jobs)
    with closing(run_tasks(run_trial, jobs, pool)) as results:
        for number, row in results:
            if isinstance(row, Failure):
                print(f'{jobs[number]} could not be run: {row.reason}', flush=True)
                continue
            rows[number] = row
            if given.log:
                with given.log.open('a') as log:
                    log.write(json.dumps(row) + '\n')
            print(
                f'{len(rows):4d}/{len(jobs)} {row["kind"]:36s} {row.get("where", ""):11s} '
                f'{row["seed"]:3d} {"+".join(row["found"]) or row["verdict"]:44s} '
                f'{row["augmented"] / row["noise"]:6.2f} x noise  {row["seconds"]:5.1f} s',
                flush=True,
            )
    return [rows[number] for number in sorted(rows)]


def shares(names: Iterable[str], groups: Sequence[Sequence[bool]]) -> dict[str, float]:
    """Return the share of true values in each group, by the groups' names; NaN without trials."""
    return {
        name: float(np.mean(group)) if group else float('nan')
        for name, group in zip(names, groups, strict=True)
    }


def print_scores(
    rows: list[dict[str, Any]],
    scores: Mapping[str, float],
    targets: Mapping[str, tuple[float, str]],
) -> None:
    """Print how many trials there were, and each score with its target, a min or a max."""
    print(f'\n{len(rows)} trials, median {np.median([r["seconds"] for r in rows]):.1f} s each')
    width = max(map(len, scores))
    for name, value in scores.items():
        target, side = targets[name]
        good = value >= target if side == 'min' else value <= target
        sign = '>=' if side == 'min' else '<='
        word = '-' if np.isnan(value) else 'reached' if good else 'SHORT'
        print(f'  {name:{width}s} {value:7.3f}   {sign} {target:<5g} {word}')
