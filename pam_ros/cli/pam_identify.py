# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_identify``: what the nominal model lacks, found in recordings of the real rig.

It reports the error of the nominal model, the error with re-tuned parameters, which physical
effect is missing, and the error with it. Recordings are rosbag2 folders or CSV files whose
column names contain the unit (t_s, pressure_command_kPa, position_mm, force_N, ...). The folder
--out will contain report.html, report.json, identified.yaml (a parameter file for pam_sim and
pam_control) and residual.csv. Exit code 0 for any verdict, 2 for invalid input. Runs
without ROS.
"""

import argparse
import shlex
import signal
import sys
from collections.abc import Mapping
from pathlib import Path
from types import FrameType
from typing import NoReturn

from pam_ros.cli.help_text import help_text
from pam_ros.cli.sentence_parser import BAD_INPUT, SentenceParser
from pam_ros.cli.set_order import values_of_files
from pam_ros.errors import PamError, printable, shown
from pam_ros.processes.outputs import guard_outputs
from pam_ros.processes.prompt_end import end_promptly
from pam_ros.version import VERSION_HELP, VERSION_LINE

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
        required=not is_part,
        metavar='FILE',
        help='the nominal model: a parameter file of pam_sim, or a muscle of this package',
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


class ProgressBar:
    """Shows the current step: a bar on a terminal, else a line when a new step begins."""

    def __init__(self) -> None:
        """Start at 0 %."""
        from tqdm import tqdm

        self._text = ''
        self._is_shown = sys.stderr.isatty()
        self._bar = tqdm(
            total=1.0,
            disable=not self._is_shown,
            leave=False,
            bar_format='{percentage:3.0f} % |{bar:24}| {desc}',
        )

    def __call__(self, fraction: float, text: str) -> None:
        """Show the progress (0 to 1) and the current step."""
        if text != self._text and not self._is_shown:
            print(f'{100.0 * fraction:3.0f} %  {text}', file=sys.stderr, flush=True)
        self._text = text
        self._bar.set_description_str(text, refresh=False)
        self._bar.update(fraction - self._bar.n)
        self._bar.refresh()

    def say(self, text: str) -> None:
        """Print a line above the bar."""
        self._bar.write(shown(text), file=sys.stderr)

    def close(self) -> None:
        """Remove the bar from the terminal."""
        self._bar.close()


def run(given: argparse.Namespace, command: str) -> str:
    """Run the identification of the command line, write the report, return a summary."""
    from pam_ros.compiled import HAVE_NUMBA
    from pam_ros.identification.data.segment import require_joint
    from pam_ros.identification.identify import identify
    from pam_ros.identification.summary import details, last_line
    from pam_ros.recording.inputs import refuse_copies, refuse_idle
    from pam_ros.recording.mapping import column_names, read_mapping
    from pam_ros.recording.warning_list import warning_list
    from pam_ros.report.provenance import provenance
    from pam_ros.report.write import check_folder, write_report
    from pam_ros.settings.nominal import nominal_joint, package_muscles, uncertain_values
    from pam_ros.settings.recording_list import READING, recording_files

    check_folder(given.out)
    nominal = nominal_joint(given.params, given.set)
    model = nominal.joint
    uncertain = {**uncertain_values(given.params), **dict(map(_deviation, given.uncertain))}
    mapping = read_mapping(given.column, given.mapping)
    reading = {
        'muscles': nominal.recorded_muscles,
        'columns': () if given.columns is None else column_names(given.columns),
        **{name: getattr(given, name) for name in READING},
    }
    recordings, test = (
        [
            file.read(model, mapping, **reading)
            for path, values in zip(paths, own, strict=True)
            for file in recording_files(Path(path), _numbers(values))
        ]
        for paths, own in zip((given.recordings, given.test), given.values, strict=True)
    )
    require_joint([*recordings, *test], model)
    refuse_idle(recordings)  # here already, so that no warning is printed before the error
    refuse_copies([*recordings, *test])
    for names, warning in warning_list([*recordings, *test]):
        print(shown(f'{names}: {warning}'), file=sys.stderr)
    if not HAVE_NUMBA:
        print('numba is not installed: this takes some hundred times as long', file=sys.stderr)
    source = provenance(nominal, given.params, given.set, recordings, test, command)
    progress = ProgressBar()
    try:
        with end_promptly(sentence=STOPPED):  # kernels are compiled here
            answer = identify(
                model,
                recordings,
                test,
                progress,
                uncertain=uncertain,
                warn=progress.say,
                muscles=package_muscles(),
            )
        progress(1.0, 'writing the report')
        write_report(given.out, answer, source)
    finally:
        progress.close()
    end = f'{last_line(answer)}; see {given.out / "report.html"}'
    texts = [answer.summary(), *([details(answer)] if given.verbose else []), end]
    return '\n'.join(map(printable, '\n\n'.join(texts).splitlines()))


def _numbers(values: Mapping[str, str]) -> dict[str, float]:
    """Return the numbers that ``--set`` gives to some of the recordings."""
    found = {}
    for name, text in values.items():
        try:
            found[name] = float(text)
        except ValueError:
            raise PamError(
                f'--set {shown(name)}={shown(text)} between recordings is not allowed: give a '
                'number'
            ) from None
    return found


def _deviation(text: str) -> tuple[str, str]:
    """Return the name and the standard deviation of a text ``name=deviation``."""
    name, equals, given = (part.strip() for part in text.partition('='))
    if not (name and equals and given):
        raise PamError(
            f'--uncertain {shown(text)} is not allowed: give NAME=DEVIATION, such as inertia=50%'
        )
    return name, given


def main() -> None:
    """Run the identification of the command line; exit with the exit code of the program."""
    signal.signal(signal.SIGTERM, _terminate)
    guard_outputs()
    try:
        given = parser().parse_intermixed_args()
        given.values = values_of_files(sys.argv[1:], parser)
        command = shlex.join(['pam_identify', *sys.argv[1:]])
        print(run(given, command))
    except PamError as error:
        print(f'pam_identify: {error}', file=sys.stderr)
        sys.exit(BAD_INPUT)
    except KeyboardInterrupt:
        print(STOPPED, file=sys.stderr)
        sys.exit(INTERRUPTED)


def _terminate(kind: int, frame: FrameType | None) -> NoReturn:
    """Exit as on Ctrl-C: incomplete files are removed before the end."""
    sys.exit(TERMINATED)


if __name__ == '__main__':
    main()
