# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_command``: command a running rig, set parameters and call services, without ``ros2``.

``pam_command pressure 300kPa``
    commands the pressure: of several muscles one value each, in order or as ``left:=3bar``.
    Repeats it until Ctrl-C, or for ``--hold SECONDS``, if the rig vents without commands
``pam_command position 60mm``, ``pam_command stiffness 4``
    sends a reference to ``pam_control``, once
``pam_command set mass 12 zeta 0.1``, ``get NAME...``, ``list [TEXT]``
    sets (all or none), prints or lists parameters of running nodes; of one with ``--node NODE``
``pam_command call reset``, ``call pause true``, ``call step``, ``call enable false``
    calls a service (Trigger, SetBool or Empty), and prints its answer

A number without a unit is in SI: Pa (gauge), m, rad, N m/rad. Units such as kPa, bar, psi, mm and
deg convert. A value that the rig does not permit, or that is plainly in another unit, is refused.

Publishes
    ``pressure_command`` or ``<muscle>/pressure_command`` (std_msgs/Float64), or
    ``pressure_commands`` (std_msgs/Float64MultiArray); ``position_reference`` and
    ``co_contraction_reference`` (std_msgs/Float64)

It waits for the rig (``--wait SECONDS``), and until what it has published is received. Exit code 0
if it was, 1 if nothing was found or answers, 2 for invalid input and for what a node refuses, 130
if it was interrupted before.
"""

import re
import sys

from pam_ros.cli.start import start_node

NEGATIVE = re.compile(r'-[.\d].*')


def main() -> None:
    """Do what the command line asks for."""
    # A parser takes -20deg for an option; a word with a space at its beginning is none.
    sys.argv[1:] = [f' {word}' if NEGATIVE.fullmatch(word) else word for word in sys.argv[1:]]
    start_node('pam_ros.nodes.command.node', 'PamCommand', __doc__)


if __name__ == '__main__':
    main()
