# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The common arguments of the launch files, and the parameters that result for the programs.

An argument has the same meaning in each launch file. Nothing here needs ROS: a launch file
declares those arguments that it uses.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from pam_ros.arguments import refuse
from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import LOAD
from pam_ros.settings.control import ControlSettings
from pam_ros.settings.files import find
from pam_ros.settings.rig import KINDS
from pam_ros.settings.sim import SimSettings
from pam_ros.settings.tables import Table, joint_table, override, table_of
from pam_ros.similar_names import similar

PACKAGE = 'pam_ros'
MUSCLE = 'dmsp_20_400n'
SIM, CONTROL = table_of(SimSettings), table_of(ControlSettings)
OWN_TIME = ('scaled', 'lockstep')
TRUE = ('true', 'True')  # the latter as Python has it
TRUE_OR_FALSE = (*TRUE, 'false', 'False')


class Argument(NamedTuple):
    """The description of an argument, which ``--show-args`` prints."""

    text: str
    default: str = ''
    choices: tuple[str, ...] = ()

    @property
    def declared(self) -> dict[str, Any]:
        """The keywords of DeclareLaunchArgument."""
        about = {'description': self.text, 'default_value': self.default}
        return {**about, 'choices': list(self.choices)} if self.choices else about


ARGUMENTS = {
    'muscle': Argument(
        'muscle of config/muscles, or the path of a parameter file of one; if not given: that of '
        f'params, and without params {MUSCLE}'
    ),
    'joint': Argument('kind of the joint; if not given: as in params, or load', '', ('', *KINDS)),
    'mass': Argument('kg of the load; if not given: as in params, or that of the muscle file'),
    'params': Argument(
        'ROS parameter file of the programs, such as an identified.yaml; several are separated by '
        'commas, and later ones override earlier ones'
    ),
    'publish_rate': Argument(
        'Hz of the simulated joint states; if not given: as in params, or 500'
    ),
    'rate': Argument("Hz of the controller's commands; if not given: as in params, or 500"),
    'time_mode': Argument(
        'how simulated time passes; if it is scaled or lockstep, a controller follows /clock; '
        'if not given: as in params, or real_time',
        '',
        ('', *SIM['time_mode'][2].choices),
    ),
    'use_sim_time': Argument(
        'true: programs that do not generate the time follow /clock; if not given: only a '
        'controller does, if time_mode is scaled or lockstep',
        '',
        ('', *TRUE_OR_FALSE),
    ),
    'namespace': Argument('namespace of all nodes'),
    'model': Argument(
        'rig, antagonistic_pair, or the path of a URDF with the joint of joint_states', 'rig'
    ),
    'rviz': Argument(
        'false: publish only the robot description and tf, without RViz', 'true', TRUE_OR_FALSE
    ),
}


# What the argument means where no controller is started.
VIEW_TIME = Argument(
    'true: the programs follow /clock; if not given: the time of the system',
    '',
    ('', *TRUE_OR_FALSE),
)


def refuse_unknown(file: str, known: Iterable[str], words: Iterable[str]) -> None:
    """Raise ParameterError for an argument that the launch file *file* does not have.

    *words* are those of the command line. If they start another launch file, which includes this
    one, they may be arguments of that file and are not checked.
    """
    words, known = list(words), list(known)
    if not is_started(file, words):
        return
    for name in (word.partition(':=')[0] for word in words if ':=' in word):
        if name not in known:
            alike = similar(name, known)
            hint = f'was {alike} meant?' if alike else f'give one of {", ".join(known)}, or a '
            hint += '' if alike else 'parameter file as params'
            raise ParameterError(f'{name} is not an argument of {Path(file).name}: {hint}')


def is_started(file: str, words: Iterable[str]) -> bool:
    """Return whether the command line of *words* starts the launch file *file* itself.

    Otherwise it starts another one, perhaps of the same name, which includes this one.
    """
    return any(_starts(Path(file), before, word) for before, word in pairwise(['', *words]))


def _starts(file: Path, before: str, word: str) -> bool:
    """Return whether a *word* after the word *before* starts this launch file: by path or name."""
    if Path(word).is_file():
        return Path(word).resolve() == file.resolve()
    return (before, word) == (PACKAGE, file.name)


class JointEnd:
    """Ends a launch, with the exit code of the program, when one of its programs dies.

    An instance is the ``on_exit`` of all programs. A program that ends with code 0 was stopped on
    purpose, and the others continue. launch itself has no exit code but 0 and 1: when all programs
    have ended, this raises SystemExit with that of the program, or with 128 and the number of the
    signal that killed it, as a shell has it.
    """

    def __init__(self, programs: int, shutdown: Callable[[str], Any]) -> None:
        """End *programs* programs together; *shutdown* returns launch's action for a reason."""
        self._running, self._shutdown, self._code = programs, shutdown, 0

    def __call__(self, event: Any, context: Any) -> list[Any]:
        """Handle the end of a program, an event of launch; return the actions that follow."""
        self._running -= 1
        actions = []
        if event.returncode and not context.is_shutdown and not self._code:
            code = event.returncode
            self._code = code if code > 0 else 128 - code
            actions = [self._shutdown(f'{event.process_name} ended with exit code {code}')]
        if self._code and not self._running:
            raise SystemExit(self._code)
        return actions


def simulator(given: Mapping[str, str]) -> list[Any]:
    """Return the parameters of ``pam_sim``: files, then the given values, which override them."""
    values = _common(given)
    values |= _of(given, SIM, 'publish_rate', 'time_mode')
    if given['use_sim_time'] and given['time_mode'] not in OWN_TIME:
        values['use_sim_time'] = given['use_sim_time'] in TRUE
    return [*_files(given), *([values] if values else [])]


def controller(given: Mapping[str, str]) -> list[Any]:
    """Return the parameters of ``pam_control``: files, then given values, which override them."""
    values = {**_common(given), **_of(given, CONTROL, 'rate')}
    follows = given['use_sim_time'] or ('true' if given['time_mode'] in OWN_TIME else '')
    if follows:
        values['use_sim_time'] = follows in TRUE
    return [*_files(given), *([values] if values else [])]


def _common(given: Mapping[str, str]) -> dict[str, Any]:
    """Return the common parameters of both programs, checked."""
    muscle = given['muscle'] or ('' if given['params'] else MUSCLE)
    if muscle:
        find(muscle)
    values = {'muscle': muscle, 'joint': given['joint']}
    return {
        **{name: value for name, value in values.items() if value},
        **_of(given, _joint_table(given), 'mass'),
    }


def _joint_table(given: Mapping[str, str]) -> Table:
    """Return the table of the joint, or only a mass for any joint if a file may name the joint."""
    if given['joint'] or not given['params']:
        return joint_table(KINDS[given['joint'] or LOAD.name])
    kind, default, about = joint_table(LOAD)['mass']
    return {'mass': (kind, default, replace(about, above_low=False))}


def _of(given: Mapping[str, str], table: Table, *names: str) -> dict[str, Any]:
    """Return the values given for *names*, checked like the parameters of *table*."""
    return dict(override(f'{name}={given[name]}', table) for name in names if given[name])


def _files(given: Mapping[str, str]) -> list[str]:
    """Return the parameter files; raises ParameterError if one does not exist."""
    files = [file.strip() for file in given['params'].split(',') if file.strip()]
    for file in files:
        if not Path(file).is_file():
            refuse('params', file, 'the path of a ROS parameter file')
    return files
