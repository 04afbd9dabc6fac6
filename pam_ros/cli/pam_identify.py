# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_identify``: what the nominal model lacks, found in recordings of the real rig.

It reports the error of the nominal model, the error with re-tuned parameters, which physical
effect is missing, and the error with it. Recordings are rosbag2 folders or CSV files whose
column names contain the unit (t_s, pressure_command_kPa, position_mm, force_N, ...). The folder
--out will contain report.html, report.json, identified.yaml (a parameter file for pam_sim and
pam_control) and residual.csv. Exit code 0 for any verdict, 2 for invalid input. Ctrl-C ends
the search and reports the best model so far, marked as incomplete (exit code 130); a second one
ends the program. Runs without ROS.
"""

import argparse
import shlex
import signal
import sys
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, NoReturn

from pam_ros.cli.help_text import help_text
from pam_ros.cli.pool_options import add_pool_options, pool_of
from pam_ros.cli.progress_bar import ProgressBar
from pam_ros.cli.sentence_parser import BAD_INPUT, SentenceParser
from pam_ros.cli.set_order import values_of_files
from pam_ros.errors import PamError, printable, shown
from pam_ros.processes.early_end import EarlyEnd
from pam_ros.processes.outputs import guard_outputs
from pam_ros.processes.prompt_end import end_promptly
from pam_ros.version import VERSION_HELP, VERSION_LINE

if TYPE_CHECKING:  # these import numba, which the help does not need
    from pam_ros.identification.identification import Identification
    from pam_ros.report.provenance import Provenance
    from pam_ros.settings.inputs import Inputs

INTERRUPTED, TERMINATED = 130, 143
STOPPED = 'pam_identify: interrupted, nothing was written'


def parser(*, is_part: bool = False) -> argparse.ArgumentParser:
    """Return the parser of the command line, or of its first part, which may lack anything."""
    some = '*' if is_part else '+'
    made = SentenceParser(
        prog='pam_identify',
        description=help_text(__doc__),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument('--version', action='version', version=VERSION_LINE, help=VERSION_HELP)
    made.add_argument(
        'recordings',
        nargs=some,
        metavar='RECORDING',
        help='rosbag2 folder or CSV file to fit, or a YAML file with a list of them',
    )
    made.add_argument(
        '--params',
        metavar='FILE',
        help='the nominal model: a parameter file of pam_sim, or a muscle of this package; a list '
        'of recordings may name it instead',
    )
    made.add_argument(
        '--set',
        action='append',
        default=[],
        metavar='NAME=VALUE',
        help='override one of its parameters, such as mass=20; may be repeated, and a number of '
        'the load also between recordings: each has the last value before it',
    )
    made.add_argument(
        '--uncertain',
        action='append',
        default=[],
        metavar='NAME=DEVIATION',
        help='standard deviation of a nominal value: inertia=50%%, or in its unit, mass=0.2; the '
        'value is then fitted as well; may be repeated',
    )
    _add_recording_options(made, some)
    made.add_argument(
        '--verbose',
        action='store_true',
        help='also print how the fits ended and every effect that was tried',
    )
    _add_batch_options(made)
    made.add_argument(
        '--out', type=Path, required=not is_part, metavar='DIR', help='folder for the report'
    )
    return made


def _add_recording_options(made: argparse.ArgumentParser, some: str) -> None:
    """Add the options for which recordings are read, and how."""
    made.add_argument(
        '--test',
        nargs=some,
        action='extend',
        default=[],
        metavar='RECORDING',
        help='recordings for validation, not used for fits (default: last quarter of the others)',
    )
    made.add_argument(
        '--column',
        action='append',
        default=[],
        metavar='SOURCE=TARGET',
        help='meaning of a column or topic: adc=force_N*0.392-4.18, or NAME=ignore',
    )
    made.add_argument(
        '--mapping', type=Path, metavar='FILE', help='YAML file with such lines below columns:'
    )
    made.add_argument(
        '--columns',
        metavar='NAMES',
        help='names of the columns of CSV files without a line of names, in their order: '
        't_s,pressure_kPa,-,position_mm; - is a column that is not used',
    )
    made.add_argument('--sheet', metavar='NAME', help='sheet of Excel workbooks that have several')
    made.add_argument(
        '--variable', metavar='NAME', help='struct or matrix of MATLAB files that have several'
    )
    made.add_argument(
        '--kind',
        choices=('free', 'held', 'pressure'),
        help='free: the load moves; held: the length is prescribed; pressure: only commands and '
        'measured pressures (default: from the data)',
    )
    made.add_argument('--namespace', help='namespace of the rig, if bags contain several')
    made.add_argument(
        '--time',
        choices=('header', 'received'),
        default='header',
        help='times of messages in bags: stamps of headers, where there are some, or times of '
        'receipt (default: header)',
    )


def _add_batch_options(made: argparse.ArgumentParser) -> None:
    """Add the options for many rigs."""
    made.add_argument(
        '--each',
        action='store_true',
        help='each RECORDING is of another rig: a report for each of them in a folder of --out, '
        'and one table; a rig with several recordings is a list of them',
    )
    add_pool_options(made, 'rigs', 'with --each: ')


def run(given: argparse.Namespace, command: str) -> int:
    """Run the identification of the command line, write the report, and print a summary.

    The first Ctrl-C ends the search as soon as it has a model, and this model is reported. Returns
    the exit code.
    """
    from pam_ros.compiled import HAVE_NUMBA
    from pam_ros.identification.summary import details, last_line
    from pam_ros.recording.warning_list import warning_list
    from pam_ros.report.provenance import provenance
    from pam_ros.report.write import check_folder
    from pam_ros.settings.inputs import read_inputs

    check_folder(given.out)
    inputs = read_inputs(given, (given.recordings, given.test), given.values)
    for names, warning in warning_list([*inputs.recordings, *inputs.test]):
        print(shown(f'{names}: {warning}'), file=sys.stderr)
    if inputs.assumed:
        print(f'note: {inputs.assumed}', file=sys.stderr)
    if not HAVE_NUMBA:
        print('numba is not installed: this takes some hundred times as long', file=sys.stderr)
    source = provenance(inputs, given.set, command)
    stop = EarlyEnd()
    answer = _reported(given.out, inputs, source, stop)
    page = given.out / 'report.html'
    texts = [answer.summary(), *([details(answer)] if given.verbose else [])]
    lines = '\n\n'.join([*texts, f'{last_line(answer)}; see {page}']).splitlines()
    print('\n'.join(map(printable, lines)))
    if stop.is_requested:
        which = 'the complete report' if answer.is_complete else 'an incomplete report'
        text = f'pam_identify: interrupted, {which} was written to {page}'
        print(shown(text), file=sys.stderr)
    return stop.code


def _reported(
    folder: Path, inputs: 'Inputs', source: 'Provenance', stop: EarlyEnd
) -> 'Identification':
    """Identify what is in *inputs*, until signals request the *stop*, and write the report."""
    from pam_ros.identification.workers import thread_count
    from pam_ros.report.write import write_report

    threads = thread_count()
    size = f'{threads} core{"" if threads == 1 else "s"} ({inputs.size})'
    progress = ProgressBar(size, lambda: stop.is_requested)
    try:
        with stop.on_signals():
            # Kernels are compiled here, before there is a result.
            with end_promptly(sentence=STOPPED, leaves_first=lambda: stop.has_result):
                answer = inputs.identify(progress, progress.say, progress.time_left, stop)
            progress(1.0, 'writing the report')
            write_report(folder, answer, source)
    finally:
        progress.close()
    return answer


def run_each(made: argparse.ArgumentParser, given: argparse.Namespace, command: str) -> int:
    """Identify each rig of the command line, and return the exit code."""
    from pam_ros.batch.batch import identify_each

    if given.test or given.verbose:
        made.error(f'--{"test" if given.test else "verbose"} is not for --each')
    return identify_each(given, command, pool_of(made, given))


def main() -> None:
    """Run the identification of the command line; exit with the exit code of the program."""
    signal.signal(signal.SIGTERM, _terminate)
    guard_outputs()
    try:
        made = parser()
        given = made.parse_intermixed_args()
        given.values = values_of_files(sys.argv[1:], parser)
        command = shlex.join(['pam_identify', *sys.argv[1:]])
        if given.each:
            sys.exit(run_each(made, given, command))
        for option in ('jobs', 'dask', 'resume'):
            if getattr(given, option):
                made.error(f'--{option} is for --each')
        sys.exit(run(given, command))
    except PamError as error:
        print(f'pam_identify: {error}', file=sys.stderr)
        sys.exit(BAD_INPUT)
    except KeyboardInterrupt as interrupt:
        kept = str(interrupt)
        print(f'pam_identify: interrupted, {kept}' if kept else STOPPED, file=sys.stderr)
        sys.exit(INTERRUPTED)


def _terminate(kind: int, frame: FrameType | None) -> NoReturn:
    """Exit as on Ctrl-C: incomplete files are removed before the end."""
    sys.exit(TERMINATED)


if __name__ == '__main__':
    main()
