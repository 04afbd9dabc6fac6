# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Position control of a muscle that is not the configured one, over its whole reach.

The law has the constants of ``dmsp_20_400n``. The muscles of the rigs have other published
constants, random ones that differ by up to 12 % each, or the force law of a braided muscle by its
geometry. All have a lag of 30 ms and dry friction of 8 N that are not configured. 20 kg, feedback
noise 20 um, 500 Hz. The plants are those of ``test/support/other_muscles.py``.
Each figure is the worst over the seeds and, beside it, their mean.
Options: ``--seeds N`` of random constants and of the noise (default 4), ``--first N``, the first
of them (default 0), ``--muscles a,b`` for some rows (default: all).
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


def muscles(text: str) -> list[str]:
    """Return the names in *text*, which are separated by commas."""
    names = text.split(',')
    for name in names:
        if name not in ROWS:
            raise argparse.ArgumentTypeError(f'{name!r} is none of {", ".join(ROWS)}')
    return names


def main() -> None:
    """Print the table of the laws."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=4)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--muscles', type=muscles, default=list(ROWS))
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.seeds)
    for law, make in LAWS.items():
        print(f'\n{law}: worst and mean of {given.seeds} seeds from {given.first}')
        heads = ''.join(f'{what:>20}{"mean":>9}' for what in ('overshoot mm', 'sine mm RMS'))
        print(f'{"muscle of the rig":<20}{heads}')
        for muscle in given.muscles:
            found = np.array([over_the_reach(make, muscle, seed) for seed in seeds])
            worst, mean = found.max(axis=0), found.mean(axis=0)
            claims, verdict = ('', ''), ''
            if law == 'sliding mode':
                claims = tuple(f' <={limit:>5.2f}' for limit in ROWS[muscle])
                verdict = 'ok' if np.all(worst <= ROWS[muscle]) else 'SHORT'
            columns = ''.join(
                f'{most:>12.3f}{claim:<8}{usual:>9.3f}'
                for most, claim, usual in zip(worst, claims, mean, strict=True)
            )
            print(f'{muscle:<20}{columns}  {verdict}', flush=True)


if __name__ == '__main__':
    main()
