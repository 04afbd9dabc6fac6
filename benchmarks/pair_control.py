# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An antagonistic pair with angle and stiffness set, on the truth plant, in simulated time.

The angle follows a sine of 15 degrees at 0.5 Hz; then it is held at 10 degrees during steps of the
stiffness. Both laws have one set of gains for all plants; feedback has noise of 0.02 degrees at
500 Hz, the target is given as samples at 100 Hz. The plants are those of ``test/truth/pair.py``,
which have their own equations and integrator.
Options: ``--seeds N`` (default 3, the worst of them counts).
"""

import argparse
import sys
from math import pi, radians, sin
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from pam_ros.control.pid import Pid
from pam_ros.control.sliding_mode import SlidingMode
from support.pair_loop import LAG, LAG_WITH_ZONE, ZONE, close_pair, nominal
from truth.pair import pair_plant

# Plant, what is configured of its muscles; largest RMS of the sine, degrees.
ROWS = {
    'nominal': ('nominal', (), 0.03),
    'payload +0.3 kg': ('payload', (), 0.05),
    'friction 0.15/0.22 N m': ('friction', (), 0.1),
    'payload and friction': ('payload and friction', (), 0.1),
    'valve lag 20/30 ms': ('quick lag', (), 0.1),
    'valve lag 50/70 ms': ('lag', (), 0.06),
    'the same, configured': ('lag', LAG, 0.03),
    'lag, dead zone 6 kPa': ('dead zone', (), 0.3),
    'its zone, configured': ('dead zone', ZONE, 0.1),
    'both, configured': ('dead zone', LAG_WITH_ZONE, 0.06),
    'dead time 40 ms': ('dead time', (), 0.6),
    'hysteresis 15 N each': ('hysteresis', (), 0.06),
    'all, and 10 ms dead time': ('all', (), 0.2),
}
LAWS = {'sliding mode': SlidingMode, 'PID': Pid}
SWING, FREQUENCY, SINE, JUDGED = radians(15.0), 0.5, 12.0, 4.0
GOAL = radians(10.0)
STIFFNESSES = (20.0, 35.0, 25.0)  # N m/rad, for 3 s each
HELD = 3.0


def sine(t: float) -> float:
    """Return the sine target in rad."""
    return SWING * sin(2.0 * pi * FREQUENCY * t)


def stiffness(t: float) -> float:
    """Return the stiffness that is set."""
    return STIFFNESSES[min(int(t / HELD), len(STIFFNESSES) - 1)]


def trial(law: str, row: str, seed: int) -> tuple[float, ...]:
    """Return errors: sine RMS and maximum, at rest, during the steps, degrees; stiffness, %."""
    name, effects, _ = ROWS[row]
    make, joint = LAWS[law], nominal(effects)
    run = close_pair(make(joint), pair_plant(name, seed=seed), sine, SINE)
    swung = np.degrees(run.error[run.last(JUDGED)])
    still = close_pair(
        make(joint),
        pair_plant(name, seed=seed),
        lambda t: GOAL,
        HELD * len(STIFFNESSES) + HELD,
        lambda t: stiffness(t - HELD),
    )
    moved = still.t > HELD
    ends = [still.t.searchsorted(HELD * (k + 2)) - 1 for k in range(len(STIFFNESSES))]
    off = [still.stiffness[k] / still.wanted[k] - 1.0 for k in ends]
    return (
        float(np.sqrt(np.mean(swung**2))),
        float(np.max(np.abs(swung))),
        float(np.degrees(np.max(np.abs(still.error[still.last(1.0)])))),
        float(np.degrees(np.max(np.abs(still.error[moved])))),
        100.0 * float(np.max(np.abs(off))),
    )


def main() -> None:
    """Print the table of both laws."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=3)
    given = parser.parse_args()
    print(f'stiffness that is set: {STIFFNESSES} N m/rad at 10 degrees')
    for law in LAWS:
        print(f'\n{law}: worst of {given.seeds} seeds')
        print(
            f'{"plant":<26}{"sine, degrees RMS":>20}{"largest":>9}{"at rest":>9}'
            f'{"while stiffened":>17}{"stiffness":>11}'
        )
        for row, (*_, limit) in ROWS.items():
            rms, largest, rest, moved, off = np.max(
                [trial(law, row, seed) for seed in range(given.seeds)], axis=0
            )
            # The claims are for the sliding-mode law; PID is for comparison.
            claim, verdict = '', ''
            if law == 'sliding mode':
                claim, verdict = f' <={limit:>5.2f}', 'ok' if rms <= limit else 'SHORT'
            print(
                f'{row:<26}{rms:>12.4f}{claim:<8}{largest:>9.3f}{rest:>9.4f}{moved:>17.3f}'
                f'{off:>9.3f} %  {verdict}',
                flush=True,
            )


if __name__ == '__main__':
    main()
