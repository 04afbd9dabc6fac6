# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Indices of the constants that effects read in addition to their own parameters.

An effect in a muscle gets the muscle's row of parameters, an effect on a joint the joint's row.
All values are SI; :mod:`pam_ros.rig.layout` defines the rest of both rows.
"""

# Row of a muscle: the constants of the force law (1), damping ratio, length at rest in m.
A1, A2, A3, A4, A5, A6, ZETA, L0 = range(8)
# Row of a joint: the nominal inertia (kg, or kg m^2), and the change of the coordinate (m, or
# rad) that corresponds to a contraction of 1.
INERTIA, LENGTH = range(2)
