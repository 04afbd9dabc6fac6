# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Steps of each law on each kind of joint, between places all over its reach, with three loads.

The rig is that of the package and equal to the nominal model, with muscles that can push according
to the force law, and with muscles that cannot push. Prints the largest error in the last 0.5 s of
the 5 s after a step, and how far the joint goes beyond both ends of a step, as shares of the
reach; fails if a law does not come to rest at its goal. Options: ``--places N`` (default 3).
"""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from pam_ros.control.pid import Pid
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import ARRANGEMENTS
from support.joint_grid import BEYOND, LOADS, REACHED, SLACK, nominal, visits


def main() -> None:
    """Run all, print a line for each, and exit with an error if one did not come to rest."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--places', type=int, default=3)
    places = parser.parse_args().places
    cases = [(kind.name, load) for kind in ARRANGEMENTS for load in LOADS]
    failed = 0
    print('| joint | load | muscles | law | last error | beyond |\n|---|---|---|---|---|---|')
    for kind, load in cases:
        for name, effects in (('push', ()), ('cannot push', SLACK)):
            for law in (Pid, SlidingMode):
                joint = nominal(kind, load, effects)
                begin = f'| {kind} | {load:g} | {name} | {law.__name__} '
                try:
                    controller = law(joint)
                except ParameterError as error:
                    print(f'{begin}| refused: {error} |', flush=True)
                    continue
                found = visits(controller, joint, places)
                error, beyond = max(v.error for v in found), max(v.farthest for v in found)
                is_late = error >= REACHED[law.__name__] or beyond >= BEYOND[law.__name__]
                failed += is_late
                mark = ' not at rest' if is_late else ''
                print(f'{begin}| {error:.1e} | {beyond:.3f} |{mark}', flush=True)
    if failed:
        sys.exit(f'{failed} laws did not come to rest')
