# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Print the muscles and rigs that this package knows by name: ``python -m pam_ros.presets``."""

import argparse
import re
from pathlib import Path
from textwrap import indent, wrap

from pam_ros.processes.outputs import guard_outputs
from pam_ros.settings.files import presets
from pam_ros.settings.nominal import nominal_joint
from pam_ros.version import VERSION_HELP, VERSION_LINE

WIDTH = 95
HEADINGS = {
    'muscles': (
        'Muscles: --ros-args -p muscle:=NAME for pam_sim and pam_control, --params NAME for '
        "pam_identify, --model NAME for pam_plot, load_muscle('NAME') in Python."
    ),
    'rigs': (
        'Rigs of which public recordings exist: --params NAME for pam_identify, --model NAME for '
        "pam_plot, load_joint('NAME') in Python."
    ),
}


def listed() -> str:
    """Return all names with what each is, its limits, where its constants are from, its file."""
    parts = []
    for folder, heading in HEADINGS.items():
        parts.append('\n'.join(wrap(heading, WIDTH)))
        parts += [_entry(name, file) for name, file in presets(folder).items()]
    return '\n\n'.join(parts)


def about(file: Path) -> str:
    """Return the first sentence of the comment with which a parameter file begins."""
    lines = file.read_text(encoding='utf-8').splitlines()
    comment = ' '.join(line.lstrip('# ') for line in lines[: _first_without_comment(lines)])
    return re.split(r'(?<=\.)\s', comment, maxsplit=1)[0]


def _first_without_comment(lines: list[str]) -> int:
    return next((k for k, line in enumerate(lines) if not line.startswith('#')), len(lines))


def _entry(name: str, file: Path) -> str:
    muscle = nominal_joint(name).joint.actuators[0].muscle
    facts = [about(file)]
    if not muscle.is_load_only:
        facts.append(
            f'l0 {muscle.l0:g} m, p_max {1e-3 * muscle.p_max:g} kPa, force_max '
            f'{muscle.force_max:g} N, kappa_max {muscle.kappa_max:g}'
        )
    facts.append(f'source: {muscle.source}')
    text = '\n'.join(line for one in facts for line in wrap(one, WIDTH - 2))
    return f'{name}\n{indent(text, "  ")}\n  {file}'


def main() -> None:
    """Run the program."""
    guard_outputs()
    parser = argparse.ArgumentParser(
        prog='python -m pam_ros.presets',
        description='Print the muscles and rigs that pam_ros knows by name.',
    )
    parser.add_argument('--version', action='version', version=VERSION_LINE, help=VERSION_HELP)
    parser.parse_args()
    print(listed())


if __name__ == '__main__':
    main()
