# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scenarios: a rig, what of it is not declared to the controller, and what is demanded of it.

A scenario is a YAML file. Those of this package are in ``config/bench``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pam_ros.bench.faults import NO_FAULTS, MessageFaults, Outage, messages_of, outages_of
from pam_ros.bench.references import Reference, reference_of
from pam_ros.bench.scores import SCORES
from pam_ros.errors import PamError, ParameterError
from pam_ros.parameters import Parameter
from pam_ros.plain_yaml import read_yaml
from pam_ros.settings.files import find, flattened, share
from pam_ros.settings.scene import Scene, SimulationSetup
from pam_ros.settings.sim import SimSettings
from pam_ros.settings.tables import Values, checked, table_of
from pam_ros.similar_names import similar

FOLDER = 'bench'  # of config/
SUITES = ('muscle', 'joint')
RATE = 500.0  # Hz of states and commands, unless the scenario gives publish_rate
# Set by the bench: the time mode follows from the controller, and the seed from the run.
OF_BENCH = ('time_mode', 'sensor.seed')
# What a run is recorded with, and where it starts.
FIXED = {*table_of(SimSettings), *Scene.start}
# Keys of a scenario, with their types and descriptions.
KEYS: Mapping[str, tuple[type, Parameter]] = {
    'about': (str, Parameter('what the scenario tests, in a sentence')),
    'suite': (str, Parameter('the suite that it belongs to', choices=SUITES)),
    'quick': (bool, Parameter('whether it belongs to the short selection')),
    'score': (str, Parameter('the score that decides', choices=tuple(s.name for s in SCORES))),
    'duration': (float, Parameter('length of the run', 's', low=1.0, high=600.0)),
}
TABLES = ('declared', 'undeclared', 'reference', 'changes', 'messages', 'outages')
NEEDED = ('about', 'duration', 'declared', 'reference')


@dataclass(frozen=True, eq=False)
class Change:
    """Parameters of the rig that change at a *time* in s; the controller is not told."""

    time: float
    values: Values


@dataclass(frozen=True, eq=False)
class Scenario:
    """A rig with what is declared of it and what is not, a reference, changes and faults.

    ``declared`` and ``undeclared`` are parameters of ``pam_sim``, by dotted names: the simulator
    has both, the controller is given the declared ones. ``score`` is the name of the score that
    decides, ``duration`` is in s, and ``file`` is where the scenario was read. ``messages`` are
    the faults of the messages between both, and ``outages`` of the rig are in ascending order.
    """

    name: str
    about: str
    declared: Values
    undeclared: Values
    reference: Reference
    duration: float
    changes: tuple[Change, ...] = ()
    score: str = 'rms_error'
    suite: str = 'muscle'
    is_quick: bool = False
    file: Path = Path()
    messages: MessageFaults = NO_FAULTS
    outages: tuple[Outage, ...] = ()

    def setups(self, seed: int, time_mode: str) -> list[tuple[float, SimulationSetup]]:
        """Return the settings of the simulator, each with the time in s from which they hold.

        *seed* is that of the sensors, and *time_mode* that of the simulator. Raises ParameterError
        if the parameters are not valid.
        """
        given = {**self.declared, **self.undeclared}
        values: dict[str, Any] = {'publish_rate': RATE, **given}
        if time_mode == 'scaled':  # a controller with a timer needs time in fine steps
            values['clock_rate'] = values['publish_rate']
        values |= {'time_mode': time_mode, 'sensor.seed': seed}
        found = [(0.0, _setup(values))]
        for change in self.changes:
            values |= change.values
            found.append((change.time, _setup(values, change.values)))
        return found


def _setup(values: Values, changed: Values | None = None) -> SimulationSetup:
    """Return the settings of flat *values*, of which those *changed* must suit a running rig."""
    scene = Scene(values)
    table = scene.table()
    for name in values:
        if name not in table:
            alike = similar(name, table)
            hint = f'was {alike} meant?' if alike else 'pam_sim --parameters lists all'
            raise ParameterError(f'{name} is not a parameter of pam_sim: {hint}')
    for name in changed or {}:
        if name in FIXED or not table[name][2].live:
            raise ParameterError(f'changes: {name} cannot change while the rig runs')
    return scene.build(checked(table, values))


def read_scenario(path: Path) -> Scenario:
    """Return the scenario in the YAML file at *path*; its name is that of the file.

    Raises ParameterError, with the path, for anything that is not valid.
    """
    content = read_yaml(path)
    if not isinstance(content, dict):
        raise ParameterError(f'{path} is not a scenario: give a mapping with {", ".join(NEEDED)}')
    try:
        return _scenario(path, content)
    except PamError as error:
        text = str(error)
        raise ParameterError(text if text.startswith(str(path)) else f'{path}: {text}') from error


def _scenario(path: Path, content: Mapping[Any, Any]) -> Scenario:
    known = (*KEYS, *TABLES)
    for key in content:
        if key not in known:
            alike = similar(str(key), known)
            hint = f'was {alike} meant?' if alike else f'give {", ".join(known)}'
            raise ParameterError(f'{key} is not a key of a scenario: {hint}')
    for key in NEEDED:
        if key not in content:
            raise ParameterError(f'{key} is missing')
    plain = {
        key: about.check(key, content[key], kind)
        for key, (kind, about) in KEYS.items()
        if key in content
    }
    declared, undeclared = (
        _table(key, content.get(key, {}), path) for key in ('declared', 'undeclared')
    )
    reference = content['reference']
    if not isinstance(reference, dict):
        raise ParameterError(f'reference = {reference!r} is not allowed: give a mapping with kind')
    scenario = Scenario(
        path.stem,
        plain['about'],
        declared,
        undeclared,
        reference_of(reference, 'reference'),
        plain['duration'],
        _changes(content.get('changes', []), plain['duration'], path),
        plain.get('score', Scenario.score),
        plain.get('suite', Scenario.suite),
        plain.get('quick', Scenario.is_quick),
        path,
        messages_of(content.get('messages', {})),
        outages_of(content.get('outages', []), plain['duration']),
    )
    for _, setup in scenario.setups(0, 'lockstep'):
        if len(setup.joints) > 1:
            raise ParameterError(f'declared has {len(setup.joints)} joints: a scenario has one')
    return scenario


def _table(key: str, given: Any, path: Path) -> dict[str, Any]:
    """Return the parameters of the rig in a mapping, by dotted names."""
    if not isinstance(given, dict):
        raise ParameterError(f'{key} = {given!r} is not allowed: give parameters of pam_sim')
    found: dict[str, Any] = {}
    for name, value in flattened(given):
        if name in OF_BENCH:
            raise ParameterError(f'{key}: {name} is set by the bench and cannot be given')
        is_list = isinstance(value, list) and all(isinstance(text, str) for text in value)
        if not (is_list or isinstance(value, bool | int | float | str)):
            raise ParameterError(f'{key}: {name} = {value!r} is not a single value')
        found[name] = tuple(value) if is_list else value
    if isinstance(muscle := found.get('muscle'), str):
        # A file may lie next to the scenario.
        beside = path.parent / muscle
        if beside.is_file():
            found['muscle'] = str(beside.resolve())
        else:
            find(muscle)  # one of the package remains a name: on another machine its path differs
    return found


def _changes(given: Any, duration: float, path: Path) -> tuple[Change, ...]:
    if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
        raise ParameterError('changes is not a list of mappings, each with time and parameters')
    found: list[Change] = []
    about = Parameter('time of the change', 's', low=0.0, high=duration)
    for k, one in enumerate(given):
        what = f'changes[{k}]'
        if 'time' not in one:
            raise ParameterError(f'{what}.time is missing')
        time = about.check(f'{what}.time', one['time'], float)
        if found and time <= found[-1].time:
            raise ParameterError(f'{what}.time = {time:g} s is not after the change before it')
        values = _table(what, {key: one[key] for key in one if key != 'time'}, path)
        found.append(Change(time, values))
    return tuple(found)


def scenarios_of_package() -> list[Scenario]:
    """Return the scenarios that come with the package, by name."""
    files = (share() / 'config' / FOLDER).glob('*.yaml')
    return [read_scenario(path) for path in sorted(files)]


def chosen(names: Sequence[str], suite: str | None, *, is_quick: bool) -> list[Scenario]:
    """Return the scenarios of *names*, each a name of the package or a path of a YAML file.

    Without names they are those of the package: of one *suite*, or all; with *is_quick* only the
    short selection. Raises ParameterError for a name that does not exist, or is given twice.
    """
    if not names:
        return [
            one
            for one in scenarios_of_package()
            if suite in (None, one.suite) and (one.is_quick or not is_quick)
        ]
    own = {path.stem: path for path in (share() / 'config' / FOLDER).glob('*.yaml')}
    found: dict[str, Scenario] = {}
    for name in names:
        path = own.get(name, Path(name))
        if not path.is_file():
            raise ParameterError(
                f'scenario {name} does not exist: give the path of a YAML file, or one of '
                f'{", ".join(sorted(own))}'
            )
        scenario = read_scenario(path)
        if scenario.name in found:
            raise ParameterError(f'scenario {scenario.name} is given twice')
        found[scenario.name] = scenario
    return list(found.values())
