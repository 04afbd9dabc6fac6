# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Identify what a model lacks in a recording, and save the report.

    python3 identify_from_python.py report

The recording is simulated here: a mass of 20 kg on a muscle, with Coulomb friction of 8 N, and a
position sensor with noise. The nominal model has no friction. For your own rig, read_recording
reads a CSV file or a bag. Open report/report.html in a browser.
"""

import argparse
import sys

import numpy as np

from pam_ros import (
    CoulombFriction,
    Mass,
    Muscle,
    PamError,
    Recording,
    identify,
    save_report,
    simulate,
    single_muscle_joint,
)

parser = argparse.ArgumentParser(description='Identify a simulated recording, save the report.')
parser.add_argument('folder', help='folder for the report')
folder = parser.parse_args().folder

muscle, mass = Muscle(), Mass(mass=20.0)
real = single_muscle_joint(muscle, mass, [CoulombFriction(level=8.0)])
t = np.arange(0.0, 30.0, 0.02)
command = 300e3 + 120e3 * np.sin(2.0 * np.pi * 0.2 * t) + 60e3 * np.sign(np.sin(0.9 * t))
noise = np.random.default_rng(1).normal(0.0, 20e-6, t.size)
position = simulate(real, t, command).position + noise
recording = Recording('bench', t, command_t=t, command=command, position=position)

found = identify(single_muscle_joint(muscle, mass), recording)
print(found.sentence)
for finding in found.effects:
    for name, value in finding.parameters.items():
        print(f'{finding.name}.{name} = {value.value:.3g} {value.unit}')
try:
    save_report(found, folder)
except PamError as error:
    print(error, file=sys.stderr)
    sys.exit(2)
print(f'the report is in {folder}')
