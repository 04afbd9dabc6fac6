# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joint that a parameter file describes, and the parameters that describe a joint."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pam_ros.arguments import refuse, sequence
from pam_ros.cached_property import cached_property
from pam_ros.effects.base import Effect
from pam_ros.effects.names import EffectName
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import Parameter
from pam_ros.rig.arrangements import LOAD, Arrangement, arrangement_of
from pam_ros.rig.joint import Joint
from pam_ros.settings.files import find, presets, read_any
from pam_ros.settings.load import only_joint, read_scene
from pam_ros.settings.rig import KINDS, RigParameters
from pam_ros.settings.tables import Table, flat, listed, mountings, override, rig_table


@dataclass(frozen=True)
class NominalJoint:
    """The joint of a parameter file, with which the search for missing effects begins.

    ``kind`` is the arrangement that the file names, ``muscles`` are the names of its muscles and
    ``name`` is that of the joint.
    """

    joint: Joint
    kind: Arrangement
    muscles: tuple[str, ...]
    name: str

    @property
    def recorded_muscles(self) -> tuple[str, ...]:
        """The names of the muscles in recordings; empty for one muscle on a mass."""
        return () if self.kind is LOAD else self.muscles

    def text(self, name: str) -> str:
        """Return the description of the parameter with a flat *name*; empty if it is unknown."""
        about = self._about(name)
        return about.text if about else ''

    def unit(self, name: str) -> str:
        """Return the unit of the parameter with a flat *name*, empty if it has none."""
        about = self._about(name)
        return about.unit if about else ''

    def _about(self, name: str) -> Parameter | None:
        head, dot, rest = name.partition('.')
        known = self._table.get(rest if dot and head in self.muscles else name)
        return known[2] if known else None

    @cached_property
    def _table(self) -> Table:
        return rig_table(self.kind)

    def flat(self, joint: Joint | None = None) -> dict[str, Any]:
        """Return the flat parameters of the nominal joint, or of another *joint* of its kind.

        A value that all muscles share appears once. Values that differ appear for each muscle,
        after its name. Effects are those that the joint was given.
        """
        joint = self.joint if joint is None else joint
        each = [
            {**flat(actuator.muscle), **_flat_effects(actuator.effects)}
            for actuator in joint.actuators
        ]
        values: dict[str, Any] = {}
        if self.kind is not LOAD:
            values['joint'] = self.kind.name
            values['muscles'] = self.muscles
            values['joint_names'] = (self.name,)
        shared = {
            name: value
            for name, value in each[0].items()
            if all(name in own and own[name] == value for own in each)
        }
        values |= shared
        for muscle, own in zip(self.muscles, each, strict=True):
            values |= {f'{muscle}.{name}': own[name] for name in own if name not in shared}
        if self.kind is not LOAD:
            values |= flat(joint.transmission)
            pairs = zip(mountings(self.kind), joint.actuators, strict=True)
            values |= {name: actuator.contraction for name, actuator in pairs}
        return {**values, **flat(joint.load), **_flat_effects(joint.effects)}


def nominal_of(joint: Joint, muscles: tuple[str, ...] = ()) -> NominalJoint:
    """Return the NominalJoint of a *joint* that a program created, as if from a file.

    *muscles* are the names of several muscles in recordings. All other names are the defaults of
    a file. A joint that no file can describe has the arrangement ``custom``.
    """
    kind = arrangement_of(joint)
    names = RigParameters({'joint': LOAD.name if kind is None else kind.name})
    if kind is None:
        parts = type(joint.transmission), type(joint.load)
        kind = Arrangement('custom', 'made by a program', len(joint.actuators), *parts)
    return NominalJoint(joint, kind, muscles or names.muscles, names.joints[0])


def nominal_joint(name: str | Path, overrides: Iterable[str] = ()) -> NominalJoint:
    """Return the joint that a file or preset *name* describes.

    *overrides* are texts ``name=value`` that replace values of the file. Unknown names in the
    file are ignored, since they may belong to another program, but mistyped ones are refused, and
    so are unknown names of *overrides*. Raises ParameterError, also for a file with several
    joints.
    """
    texts = sequence('overrides', overrides, str, "a text such as 'mass=10'")

    def typed(table: Mapping[str, Any]) -> dict[str, Any]:
        return dict(override(text, dict(table)) for text in texts)

    raw: dict[str, Any] = {}
    for text in texts:
        key, _, value = (part.strip() for part in text.partition('='))
        # The names of muscles and joints determine which parameters exist.
        raw[key] = listed(value) if key in ('muscles', 'joint_names') else _number_or(value)
    if raw.get('joint', LOAD.name) not in KINDS:
        refuse('joint', raw['joint'], f'one of {", ".join(KINDS)}')
    scene, values = read_scene(name, raw, typed)
    joint = only_joint(name, scene, values)
    return NominalJoint(joint, scene.kind, tuple(scene.muscles), scene.joints[0])


def example_mass(name: str, joint: Joint, given: Collection[str]) -> str:
    """Return a sentence if the mass of *joint* is the example in the file of a muscle, else ''.

    *name* is the file or preset that was read, and *given* are the parameters that were replaced.
    """
    mass = getattr(joint.load, 'mass', None)
    if mass is None or 'mass' in given or name not in presets('muscles'):
        return ''
    return (
        f'the load is {mass:g} kg, the example in the file of the muscle {name}: give that of '
        'your rig with --set mass=...'
    )


def package_muscles() -> dict[str, Muscle]:
    """Return the muscles of this package, by the names of their files."""
    return {name: nominal_joint(name).joint.muscle for name in presets('muscles')}


def _number_or(text: str) -> float | str:
    """Return a text as a number if it is one: the braid is needed before the types are known."""
    try:
        return float(text)
    except ValueError:
        return text


def uncertain_values(name: str | Path) -> dict[str, Any]:
    """Return the standard deviations of nominal values that a file states, by parameter.

    They are the parameters ``uncertain.<parameter>`` of the node ``pam_identify``, so that no
    other program sees them.
    """
    head = 'uncertain.'
    found = read_any(find(str(name)), 'pam_identify')
    return {flat.removeprefix(head): found[flat] for flat in found if flat.startswith(head)}


def _flat_effects(effects: Sequence[Effect]) -> dict[str, float]:
    return {
        EffectName(effect.name, parameter).flat: value
        for effect in effects
        for parameter, value in effect.values.items()
    }
