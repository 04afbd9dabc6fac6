# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` simulates: its muscles and joints, put together from flat parameters.

A parameter without a name before it is everybody's; ``<name>.<parameter>`` is that of one muscle
or joint alone. A name has those of its own that it was given at the start, itself or by a preset
``<name>.muscle``; in all else it follows what is everybody's.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.config import (
    Table,
    Values,
    build,
    build_rig,
    effects_table,
    refuse_mistyped,
    rig_table,
    table_of,
    with_defaults,
)
from pam_ros.effects import EFFECTS
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.nodes.sim_settings import MUSCLE, SimSettings, Start
from pam_ros.parameter_files import read_known
from pam_ros.rig.assembly import Model
from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints import antagonistic_pair, parallel
from pam_ros.rig.joints.base import Joint, acts_in_muscle, acts_on_load
from pam_ros.rig.sensors import Sensors

Array = NDArray[np.float64]

START = (-0.2, 0.95)  # contractions at which a simulation may start
PAIRS: dict[str, Joint] = {'antagonistic': antagonistic_pair.JOINT, 'parallel': parallel.JOINT}
NAME = re.compile(r'[A-Za-z][A-Za-z0-9_]*')


def _lists(value: Any) -> tuple[str, ...]:
    is_list = isinstance(value, list | tuple) and all(isinstance(name, str) for name in value)
    return tuple(value) if is_list else ()


class Scene:
    """The names of muscles and joints, and which parameters each of them can have.

    *given* are the parameters that the node was started with. Raises ParameterError where the
    names do not go together, or a parameter given to one of them is none of its own.
    """

    def __init__(self, given: Values) -> None:
        """Look at what is given; the values are checked later."""
        self.pair = PAIRS.get(str(given.get('joint', 'load')))
        self._given = given
        per_joint = self.pair.muscles if self.pair else 1
        alone = str(given.get('joint_name', SimSettings.joint_name))
        self.muscles = _lists(given.get('muscles')) or self._names(alone, per_joint)
        if len(self.muscles) % per_joint:
            raise ParameterError(
                f'muscles: {len(self.muscles)} names make no joint = {given["joint"]}: give '
                f'{per_joint} for each joint'
            )
        count = len(self.muscles) // per_joint
        self.joints = _lists(given.get('joint_names')) or (
            self._names(alone, count) if self.pair or not given.get('muscles') else self.muscles
        )
        if len(self.joints) != count:
            raise ParameterError(
                f'joint_names: {len(self.joints)} names for {count} joints: give one each'
            )
        self._check_names()

    @staticmethod
    def _names(stem: str, count: int) -> tuple[str, ...]:
        return (stem,) if count == 1 else tuple(f'{stem}_{i + 1}' for i in range(count))

    def _check_names(self) -> None:
        taken = {name.partition('.')[0] for name in self.base()}
        for kind, names in (('muscles', self.muscles), ('joint_names', self.joints)):
            for i, name in enumerate(names):
                if name in names[:i]:
                    raise ParameterError(f'{kind}: {name} is named twice')
                # What nobody named is not told from others by its name.
                if not self._given.get(kind):
                    continue
                if not NAME.fullmatch(name) or '__' in name or name.endswith('_'):
                    raise ParameterError(
                        f'{kind}: {name!r} is no name: give letters, digits and single _'
                    )
                if name in taken:
                    raise ParameterError(f'{kind}: {name} is the name of a parameter')

    # Tables ----------------------------------------------------------------------------------

    def _load(self) -> Table:
        """Return the table of a joint's load, with the effects on it."""
        assert self.pair
        library = tuple(self.pair.on_load(e) for e in EFFECTS if acts_on_load(e))
        return {**table_of(self.pair.declared), **effects_table(library)}

    def _actuator(self) -> Table:
        """Return the table of a muscle in a joint, with the effects in it."""
        return {
            **table_of(Muscle),
            **effects_table(tuple(e for e in EFFECTS if acts_in_muscle(e))),
        }

    def _own(self, name: str) -> Table:
        """Return the table of all that the muscle or joint *name* can have of its own."""
        start = table_of(Start, 'initial.')
        if self.pair is None:
            return {**MUSCLE, **rig_table(), **start}
        pressure = {'initial.pressure': start.pop('initial.pressure')}
        own: Table = {}
        if name in self.muscles:
            own |= {**MUSCLE, **self._actuator(), **pressure}
        if name in self.joints:
            own |= {**self._load(), **start}
        return own

    def base(self) -> Table:
        """Return the table of the parameters that are everybody's."""
        plain = {
            **MUSCLE,
            **({**self._actuator(), **self._load()} if self.pair else rig_table()),
            **table_of(Sensors, 'sensor.'),
            **table_of(SimSettings),
            **table_of(Start, 'initial.'),
        }
        return with_defaults(plain, self._preset(self._given, plain))

    def _preset(self, given: Values, known: Table) -> Values:
        """Return what a preset says: for a pair of muscles nothing of the load."""
        if not given.get('muscle'):
            return {}
        values = read_known(str(given['muscle']), known)
        here = self._actuator() if self.pair else known
        return {name: value for name, value in values.items() if name in here}

    def table(self) -> Table:
        """Return the table of everybody's parameters and of each name's own."""
        names = dict.fromkeys(chain(self.muscles, self.joints))
        own: dict[str, dict[str, Any]] = {}
        for flat, value in self._given.items():
            name, dot, rest = flat.partition('.')
            if dot and name in names:
                own.setdefault(name, {})[rest] = value
        table = self.base()
        for name, given in own.items():
            known = self._own(name)
            all_known = {f'{name}.{rest}' for rest in known}
            for stranger in refuse_mistyped((f'{name}.{rest}' for rest in given), all_known):
                raise ParameterError(f'{stranger}: {name} has no parameter of this name')
            preset = self._preset(given, known)
            known = with_defaults(known, preset)
            table |= {f'{name}.{rest}': known[rest] for rest in chain(preset, given)}
        return table

    # Models ----------------------------------------------------------------------------------

    def build(self, values: Values) -> 'Simulation':
        """Make the simulation of checked flat *values*; ParameterError where they make none."""
        settings = build(SimSettings, values)
        sensors = build(Sensors, values, 'sensor.')
        if self.pair is None:
            # Muscles that are told the same are the same: most of many are.
            made: dict[tuple[Any, ...], tuple[Model, Start]] = {}
            found = []
            for name in self.joints:
                own = _of(values, name, self._own(name))
                key = tuple(own.values())
                if key not in made:
                    made[key] = build_rig(own), build(Start, own, 'initial.')
                found.append(made[key])
            models = tuple(model for model, _ in found)
            starts = pressures = tuple(start for _, start in found)
        else:
            per_joint = self.pair.muscles
            acting = [_of(values, name, self._own(name)) for name in self.muscles]
            loads = [_of(values, name, self._own(name)) for name in self.joints]
            actuators = [
                Actuator(build(Muscle, own), _effects(own, acts_in_muscle)) for own in acting
            ]
            models = tuple(
                JointModel(
                    build(self.pair.declared, own),
                    tuple(actuators[k * per_joint : (k + 1) * per_joint]),
                    _effects(own, acts_on_load),
                )
                for k, own in enumerate(loads)
            )
            starts = tuple(build(Start, own, 'initial.') for own in loads)
            pressures = tuple(build(Start, own, 'initial.') for own in acting)
        return Simulation(
            models,
            self.muscles,
            self.joints,
            sensors,
            settings,
            starts,
            tuple(start.pressure for start in pressures),
        )


def _of(values: Values, name: str, table: Table) -> dict[str, Any]:
    """Return the values of *table* for one name: its own, or everybody's."""
    own = ((rest, f'{name}.{rest}') for rest in table)
    return {rest: values[flat] if flat in values else values[rest] for rest, flat in own}


def _effects(values: Values, is_here: Any) -> dict[str, dict[str, float]]:
    """Return the effects of a muscle or of a load among flat *values*."""
    return {
        effect.name: {
            p.name: values[f'effects.{effect.name}.{p.name}']  # type: ignore[misc]
            for p in effect.parameters
        }
        for effect in EFFECTS
        if is_here(effect)
    }


@dataclass(frozen=True)
class Simulation:
    """All that the node is told, checked together.

    ``models`` are the joints, ``starts`` theirs; ``pressures`` (Pa) are those of the muscles.
    """

    models: tuple[Model, ...]
    muscle_names: tuple[str, ...]
    joint_names: tuple[str, ...]
    sensors: Sensors
    settings: SimSettings
    starts: tuple[Start, ...]
    pressures: tuple[float, ...]

    def __post_init__(self) -> None:
        """Refuse a step that is too long, and a start that the muscles cannot have."""
        for model in {id(model): model for model in self.models}.values():
            model.check_step(1.0 / self.settings.physics_rate)
        for muscle, pressure, name in zip(
            self.muscles, self.pressures, self.muscle_names, strict=True
        ):
            if not muscle.p_min <= pressure <= muscle.p_max:
                raise ParameterError(
                    f'{self._whose(name)}initial.pressure = {pressure:g} Pa is outside p_min = '
                    f'{muscle.p_min:g} to p_max = {muscle.p_max:g} Pa'
                )
        for model, start, name in zip(self.models, self.starts, self.joint_names, strict=True):
            if not start.at_rest:
                self._check_position(model, start.position, self._whose(name))

    def _whose(self, name: str) -> str:
        return f'{name}: ' if len(self.models) > 1 else ''

    def _check_position(self, model: Model, position: float, whose: str) -> None:
        if isinstance(model, JointModel):
            ends = [
                sorted(model.joint.coordinate(k * m.l0, i, model.geometry) for k in START)
                for i, m in enumerate(model.muscles)
            ]
            low, high = max(end[0] for end in ends), min(end[1] for end in ends)
            unit, of = model.joint.unit, f'joint = {self.settings.joint}'
        elif model.muscle.is_load_only:
            return
        else:
            low, high = (bound * model.muscle.l0 for bound in START)
            unit, of = 'm', f'a muscle of {model.muscle.l0:g} m'
        if not low <= position <= high:
            raise ParameterError(
                f'{whose}initial.position = {position:g} {unit} is no '
                f'{"place" if isinstance(model, JointModel) else "length"} of {of}: give '
                f'{low:g} to {high:g} {unit}'
            )

    @cached_property
    def muscles(self) -> tuple[Muscle, ...]:
        """All muscles in order."""
        return tuple(chain.from_iterable(map(_muscles_of, self.models)))

    @property
    def is_one(self) -> bool:
        """Whether there is one muscle alone."""
        return len(self.muscles) == 1

    @cached_property
    def reach(self) -> Array:
        """Contraction at which each muscle would have no length left; inf where there is none."""
        return np.array([np.inf if m.is_load_only else 1.0 for m in self.muscles])

    @cached_property
    def limits(self) -> Array:
        """Least and largest pressure in Pa of each muscle, (2, muscles)."""
        return np.array([[m.p_min for m in self.muscles], [m.p_max for m in self.muscles]])

    @cached_property
    def initial(self) -> tuple[Array, Array, Array]:
        """Pressures in Pa, then positions (m, rad) and velocities of the joints, at the start."""
        pressures = iter(self.pressures)
        positions, velocities = [], []
        rests: dict[tuple[int, tuple[float, ...]], float] = {}
        for model, start in zip(self.models, self.starts, strict=True):
            p = tuple(next(pressures) for _ in _muscles_of(model))
            if start.at_rest:
                key = id(model), p
                if key not in rests:
                    rests[key] = _rest(model, p)
                positions.append(rests[key])
                velocities.append(0.0)
            else:
                positions.append(start.position)
                velocities.append(start.velocity)
        return np.array(self.pressures), np.array(positions), np.array(velocities)


def _muscles_of(model: Model) -> Iterable[Muscle]:
    return model.muscles if isinstance(model, JointModel) else (model.muscle,)


def _rest(model: Model, pressures: tuple[float, ...]) -> float:
    return model.rest(pressures) if isinstance(model, JointModel) else model.rest(pressures[0])


def table(**given: Any) -> Table:
    """Return the table of all parameters of a node that is started with *given*."""
    return Scene(given).table()


def simulation(values: Values) -> Simulation:
    """Make the simulation of a complete set of flat, checked values."""
    return Scene(values).build(values)
