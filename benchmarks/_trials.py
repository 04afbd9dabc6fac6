# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials side by side: the options of the command line, the loop, a line for each trial."""

import argparse
import json
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

Job = TypeVar('Job')


def options(about: str | None, seeds: int) -> argparse.ArgumentParser:
    """Return the parser of the options of all trials; *seeds* is their default number."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument('--seeds', type=int, default=seeds)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--kinds', default='')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--log', type=Path)
    return parser


def chosen(given: argparse.Namespace, kinds: Iterable[str]) -> list[tuple[str, int]]:
    """Return kind and seed of each trial that is asked for; *kinds* are those without --kinds."""
    names = given.kinds.split(',') if given.kinds else [*kinds]
    seeds = range(given.first, given.first + given.seeds)
    return [(kind, seed) for seed in seeds for kind in names]


def run_all(
    run_trial: Callable[[Job], dict[str, Any]], jobs: list[Job], given: argparse.Namespace
) -> list[dict[str, Any]]:
    """Run the trials, print and log a line for each, and return their rows."""
    rows: list[dict[str, Any]] = []
    with ProcessPoolExecutor(given.jobs) as pool:
        for row in pool.map(run_trial, jobs):
            rows.append(row)
            if given.log:
                with given.log.open('a') as log:
                    log.write(json.dumps(row) + '\n')
            print(
                f'{len(rows):4d}/{len(jobs)} {row["kind"]:36s} {row.get("where", ""):11s} '
                f'{row["seed"]:3d} {"+".join(row["found"]) or row["verdict"]:44s} '
                f'{row["augmented"] / row["noise"]:6.2f} x noise  {row["seconds"]:5.1f} s',
                flush=True,
            )
    return rows
