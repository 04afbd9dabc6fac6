# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From numbers to a sentence: which of five verdicts, what stays open, what to record next."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pam_ros.effects.base import Effect
from pam_ros.identification import evidence
from pam_ros.identification.admission import Tried, explains_as_much
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.result import Trace
from pam_ros.identification.selection import Search

SMALLEST = 1e-12  # p value that is worth telling apart from smaller ones
SHORTEST = 5.0  # s of recording
VISIBLE = 10.0  # noise floors that the target must move
CEILING = 0.12  # R^2 of the generic regressor from which a residual is structured
ABOVE = 0.4  # share of the residual's variance above the noise floor that then matters
FAR_ABOVE = 2.5  # noise floors from which a residual is no noise, predictable or not
UNEXPLAINED = 0.4  # share of what re-tuning left that found effects may leave unexplained
CLOSE = 1.05  # ratio of errors that are the same for a user


def too_little(segments: Sequence[Segment], noise: Noise) -> str:
    """Return the sentence why the data cannot carry a verdict, empty when they can."""
    duration = sum(float(s.t[-1] - s.t[0]) for s in segments)
    if duration < SHORTEST:
        return f'the recordings last {duration:.1f} s; at least {SHORTEST:g} s are needed'
    moved = max(float(np.ptp(s.target)) for s in segments)
    if moved < VISIBLE * noise.sigma:
        return (
            f'the {segments[0].quantity} moves by {moved:.3g}, less than {VISIBLE:g} times its '
            f'noise of {noise.sigma:.3g}: excite the rig more'
        )
    return ''


def alternatives(found: Search, winner: Tried) -> tuple[str, ...]:
    """Return the effects that explain the samples kept back as well as *winner* does.

    Those whose squared error is higher by less than one standard error of the difference, or
    by so little that it makes no difference.
    """
    rivals = []
    for tried in found.rounds:
        if winner not in tried:
            continue
        for t in tried:
            if t is winner or not t.evidence.interval_clear:
                continue
            if t.evidence.p > evidence.SIGNIFICANCE:
                continue
            if winner.evidence.absorbed != t.evidence.absorbed:
                continue
            mean, error = evidence.held_difference(winner.fit, t.fit)
            close = t.fit.held_error < CLOSE * winner.fit.held_error
            if winner.evidence.absorbed:
                close = close and t.fit.score - winner.fit.score < evidence.AMBIGUOUS
            if explains_as_much(t, winner) or (close and mean < error):
                rivals.append(t.effect.name)
    return tuple(rivals)


def likelihood(p: float) -> str:
    """Return a p value in words that does not pretend to be 0."""
    return f'p = {p:.1g}' if p > SMALLEST else f'p < {SMALLEST:g}'


def why_not(tried: Tried, winner: Tried | None) -> str:
    """Return the first reason for which a candidate was not chosen."""
    e = tried.evidence
    if not e.interval_clear:
        return 'the interval of its strength includes 0, or has the wrong sign'
    if e.p > evidence.SIGNIFICANCE:
        return f'not significant ({likelihood(e.p)} after correction)'
    if e.gain < evidence.GAIN and not e.absorbed:
        return (
            f'changes the error of the samples kept back by {-100 * e.gain:+.1f} %, '
            f'less than the {100 * evidence.GAIN:.0f} % asked for'
        )
    if winner is not None:
        return f'{winner.effect.name} explains more'
    return 'explains too little of what re-tuning left'


def judged(answer: Trace, lacking: str, library: tuple[Effect, ...]) -> Trace:
    """Return *answer* with its verdict, its sentence and the next experiment."""
    name = _verdict(answer, lacking)
    return replace(
        answer,
        verdict=name,
        sentence=_sentence(answer, name, lacking),
        next_experiment=_experiment(answer, name, library),
        effects=answer.effects if name == 'effect_found' else (),
    )


def _verdict(answer: Trace, lacking: str) -> str:
    if lacking:
        return 'insufficient_data'
    declared, retuned, augmented = (s.held_error for s in answer.stages)
    floor = answer.noise.sigma
    left = np.sqrt(max(augmented**2 - floor**2, 0.0))
    asked = np.sqrt(max(retuned**2 - floor**2, 0.0))
    structured = answer.structure.ceiling > CEILING and answer.structure.share > ABOVE
    remains = structured or augmented > FAR_ABOVE * floor
    if answer.effects and (not remains or left < UNEXPLAINED * asked):
        return 'effect_found'
    if remains:
        return 'unexplained_structure'
    if declared < CLOSE * retuned:
        return 'no_missing_effect'
    return 'parameters_wrong'


def _sentence(answer: Trace, name: str, lacking: str) -> str:
    if name == 'insufficient_data':
        return f'The data cannot carry a verdict: {lacking}.'
    declared, retuned, augmented = (_size(s.held_error, answer.unit) for s in answer.stages)
    floor = _size(answer.noise.sigma, answer.unit)
    if name == 'effect_found':
        names = ', '.join(
            e.name + (f' (or {" or ".join(e.alternatives)})' if e.alternatives else '')
            for e in answer.effects
        )
        return (
            f'The model lacks {names}: with it the error on unseen data falls from {retuned} '
            f're-tuned ({declared} as declared) to {augmented}; the noise floor is {floor}.'
        )
    if name == 'no_missing_effect':
        return (
            f'Nothing is missing: the declared model leaves {declared} on unseen data; the noise '
            f'floor is {floor}.'
        )
    if name == 'parameters_wrong':
        return (
            f'No physics is missing, but parameters are wrong: re-tuning lowers the error on '
            f'unseen data from {declared} to {retuned}; the noise floor is {floor}.'
        )
    return (
        f'Something is missing that no effect of the library explains: {augmented} are left on '
        f'unseen data, and {100 * answer.structure.ceiling:.0f} % of the residual can be '
        f'predicted from the input; the noise floor is {floor}.'
    )


def _size(value: float, unit: str) -> str:
    if unit == 'm':
        return f'{1e3 * value:.3g} mm'
    return f'{value:.3g} {unit}'


def _experiment(answer: Trace, name: str, library: tuple[Effect, ...]) -> str:
    known = {e.name: e for e in library}
    if name == 'insufficient_data':
        return 'Record a minute or more with pam_excite over the whole range of pressure.'
    if name == 'effect_found':
        open_ones = [e for e in answer.effects if e.alternatives]
        if open_ones:
            rivals = ', '.join((open_ones[0].name, *open_ones[0].alternatives))
            return f'To tell {rivals} apart, record: {known[open_ones[0].name].experiment}.'
        first = answer.effects[0]
        return f'To confirm {first.name}, record: {known[first.name].experiment}.'
    if name == 'unexplained_structure':
        tried = [c for c in answer.candidates if c.gain > 0.0]
        if tried:
            best = max(tried, key=lambda c: c.gain)
            return (
                f'{best.effect} comes nearest; to see what is left beside it, record: '
                f'{known[best.effect].experiment}, with force and pressure measured.'
            )
        return 'Record force and pressure beside the position, with slow and fast programmes.'
    return 'Repeat the recording on another day, or with another load, to see whether it holds.'
