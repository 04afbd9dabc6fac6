# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Position control of a muscle that is not the configured one, over its whole reach.

The law has the constants of ``dmsp_20_400n``. The muscles of the rigs have other published
constants, random ones that differ by up to 12 % each, or the force law of a braided muscle by its
geometry. All have a lag of 30 ms and dry friction of 8 N that are not configured. 20 kg, feedback
noise 20 um, 500 Hz. The plants are those of ``test/support/other_muscles.py``.
Options: ``--seeds N`` of random constants and of the noise (default 4).
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from pam_ros.control.gains import Gains
from pam_ros.control.pid import Pid
from pam_ros.control.sliding_mode import SlidingMode
from support.other_muscles import over_the_reach

# Largest overshoot and RMS of the sine with the sliding-mode law, mm.
ROWS = {
    'dmsp_20_400n': (1.0, 0.1),
    'dmsp_20_200n': (1.0, 0.1),
    'dmsp_20_datasheet': (1.0, 0.1),
    'random': (1.0, 0.15),
    'braided': (3.0, 1.0),
}
LAWS = {
    'sliding mode': SlidingMode,
    'without learning': lambda joint: SlidingMode(joint, Gains(learning=False)),
    'PID': Pid,
}


def main() -> None:
    """Print the table of the laws."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=4)
    given = parser.parse_args()
    for law, make in LAWS.items():
        print(f'\n{law}: worst of {given.seeds} seeds')
        print(f'{"muscle of the rig":<26}{"overshoot mm":>20}{"sine mm RMS":>20}')
        for muscle, limits in ROWS.items():
            worst = np.max(
                [over_the_reach(make, muscle, seed) for seed in range(given.seeds)], axis=0
            )
            claims, verdict = ('', ''), ''
            if law == 'sliding mode':
                claims = tuple(f' <={limit:>5.2f}' for limit in limits)
                verdict = 'ok' if np.all(worst <= limits) else 'SHORT'
            overshoot, rms = worst
            print(
                f'{muscle:<26}{overshoot:>12.3f}{claims[0]:<8}{rms:>12.3f}{claims[1]:<8}  '
                f'{verdict}',
                flush=True,
            )


if __name__ == '__main__':
    main()
