# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Another unit or sign of a signal, mass or muscle with which the nominal model is right.

If a pressure in psi is read as one in kPa, a fit still follows the motion: with constants that no
muscle has, and with effects that the rig does not have. But the nominal model does not follow it
at all, and with the right unit it does. So the nominal model, which is simulated without any fit,
is compared for all usual mistakes, whose factors are so large (at least 2.5) that no effect of the
library is mistaken for one of them.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np

from pam_ros.errors import PamError, ParameterError
from pam_ros.identification.data.segment import FreeSegment, Segment
from pam_ros.identification.data.thinning import coarse_period, longest_step
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.search.doubt import Doubt
from pam_ros.identification.search.setting import Setting, rms
from pam_ros.muscle.constants import CONSTANTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

# Error of the nominal model, in standard deviations of the signal, above which the data are
# doubted: a constant has 1. With psi read as kPa, rigs of two muscles had 0.52 to 0.8.
DOUBTED = 0.4
# Share of that error, and error, that another reading may leave. In 190 rigs with a missing
# effect that were read as they are, every other reading left more than 0.6 of it. If the nominal
# constants were those of another muscle, or one of them was off by 20 to 80 %, it left more than
# 0.37 of it, or an error of at least 0.65. The right reading left 0.001 to 0.33 of it, with few
# exceptions.
LEFT, FOLLOWS = 1.0 / 3.0, 0.5
# Share of its greatest force, or of its length, by which another muscle differs at least.
DIFFERENT = 0.25
REMEDY = (
    "Correct it, with --column 'NAME=TARGET*SCALE+OFFSET' for a signal, and identify again. If "
    'the recording is right, the nominal model is of another rig: state how uncertain its '
    'constants are, --uncertain a5=50%, and so on for a1 to a6.'
)
ALIKE = 2.0  # times the least error that the readings that are named with it have at most

# Factors by which a signal is too small, and how this can happen: as <unit> that is read as <unit>
PRESSURE = {
    6.894757: ('psi', 'kPa'),
    14.50377: ('bar', 'psi'),
    7.500617: ('kPa', 'mmHg'),
    10.0: ('MPa', 'bar'),
    100.0: ('bar', 'kPa'),
}
LENGTH = {
    2.54: ('inch', 'cm'),
    25.4: ('inch', 'mm'),
    10.0: ('cm', 'mm'),
    100.0: ('m', 'cm'),
    1000.0: ('m', 'mm'),
}
ANGLE = {
    180.0 / pi: ('rad', 'deg'),
    2.0 * pi: ('turns', 'rad'),
    360.0: ('turns', 'deg'),
}
FORCE = {
    4.448222: ('lbf', 'N'),
    9.80665: ('kgf', 'N'),
    10.0: ('daN', 'N'),
    1000.0: ('kN', 'N'),
    101.9716: ('N', 'gf'),
}
MASS = {9.80665: ('kg', 'N'), 1000.0: ('kg', 'g')}


@dataclass(frozen=True)
class Reading:
    """Another meaning of the numbers of recordings, or of the nominal mass or muscle.

    ``text`` is a clause that says what would be different. The maps are of the runs, and of the
    joint, None if it remains the same.
    """

    text: str
    of_run: Callable[[Segment], Segment] = lambda run: run
    joint: Joint | None = None


def likely_mistake(setting: Setting, muscles: Mapping[str, Muscle]) -> Doubt | None:
    """Return the doubt if the recordings show a mistake in a unit or a sign, None if not.

    *setting* is the setting of their identification. The nominal muscle may also have been
    confused with one of *muscles*, by name. If constants were stated as uncertain, the error of
    the nominal model shows nothing.
    """
    if any(name.rpartition('.')[2] in CONSTANTS for name in setting.uncertain):
        return None
    # Without unknowns, the runs begin as they were measured.
    nominal = replace(setting.problem, unknowns=())
    before = _error(nominal)
    if before < DOUBTED:
        return None
    found: list[tuple[float, str]] = []
    joint, runs = setting.joint, nominal.segments
    others = {} if setting.is_of_pressures else muscles
    for reading in (*_readings(joint, runs[0]), *_with_muscles(joint, others)):
        with suppress(PamError):  # there is no rest position, or no joint with such values
            other = replace(nominal, segments=tuple(map(reading.of_run, runs)))
            if reading.joint is not None:
                other = _of_joint(other, reading.joint)
            found.append((_error(other), reading.text))
    least = min(found)[0]
    if least > min(LEFT * before, FOLLOWS):
        return None
    texts = ', or '.join(text for error, text in sorted(found) if error <= ALIKE * least)
    return Doubt(
        f'the nominal model does not follow the recording (its error is {before:.2g} standard '
        f'deviations of the {runs[0].quantity}), but it does (then {least:.2g}) if {texts}',
        REMEDY,
    )


def _error(problem: Problem) -> float:
    """Return the RMSE of a model without unknowns in standard deviations of the target."""
    error = rms(problem.residuals(np.zeros(0)))
    target = np.concatenate([s.target[s.fit] for s in problem.segments])
    return error / float(np.std(target))


def _of_joint(problem: Problem, joint: Joint) -> Problem:
    """Return *problem* with the nominal values of another *joint* of the same kind."""
    step = min(problem.step, longest_step(coarse_period(joint)))
    return replace(problem, row=joint.parameters().ravel(), joint=joint, step=step)


def _readings(joint: Joint, run: Segment) -> Iterator[Reading]:
    """Return the other readings of runs like *run* of *joint*."""
    if run.quantity == 'pressure':
        for factor, right, wrong in _both_ways(PRESSURE):
            text = (
                f'the command is {factor:.4g} times as large, as a pressure in {right} that was '
                f'read as one in {wrong}'
            )
            yield Reading(text, _scaled('command', factor))
        if len(joint.muscles) == 2:
            yield Reading('the commands of the two muscles are exchanged', _exchanged)
        return
    is_angle = run.unit == 'rad'
    units = [('pressure', PRESSURE), ('position', ANGLE if is_angle else LENGTH)]
    if run.kind == 'held':
        units.append(('force', FORCE))
    for quantity, table in units:
        for factor, right, wrong in _both_ways(table):
            text = (
                f'the {quantity} is {factor:.4g} times as large, as a {quantity} in {right} that '
                f'was read as one in {wrong}'
            )
            yield Reading(text, _scaled(quantity, factor))
    if run.kind == 'free' and joint.load.mass > 0.0:
        for factor, wrong, right in _both_ways(MASS):
            text = (
                f'the mass is {factor * joint.load.mass:.4g} kg instead of '
                f'{joint.load.mass:.4g} kg, as a number in {right} that was given as {wrong}'
            )
            with suppress(ParameterError):  # no load has this mass
                yield Reading(text, joint=joint.with_load(mass=factor * joint.load.mass))
    if run.kind == 'free':
        text = 'the position has the opposite sign, and increases with the pull of the muscle'
        if is_angle:
            yield Reading('the angle has the opposite sign', _scaled('position', -1.0))
            text = 'the angle has the opposite sign and another zero'
        yield Reading(text, _turned(joint))
    if len(joint.muscles) == 2:
        yield Reading('the two muscles are exchanged', _exchanged)


def _both_ways(table: dict[float, tuple[str, str]]) -> Iterator[tuple[float, str, str]]:
    """Return the factors of *table* with their units, and the inverse ones."""
    for factor, (one, other) in table.items():
        yield factor, one, other
        yield 1.0 / factor, other, one


def _changed(run: Segment, names: Sequence[str], change: Callable[[Any], Any]) -> Segment:
    """Return *run* with those of its values called *names* changed that it has."""
    own = {name: getattr(run, name) for name in names if hasattr(run, name)}
    return replace(run, **{name: change(value) for name, value in own.items()})


def _scaled(quantity: str, factor: float) -> Callable[[Segment], Segment]:
    """Return a map to runs in which a *quantity* is *factor* times as large."""

    def scaled(run: Segment) -> Segment:
        names = {
            'command': ('drive',),
            'pressure': ('drive', 'pressure'),
            'position': ('position', 'velocity', 'y0', 'v0'),
        }.get(quantity, ())
        is_target = quantity == run.quantity
        return _changed(run, (*names, *(['target'] if is_target else [])), lambda x: factor * x)

    return scaled


def _turned(joint: Joint) -> Callable[[Segment], Segment]:
    """Return a map to runs with the opposite sign of the position, which may have any zero.

    The zero is the one with which the median position is that at rest with the median pressures.
    """

    def turned(run: Segment) -> Segment:
        assert isinstance(run, FreeSegment)
        middle = float(np.median(run.target))
        # A load without a spring is at rest anywhere. Commands of a thinned run are not evenly
        # spaced.
        at_rest = middle
        if not joint.is_driven:
            at_rest = statics.equilibrium(joint, np.median(run.commands(run.t), axis=0))
        zero = at_rest + middle
        return _changed(_changed(run, ('target', 'y0'), lambda y: zero - y), ('v0',), np.negative)

    return turned


def _exchanged(run: Segment) -> Segment:
    return _changed(run, ('drive',), lambda values: values[:, ::-1])


def _are_alike(one: Muscle, other: Muscle) -> bool:
    """Return whether two muscles differ less than a missing effect may change one of them."""
    if abs(one.l0 / other.l0 - 1.0) > DIFFERENT:
        return False
    p, kappa = np.meshgrid(np.linspace(0.2, 1.0, 5) * other.p_max, np.linspace(0.0, 0.2, 5))
    forces = [np.asarray(muscle.force(p, kappa)) for muscle in (one, other)]
    return bool(np.max(np.abs(forces[0] - forces[1])) <= DIFFERENT * np.max(np.abs(forces[1])))


def _with_muscles(joint: Joint, muscles: Mapping[str, Muscle]) -> Iterator[Reading]:
    """Return the readings with another muscle, of its own length or of the nominal one."""
    for name, muscle in muscles.items():
        for l0 in dict.fromkeys((muscle.l0, joint.muscles[0].l0)):
            other = replace(muscle, l0=l0)
            if _are_alike(other, joint.muscles[0]):
                continue
            actuators = tuple(replace(one, muscle=other) for one in joint.actuators)
            with suppress(ParameterError):  # this joint cannot have the muscle
                other_joint = replace(joint, actuators=actuators)
                yield Reading(f'the muscle is {name} with l0 = {l0:g} m', joint=other_joint)
