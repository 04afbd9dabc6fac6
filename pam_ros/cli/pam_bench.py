# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_bench``: compare controllers in scenarios, each controller a process over ROS topics.

A CONTROLLER is sliding_mode or pid (pam_control with this law), pam_control:FILE with a parameter
file, or NAME='COMMAND', which starts a node of your own in any language: it hears joint_states and
position_reference, and publishes pressure_command (pressure_commands for several muscles). A node
that follows /clock (use_sim_time) runs in lockstep, as fast as it can compute; another one runs in
real time, and is marked. In COMMAND, {parameters} stands for a parameter file of what is declared
of the rig. A launch file is started by NAME='ros2 launch FILE use_sim_time:=true'. Each run has
a DDS domain of its own: no other robot is commanded.

The folder --out will contain bench.html and bench.json, and with --draw the folder scenarios.
Exit code 0 if all was run, whatever the scores are; 1 if a limit of --limits is not kept, 2 for
invalid input.
"""

import argparse
import sys
from importlib import import_module
from pathlib import Path
from secrets import randbelow
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from pam_ros.cli.help_text import help_text
from pam_ros.cli.pool_options import add_pool_options, count_of, pool_of
from pam_ros.cli.sentence_parser import BAD_INPUT, SentenceParser
from pam_ros.cli.start import NEEDS_ROS
from pam_ros.errors import PamError, shown
from pam_ros.processes.ends import ignore_ends
from pam_ros.processes.interrupts import raise_on_signal
from pam_ros.processes.outputs import guard_outputs
from pam_ros.version import VERSION_HELP, VERSION_LINE

if TYPE_CHECKING:
    from pam_ros.bench.scenario import Scenario

INTERRUPTED = 130
SEEDS = 3
LARGEST_SEED = 999_999


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    made = SentenceParser(
        prog='pam_bench',
        description=help_text(__doc__),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument('--version', action='version', version=VERSION_LINE, help=VERSION_HELP)
    made.add_argument('controllers', nargs='*', metavar='CONTROLLER', help='see above')
    made.add_argument('--out', type=Path, metavar='DIR', help='folder for the results')
    made.add_argument(
        '--scenario',
        nargs='+',
        action='extend',
        default=[],
        metavar='NAME',
        help='scenarios of this package, or YAML files (default: all of this package)',
    )
    made.add_argument('--suite', choices=('muscle', 'joint'), help='only scenarios of this suite')
    made.add_argument(
        '--draw',
        type=count_of,
        metavar='N',
        help='N scenarios drawn at random, kept in DIR/scenarios',
    )
    made.add_argument(
        '--seed', type=_seed, metavar='S', help='draw those of this seed (default: a new one)'
    )
    made.add_argument(
        '--quick', action='store_true', help='a short selection, with one seed unless --seeds'
    )
    made.add_argument(
        '--seeds', type=count_of, metavar='N', help=f'runs of each (default: {SEEDS})'
    )
    add_pool_options(made, 'runs')
    made.add_argument(
        '--domain', type=int, metavar='N', help='DDS domain of a single job (default: a free one)'
    )
    made.add_argument(
        '--limits', type=Path, metavar='FILE', help='YAML file of the highest scores permitted'
    )
    made.add_argument(
        '--compare', type=Path, metavar='JSON', help='bench.json of an earlier bench: what changed'
    )
    made.add_argument('--list', action='store_true', help='list scenarios and scores, and end')
    return made


def _seed(text: str) -> int:
    value = int(text) if text.isdecimal() else -1
    if not 0 <= value <= LARGEST_SEED:
        raise argparse.ArgumentTypeError(f'{text!r} is not allowed: give 0 to {LARGEST_SEED}')
    return value


def main() -> None:
    """Run the bench that the command line describes."""
    guard_outputs()
    made = parser()
    given = made.parse_args()
    raise_on_signal()
    try:
        code = _run(made, given)
    except (PamError, OSError) as error:
        print(f'pam_bench: {shown(str(error))}', file=sys.stderr)
        code = BAD_INPUT
    except KeyboardInterrupt as interrupt:
        what = 'nothing' if given.draw is None else 'nothing but the drawn scenarios'
        print(
            f'pam_bench: interrupted, {str(interrupt) or f"{what} was written"}', file=sys.stderr
        )
        code = INTERRUPTED
    finally:
        ignore_ends()
    sys.exit(code)


def _run(made: argparse.ArgumentParser, given: argparse.Namespace) -> int:
    from pam_ros.bench import listing
    from pam_ros.bench.controllers import controllers_of

    if given.draw is not None and given.scenario:
        made.error('--draw and --scenario exclude each other: give one of them')
    if given.seed is not None and given.draw is None:
        made.error(f'--seed {given.seed} is the seed of --draw: give --draw N, or --seeds N')
    if given.resume and given.draw is not None and given.seed is None:
        made.error('--resume needs --seed S with --draw: the names of the scenarios have it')
    if given.list:
        with TemporaryDirectory() as folder:
            print(listing.text(_scenarios(given, Path(folder))))
        return 0
    if not given.controllers:
        made.error('no controller is given, such as sliding_mode or pid')
    if given.out is None:
        made.error('--out is missing: give the folder for the results')
    is_single = not given.dask and given.jobs in (None, 1)
    if given.domain is not None and not (is_single and 0 <= given.domain <= 232):
        made.error(f'--domain {given.domain} is not allowed: give 0 to 232, and one job')
    from pam_ros.bench.bench import perform

    try:
        run = import_module('pam_ros.nodes.bench.run').run
    except ModuleNotFoundError as error:
        if error.name != 'rclpy':
            raise
        raise PamError(NEEDS_ROS) from None
    pool = pool_of(made, given)
    controllers_of(given.controllers)  # what is wrong is said before scenarios are written
    scenarios = _scenarios(given, given.out / 'scenarios')
    return perform(given, scenarios, given.seeds or (1 if given.quick else SEEDS), run, pool)


def _scenarios(given: argparse.Namespace, folder: Path) -> 'list[Scenario]':
    """Return the scenarios of the command line; those that are drawn are written to *folder*."""
    if given.draw is not None:
        from pam_ros.bench.draw.draw import drawn_scenarios

        seed = randbelow(LARGEST_SEED + 1) if given.seed is None else given.seed
        return drawn_scenarios(folder, given.draw, seed, given.suite)
    from pam_ros.bench.scenario import chosen

    return chosen(given.scenario, given.suite, is_quick=given.quick)


if __name__ == '__main__':
    main()
