# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joint or the muscle that a parameter file of ``pam_sim`` describes, for programs."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pam_ros.arguments import as_path, instance
from pam_ros.effects.names import GROUP
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Joint
from pam_ros.settings.braid import without_constants
from pam_ros.settings.files import find, read
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import (
    Table,
    Values,
    build,
    checked,
    effects_of,
    refuse_mistyped,
    refuse_unknown_effects,
    rig_table,
)

# Parameters of the simulator itself that select the joint; the others do not describe one.
ABOUT_JOINTS = frozenset({'joint', 'muscles', 'joint_name', 'joint_names'})


def load_joint(
    name: str | Path, /, values: Mapping[str, Any] | None = None, **parameters: Any
) -> Joint:
    """Return the joint that a parameter file, or a muscle or rig of this package, describes.

    *name* is a path, such as that of an ``identified.yaml``, or the name of a preset, such as
    ``'dmsp_20_400n'``. *parameters* and *values* replace those of the file. They have the names
    and SI units of the parameters of ``pam_sim``: ``mass=10``, ``joint='antagonistic'``. Names
    with dots are keys of *values*: ``{'effects.slack.share': 1.0}``. The result is the joint that
    ``pam_sim`` simulates with this file and these parameters. If ``joint`` is given here and not
    in the file, the file describes a muscle, and its load is not used.

    Raises ParameterError for a file that cannot be read, a name that is not a parameter, a value
    that is not allowed, and a file with more than one joint.
    """
    scene, known = read_scene(name, {**_overrides(values), **parameters})
    return only_joint(name, scene, known)


def load_muscle(name: str | Path, /) -> Muscle:
    """Return the muscle of a preset of this package, such as ``'dmsp_10'``, or of a file.

    *name* is the name of the preset, or a path. Raises ParameterError for a file that cannot be
    read, a value that is not allowed, and a file with muscles that differ.
    """
    scene, known = read_scene(name, {})
    made = [build(Muscle, scene.of_muscle(known, i)) for i in range(len(scene.muscles))]
    if any(muscle != made[0] for muscle in made):
        raise ParameterError(
            f'{name} describes muscles that differ, {", ".join(scene.muscles)}: load the joint, '
            'and take one of its muscles'
        )
    return made[0]


def only_joint(name: str | Path, scene: Scene, values: Values) -> Joint:
    """Return the only joint of the file *name* with this scene and these values.

    Raises ParameterError for a file with several joints.
    """
    joints = scene.build_joints(values)
    if len(joints) > 1:
        raise ParameterError(
            f'{name} describes {len(joints)} joints, {", ".join(scene.joints)}: give a file '
            'with one joint'
        )
    return joints[0]


def _overrides(values: Mapping[str, Any] | None) -> dict[str, Any]:
    if values is None:
        return {}
    example = "values by the names of parameters, such as {'effects.slack.share': 1.0}"
    return dict(instance('values', values, Mapping, example))


def read_scene(
    name: str | Path, overrides: Values, typed: Callable[[Table], Values] | None = None
) -> tuple[Scene, dict[str, Any]]:
    """Return the scene of a file with *overrides*, and all of its flat values, checked.

    If the overrides are texts, *typed* converts them to values with the table of parameters.
    """
    text = str(as_path('name', name, 'a path, or the name of a muscle or rig of this package'))
    path = find(text)
    from_file = read(path)
    try:
        refuse_unknown_effects(from_file)
    except ParameterError as error:
        raise ParameterError(f'{path}: {error}') from error
    refuse_unknown_effects(overrides)
    if 'joint' in overrides and 'joint' not in from_file:
        from_file = {'muscle': text}
    from_file = without_constants(from_file, overrides)
    given = {**from_file, **overrides}
    scene, table = _scene(path, from_file, given)
    _refuse_mistyped(path, from_file, scene, table)
    _refuse_others(overrides, scene, table)
    if typed is not None:
        given |= typed(table)
    return scene, _without_absent_effects(checked(table, given), scene)


def _scene(path: Path, from_file: Values, given: Values) -> tuple[Scene, Table]:
    """Return the scene of *given* and its table; an error of the file alone names the file."""
    try:
        scene = Scene(given)
        return scene, scene.table()
    except ParameterError:
        try:
            Scene(from_file).table()
        except ParameterError as error:
            raise ParameterError(f'{path}: {error}') from error
        raise


def _refuse_mistyped(path: Path, values: Values, scene: Scene, table: Table) -> None:
    """Raise ParameterError for a mistyped name in a file; the scene has checked own names."""
    own = {*scene.muscles, *scene.joints}
    try:
        refuse_mistyped([flat for flat in values if flat.partition('.')[0] not in own], table)
    except ParameterError as error:
        raise ParameterError(f'{path}: {error}') from error


def _refuse_others(overrides: Values, scene: Scene, table: Table) -> None:
    """Raise ParameterError for an override that is not a parameter of the joint."""
    simulator = {*scene.common, *scene.start} - ABOUT_JOINTS
    for name in overrides:
        if name in simulator:
            raise ParameterError(
                f'{name} is a parameter of pam_sim, not of a joint: give one such as mass or zeta'
            )
        if name not in table:
            refuse_mistyped([name], table)
            raise ParameterError(
                f'{name} is not a parameter of joint = {scene.kind.name}: give one such as mass '
                'or zeta'
            )


def _without_absent_effects(values: Values, scene: Scene) -> dict[str, Any]:
    """Return *values* without effects that have only default values, as joints omit them."""
    plain = rig_table(scene.kind)
    absent = effects_of({flat: default for flat, (_, default, _) in plain.items()})
    left_out = tuple(
        f'{GROUP}.{effect}.'
        for effect, given in effects_of(values).items()
        if given == absent[effect]
    )
    return {flat: value for flat, value in values.items() if not flat.startswith(left_out)}
