# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scenarios drawn with a seed, written as files like those of the package.

What is drawn can be done: the load can be held at each position of the reference, by the rig that
is declared and by the real one with all its effects, and smooth motions need no more than the
muscles can give.
"""

from collections.abc import Iterator, Mapping
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from pam_ros.bench.draw import reference as references
from pam_ros.bench.draw.about import about
from pam_ros.bench.draw.changes import Change, draw_change, timed
from pam_ros.bench.draw.dice import Dice, digits
from pam_ros.bench.draw.effects import Given, draw_declared, draw_effects, sizes_of
from pam_ros.bench.draw.possible import (
    ImpossibleError,
    common_reach,
    draw_motion,
    draw_start,
    joints_of,
)
from pam_ros.bench.draw.reference import BEGIN, Motion, draw_score
from pam_ros.bench.draw.rig import JOINTS, Rig, draw_rig, muscles
from pam_ros.bench.scenario import RATE, SUITES, Scenario, read_scenario
from pam_ros.errors import PamError, ParameterError
from pam_ros.plain_yaml import read_yaml
from pam_ros.report.write import check_parent
from pam_ros.rig.arrangements import LOAD, Arrangement
from pam_ros.settings.files import write_whole

FASTEST = 10.0  # Hz, natural frequency of the joint
MOST = 500  # tries for a scenario, which needs one or two
SETTLED = 5.0, 7.0  # s after the last motion or change
RATES: Mapping[float, float] = {RATE: 4.0, 200.0: 1.0, 250.0: 1.0, 1000.0: 1.0}  # Hz
WIDTH = 99  # columns of a file


class _Frame(NamedTuple):
    """What of a scenario is drawn once, so that what is possible more often is not preferred."""

    suite: str
    kind: Arrangement
    muscle: str
    reference: str
    score: str


def drawn_scenarios(
    folder: Path, count: int, seed: int, suite: str | None = None
) -> list[Scenario]:
    """Return so many scenarios, which are written to *folder* and read from there.

    With a *suite* those of the others are left out. The same *seed* gives the same scenarios by
    name, whatever *count* and *suite* are. Raises ParameterError if a file with one of the names
    has another content, and PamError if one cannot be written.
    """
    contents = {}
    for number, content in _contents(seed, suite):
        contents[folder / f'draw_{seed}_{number:03d}.yaml'] = content
        if len(contents) == count:
            break
    check_parent(next(iter(contents)))
    for path, content in contents.items():
        if path.exists() and read_yaml(path) != content:
            raise ParameterError(
                f'{path} has another content than what is drawn: move it, or give another --out'
            )
    for path, content in contents.items():
        try:
            write_whole(path, _text(content))
        except OSError as error:
            raise PamError(f'{path} cannot be written: {error.strerror}') from error
    return [read_scenario(path) for path in contents]


def _text(content: Mapping[str, Any]) -> str:
    return yaml.safe_dump(content, sort_keys=False, default_flow_style=None, width=WIDTH)


def _contents(seed: int, suite: str | None) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the scenarios of a *seed*, with their numbers, as the contents of their files."""
    number = 0
    while True:
        number += 1
        dice = Dice(seed, number)
        own = dice.one_of(dict.fromkeys(SUITES, 1.0))
        if suite in (None, own):
            yield number, _content(dice, seed, own)


def _content(dice: Dice, seed: int, suite: str) -> dict[str, Any]:
    """Return a scenario of a *suite* as the content of its file."""
    kind = dice.one_of(references.KINDS).__name__
    frame = _Frame(
        suite,
        LOAD if suite == 'muscle' else dice.one_of(JOINTS),
        dice.one_of(dict.fromkeys(muscles(), 1.0)),
        kind,
        draw_score(dice, kind),
    )
    for _ in range(MOST):
        try:
            return _drawn(dice, seed, frame)
        except PamError as error:  # not a muscle, not a joint, or not possible
            reason = error
    raise PamError(f'no scenario like {frame} can be drawn: {reason}')


def _drawn(dice: Dice, seed: int, frame: _Frame) -> dict[str, Any]:
    """Return a scenario; raises PamError if what was drawn is not possible."""
    rig = draw_rig(dice, frame.kind, frame.muscle)
    (nominal,) = joints_of(rig.declared)
    sizes = sizes_of(nominal, common_reach(nominal))
    if not 0.0 < sizes.stiffness < (2.0 * pi * FASTEST) ** 2 * sizes.inertia:
        raise ImpossibleError('the joint is not stable, or too fast')
    change = draw_change(dice, rig, sizes, must=frame.reference == 'hold')
    hidden = draw_effects(dice, sizes, {change.uses} if change else set())
    name = draw_declared(dice, hidden)
    known = {name: hidden.pop(name)} if name else {}
    declared = {**rig.declared, **({'effects': known} if known else {})}
    present = {**hidden, **({change.uses: change.start} if change and change.start else {})}
    undeclared = {
        'publish_rate': dice.one_of(RATES),
        'sensor': _sensor(dice, rig),
        **({'effects': present} if present else {}),
    }
    given = {**undeclared, **rig.of_muscles(*rig.specimens)}
    real = joints_of(declared, given, timed(change, 0.1) if change else [])
    reach = common_reach(*joints_of(declared), *real)
    pressures, start = draw_start(dice, real[0], reach)
    motion = draw_motion(dice, frame.reference, real, reach, (pressures, start))
    own = (
        {**one, 'initial': {'pressure': p}}
        for one, p in zip(rig.specimens, pressures, strict=True)
    )
    given = {'declared': declared, 'undeclared': {**undeclared, **rig.of_muscles(*own)}}
    return _complete(dice, seed, frame, rig, given, (hidden, known), change, motion)


def _complete(
    dice: Dice,
    seed: int,
    frame: _Frame,
    rig: Rig,
    given: Mapping[str, Any],
    effects: tuple[Mapping[str, Given], Mapping[str, Given]],
    change: Change | None,
    motion: Motion,
) -> dict[str, Any]:
    """Return the content of a file, with the times of the change and of the end."""
    end, changes, clause = motion.end, [], ''
    if change:
        is_after = frame.score == 'error_at_rest'
        share = dice.between(0.2, 0.7)
        at = end + dice.between(2.5, 4.0) if is_after else BEGIN + share * (end - BEGIN)
        changes = timed(change, at)
        clause = f'at {changes[0]["time"]:g} s {change.text}'
        end = max(end, changes[-1]['time'])
    if frame.score == 'error_at_rest' or frame.reference in ('minimum_jerk', 'trajectory'):
        end += dice.between(*SETTLED)
    reference = {'kind': frame.reference, **motion.content}
    content = {
        'about': about(seed, rig, given['undeclared'], *effects, clause, reference),
        'suite': frame.suite,
        'score': frame.score,
        'duration': digits(end),
        'declared': given['declared'],
        'undeclared': given['undeclared'],
        'reference': reference,
    }
    return {**content, 'changes': changes} if changes else content


def _sensor(dice: Dice, rig: Rig) -> dict[str, float]:
    """Return the errors of the sensors: encoders of 2 to 50 um, or 0.02 to 0.3 mrad."""
    low, high = (20e-6, 0.3e-3) if rig.is_revolute else (2e-6, 50e-6)
    highest = muscles()[rig.muscle].p_max
    found = {
        'position_noise': dice.decade(low, high),
        'velocity_noise': dice.decade(100.0 * low, 100.0 * high),
        'pressure_noise': digits(highest * dice.decade(0.0003, 0.003)),
    }
    if dice.chance(0.3):
        found['position_resolution'] = dice.decade(low, 2.0 * high)
    if dice.chance(0.5):
        found['latency'] = dice.decade(0.5e-3, 8e-3)
    return found
