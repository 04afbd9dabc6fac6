# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The verdict, which is one of five, its sentence, and what to record next."""

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np

from pam_ros.excitation.command import command_line
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.fit.places import effect_of, spelled
from pam_ros.identification.result import Conclusion, Estimate, Verdict
from pam_ros.identification.search.criteria import Criteria
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Setting
from pam_ros.recording.quantities import ATMOSPHERE
from pam_ros.recording.recording import Recording
from pam_ros.rig.arrangements import LOAD, arrangement_of
from pam_ros.rig.joint import Joint

FILE = 'FILE'  # in a command: the parameter file of the joint, without which it is one muscle
REMAINDER = 3.0  # noise floors; a larger error is more than the inexact form of the right effects
INCOMPLETE = 'Incomplete: the search was stopped before it ended, and the answer may change.'
WEATHER = 6e3  # Pa; change of the air pressure by weather and up to 500 m of altitude


class NextExperiment(NamedTuple):
    """What to record next, and the command that plays it, '' if there is none."""

    text: str
    command: str = ''


def too_little(segments: Sequence[Segment], noise: float, criteria: Criteria) -> str:
    """Return the reason why the data cannot support a verdict, '' if they can.

    *noise* is its standard deviation in m, rad or N.
    """
    duration = sum(float(s.t[-1] - s.t[0]) for s in segments)
    if duration < criteria.duration:
        return f'the recordings last {duration:.1f} s; at least {criteria.duration:g} s are needed'
    moved = max(float(np.ptp(s.target)) for s in segments)
    if moved < criteria.range * noise:
        s = segments[0]
        return (
            f'the {s.quantity} changes by {_size(moved, s.unit)}, less than {criteria.range:g} '
            f'times its noise of {_size(noise, s.unit)}: excite the rig more'
        )
    return ''


def explains(search: Search) -> bool:
    """Return whether the best model of a search explains enough of the error after re-tuning.

    The errors are compared on *fit*, and on *fit* and *choose* by the geometric mean: a load that
    sticks stops at another position if its friction differs slightly from the fitted one, so that
    a correct model with hardly any error on *fit* may have a larger one on *choose*. Without
    effects, return whether the error above the noise after re-tuning is at most the noise, on
    *fit* or on *choose*.
    """
    setting, errors, before = search.setting, search.best.errors, search.retuned.errors
    if not search.best.effects:
        return min(setting.above(errors.fit), setting.above(errors.choose)) <= setting.noise
    fit = _left(setting, before.fit, errors.fit)
    choose = _left(setting, before.choose, errors.choose)
    return max(fit, sqrt(fit * choose)) <= setting.criteria.left


def _left(setting: Setting, before: float, now: float) -> float:
    """Return the share of an error above the noise that is left: it was *before*, and is *now*.

    An error up to the noise cannot be detected, and counts as small enough.
    """
    least = setting.noise / setting.criteria.left
    return setting.above(now) / max(setting.above(before), least)


def is_refuted(search: Search, retuned: float, augmented: float) -> bool:
    """Return whether the judging data contradict the effects of a search: they explain too little.

    *retuned* and *augmented* are the errors over these data, in m, rad or N, without and with the
    effects. False if there are no such data. Where *choose* does not show how a free run
    continues, the judging data must show it, with the limit that *choose* has elsewhere.
    """
    setting = search.setting
    most = setting.criteria.left if setting.choices_interpolate else 1.0 - setting.criteria.left
    return bool(search.best.effects) and _left(setting, retuned, augmented) > most


def verdict(search: Search, nominal: float, retuned: float, augmented: float) -> Verdict:
    """Return the verdict on data that are sufficient for one.

    *nominal*, *retuned* and *augmented* are the errors of these models over the judging data, in
    m, rad or N.
    """
    if search.best.effects:
        is_right = explains(search) and not is_refuted(search, retuned, augmented)
        return Verdict.EFFECT_FOUND if is_right else Verdict.UNEXPLAINED_STRUCTURE
    # Nothing is missing only if data that no fit has used are explained as well as the rest.
    level = max(search.setting.noise, search.best.errors.fit, search.best.errors.choose)
    if not explains(search) or retuned**2 - level**2 > level**2:
        return Verdict.UNEXPLAINED_STRUCTURE
    is_same = nominal <= search.setting.criteria.worse * retuned
    return Verdict.NO_MISSING_EFFECT if is_same else Verdict.PARAMETERS_WRONG


def sentence(answer: Conclusion, lacking: str, explaining: Sequence[str] = ()) -> str:
    """Return the verdict of *answer* with its numbers, as one paragraph of plain sentences.

    *lacking* is what :func:`too_little` returned, *explaining* are the effects with which the
    model explains a recording up to a moment; none for the re-tuned model. If the search was
    stopped, the first sentence says so.
    """
    text = _sentence(answer, lacking, explaining)
    return text if answer.is_complete else f'{INCOMPLETE} {text}'


def _sentence(answer: Conclusion, lacking: str, explaining: Sequence[str]) -> str:
    if answer.verdict == Verdict.INSUFFICIENT_DATA:
        return f'The data cannot support a verdict: {lacking}.'
    nominal, retuned, augmented = (_size(s.held_error, answer.unit) for s in answer.stages)
    floor = f'The noise floor is {_size(answer.noise.sigma, answer.unit)}.'
    if answer.verdict == Verdict.EFFECT_FOUND:
        named = ', '.join(
            spelled(e.name)
            + (f' (or {" or ".join(map(spelled, e.alternatives))})' if e.alternatives else '')
            for e in answer.effects
        )
        these = 'this effect' if len(answer.effects) == 1 else 'these effects'
        since = '' if answer.since is None else f' from {onset_text(answer)} on'
        if answer.development is not None:
            since += f', developing within {answer.development:.2g} s'
        lacks = f'The model lacks {named}{since}{_remainder(answer)}'
        doubtful = [spelled(e.name) for e in answer.effects if e.or_constants]
        if doubtful:
            return (
                f'{lacks}: the error on held-out data is {augmented} with {these}, '
                f'{retuned} re-tuned and {nominal} nominal. Instead of '
                f'{" and ".join(doubtful)}, constants far from the nominal ones explain the data '
                f'as well. {floor}'
            )
        # No constant of the model acts on a pressure.
        before = (
            nominal if answer.quantity == 'pressure' else f'{retuned} re-tuned ({nominal} nominal)'
        )
        return (
            f'{lacks}: with {these} the error on held-out data falls from {before} to '
            f'{augmented}. {floor}'
        )
    if answer.verdict == Verdict.NO_MISSING_EFFECT:
        return f'Nothing is missing: the error on held-out data is {nominal}. {floor}'
    if answer.verdict == Verdict.PARAMETERS_WRONG:
        return (
            'No effect is missing, but parameters are wrong: re-tuning lowers the error on '
            f'held-out data from {nominal} to {retuned}. {floor}'
        )
    since = ''
    if answer.since is not None:
        model = f'model with {" and ".join(map(spelled, explaining))}'
        since = (
            f' The {model if explaining else "re-tuned model"} explains the recording up to '
            f'{onset_text(answer)}, but not after this time: something begins there, or the '
            'motion begins to show it.'
        )
    added = f' with {" and ".join(map(spelled, answer.added))}' if answer.added else ''
    before = f' ({retuned} re-tuned)' if added else ''
    tried = 'no effect of the library' if answer.is_complete else 'none of the effects so far'
    return (
        f'Something is missing that {tried} explains: the error on held-out data is '
        f'{augmented}{added}{before}, and {100 * answer.structure.ceiling:.0f} % of the '
        f'variance of the residual can be predicted from {answer.regressors}.'
        f'{since} {floor}'
    )


def _remainder(answer: Conclusion) -> str:
    """Return a clause on the error that the effects of *answer* leave, '' if it is small."""
    left, noise = answer.stages[2].held_error, answer.noise.sigma
    if not 0.0 < REMAINDER * noise < left:
        return ''
    return f', and something remains that no effect explains ({left / noise:.2g} noise floors)'


def of_unused(recordings: Sequence[Recording], names: Sequence[str]) -> list[str]:
    """Return the warning on measured signals that have no influence on the result.

    *names* are the signals that may have none: ``pressure`` and ``force``.
    """
    unused = [
        name
        for name in names
        for one in recordings
        if one.kind == 'free' and one.command is not None and getattr(one, name) is not None
    ]
    if not unused:
        return []
    what = ' and '.join(f'the measured {name}' for name in dict.fromkeys(unused))
    return [
        f'{what} of a load that moves freely is not used: the commands are the input, and the '
        'position is what is compared'
    ]


def of_problem(problem: str) -> list[str]:
    """Return the warning on identified parameters that describe no joint, with the reason."""
    if not problem:
        return []
    return [
        'the identified parameters describe no joint that can be simulated, so that there is no '
        f'identified.yaml: {problem}; are the signs and units of all signals right?'
    ]


def of_absolute_pressures(
    parameters: Mapping[str, Estimate], signal: str, quantity: str
) -> list[str]:
    """Return a warning for each pressure offset that is minus the pressure of the air.

    *signal* is the pressure that drives the recordings: ``pressure_command`` or ``pressure``. If
    their *quantity* is a pressure, that of the air is added to it, and not missing.
    """
    offset, what, which = -ATMOSPHERE, 'minus the pressure', 'pressures of the recording'
    if quantity == 'pressure':
        offset, what, which, signal = ATMOSPHERE, 'the pressure', 'measured pressures', 'pressure'
    return [
        f'{name} = {one.value:.6g} Pa is {what} of the air: are the {which} absolute? Gauge '
        f"pressures are expected: --column 'NAME={signal}_Pa-101325'"
        for name, one in parameters.items()
        if name.endswith('effects.pressure_offset.offset') and abs(one.value - offset) < WEATHER
    ]


def next_experiment(answer: Conclusion, model: Joint) -> NextExperiment:
    """Return which recording of the rig of *model* would resolve what *answer* leaves open."""
    known = {e.name: e for e in model.library}
    kind = arrangement_of(model)
    can_excite = kind is not None and not model.is_driven
    file = '' if kind is LOAD else FILE
    if answer.verdict == Verdict.INSUFFICIENT_DATA:
        return NextExperiment(
            'Record a minute or more over the whole range of pressure.',
            command_line({}, file) if can_excite else '',
        )
    doubtful = next((e for e in answer.effects if e.or_constants), None)
    if answer.verdict == Verdict.EFFECT_FOUND and doubtful is not None:
        chosen = known[effect_of(doubtful.name)]
        text = (
            f'To distinguish between {spelled(doubtful.name)} and other constants, record: '
            f'{chosen.experiment}. If the constants are known with less accuracy than usual, '
            'state it: --uncertain a2=10%, and so on for a1 to a6.'
        )
    elif answer.verdict == Verdict.EFFECT_FOUND:
        first = next((e for e in answer.effects if e.alternatives), answer.effects[0])
        chosen, what = known[effect_of(first.name)], 'To confirm ' + spelled(first.name)
        if first.alternatives:
            rivals = ', '.join(map(spelled, (first.name, *first.alternatives)))
            what = f'To distinguish between {rivals}'
        text = f'{what}, record: {chosen.experiment}.'
    elif answer.verdict == Verdict.UNEXPLAINED_STRUCTURE:
        tried = [
            c
            for c in answer.candidates
            if c.effect in answer.tested and c.gain > 0.0 and c.score_fall > 0.0
        ]
        if not tried:
            return NextExperiment(
                'Record slow and fast motion over the whole range of pressure, in both directions.'
            )
        best = max(tried, key=lambda c: c.gain).effect
        chosen = known[effect_of(best)]
        text = (
            f'{spelled(best)} lowers the error most, but not enough; to see what remains with '
            f'it, record: {chosen.experiment}.'
        )
    else:
        return NextExperiment(
            'Repeat the recording on another day, or with another load, to confirm the verdict.'
        )
    if not can_excite:
        return NextExperiment(text)
    if chosen.excitation is None:
        return NextExperiment(f'{text} pam_excite has no segment for it.')
    return NextExperiment(text, command_line(chosen.excitation, file))


def time_of(since: Estimate) -> str:
    """Return a time with its 95 % interval, rounded according to its width."""
    width = since.high - since.low
    places = int(np.clip(np.ceil(1.0 - np.log10(max(width, 1e-9))), 0, 3))
    value, low, high = (f'{x:.{places}f}' for x in (since.value, since.low, since.high))
    return f'{value} s ({low} to {high} s)'


def onset_text(answer: Conclusion) -> str:
    """Return the moment of *answer*, with its reference if the file has another time axis."""
    assert answer.since is not None
    is_shifted = any(recording.origin for recording in answer.recordings)
    return time_of(answer.since) + (' after the first sample' if is_shifted else '')


def _size(value: float, unit: str) -> str:
    if unit in ('m', 'rad') and value < 1.0:
        return f'{1e3 * value:.3g} m{unit}'
    if unit == 'Pa' and value >= 1e3:
        return f'{1e-3 * value:.3g} kPa'
    return f'{value:.3g} {unit}'
