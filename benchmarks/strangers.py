# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings with what goes wrong in other people's laboratories: right, a sentence, or wrong.

Each case is a recording of the truth plant in ``test/truth``, spoiled or written as strangers do:
a glitch, another unit, two loads, a clock that is late, a format. It is ``right`` if the
identification names what the rig lacks and nothing else, ``sentence`` if the recording is refused
or no verdict is given, with the reason, and ``wrong`` otherwise. Options: ``--seeds N`` (default
1) from ``--first N``, ``--kinds a,b``, ``--jobs N``.
"""

import os

# One thread for each of many small matrices: cases run side by side instead.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

import argparse
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from pam_ros.errors import PamError
from pam_ros.identification.identify import identify
from pam_ros.recording.read import read_recording
from pam_ros.recording.recording import Recording
from pam_ros.settings.nominal import package_muscles
from support import bags, bench_truth
from truth import effect

Array = NDArray[np.float64]
Case = Callable[[int, Path], Sequence[Recording]]
JOINT = bench_truth.nominal()
FRICTION = 'coulomb_friction'
NAMES = 't_s,pressure_command_kPa,position_mm'


def rig(seed: int, mass: float = 20.0) -> Recording:
    """Return the recording of a rig with friction."""
    return bench_truth.free(effect(FRICTION), seed=seed, mass=mass, name=f'{mass:g}kg.csv')


def changed(change: Callable[[Recording, np.random.Generator], Recording]) -> Case:
    """Return the case of a recording that is *changed*."""
    return lambda seed, folder: [change(rig(seed), np.random.default_rng([seed, 1]))]


def scaled(name: str, factor: float) -> Case:
    """Return the case of a signal that is *factor* times as large as it should be."""
    return changed(lambda one, rng: replace(one, **{name: factor * getattr(one, name)}))


def written(change: Callable[[Recording, np.random.Generator], Recording]) -> Case:
    """Return the case of a *changed* recording that is read from a file."""

    def case(seed: int, folder: Path) -> list[Recording]:
        one = change(rig(seed), np.random.default_rng([seed, 1]))
        (folder / 'log.csv').write_text(table(rows_of(one)), encoding='utf-8')
        return [read_recording(folder / 'log.csv', JOINT)]

    return case


def glitches(share: float) -> Case:
    """Return the case in which a *share* of the positions, at least one, are glitches."""

    def spoiled(one: Recording, rng: np.random.Generator) -> Recording:
        y = np.array(one.position)
        count = max(1, round(share * y.size))
        at = 20 + rng.choice(y.size // 12 - 4, count, replace=False) * 12
        y[at] += rng.choice([-1.0, 1.0], count) * rng.uniform(0.01, 0.05, count)
        return replace(one, position=y)

    return written(spoiled)


def rows_of(one: Recording) -> Array:
    """Return the rows (n, 3) of a recording in s, kPa and mm, a command in each."""
    return np.column_stack([one.t, 1e-3 * np.asarray(one.command), 1e3 * np.asarray(one.position)])


def text_file(write: Callable[[Array], str], **reading: object) -> Case:
    """Return the case of a file with the text write(rows), read with the options *reading*."""

    def case(seed: int, folder: Path) -> list[Recording]:
        path = folder / 'log.csv'
        path.write_text(write(rows_of(rig(seed))), encoding='utf-8')
        return [read_recording(path, JOINT, **reading)]

    return case


def table(rows: Array, header: str = NAMES, separator: str = ',', mark: str = '.') -> str:
    """Return rows as the text of a file."""
    lines = [separator.join(f'{x:.5f}'.replace('.', mark) for x in row) for row in rows]
    return '\n'.join([*([header] if header else []), *lines, ''])


def thousands(rows: Array) -> str:
    """Return rows with pressures in Pa that have marks of thousands, in a file with tabs."""
    lines = [f'{t:.5f}\t{1e3 * p:,.0f}\t{y:.5f}' for t, p, y in rows]
    return '\n'.join([NAMES.replace('kPa', 'Pa').replace(',', '\t'), *lines, ''])


def clock(rows: Array) -> str:
    """Return rows whose times are those of a clock, past midnight."""
    stamps = np.datetime64('2024-05-01T23:59:50') + np.round(1e6 * rows[:, 0]).astype('m8[us]')
    lines = [f'{t},{p:.5f},{y:.5f}' for t, (_, p, y) in zip(stamps, rows, strict=True)]
    return '\n'.join(['time,pressure_command_kPa,position_mm', *lines, ''])


def stale(one: Recording, rng: np.random.Generator) -> Recording:
    """Return positions of a sensor of 25 Hz in rows of 100 Hz."""
    at = np.arange(one.t.size) // 4 * 4
    return replace(one, position=np.asarray(one.position)[at])


def early(rows: int) -> Case:
    """Return the case of outputs that are so many rows early."""

    def moved(one: Recording, rng: np.random.Generator) -> Recording:
        n = one.t.size - rows
        times = {name: getattr(one, name)[:n] for name in ('t', 'command_t', 'command')}
        return replace(one, **times, position=np.asarray(one.position)[rows:])

    return changed(moved)


def bag(behind: float = 0.0, others: int = 0, use_sim_time: bool = False) -> Case:
    """Return the case of a bag: headers *behind* the recorder in s, *others* on the topic."""

    def case(seed: int, folder: Path) -> list[Recording]:
        one, states, commands = rig(seed), [], []
        for k, (t, p, y) in enumerate(zip(one.t, one.command, one.position, strict=True)):
            begun = not (use_sim_time and k < 200)
            at = bags.ns(t) if begun else 0
            states.append((at, bags.joint(bags.ns(t - behind) if behind else 0, [y])))
            commands.append((at, bags.number(p)))
            if others and k % others == 0:
                states.append((at, bags.joint(0, [0.3], names=('other',))))
        path = folder / 'bag'
        topics = {'/pressure_command': (bags.FLOAT, commands)}
        bags.write_bag(path, {**topics, '/joint_states': (bags.JOINT, states)})
        return [read_recording(path, JOINT)]

    return case


def loads(stated: bool) -> Case:
    """Return the case of two loads, of which both are *stated* or one."""

    def case(seed: int, folder: Path) -> list[Recording]:
        found = [rig(seed, mass) for mass in (12.0, 20.0)]
        if not stated:
            return found
        masses = zip(found, (12.0, 20.0), strict=True)
        return [replace(one, numbers={'mass': mass}) for one, mass in masses]

    return case


def against(one: Recording, rng: np.random.Generator) -> Recording:
    """Return a recording whose position falls as the muscle pulls."""
    return replace(one, position=0.11 - np.asarray(one.position))


def masked(one: Recording, rng: np.random.Generator) -> Recording:
    """Return a recording whose invalid positions are masked."""
    y = np.array(one.position)
    y[100::50] = -1.0
    return replace(one, position=np.ma.masked_less(y, -0.5))


PREAMBLE = 'LabVIEW Measurement\nOperator,A\n***End_of_Header***\n\n'
CASES: dict[str, Case] = {
    'as it is': changed(lambda one, rng: one),
    'one glitch': glitches(0.0),
    'glitches in 1 %': glitches(0.01),
    'psi read as kPa': scaled('command', 1.0 / 6.894757),
    'kPa read as psi': scaled('command', 6.894757),
    'MPa read as bar': scaled('command', 0.1),
    'inch read as cm': scaled('position', 1.0 / 2.54),
    'cm read as mm': scaled('position', 0.1),
    'position against the pull': changed(
        lambda one, rng: replace(one, position=0.11 - one.position)
    ),
    'positions 30 ms early': early(3),
    'positions 100 ms early': early(10),
    'repeated values': written(stale),
    'masked values': changed(masked),
    'two loads: one stated': loads(stated=False),
    'two loads: both stated': loads(stated=True),
    'decimal comma': text_file(
        partial(table, header=NAMES.replace(',', ';'), separator=';', mark=',')
    ),
    'marks of thousands': text_file(thousands),
    'no names': text_file(partial(table, header=''), columns=NAMES.split(',')),
    'no names and none given': text_file(partial(table, header='')),
    'row of units': text_file(partial(table, header='time,pressure_command,position\ns,kPa,mm')),
    'lines above': text_file(partial(table, header=PREAMBLE + NAMES)),
    'clock past midnight': text_file(clock),
    'bag': bag(),
    'bag with another joint': bag(others=3),
    'bag with a clock 100 ms behind': bag(behind=0.1),
    'bag from before the first clock': bag(use_sim_time=True),
}


def run(job: tuple[str, int]) -> tuple[str, int, str, str, float]:
    """Run one case; return it with its outcome, what was said, and the s that it took."""
    name, seed = job
    began = time.perf_counter()
    with TemporaryDirectory() as folder:
        try:
            found = identify(JOINT, CASES[name](seed, Path(folder)), muscles=package_muscles())
        except PamError as error:
            outcome, said = 'sentence', str(error).replace(folder, '')
        else:
            effects = [one.name for one in found.effects]
            is_right = effects == [FRICTION]
            is_open = found.verdict == 'insufficient_data'
            outcome = 'right' if is_right else 'sentence' if is_open else 'wrong'
            said = found.sentence if is_open else '+'.join(effects) or str(found.verdict)
    return name, seed, outcome, said, time.perf_counter() - began


def main() -> None:
    """Run the cases that the command line selects; exit with 1 if one of them is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, default in (('--seeds', 1), ('--first', 0), ('--jobs', 2)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument('--kinds', default=','.join(CASES))
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.seeds)
    chosen = [name for name in CASES if name in given.kinds.split(',')]
    with ProcessPoolExecutor(given.jobs) as pool:
        rows = []
        for row in pool.map(run, [(name, seed) for seed in seeds for name in chosen]):
            rows.append(row)
            name, seed, outcome, said, seconds = row
            print(f'{name:32s} {seed:3d}  {outcome:9s} {seconds:5.1f} s  {said}', flush=True)
    count = Counter(outcome for _, _, outcome, _, _ in rows)
    print(', '.join(f'{count[word]} {word}' for word in ('right', 'sentence', 'wrong')))
    sys.exit(1 if count['wrong'] else 0)


if __name__ == '__main__':
    main()
