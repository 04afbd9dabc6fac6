# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_plot``: draw the signals of a rig, as a page for a browser or as a PNG file.

Position and reference, commanded and measured pressure, force, stiffness and damping, one below
the other on a common time axis. With the names of the joints and muscles; pressures are gauge
pressures in kPa, and the page shows SI units as well.

Subscribes, best effort
    ``joint_states``, ``pressure_command``, ``pressure``, ``force``, ``stiffness``, ``damping``,
    of joints ``pressure_commands``, ``pressures``, ``forces``, ``stiffnesses``, ``dampings``,
    and ``position_reference`` and ``pam_control/state``

Without an option it prints the address of a page on this machine (127.0.0.1) that shows the last
20 s, until Ctrl-C. With ``--png FILE`` it draws ``--seconds`` from the first message on and ends.
``--bag PATH`` draws a recording, without ROS, and ``--model`` the free runs of models over it,
with their residuals and errors. Exit code 0 at the end and after Ctrl-C, 2 for
invalid input, and if ``--png`` received nothing.
"""

import argparse
import sys
from functools import partial
from threading import Event
from typing import NamedTuple

from pam_ros.cli.help_text import help_text
from pam_ros.cli.start import start_node
from pam_ros.errors import PamError, shown
from pam_ros.plot.options import Options, add_arguments, checked
from pam_ros.plot.panels import Panel
from pam_ros.processes.ends import ignore_ends
from pam_ros.processes.interrupts import raise_on_signal
from pam_ros.processes.outputs import guard_outputs
from pam_ros.version import VERSION_HELP, VERSION_LINE

BAD_INPUT, INTERRUPTED = 2, 130


def main() -> None:
    """Draw a rig until a signal requests the end, or draw a recording."""
    own = _own(sys.argv[1:])
    if any(word in ('-h', '--help', '--bag') or word.startswith('--bag=') for word in own):
        _draw_recording(own)
    else:
        start_node('pam_ros.nodes.plot.node', 'PamPlot', __doc__)


def _own(arguments: list[str]) -> list[str]:
    """Return the arguments that are not for ROS, which are between --ros-args and --."""
    own, is_ros = [], False
    for word in arguments:
        if word == '--ros-args':
            is_ros = True
        elif is_ros:
            is_ros = word != '--'
        else:
            own.append(word)
    return own


def _draw_recording(arguments: list[str]) -> None:
    """Draw the recording of --bag, without ROS; exit with the exit code of the program."""
    raise_on_signal()
    guard_outputs()
    parser = argparse.ArgumentParser(
        prog='pam_plot',
        description=help_text(__doc__),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog='Parameters and remappings follow --ros-args: see the manual of ROS 2.',
    )
    parser.add_argument('--version', action='version', version=VERSION_LINE, help=VERSION_HELP)
    add_arguments(parser)
    try:
        _run(checked(parser.parse_args(arguments)))
    except PamError as error:
        print(f'pam_plot: {error}', file=sys.stderr)
        sys.exit(BAD_INPUT)
    except KeyboardInterrupt:
        print('pam_plot: interrupted, nothing was drawn', file=sys.stderr)
        sys.exit(INTERRUPTED)
    finally:
        ignore_ends()


def _run(options: Options) -> None:
    made = _compared(options) if options.models else _recorded(options)
    for note in made.notes:
        print(shown(f'{made.name}: {note}'), file=sys.stderr)
    if options.png is not None:
        from pam_ros.plot.figure import figure, save

        save(figure(made.panels, made.start, made.end), options.png)
        print(shown(f'wrote {options.png}'))
        return
    from pam_ros.plot.server import PageServer, content

    look = partial(
        content,
        made.panels,
        made.start,
        made.end,
        made.end,
        note=shown('; '.join(made.notes)),
        is_live=False,
    )
    server = PageServer(lambda window: look(window=window), options.port)
    try:
        server.start()
        print(f'open {server.address} in a browser; Ctrl-C ends it', flush=True)
        Event().wait()
    except KeyboardInterrupt:
        pass
    finally:
        server.close()


class _Drawing(NamedTuple):
    """The plots of a recording, the ends of the axis of time in s, and notes."""

    name: str
    panels: list[Panel]
    start: float
    end: float
    notes: tuple[str, ...]


def _recorded(options: Options) -> _Drawing:
    """Return all signals of a recording."""
    from pam_ros.plot.panels import panels
    from pam_ros.plot.recorded import read
    from pam_ros.plot.value_axis import judged
    from pam_ros.recording.mapping import read_mapping

    assert options.bag is not None
    mapping = read_mapping(options.rules)
    of_table = (options.columns, options.sheet, options.variable)
    found = read(options.bag, options.namespace, mapping, *of_table)
    drawn = panels(judged(found.curves), options.unit or found.unit, found.end)
    return _Drawing(options.bag.name, drawn, found.start, found.end, found.notes)


def _compared(options: Options) -> _Drawing:
    """Return the free runs of models over a recording, and print their errors."""
    from pam_ros.plot.models import read_comparison
    from pam_ros.recording.mapping import read_mapping

    assert options.bag is not None
    mapping = read_mapping(options.rules)
    of_table = (options.columns, options.sheet, options.variable)
    found, notes = read_comparison(
        options.bag, options.models, options.namespace, mapping, *of_table
    )
    for line in found.table():
        print(shown(line), flush=True)
    return _Drawing(options.bag.name, found.panels(), 0.0, found.end, notes)


if __name__ == '__main__':
    main()
