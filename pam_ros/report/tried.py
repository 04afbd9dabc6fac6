# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The effects that a search tried, round by round, with those that nearly replaced another."""

from dataclasses import dataclass

from pam_ros.identification.fit.places import effect_of
from pam_ros.identification.identification import Identification
from pam_ros.identification.result import Candidate
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.wording import listed, name_in_words, number

Names = frozenset[str]

OPEN = ('chosen', 'ambiguous', 'near', 'later')  # kinds of rows that are not folded


@dataclass(frozen=True)
class Rival:
    """An effect that lowers the score about as much as another one, which the last model has.

    ``more`` is by how much more it lowers the score than ``chosen``. ``is_last`` is whether
    this compares the last model with the same model that has the rival instead of ``chosen``;
    otherwise both were added to the same model in a round of the search.
    """

    name: str
    chosen: str
    more: float
    is_last: bool

    @property
    def decision(self) -> str:
        """The word for the table: whether the score distinguishes the two."""
        return 'near tie' if self.more <= CRITERIA.margin else 'lower score'

    def compared(self) -> str:
        """Return the comparison of both scores, as a part of a sentence."""
        name, chosen = name_in_words(self.name), name_in_words(self.chosen)
        is_tie = abs(self.more) <= CRITERIA.margin
        size = number(abs(self.more), 2)
        if self.is_last:
            how = 'about the same' if is_tie else f'lower by {size}'
            return f'with {name} instead of {chosen} the score of the last model is {how}'
        how = 'about as much as' if is_tie else f'by {size} more than'
        return f'in one round {name} lowers the score {how} {chosen}'


def rounds_of(result: Identification) -> dict[tuple[str, ...], list[Candidate]]:
    """Return for each round of the search the effects of its base model, and the candidates."""
    found: dict[tuple[str, ...], list[Candidate]] = {}
    for candidate in result.candidates:
        found.setdefault(candidate.parents, []).append(candidate)
    return found


def rival_of(candidate: Candidate, result: Identification) -> Rival | None:
    """Return *candidate* as a rival of an effect of the last model, None if it is not one.

    It was rejected although the score is at most by the margin higher with it, or even lower.
    """
    last = frozenset(result.added)
    if candidate.decision != 'rejected' or candidate.effect in last:
        return None
    if candidate.score_fall < CRITERIA.margin:
        return None
    falls = _falls(result)
    own = frozenset({*candidate.parents, candidate.effect})
    missing = last - own
    if len(own) == len(last) and len(missing) == 1 and {own, last} <= falls.keys():
        more = falls[own] - falls[last]
        if more >= -CRITERIA.margin:
            (chosen,) = missing
            return Rival(candidate.effect, chosen, more, is_last=True)
    for other in rounds_of(result)[candidate.parents]:
        more = candidate.score_fall - other.score_fall
        if other.decision == 'chosen' and more >= -CRITERIA.margin:
            return Rival(candidate.effect, other.effect, more, is_last=False)
    return None


def rivals_of(name: str, result: Identification) -> list[tuple[Candidate, Rival]]:
    """Return the rejected effects that are nearly as good as *name*, best compared ones first.

    Each is named once, if possible as compared in the last model.
    """
    found = [(one, rival_of(one, result)) for one in result.candidates]
    named = [(one, rival) for one, rival in found if rival is not None and rival.chosen == name]
    named.sort(key=lambda pair: not pair[1].is_last)
    first: dict[str, tuple[Candidate, Rival]] = {}
    for one, rival in named:
        first.setdefault(rival.name, (one, rival))
    return list(first.values())


def why_not(candidate: Candidate, rival: Rival, result: Identification) -> str:
    """Return what speaks for the chosen effect instead of its *rival*, '' if only the search does.

    The chosen effect explains nearly as much, by the score or by the error of samples that were
    not fitted, and the rival contains it or has more parameters; or its error is smaller.
    """
    rows = [one for one in result.candidates if one.decision == 'chosen']
    other = next((one for one in rows if one.effect == rival.chosen), None)
    own = frozenset(result.added) if rival.is_last else {*candidate.parents, rival.chosen}
    model = next((one for one in rows if {*one.parents, one.effect} == own), None)
    if other is None or model is None:
        return ''
    error, room = candidate.choose_error, 1.0 + CRITERIA.gain
    if rival.more > CRITERIA.margin and model.choose_error > room * error:
        return ''
    name, chosen = name_in_words(rival.name), name_in_words(rival.chosen)
    library = {effect.name: effect for effect in result.stages[0].model.library}
    if effect_of(rival.chosen) in library[effect_of(rival.name)].contains:
        return f'{name} contains {chosen}, which is simpler and explains nearly as much'
    more, fewer = (
        sum(p.low != p.high for p in one.parameters.values()) for one in (candidate, other)
    )
    if fewer < more:
        return f'{chosen} has fewer parameters ({fewer} instead of {more})'
    if model.choose_error < error:
        return f'with {chosen} the error of samples that were not fitted is smaller'
    return ''


def kind_of(candidate: Candidate, result: Identification) -> str:
    """Return the kind of the row of *candidate*: its decision, ``near`` or ``later``.

    ``near`` is a rival of an effect of the last model, and ``later`` an effect of the last model
    that was not chosen in this round.
    """
    if candidate.decision == 'rejected':
        if candidate.effect in result.added:
            return 'later'
        if rival_of(candidate, result) is not None:
            return 'near'
    return candidate.decision


def decision_of(candidate: Candidate, result: Identification) -> tuple[str, str]:
    """Return the decision on *candidate* for readers, and the reason."""
    kind = kind_of(candidate, result)
    if kind == 'later':
        return 'not in this round', _later(candidate, result)
    rival = rival_of(candidate, result) if kind == 'near' else None
    if rival is None:
        return candidate.decision, candidate.reason
    why = why_not(candidate, rival, result)
    parts = [rival.compared(), why or candidate.reason]
    return rival.decision, '; '.join(parts)


def _later(candidate: Candidate, result: Identification) -> str:
    """Return in which round an effect of the last model was chosen, and why not in this one."""
    rows = [one for one in result.candidates if one.effect == candidate.effect]
    chosen = next((one for one in rows if one.decision == 'chosen'), None)
    where = 'in the last model'
    if chosen is not None:
        before = listed([name_in_words(name) for name in chosen.parents]) or 're-tuning'
        where = f'chosen in addition to {before}'
    others = rounds_of(result)[candidate.parents]
    is_first = candidate is max(others, key=lambda one: one.score_fall)
    return where if is_first else f'{where}; here, {candidate.reason}'


def _falls(result: Identification) -> dict[Names, float]:
    """Return by how much each set of effects that was tried lowers the score after re-tuning."""
    found: dict[Names, float] = {frozenset(): 0.0}
    for one in sorted(result.candidates, key=lambda one: len(one.parents)):
        before = found.get(frozenset(one.parents))
        if before is not None:
            own = frozenset({*one.parents, one.effect})
            found[own] = max(found.get(own, float('-inf')), before + one.score_fall)
    return found
