# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``identified.yaml``: the identified model as the parameter file of a simulator."""

import itertools
import textwrap
from dataclasses import replace
from pathlib import Path

from pam_ros.effects import EFFECTS
from pam_ros.errors import ParameterError
from pam_ros.identification.identification import Identification
from pam_ros.identification.summary import last_line
from pam_ros.identification.wording import listed
from pam_ros.plain_yaml import plain_text
from pam_ros.report.provenance import Provenance
from pam_ros.rig.arrangements import ARRANGEMENTS, LOAD
from pam_ros.rig.joint import Joint
from pam_ros.settings.files import write
from pam_ros.settings.nominal import NominalJoint, nominal_of
from pam_ros.settings.rig import RigParameters
from pam_ros.version import __version__


def identified(result: Identification, source: Provenance) -> Joint:
    """Return the identified joint, whose constants have a new source text.

    They are no longer those of the nominal source, and the text states this.
    """
    joint = result.joint
    names = listed([recording.name for recording in source.recordings])
    text = plain_text(f'pam_ros, re-tuned on {names}; nominal model: {source.parameters}')
    actuators = tuple(
        replace(actuator, muscle=replace(actuator.muscle, source=text))
        for actuator in joint.actuators
    )
    return replace(joint, actuators=actuators)


def write_identified(path: Path, result: Identification, source: Provenance) -> None:
    """Write the identified model as a ROS parameter file for every node that takes a rig.

    Constants are in the units of the nominal model. The file gives the same rig bit for bit when
    it is read. Raises ParameterError if no parameter file can describe the joint.
    """
    refuse_indescribable(result, source)
    write(path, source.nominal.flat(identified(result, source)), about(result, source))


def write_joint(path: Path, joint: Joint) -> None:
    """Write a *joint* that a program made as a ROS parameter file for every node.

    Raises ParameterError if no parameter file can describe it.
    """
    nominal = nominal_of(joint)
    _refuse_custom(nominal, joint)
    text = (
        'A joint made by a program.\n'
        'To simulate it: pam_sim --ros-args --params-file <this file>\n\n'
        f'Written by pam_ros {__version__}.'
    )
    write(path, nominal.flat(), text)


def refuse_indescribable(result: Identification, source: Provenance) -> None:
    """Raise ParameterError if no parameter file can describe the identified joint."""
    result.refuse_invalid()
    _refuse_custom(source.nominal, result.stages[-1].model)


def _refuse_custom(nominal: NominalJoint, model: Joint) -> None:
    """Raise ParameterError if no file can describe the joint or the effects of *model*."""
    joint = nominal.joint
    if nominal.kind not in ARRANGEMENTS:
        parts = f'{type(joint.transmission).__name__} and {type(joint.load).__name__}'
        names = ', '.join(kind.name for kind in ARRANGEMENTS)
        raise ParameterError(
            f'a parameter file cannot describe this joint of {len(joint.actuators)} muscle(s), '
            f'{parts}: it can be one of {names}'
        )
    if nominal.kind is not LOAD:  # checks the names, which become names of parameters
        RigParameters({'joint': nominal.kind.name, 'muscles': nominal.muscles})
    known = {effect.name for effect in EFFECTS}
    for effect in itertools.chain(*model.present):
        if effect.name not in known:
            raise ParameterError(
                f'a parameter file cannot describe the custom effect {effect.name}: it can be '
                f'one of {", ".join(sorted(known))}'
            )


def about(result: Identification, source: Provenance) -> str:
    """Return the comment at the head of the file: what it is, and where it comes from."""
    files = [
        ('Nominal model', source.parameters, source.digest),
        *(('Recording', one.name, one.digest) for one in source.recordings),
        *(('Test recording', one.name, one.digest) for one in source.test),
    ]
    lines = [
        'Identified by pam_ros:',
        *textwrap.wrap(last_line(result), 95),
        'To simulate it: pam_sim --ros-args --params-file <this file>',
        '',
        *(
            f'{what} {name}\n  SHA-256 {digest}' if digest else f'{what} {name}'
            for what, name, digest in files
        ),
        *(f'  with {override}' for override in source.overrides),
        *(f'  uncertain: {name}={given}' for name, given in result.uncertain.items()),
        f'Written {source.date} by pam_ros {source.versions["pam_ros"]}.',
    ]
    return '\n'.join(lines)
