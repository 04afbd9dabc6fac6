# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The controllers that are compared: which program each of them is, and with which parameters."""

import re
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pam_ros.errors import ParameterError
from pam_ros.settings.files import read_any
from pam_ros.settings.tables import Values

# Controllers of this package, each pam_control with these parameters.
OWN: Mapping[str, Values] = {
    'pam_control': {},
    'sliding_mode': {'controller': 'sliding_mode'},
    'pid': {'controller': 'pid'},
}
PROGRAM = 'pam_control'
NAME = re.compile(r'[A-Za-z0-9][A-Za-z0-9_.-]*')
PARAMETERS = '{parameters}'  # in a command line: the file of the declared parameters


@dataclass(frozen=True)
class Controller:
    """A program that controls: ``pam_control`` with *parameters*, or a *command* of the user.

    *file* is a parameter file of ``pam_control``.
    """

    name: str
    parameters: Values = field(default_factory=dict)
    file: Path | None = None
    command: tuple[str, ...] = ()

    @property
    def is_own(self) -> bool:
        """Whether it is ``pam_control``."""
        return not self.command

    @property
    def about(self) -> str:
        """How it is started, as text."""
        if self.command:
            return shlex.join(self.command)
        own = [f'{name}={value}' for name, value in self.parameters.items()]
        return ' '.join([PROGRAM, *own, *([str(self.file)] if self.file else [])])

    def command_line(self, file: Path, rate: float, *, is_simulated: bool) -> list[str]:
        """Return the command that starts it.

        *file* is a parameter file with what is declared of the rig, whose states have this *rate*
        in Hz. With *is_simulated* time is simulated.
        """
        if self.command:
            return [word.replace(PARAMETERS, str(file)) for word in self.command]
        given = {'use_sim_time': is_simulated, 'rate': rate, **self.parameters}
        words = [sys.executable, '-m', f'pam_ros.cli.{PROGRAM}', '--ros-args']
        words += ['--params-file', str(file)]
        if self.file is not None:
            words += ['--params-file', str(self.file)]
        for name, value in given.items():
            words += ['-p', f'{name}:={str(value).lower()}']
        return words


def controllers_of(texts: Sequence[str]) -> list[Controller]:
    """Return the controllers that a command line names.

    Each text is ``pam_control``, ``sliding_mode`` or ``pid``; ``pam_control:FILE`` or
    ``NAME=pam_control:FILE`` with a parameter file; or ``NAME=COMMAND``. Raises ParameterError for
    other texts, for names given twice, and for files and programs that do not exist.
    """
    found: dict[str, Controller] = {}
    for text in texts:
        one = _controller(text)
        if one.name in found:
            raise ParameterError(
                f'two controllers are called {one.name}: give NAME=... with another name'
            )
        found[one.name] = one
    return list(found.values())


def _controller(text: str) -> Controller:
    if text in OWN:
        return Controller(text, OWN[text])
    name, equals, rest = text.partition('=')
    if not equals or ':' in name:
        name, rest = '', text
    program, colon, file = rest.partition(':')
    if program == PROGRAM and colon:
        return _with_file(name, Path(file))
    if not name:
        raise ParameterError(
            f'{text!r} is not a controller: give one of {", ".join(OWN)}, {PROGRAM}:FILE with a '
            "parameter file, or NAME='COMMAND' that starts a node of your own"
        )
    if not NAME.fullmatch(name):
        raise ParameterError(
            f'{name!r} is not a name of a controller: give letters, digits, _, - and .'
        )
    try:
        words = shlex.split(rest)
    except ValueError as error:
        raise ParameterError(f'the command of {name} cannot be read: {error}') from error
    if not words:
        raise ParameterError(f'{name} has no command: give {name}=COMMAND')
    if shutil.which(words[0]) is None:
        raise ParameterError(f'the program {words[0]} of {name} does not exist')
    return Controller(name, command=tuple(words))


def _with_file(name: str, file: Path) -> Controller:
    if not file.is_file():
        raise ParameterError(f'{PROGRAM}:{file}: the parameter file does not exist')
    read_any(file, PROGRAM)
    return Controller(name or file.stem, file=file.resolve())
