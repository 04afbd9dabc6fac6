# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The options on the command line of ``pam_plot``."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path

from pam_ros.errors import PamError, shown
from pam_ros.plot.colours import GREY
from pam_ros.plot.panels import UNITS
from pam_ros.recording.mapping import column_names

PAGE_SECONDS, PNG_SECONDS, WAIT = 20.0, 10.0, 10.0
SHORTEST_AXIS, LONGEST_AXIS = 0.5, 3600.0  # s
PORTS = 65535
MOST_MODELS = GREY  # the colours before the one of the measurement


@dataclass(frozen=True)
class ModelOption:
    """A model to compare: a parameter file or a preset, and its values of ``--set``."""

    params: str
    values: tuple[str, ...] = ()
    own: tuple[str, ...] = ()  # those of this model alone

    @property
    def name(self) -> str:
        """The name for legends and tables; values that only this model has belong to it."""
        return ', '.join([self.params, *self.own])


@dataclass(frozen=True)
class Options:
    """The options, checked; ``png`` is None for a page, ``bag`` is None for a running rig.

    ``seconds`` is the length of the axis of time, ``wait`` how long a PNG waits for the first
    message, both in s. ``unit`` is m, rad or unknown ''.
    """

    png: Path | None
    seconds: float
    wait: float
    port: int
    unit: str
    bag: Path | None
    namespace: str | None
    rules: tuple[str, ...]
    columns: tuple[str, ...]
    sheet: str | None
    variable: str | None
    models: tuple[ModelOption, ...] = ()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options to *parser*."""
    # The program looks for --bag, by its full name, before a parser is created.
    parser.allow_abbrev = False
    parser.add_argument(
        '--png', type=Path, metavar='FILE', help='write a PNG file instead of serving a page'
    )
    parser.add_argument(
        '--seconds',
        type=float,
        metavar='S',
        help=f'length of the time axis, {SHORTEST_AXIS:g} to {LONGEST_AXIS:g} s (default: '
        f'{PAGE_SECONDS:g} of a page, {PNG_SECONDS:g} of a PNG file)',
    )
    parser.add_argument(
        '--wait',
        type=float,
        metavar='S',
        help=f'how long --png waits for the first message (default: {WAIT:g} s)',
    )
    parser.add_argument(
        '--port', type=int, metavar='N', help='port of the page (default: any free port)'
    )
    parser.add_argument(
        '--unit',
        choices=UNITS,
        help='unit of positions, for the titles: messages do not contain it',
    )
    parser.add_argument(
        '--bag',
        type=Path,
        metavar='PATH',
        help='draw a recording, a rosbag2 or a CSV file, instead of a rig that is running',
    )
    parser.add_argument(
        '--model',
        action=_InOrder,
        metavar='MODEL',
        help='with --bag: draw the free run of this model with its residuals, and print its '
        'error; a parameter file such as identified.yaml, or a muscle of this package; may be '
        'repeated',
    )
    parser.add_argument(
        '--set',
        action=_InOrder,
        metavar='NAME=VALUE',
        help='override a parameter of the --model before it, or of all models if it is before the '
        'first one; may be repeated',
    )
    parser.add_argument('--namespace', help='namespace of the rig, if a bag contains several')
    parser.add_argument(
        '--column',
        action='append',
        default=[],
        metavar='SOURCE=TARGET',
        help='meaning of a column of a CSV file, as for pam_identify',
    )
    parser.add_argument(
        '--columns',
        metavar='NAMES',
        help='names of the columns of a CSV file without a line of names, as for pam_identify',
    )
    parser.add_argument('--sheet', metavar='NAME', help='sheet of a workbook that has several')
    parser.add_argument(
        '--variable', metavar='NAME', help='struct or matrix of a MATLAB file that has several'
    )


class _InOrder(argparse.Action):
    """Collects ``--model`` and ``--set`` in the order in which they were given."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[object] | None,
        option_string: str | None = None,
    ) -> None:
        """Add the option and its value."""
        before = getattr(namespace, 'of_models', ())
        namespace.of_models = (*before, (self.dest, str(values)))


def _models(given: argparse.Namespace) -> tuple[ModelOption, ...]:
    """Return the models of a command line, with their values."""
    found: list[ModelOption] = []
    common: list[str] = []
    for option, value in getattr(given, 'of_models', ()):
        if option == 'model':
            found.append(ModelOption(value, tuple(common)))
        elif found:
            last = found[-1]
            found[-1] = replace(last, values=(*last.values, value), own=(*last.own, value))
        else:
            common.append(value)
    if common and not found:
        raise PamError(f'--set {shown(common[0])} is for --model, and no model is given')
    if len(found) > MOST_MODELS:
        raise PamError(f'{len(found)} times --model is not allowed: give at most {MOST_MODELS}')
    if found and given.bag is None:
        raise PamError('--model is for --bag: a model is compared with a recording')
    for one in found:
        if [other.name for other in found].count(one.name) > 1:
            raise PamError(f'--model {shown(one.name)} is given twice: give different models')
    return tuple(found)


def checked(given: argparse.Namespace) -> Options:
    """Return the options of a command line.

    Raises PamError, with a sentence for the user, for options that are not valid or do not match
    each other.
    """
    _refuse_together(given)
    seconds = PAGE_SECONDS if given.png is None else PNG_SECONDS
    options = Options(
        given.png,
        seconds if given.seconds is None else given.seconds,
        WAIT if given.wait is None else given.wait,
        given.port or 0,
        given.unit or '',
        given.bag,
        given.namespace,
        tuple(given.column),
        () if given.columns is None else column_names(given.columns),
        given.sheet,
        given.variable,
        _models(given),
    )
    for name, value in (('--seconds', options.seconds), ('--wait', options.wait)):
        if not (isfinite(value) and SHORTEST_AXIS <= value <= LONGEST_AXIS):
            raise PamError(
                f'{name} {value:g} is not allowed: give {SHORTEST_AXIS:g} to {LONGEST_AXIS:g} s'
            )
    if not 0 <= options.port <= PORTS:
        raise PamError(f'--port {options.port} is not allowed: give 1 to {PORTS}')
    if options.png is not None:
        _check_file(options.png)
    return options


def _refuse_together(given: argparse.Namespace) -> None:
    for option, value, other, is_other, reason in (
        ('--port', given.port, '--png', given.png, 'a PNG file has no page'),
        ('--seconds', given.seconds, '--bag', given.bag, 'a recording is drawn from end to end'),
        ('--wait', given.wait, '--bag', given.bag, 'a recording is already complete'),
    ):
        if value is not None and is_other is not None:
            raise PamError(f'{option} is not allowed with {other}: {reason}')
    if given.wait is not None and given.png is None:
        raise PamError('--wait is for --png: a page waits until it is ended')
    for option, value in (
        ('--namespace', given.namespace),
        ('--column', given.column),
        ('--columns', given.columns),
        ('--sheet', given.sheet),
        ('--variable', given.variable),
    ):
        if value and given.bag is None:
            raise PamError(
                f'{option} is for --bag; a rig that is running is chosen with '
                '--ros-args -r __ns:=/NAMESPACE'
            )


def _check_file(path: Path) -> None:
    if path.suffix.lower() != '.png':
        raise PamError(f'--png {path} is not allowed: give a name that ends in .png')
    if path.is_dir():
        raise PamError(f'--png {path} is a folder: give the path of a file')
    if not path.parent.is_dir():
        raise PamError(f'--png {path} cannot be written: the folder {path.parent} does not exist')
