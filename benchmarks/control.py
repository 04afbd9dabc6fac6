# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Position control on the truth plant: a 20 mm step and a 0.5 Hz sine, in simulated time.

Both laws have one set of gains for all plants. Feedback is noisy (20 um) at 500 Hz; the target is
told as samples at 100 Hz. The plants are those of ``test/truth``: own equations, own integrator.
Options: ``--seeds N`` (default 3, the worst of them counts), ``--picture FILE``.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from pam_ros.control.gains import Gains
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.sliding_mode import SlidingMode
from support.closed_loop import LAG, Run, close_loop, declared, sine_target, step_target, truth

# Plant, what is declared of it; largest error at rest and RMS of the sine, mm.
ROWS = {
    'nominal': ('nominal', None, 0.01, 0.02),
    'payload +5 kg': ('payload', None, 0.01, 0.02),
    'hysteresis 40 N': ('hysteresis', None, 0.03, 0.15),
    'friction 15/25 N': ('friction', None, 0.03, 0.15),
    'valve lag 50/70 ms': ('lag', None, 0.03, 0.25),
    'valve lag, declared': ('lag', LAG, 0.01, 0.05),
    'all, and 10 ms dead time': ('all', None, 0.06, 0.6),
}
LAWS = {
    'sliding mode': lambda model: SlidingMode(model, Gains()),
    'PID': lambda model: Pid(model, PidGains()),
}
STEP, SWING = 12.0, 20.0  # s
REST, JUDGED = 2.0, 4.0  # s at the end over which they are judged
CALM = 3.0  # kPa


def trial(law: str, row: str, seed: int) -> tuple[tuple[float, ...], Run, Run]:
    """Return error at rest and of the sine in mm, pressure moved in kPa, settling in s; runs."""
    name, effects, _, _ = ROWS[row]
    make, model = LAWS[law], declared(effects=effects)
    step = close_loop(make(model), truth(name, seed=seed), step_target(0.02), STEP)
    sine = close_loop(make(model), truth(name, seed=seed), sine_target(0.01, 0.5), SWING)
    end = step.last(REST)
    off = np.flatnonzero((np.abs(step.error) > 0.02 * 0.02) & (step.t > 1.0))
    figures = (
        1e3 * float(np.max(np.abs(step.error[end]))),
        1e3 * float(np.sqrt(np.mean(sine.error[sine.last(JUDGED)] ** 2))),
        1e-3 * float(np.ptp(step.pressure[end])),
        float(step.t[off[-1]] - 1.0) if off.size else 0.0,
    )
    return figures, step, sine


def draw(runs: dict[str, list[tuple[Run, Run]]], path: Path) -> None:
    """Draw the errors of both laws on every plant."""
    figure = Figure(figsize=(10, 2 * len(ROWS)), layout='constrained')
    axes = figure.subplots(len(ROWS), 2, sharex='col')
    for n, row in enumerate(ROWS):
        for law, colour in zip(reversed(LAWS), ('0.7', 'C0'), strict=True):
            step, sine = runs[law][n]
            axes[n, 0].plot(step.t, 1e3 * step.error, color=colour, linewidth=0.8, label=law)
            axes[n, 1].plot(sine.t, 1e3 * sine.error, color=colour, linewidth=0.8)
        axes[n, 0].set_title(f'{row}: error after a step of 20 mm [mm]', fontsize=9)
        axes[n, 1].set_title('error of a sine of 10 mm [mm]', fontsize=9)
        axes[n, 0].set_ylim(-1.0, 1.0)
    axes[0, 0].legend(frameon=False)
    figure.savefig(path, dpi=100)


def main() -> None:
    """Print the table of both laws and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=3)
    parser.add_argument('--picture', type=Path, default=Path('build/control.png'))
    given = parser.parse_args(sys.argv[2:] if sys.argv[0] == '-c' else None)
    runs: dict[str, list[tuple[Run, Run]]] = {}
    for law in LAWS:
        print(f'{law}: worst of {given.seeds} seeds')
        print(f'{"plant":<26}{"at rest mm":>20}{"sine mm RMS":>20}{"kPa":>7}{"settles":>10}')
        runs[law] = []
        for row, (_, _, rest, sine) in ROWS.items():
            trials = [trial(law, row, seed) for seed in range(given.seeds)]
            worst = np.max([figures for figures, _, _ in trials], axis=0)
            runs[law].append(trials[0][1:])
            ok = worst[0] <= rest and worst[1] <= sine and worst[2] <= CALM
            print(
                f'{row:<26}{worst[0]:>12.4f} <={rest:>5.2f}{worst[1]:>12.4f} <={sine:>5.2f}'
                f'{worst[2]:>7.2f}{worst[3]:>8.2f} s  {"ok" if ok else "SHORT"}',
                flush=True,
            )
        print()
    given.picture.parent.mkdir(parents=True, exist_ok=True)
    draw(runs, given.picture)
    print(f'wrote {given.picture}')


if __name__ == '__main__':
    main()
