# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_demo``: run the parts of this package over ROS topics, and write plots and tables."""

import argparse
import os
import sys
from importlib import import_module
from pathlib import Path

from pam_ros.cli.help_text import help_text
from pam_ros.demo.outline import CHAPTERS, next_steps, plan
from pam_ros.errors import PamError
from pam_ros.processes.ends import ignore_ends
from pam_ros.processes.interrupts import raise_on_signal
from pam_ros.processes.outputs import guard_outputs
from pam_ros.version import VERSION_HELP, VERSION_LINE

BAD_INPUT, INTERRUPTED = 2, 130


def main() -> None:
    """Play the chapters that the command line names, all of them by default."""
    guard_outputs()
    parser = argparse.ArgumentParser(prog='pam_demo', description=help_text(__doc__))
    parser.add_argument('--version', action='version', version=VERSION_LINE, help=VERSION_HELP)
    parser.add_argument(
        'chapters', nargs='*', metavar='CHAPTER', help='one of ' + ', '.join(CHAPTERS)
    )
    parser.add_argument('--out', type=Path, default=Path('demo'), help='folder (default: demo)')
    given = parser.parse_args()
    for name in given.chapters:
        if name not in CHAPTERS:
            parser.error(f'the chapter {name} does not exist: give one of ' + ', '.join(CHAPTERS))
    names = given.chapters or [*CHAPTERS]
    print(plan(names, given.out), flush=True)
    # Each signal that requests the end stops the programs that a chapter has started.
    raise_on_signal()
    # The demonstration needs no other machine, and no other should receive its messages.
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    try:
        stage = import_module('pam_ros.demo.stage').DemoStage(given.out)
        for name in names:
            import_module(f'pam_ros.nodes.demo.{name}').play(stage)
        print(next_steps(given.out))
    except (PamError, OSError) as error:
        print(f'pam_demo: {error}', file=sys.stderr)
        sys.exit(BAD_INPUT)
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    finally:
        ignore_ends()


if __name__ == '__main__':
    main()
