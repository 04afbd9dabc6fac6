# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The texts at the beginning and at the end of the demonstration."""

import shlex
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Chapter:
    """A part of the demonstration: its content, and its approximate duration in s."""

    about: str
    seconds: int


# Each is a module of pam_ros.nodes.demo with a function play(stage). The times were measured on
# two cores in 2026, with all kernels compiled.
CHAPTERS = {
    'paper': Chapter('the experiment of the paper: a load is released, then pressure steps', 10),
    'position': Chapter('position control of a load that is heavier than configured', 15),
    'joint': Chapter('an antagonistic joint: angle and stiffness are controlled', 13),
    'loop': Chapter('a rig is excited, recorded and identified; the result is validated', 62),
}
ROUNDED = 5  # s


def plan(names: Sequence[str], folder: Path) -> str:
    """Return what the chapters *names* will show, how long it takes, and where the files go."""
    whole = sum(CHAPTERS[name].seconds for name in names)
    width = max(len(name) for name in names)
    lines = [f'{name:<{width}}  {CHAPTERS[name].about}' for name in names]
    head = f'Demonstration over ROS topics, about {duration(whole)}; files go to {folder}/'
    return '\n'.join([head, *(f'  {line}' for line in lines)])


def duration(seconds: int) -> str:
    """Return a time in words: in seconds below 90 s, else in minutes, rounded to one half."""
    if seconds < 90:
        return f'{ROUNDED * round(seconds / ROUNDED)} s'
    return f'{round(seconds / 30) / 2:g} minutes'


def next_steps(folder: Path) -> str:
    """Return commands to try next, with the files that exist in *folder*."""
    report = folder / 'loop' / 'report'
    commands = [
        (
            'simulate a muscle, until Ctrl-C',
            'pam_sim',
            ['--ros-args', '-p', 'muscle:=dmsp_20_400n'],
        )
    ]
    if (report / 'identified.yaml').is_file():
        file = str(report / 'identified.yaml')
        commands.append(
            (
                'simulate the rig as it was identified',
                'pam_sim',
                ['--ros-args', '--params-file', file],
            )
        )
        recording = str(folder / 'loop' / 'recording')
        given = [recording, '--params', 'dmsp_20_400n', '--out', 'report']
        commands.append(('identify the recording yourself', 'pam_identify', given))
    lines = []
    for what, name, arguments in commands:
        lines += [f'  # {what}', f'  {program(name)} {shlex.join(arguments)}']
    page = 'docs/tutorials/muscle_in_ten_minutes.md'
    return '\n'.join(['Try next:', *lines, f'and read {page}'])


def program(name: str) -> str:
    """Return the command that starts a program of this package, next to this one if possible."""
    beside = Path(sys.argv[0]).with_name(name)
    return shlex.quote(str(beside)) if beside.is_file() else f'python3 -m pam_ros.cli.{name}'
