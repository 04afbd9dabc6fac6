# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Make a muscle from a data sheet: fit the constants a1 to a6 to points of its diagram.

    python3 muscle_from_data_sheet.py

The table below is as one reads it from a diagram of force over contraction, with one curve for
each pressure. Its numbers are those of the force law with the constants of
config/muscles/dmsp_20_festo.yaml, rounded to 10 N. Replace them by the points of your data sheet.
None: the curve has ended before this contraction.
"""

import numpy as np

from pam_ros import Mass, equilibrium, fit_static_map, load_muscle, single_muscle_joint

CONTRACTION = (0, 2, 5, 10, 15, 20, 25)  # percent of the length at rest
FORCE = {  # gauge pressure in bar: force in N at each contraction
    1: (250, 130, 20, None, None, None, None),
    2: (500, 370, 240, 110, 20, None, None),
    3: (760, 610, 460, 300, 160, 40, None),
    4: (1010, 850, 680, 480, 310, 140, None),
    5: (1260, 1100, 910, 660, 450, 250, 40),
    6: (1520, 1340, 1130, 850, 600, 350, 110),
}

points = [
    (pressure, contraction, force)
    for pressure, row in FORCE.items()
    for contraction, force in zip(CONTRACTION, row, strict=True)
    if force is not None
]
fit = fit_static_map(*np.array(points, dtype=float).T, 'bar', 'percent')
print(f'{fit.points} points, RMSE {fit.rmse:.1f} N')
for number, (value, error) in enumerate(zip(fit.constants, fit.standard_errors, strict=True), 1):
    print(f'a{number} = {value:9.3f} +- {error:.3f}')

muscle = fit.muscle(
    l0=0.4,  # m, length at rest
    inside_diameter=0.02,  # m
    p_max=600e3,  # Pa
    kappa_min=0.0,  # the contractions of the data sheet, as fractions
    kappa_max=0.25,
    force_max=1500.0,  # N
    zeta=0.15,  # damping ratio: an assumption, until it is identified
    source='my data sheet',
)
joint = single_muscle_joint(muscle, Mass(mass=20.0))
print(f'{1e3 * equilibrium(joint, 300e3):.1f} mm of contraction under 20 kg at 300 kPa')
preset = single_muscle_joint(load_muscle('dmsp_20_festo'), Mass(mass=20.0))
print(f'{1e3 * equilibrium(preset, 300e3):.1f} mm with the constants of dmsp_20_festo')
