# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The search in recordings with commands, measured pressures and positions.

The measured pressures divide the problem. What is between the commands and the chambers is found
from the pressures, what is behind them from the motion under the measured pressures: each is
smaller, and an error of the one does not hide an effect of the other. Then all that was found is
fitted together to the motion under the commands alone, which is what is reported.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.by_signal import behind_chambers, of_chambers
from pam_ros.identification.data.parts import like, parts_in_turn
from pam_ros.identification.data.segment import PressureSegment
from pam_ros.identification.fit.extend import bounded, with_effect
from pam_ros.identification.fit.places import effect_of
from pam_ros.identification.fit.solve import converge, initial_solution
from pam_ros.identification.fit.unknowns import OfEffect
from pam_ros.identification.search.forecast import of_search
from pam_ros.identification.search.readings import likely_mistake
from pam_ros.identification.search.search import (
    Search,
    find_effects,
    find_effects_from,
    improved,
    without_effects,
)
from pam_ros.identification.search.setting import Model, Setting, rms
from pam_ros.identification.search.starts import without_idle
from pam_ros.identification.verdict import WEATHER
from pam_ros.identification.wording import listed
from pam_ros.recording.quantities import ATMOSPHERE
from pam_ros.recording.recording import Recording

# Effects that an error of the pressure sensor imitates, its offset or the age of its samples: the
# motion must show them as well.
OF_SENSOR = ('pressure_offset', 'dead_time')
# Share of the highest command by which a copy of the commands may differ from them: offsets of the
# pressure of the air that were added and subtracted leave errors of rounding.
EQUAL = 1e-9
SIDES: tuple[Literal['left', 'right'], ...] = ('left', 'right')
# Error of the best model in standard deviations of a pressure, above which it is another signal.
STRANGE = 1.0 / 3.0


@dataclass(frozen=True, eq=False)
class BySignal:
    """The search for all effects, and the one in the pressures, None if they are not used.

    ``note`` is a sentence that says why they are not used, '' if they are.
    """

    search: Search
    path: Search | None = None
    note: str = ''


def find_by_signal(
    setting: Setting,
    recordings: Sequence[Recording],
    shares: tuple[float, float],
) -> BySignal:
    """Find the effects in *recordings*, which have commands and measured pressures.

    *setting* is their setting, and *shares* are those of its parts. What judges there is used
    nowhere else.
    """
    chambers = [of_chambers(one) for one in recordings]
    of_path = replace(setting, parts=parts_in_turn(chambers, *shares))
    path, reason = None, idle(recordings) or copied(recordings)
    if not reason and (doubt := likely_mistake(of_path, {})):
        reason = doubt.reason
    behind = [behind_chambers(one) for one in recordings]
    of_motion = replace(setting, parts=like(setting.parts, behind), is_behind_chambers=True)
    both = of_search(setting)
    if not reason:
        with setting.work.part('pressures', of_search(of_motion).plus(both)):
            path = _found(of_path)
        # Before its end, the search may not have found why the pressures differ from the commands.
        reason = '' if setting.work.is_stopped else contradiction(path)
    if path is None or reason:
        note = f'the measured pressures are not used: {reason}'
        return BySignal(find_effects(setting), None, note)
    with setting.work.part('motion', both):
        motion = _found(of_motion)
    with setting.work.part('both'):
        found = without_effects(setting)
        found.kept = tuple(one for one in path.best.effects if effect_of(one) not in OF_SENSOR)
        begin = joined(found, path.best, motion.best)
        return BySignal(find_effects_from(found, begin), path)


def _found(setting: Setting) -> Search:
    """Return the search of a part, whose effects the search of all confirms."""
    return improved(without_effects(setting))


def idle(recordings: Sequence[Recording]) -> str:
    """Return a clause that names the pressures which are the same in all samples, '' if none."""
    given = [(one.pressure, one.t.size) for one in recordings if one.pressure is not None]
    values = np.concatenate([pressure.reshape(count, -1) for pressure, count in given])
    still = np.flatnonzero(np.ptp(values, axis=0) == 0.0)
    if not still.size:
        return ''
    names = [recordings[0].muscles[k] for k in still] if recordings[0].muscles else []
    which = f'those of {listed(names)}' if names else 'they'
    return f'{which} are constant while the commands change: was the sensor read?'


def copied(recordings: Sequence[Recording]) -> str:
    """Return a clause that names the pressures which equal the commands, '' if none do.

    A program that stores its set-point twice gives such pressures. As a measurement they would
    exclude each effect between the commands and the chambers.
    """
    equal = np.logical_and.reduce([_are_copies(one) for one in recordings])
    if not equal.any():
        return ''
    names = [recordings[0].muscles[k] for k in np.flatnonzero(equal) if recordings[0].muscles]
    which = f'those of {listed(names)}' if names else 'they'
    return f'{which} equal the commands in all samples, as a copy of them does, and no sensor'


def _are_copies(recording: Recording) -> NDArray[np.bool_]:
    """Return for each muscle whether its pressure equals its command (muscles,)."""
    assert recording.command is not None
    assert recording.command_t is not None
    assert recording.pressure is not None
    command = recording.command.reshape(recording.command.shape[0], -1)
    pressure = recording.pressure.reshape(recording.pressure.shape[0], -1)
    found = np.zeros(command.shape[1], dtype=bool)
    for side in SIDES:  # a copy may be taken before or after a command of the same stamp acts
        at = np.searchsorted(recording.command_t, recording.t, side=side) - 1
        error = np.abs(pressure - command[np.maximum(at, 0)]).max(axis=0)
        found |= error <= EQUAL * np.abs(command).max(axis=0)
    return found


def contradiction(path: Search) -> str:
    """Return why measured pressures cannot be those in the chambers, '' if they can be.

    *path* is the search in them.
    """
    known = path.best.nearest
    for unknown, u in zip(known.problem.unknowns, known.u, strict=True):
        value = unknown.value(u)
        if unknown.name.endswith('pressure_offset.offset') and abs(value - ATMOSPHERE) < WEATHER:
            return (
                f'they are {1e-3 * value:.4g} kPa higher than what was commanded, which is the '
                'pressure of the air: are they absolute? Gauge pressures are expected: --column '
                "'NAME=pressure_Pa-101325'"
            )
    segments, errors = known.problem.segments, known.problem.by_run(known.r)
    for name in dict.fromkeys(one.muscle for one in segments if isinstance(one, PressureSegment)):
        own = [
            (e, s.target[s.fit])
            for s, e in zip(segments, errors, strict=True)
            if isinstance(s, PressureSegment) and s.muscle == name
        ]
        error, target = (np.concatenate(each) for each in zip(*own, strict=True))
        share = rms(error) / float(np.std(target))
        if share > STRANGE:
            which = f' in {path.setting.muscles[name]}' if path.setting.muscles else ''
            return (
                f'they differ{which} from what the commands give by {share:.2g} of their standard '
                'deviations, with the best effects of the pressure path: are they those of '
                'another sensor, or in another unit?'
            )
    return ''


def joined(search: Search, path: Model, motion: Model) -> Model:
    """Return the model with the effects of *path* and *motion*, fitted as *search* requires.

    The fit begins with their effects, and with the constants of *motion*.
    """
    setting = search.setting
    known = search.retuned.solution
    problem, u = known.problem, known.u
    values: dict[str, float] = {}
    for model in (path, motion):
        pairs = zip(model.nearest.problem.unknowns, model.nearest.u, strict=True)
        own = [(one, value) for one, value in pairs if one.is_parameter]
        values |= {one.name: one.value(value) for one, value in own}
        for name in model.effects:
            start = {
                one.of.parameter: one.value(value)
                for one, value in own
                if isinstance(one.of, OfEffect) and one.of.place == name
            }
            problem, added = with_effect(problem, setting.joint, setting.places[name], start)
            u = np.concatenate([u, added])
            problem = bounded(problem, u, setting.joint, setting.places[name])
    u = np.array(
        [
            one.coordinate(values[one.name]) if one.name in values else before
            for one, before in zip(problem.unknowns, u, strict=True)
        ]
    )
    begin = without_idle(initial_solution(problem, u, pool=setting.pool), setting.noise)
    begin = replace(begin, discrepancy=begin.most_likely())
    end = converge(begin, setting.budget.iterations, setting.pool)
    return setting.model((*path.effects, *motion.effects), end)
