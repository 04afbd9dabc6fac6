# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The line that a node logs at its start: its rig, its settings and its topics."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from pam_ros.errors import shown
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.arrangements import LOAD
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.settings.control import ControlSetup
from pam_ros.settings.scene import SimulationSetup

SHOWN = 5  # names that are listed before "and others"
Resolve = Callable[[str], str]  # the full name of a topic, after remapping


def of_simulator(
    setup: SimulationSetup, values: Mapping[str, Any], resolve: Resolve, *, has_sim_time: bool
) -> str:
    """Return the line of ``pam_sim``; *values* are its parameters.

    *has_sim_time* is whether it follows ``/clock``.
    """
    settings, joints = setup.settings, setup.joints
    has_own = len(setup.joint_names) == len(setup.muscle_names)
    others = setup.joint_names if has_own else setup.muscle_names
    muscles = _muscles(values, setup.muscles, setup.muscle_names, others)
    loads = listed(_load(joint) for joint in joints)
    names = listed(setup.muscle_names)
    if not setup.has_arrays:
        rig = f'the muscle {muscles} with a load of {loads}'
    elif settings.joint == LOAD.name:
        count = len(setup.muscle_names)
        rig = f'{count} muscles {names} ({muscles}), each with its own load of {loads}'
    else:
        whose = 'the joint' if len(joints) == 1 else f'{len(joints)} joints'
        rig = f'{whose} {listed(setup.joint_names)} ({settings.joint}) with the muscles {names} '
        rig += f'({muscles}) and a load of {loads}'
    time = settings.time_mode
    if time == 'scaled':
        time += f' with speed_factor {settings.speed_factor:g}'
    elif has_sim_time:
        time += ' following /clock'
    return shown(
        f'simulates {rig}; commands: {listed(map(resolve, setup.command_topics))}; states: '
        f'{resolve("joint_states")} at {settings.publish_rate:g} Hz; time_mode: {time}'
    )


def of_controller(
    setup: ControlSetup, values: Mapping[str, Any], resolve: Resolve, *, has_sim_time: bool
) -> str:
    """Return the line of ``pam_control``; *values* are its parameters.

    *has_sim_time* is whether it answers joint states.
    """
    settings, joint = setup.settings, setup.law.joint
    names = setup.topics.muscles
    others = (settings.joint_name,) if len(names) == 1 else names
    muscles = _muscles(values, joint.muscles, names, others)
    pace = command_pace(settings.rate, has_sim_time=has_sim_time)
    references = [resolve('position_reference'), resolve('joint_trajectory')]
    if setup.law.can_stiffen:
        references.append(resolve('co_contraction_reference'))
    line = (
        f'controls the joint {settings.joint_name} ({values["joint"]}; muscle {muscles}; load of '
        f'{_load(joint)}) with the law {settings.controller}; states: {resolve("joint_states")}; '
        f'commands: {listed(map(resolve, setup.topics.commands))}, {pace}; references: '
        f'{listed(references)}'
    )
    if not settings.start_enabled:
        line += '; disabled until the service ~/enable is called'
    return shown(line)


def command_pace(rate: float, *, has_sim_time: bool) -> str:
    """Return when commands are sent, as text; *has_sim_time* is whether joint states set it.

    Otherwise *rate* in Hz does.
    """
    return 'one for each joint state (use_sim_time is set)' if has_sim_time else f'at {rate:g} Hz'


def listed(names: Iterable[str]) -> str:
    """Return names in one text, each once; of more than five, only the first five."""
    each = list(dict.fromkeys(names))
    return ', '.join(each[:SHOWN]) + (' and others' if len(each) > SHOWN else '')


def _muscles(
    values: Mapping[str, Any],
    muscles: Sequence[Muscle],
    names: Sequence[str],
    others: Sequence[str],
) -> str:
    """Return a description of the muscles: the names of their files, if any, and lengths.

    Their parameters begin with one of *names*, or with one of *others*.
    """
    texts = []
    for muscle, name, other in zip(muscles, names, others, strict=True):
        common = values.get(f'{other}.muscle', values['muscle'])
        source = values.get(f'{name}.muscle', common)
        texts.append(f'{source} of {muscle.l0:g} m' if source else f'of {muscle.l0:g} m')
    return listed(texts)


def _load(joint: Joint) -> str:
    load = joint.load
    if isinstance(load, Mass):
        return f'{load.mass:g} kg {load.mount}'
    assert isinstance(load, Arm)
    return f'{load.mass:g} kg on a {load.plane} arm of {load.arm:g} m'
