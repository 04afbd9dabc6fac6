# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Options of programs that do many tasks: how many at once, where, and what is resumed."""

import argparse

from pam_ros.parallel.cluster import ClusterPool
from pam_ros.parallel.local import LocalPool
from pam_ros.parallel.tasks import Pool


def add_pool_options(made: argparse.ArgumentParser, tasks: str, when: str = '') -> None:
    """Add the options for *tasks*, such as runs; *when* they apply begins each help text."""
    made.add_argument(
        '--jobs',
        type=count_of,
        metavar='N',
        help=f'{when}{tasks} side by side on this machine (default: 1)',
    )
    made.add_argument(
        '--dask',
        metavar='ADDRESS',
        help=f'{when}use the workers of a Dask cluster: the address or the file of its scheduler, '
        'or local for a cluster on this machine',
    )
    made.add_argument('--resume', action='store_true', help=f'{when}go on after an interruption')


def count_of(text: str) -> int:
    """Return the number in *text*, from 1 to 1000."""
    value = int(text) if text.isdigit() else 0
    if not 1 <= value <= 1000:
        raise argparse.ArgumentTypeError(f'{text!r} is not allowed: give 1 to 1000')
    return value


def pool_of(made: argparse.ArgumentParser, given: argparse.Namespace) -> Pool:
    """Return the processes that the options describe."""
    if given.dask and given.jobs:
        made.error('--jobs is of this machine: a Dask cluster runs as many as it has workers')
    return ClusterPool(given.dask) if given.dask else LocalPool(given.jobs or 1)
