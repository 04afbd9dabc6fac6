# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What nodes import and the kernels of their default joints: the fork server runs this once."""

from importlib import import_module

from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.simulation import Simulation

for name in ('sim', 'control', 'excite', 'record', 'command'):
    import_module(f'pam_ros.cli.pam_{name}')
    import_module(f'pam_ros.nodes.{name}.node')

for kind in ARRANGEMENTS[:3]:
    muscle = Actuator(contraction=kind.contraction)
    Simulation([Joint((muscle,) * kind.muscles, kind.load(), kind.transmission())]).prepare()
