# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How far disturbing forces move a load that is held, in simulated time on the truth plant.

20 kg on the DMSP-20, position with noise of 20 um at 500 Hz, one set of gains; effects are
configured only where this is stated. The plants are those of ``test/truth``, which have their own
equations and integrator. Prints the ratio of the motion at a held pressure to the motion with a
law, under a sine of 8 N; how long other disturbances move the load; the same ratio with
unconfigured effects, and with a force that begins before a motion; and the margins of the linear
loop. Draws the compliance over the frequency. The baselines are PID, and a computed force with an
extended-state observer (``benchmarks/_computed_force.py``).
Options: ``--seed N`` (default 0), ``--picture FILE``.
"""

import argparse
import sys
from collections.abc import Callable
from math import pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from benchmarks._computed_force import ComputedForce
from benchmarks._loop_gain import Margins, margins_of
from pam_ros.control.gains import Gains
from pam_ros.control.pid import Pid
from pam_ros.control.rest.rejection import Rejection, RejectionTuning
from pam_ros.control.signals import Reference, Terms
from pam_ros.control.sliding_mode import SlidingMode
from support.closed_loop import LAG, Run, close_loop, nominal, truth
from truth import TruthPlant
from truth.effects import effect

LAWS = {'sliding mode': SlidingMode, 'PID': Pid, 'computed force': ComputedForce}
COLOURS = {'sliding mode': 'C0', 'PID': '0.6', 'computed force': 'C1'}
FORCE, BEGIN, LASTS, JUDGED = 8.0, 1.0, 10.0, 4.0  # N, s
FREQUENCIES = (0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0)  # Hz
LEAST = {0.5: 15.0, 1.0: 9.0, 2.0: 7.0, 3.0: 8.0}  # Hz -> ratio, claims for the sliding-mode law
# Loads in kg and pressures in Pa, with natural frequencies of 2.4 to 4.0 Hz.
LOADS = ((27.0, 231e3), (25.0, 330e3), (20.0, 300e3), (16.0, 320e3))
LEAST_AFTER_MOTION = 4.0  # claim for 1 to 3 Hz with a force that begins before a motion
LEAST_CONFIGURED = {0.5: 10.0, 1.0: 6.0, 2.0: 5.0, 3.0: 6.0}  # the same with a configured lag
AFTER_MOTION = (0.5, 1.0, 2.0, 3.0, 4.0, 5.0)  # Hz
MOST = 1 / 1.6  # least of all frequencies
HUNT = 0.05  # mm, most that a load may move after a push
CLOSE = 1e-4  # m
# The highest level before anything is known of the delay.
FIRST = Rejection(Gains(), RejectionTuning()).highest


def lag(fill: float, vent: float) -> tuple[Any, ...]:
    """Return the effect of a lag with these times in s."""
    return (effect('pressure_lag', 'two_times', fill_s=fill, vent_s=vent),)


# Plant, what is configured of its muscle.
ROWS = {
    'nominal': ('nominal', ()),
    'payload +5 kg': ('payload', ()),
    'hysteresis 40 N': ('hysteresis', ()),
    'friction 15/25 N': ('friction', ()),
    'valve lag 10/14 ms': (lag(0.010, 0.014), ()),
    'valve lag 20/28 ms': (lag(0.020, 0.028), ()),
    'valve lag 50/70 ms': ('lag', ()),
    'the same lag, configured': ('lag', LAG),
    'dead time 20 ms': ((effect('dead_time', dead_time_s=0.020),), ()),
    'all, and 10 ms dead time': ('all', ()),
}
# Level, plant, what is configured: the loop whose margins are stated.
LOOPS = {
    'level 0.35, nominal': (FIRST, 'nominal', ()),
    'level 0.35, valve lag 20/28 ms': (FIRST, lag(0.020, 0.028), ()),
    'level 0.35, valve lag 50/70 ms': (FIRST, 'lag', ()),
    'level 1, nominal': (1.0, 'nominal', ()),
    'level 1, valve lag 10/14 ms': (1.0, lag(0.010, 0.014), ()),
    'level 1, lag 50/70 ms configured': (1.0, 'lag', LAG),
}


class Held:
    """No law: the pressure stays as it was."""

    def __init__(self, joint: Any) -> None:
        """Command nothing yet."""
        self.terms, self._pressures = Terms(), (0.0,)

    def start(self, position: float, pressures: tuple[float, ...]) -> None:
        """Keep these *pressures*."""
        self._pressures = pressures

    def update(self, dt: float, reference: Reference, *seen: Any) -> tuple[float, ...]:
        """Return the same pressures."""
        return self._pressures


def sine(frequency: float, end: float = np.inf) -> Callable[[float], float]:
    """Return a push in N that begins at BEGIN."""
    return lambda t: FORCE * sin(2.0 * pi * frequency * (t - BEGIN)) if BEGIN <= t < end else 0.0


def hold(
    make: Any, plant: TruthPlant, effects: Any, seconds: float, push: Callable[[float], float]
) -> Run:
    """Return the run in which a law holds the load at its rest position."""
    return close_loop(make(nominal(effects=effects)), plant, lambda t: 0.0, seconds, push=push)


def amplitude(run: Run, frequency: float) -> float:
    """Return the amplitude in m at the *frequency* of the push, over the last periods."""
    end = run.last(np.floor(JUDGED * frequency) / frequency)
    angle = 2.0 * pi * frequency * run.t[end]
    basis = np.column_stack([np.sin(angle), np.cos(angle), np.ones(angle.size)])
    a, b, _ = np.linalg.lstsq(basis, run.error[end], rcond=None)[0]
    return float(np.hypot(a, b))


def moved(make: Any, row: str, frequency: float, seed: int) -> float:
    """Return the amplitude in m at the *frequency* of the push, over the last periods."""
    name, effects = ROWS[row]
    run = hold(make, truth(name, seed=seed), effects, BEGIN + LASTS, sine(frequency))
    return amplitude(run, frequency)


def print_frequencies(seed: int) -> dict[str, np.ndarray]:
    """Print and return the amplitudes, m, of the held pressure and of all laws."""
    amplitudes = {
        name: np.array([moved(make, 'nominal', f, seed) for f in FREQUENCIES])
        for name, make in {'held': Held, **LAWS}.items()
    }
    print('amplitude at a held pressure / with the law, 8 N, nominal')
    print(f'{"Hz":>6}{"held, mm":>12}' + ''.join(f'{name:>18}' for name in LAWS))
    for n, f in enumerate(FREQUENCIES):
        held = amplitudes['held'][n]
        ratios = [held / amplitudes[name][n] for name in LAWS]
        least = LEAST.get(f, MOST)
        verdict = f'  >= {least:.3g} ' + ('ok' if ratios[0] >= least else 'SHORT')
        print(f'{f:>6g}{1e3 * held:>12.3f}' + ''.join(f'{r:>18.2f}' for r in ratios) + verdict)
    return amplitudes


def outside(run: Run, begin: float, end: float) -> float:
    """Return the time in s after *begin* at which the error is above CLOSE for the last time."""
    off = run.t[(np.abs(run.error) > CLOSE) & (run.t > begin) & (run.t <= end)]
    return float(off[-1] - begin) if off.size else 0.0


def dropping(plant: TruthPlant) -> Callable[[float], float]:
    """Return a push of 0 N that removes the payload from the *plant* at BEGIN."""

    def push(t: float) -> float:
        if t >= BEGIN:
            plant.parameters.payload_kg = 0.0
        return 0.0

    return push


def sagging(plant: TruthPlant) -> Callable[[float], float]:
    """Return a push of 0 N with a supply of the *plant* that falls by 8 %, time constant 4 s."""

    def push(t: float) -> float:
        plant.parameters.regulator_gain = 1.0 - 0.08 * (1.0 - np.exp(-max(t - BEGIN, 0.0) / 4.0))
        return 0.0

    return push


def print_others(seed: int) -> None:
    """Print how long and how far other disturbances move the load, and its error without them."""
    print('other disturbances, nominal: s until within 0.1 mm, largest error in mm; then without')
    print(
        'a push, nominal and with a lag of 20/28 ms not configured: largest error of the last 2 s'
    )
    print(
        f'{"":<18}{"50 N begins":>13}{"ends":>8}{"5 kg dropped":>16}{"supply -8 %":>13}'
        f'{"at rest":>10}{"with lag":>10}'
    )
    end = BEGIN + 2.0

    def hand(t: float) -> float:
        return 50.0 if BEGIN <= t < end else 0.0

    for name, make in LAWS.items():
        plant = truth('nominal', seed=seed)
        run = hold(make, plant, (), end + 3.0, hand)
        plant = truth('payload', seed=seed)
        dropped = hold(make, plant, (), BEGIN + 4.0, dropping(plant))
        plant = truth('nominal', seed=seed)
        sagged = hold(make, plant, (), BEGIN + 10.0, sagging(plant))
        rests = []
        for effects in ('nominal', lag(0.020, 0.028)):
            still = hold(make, truth(effects, seed=seed), (), 6.0, lambda t: 0.0)
            rests.append(1e3 * float(np.max(np.abs(still.error[still.last(2.0)]))))
        print(
            f'{name:<18}{outside(run, BEGIN, end):>11.2f} s{outside(run, end, end + 3.0):>6.2f} s'
            f'{outside(dropped, BEGIN, BEGIN + 4.0):>7.2f} s{1e3 * np.ptp(dropped.error):>6.1f}'
            f'{1e3 * np.max(np.abs(sagged.error)):>13.3f}{rests[0]:>10.3f}{rests[1]:>10.3f}',
            flush=True,
        )


def print_unconfigured(seed: int) -> None:
    """Print the rejection with unconfigured effects, and whether the load is calm afterwards."""
    print('sliding mode: held / law; largest error in mm 4 to 6 s after a push of 1 Hz and 8 s')
    heads = ''.join(f'{f"{f:g} Hz":>9}' for f in LEAST)
    print(f'{"plant":<28}{heads}{"after":>10}')
    for row, (name, effects) in ROWS.items():
        ratios = {f: moved(Held, row, f, seed) / moved(SlidingMode, row, f, seed) for f in LEAST}
        end = BEGIN + 8.0
        run = hold(SlidingMode, truth(name, seed=seed), effects, end + 6.0, sine(1.0, end))
        after = 1e3 * float(np.max(np.abs(run.error[run.last(2.0)])))
        least = {'nominal': LEAST, 'the same lag, configured': LEAST_CONFIGURED}.get(row, {})
        ok = after <= HUNT and all(r >= least.get(f, 0.0) for f, r in ratios.items())
        figures = ''.join(f'{r:>9.2f}' for r in ratios.values())
        print(f'{row:<28}{figures}{after:>10.3f}  {"ok" if ok else "SHORT"}', flush=True)


def print_after_motion(seed: int) -> None:
    """Print the rejection of a force that begins before a motion of 10 mm and back."""
    print('sliding mode: held / law, force from 1 s on, 10 mm away at 2 s and back at 5 s')
    print(f'{"load":<18}' + ''.join(f'{f"{f:g} Hz":>9}' for f in AFTER_MOTION))

    def target(t: float) -> float:
        return 0.01 if 2.0 <= t < 5.0 else 0.0

    for mass, pressure in LOADS:
        ratios = []
        for f in AFTER_MOTION:
            plant, left = (truth('nominal', mass, pressure, seed=seed) for _ in range(2))
            run = close_loop(SlidingMode(nominal(mass)), plant, target, 16.0, push=sine(f))
            alone = close_loop(Held(None), left, lambda t: 0.0, 16.0, push=sine(f))
            ratios.append(amplitude(alone, f) / amplitude(run, f))
        # The claim is for frequencies that the loop can follow.
        judged = [r for f, r in zip(AFTER_MOTION, ratios, strict=True) if 1.0 <= f <= 3.0]
        ok = 'ok' if min(judged) >= LEAST_AFTER_MOTION else 'SHORT'
        name = f'{mass:g} kg, {1e-3 * pressure:g} kPa'
        print(f'{name:<18}' + ''.join(f'{r:>9.2f}' for r in ratios) + f'  {ok}', flush=True)


def print_margins() -> None:
    """Print the margins of the linear loop at the levels that the rejection may have."""
    print('margins of the loop, cut at the command; the level is held')
    print(f'{"":<32}{"crosses at":>12}{"phase":>8}{"delay":>10}{"gain":>9}')
    for row, (level, name, effects) in LOOPS.items():
        found: Margins = margins_of(level, truth(name, noise=0.0), nominal(effects=effects))
        print(
            f'{row:<32}{found.crossover:>9.1f} Hz{found.phase:>6.0f} °'
            f'{1e3 * found.delay:>7.1f} ms{found.gain:>6.1f} dB',
            flush=True,
        )


def draw(amplitudes: dict[str, np.ndarray], path: Path) -> None:
    """Draw the compliance, and the rejection relative to a held pressure."""
    figure = Figure(figsize=(9, 3.6), layout='constrained')
    left, right = figure.subplots(1, 2, sharex=True)
    held = amplitudes['held']
    left.loglog(FREQUENCIES, 1e3 * held / FORCE, 'k--', label='pressure held')
    for name in LAWS:
        found, colour = amplitudes[name], COLOURS[name]
        left.loglog(FREQUENCIES, 1e3 * found / FORCE, color=colour, marker='.', label=name)
        right.semilogx(FREQUENCIES, 20.0 * np.log10(found / held), color=colour, marker='.')
    right.axhline(0.0, color='k', linestyle='--', linewidth=0.8)
    left.set_ylabel('compliance [mm/N]')
    right.set_ylabel('motion against the pressure held [dB]')
    left.legend(frameon=False)
    for axes in (left, right):
        axes.set_xlabel('frequency of the push [Hz]')
        axes.grid(which='both', alpha=0.2)
        axes.set_xticks((0.3, 1, 3, 10, 20), ('0.3', '1', '3', '10', '20'), minor=False)
        axes.minorticks_off()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)
    print(f'wrote {path}')


def main() -> None:
    """Print the tables and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seed', type=int, default=0)
    parser.add_argument('--picture', type=Path, default=Path('build/disturbance.png'))
    given = parser.parse_args()
    amplitudes = print_frequencies(given.seed)
    print()
    print_others(given.seed)
    print()
    print_unconfigured(given.seed)
    print()
    print_after_motion(given.seed)
    print()
    print_margins()
    print()
    draw(amplitudes, given.picture)


if __name__ == '__main__':
    main()
