# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The report and the parameter file of an identification, saved by a program."""

from pathlib import Path

from pam_ros.arguments import as_path, instance, refuse
from pam_ros.errors import PamError
from pam_ros.identification.identification import Identification
from pam_ros.report.parameters import write_identified, write_joint
from pam_ros.report.provenance import provenance_of_program
from pam_ros.report.write import check_parent, write_report
from pam_ros.rig.joint import Joint


def save_report(identification: Identification, folder: str | Path) -> None:
    """Write the report of an identification into *folder*, as ``pam_identify`` does.

    The folder has ``report.html`` to read, ``report.json``, ``residual.csv`` and
    ``identified.yaml``; the last is left out if no parameter file can describe the joint. It
    is written completely or not at all, and replaces a previous report. Its provenance is the
    command line of this program.

    Raises PamError if *folder* is a file, contains something else or cannot be written.
    """
    result = _checked(identification)
    path = as_path('folder', folder, 'the path of a folder')
    write_report(path, result, provenance_of_program(result))


def save_parameters(what: Identification | Joint, file: str | Path) -> None:
    """Write a joint as a parameter file: an identified one, or one that a program made.

    *what* is what :func:`pam_ros.identify` returned, or a joint, and *file* the path of a YAML
    file; folders that do not exist are made. That of an identification is the ``identified.yaml``
    of its report, with the re-tuned constants and the effects that were found. ``pam_sim``,
    ``pam_control`` and :func:`pam_ros.load_joint` read it. It is written completely or not at all,
    and replaces a file of this name.

    Raises PamError if *file* is a folder or cannot be written, and ParameterError if no
    parameter file can describe the joint: a custom transmission, load or effect.
    """
    if not isinstance(what, Identification | Joint):
        refuse('what', what, 'what identify() returned, or a Joint')
    path = as_path('file', file, 'the path of a file')
    if path.is_dir():
        raise PamError(f'{path} is a folder: give the path of a file')
    check_parent(path)
    try:
        if isinstance(what, Joint):
            write_joint(path, what)
        else:
            write_identified(path, what, provenance_of_program(what))
    except OSError as error:
        raise PamError(f'{path} cannot be written: {error.strerror}') from error


def _checked(identification: Identification) -> Identification:
    found: Identification = instance(
        'identification', identification, Identification, 'what identify() returned'
    )
    return found
