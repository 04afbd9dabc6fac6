# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joints that muscles can move. To add one, write its file and add its line here."""

from pam_ros.rig.joints import antagonistic_pair, mass, parallel
from pam_ros.rig.joints.base import Joint

JOINTS: tuple[Joint, ...] = (
    mass.JOINT,
    parallel.JOINT,
    antagonistic_pair.JOINT,
)
