# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The result of an identification: the numbers of the report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.fit.places import effect_of, muscle_of, place_of
from pam_ros.identification.fit.solve import FitLog
from pam_ros.identification.structure import Structure
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


class Verdict(str, Enum):
    """What an identification concludes; each is also the text of its value."""

    heading: str  # for readers

    EFFECT_FOUND = 'effect_found', 'Effect found'
    NO_MISSING_EFFECT = 'no_missing_effect', 'Nothing missing'
    PARAMETERS_WRONG = 'parameters_wrong', 'Parameters wrong'
    UNEXPLAINED_STRUCTURE = 'unexplained_structure', 'Unexplained structure'
    INSUFFICIENT_DATA = 'insufficient_data', 'Insufficient data'

    def __new__(cls, value: str, heading: str) -> 'Verdict':
        """Create a member with its *value* and its *heading*."""
        member = str.__new__(cls, value)
        member._value_, member.heading = value, heading
        return member

    def __str__(self) -> str:
        """Return the value, as in files."""
        return str(self.value)


@dataclass(frozen=True)
class Estimate:
    """A parameter with its 95 % interval, in ``unit``; low = high = value if not fitted."""

    value: float
    low: float
    high: float
    unit: str
    at_bound: bool = False


@dataclass(frozen=True, eq=False)
class Stage:
    """One of the three models: nominal (called ``declared`` in files), re-tuned or augmented.

    Errors are RMSE in the unit of the target: over the fitted samples, and over those that were
    held out or the test recordings. ``simulated`` and ``tested`` are its free runs over
    ``segments`` and ``test`` of the identification, in their order. ``log`` is how its last fit
    ended, to all samples that may be fitted.

    ``model`` has these ``parameters``. If they describe no joint that can be simulated,
    ``problem`` is the reason, and ``model`` is one between them and the nominal ones; else ''.
    """

    name: str
    model: Joint
    problem: str
    parameters: dict[str, Estimate]
    fit_error: float
    held_error: float
    simulated: tuple[Array, ...]
    tested: tuple[Array, ...]
    log: FitLog


@dataclass(frozen=True)
class Candidate:
    """An effect that was tried in addition to ``parents``.

    ``fit_error`` and ``choose_error`` are RMSE over the samples that were fitted and over those
    that decide between models, in m, rad or N. ``score_fall`` is the decrease of the score,
    -2 ln(evidence), by the effect: 10 is very strong evidence. ``gain`` is the relative decrease
    of ``choose_error``. ``p`` is that of the likelihood-ratio test (Wilks 1938), times the number
    of effects that were added to these parents (Bonferroni). ``interval_clear`` is true if the
    95 % intervals of its strengths exclude 0. ``decision`` is chosen, ambiguous, rejected or
    untestable. Untestable means that the recordings could not have shown the effect; then p is
    NaN. ``reason`` is the reason for the decision, and for an untestable effect what to record.
    """

    effect: str
    parents: tuple[str, ...]
    fit_error: float
    choose_error: float
    score_fall: float
    gain: float
    p: float
    interval_clear: bool
    parameters: dict[str, Estimate]
    decision: str
    reason: str


@dataclass(frozen=True)
class Finding:
    """An effect that the nominal model lacks, and the effects that could replace it.

    ``or_constants`` is whether constants a1..a6 far from the nominal ones could replace it, too.
    """

    name: str
    parameters: dict[str, Estimate]
    alternatives: tuple[str, ...]
    reason: str
    or_constants: bool = False


@dataclass(frozen=True, eq=False)
class Conclusion:
    """The numbers of an identification, and its verdict; :class:`Identification` has texts, too.

    ``quantity`` is what was predicted, ``position``, ``force`` or ``pressure``, and ``unit`` its
    unit, in which errors and ``noise`` are given. ``stages`` are the nominal, re-tuned and
    augmented model, in this order. ``effects`` are the effects that the nominal model lacks,
    ``candidates`` all that were tried, and ``structure`` what remains in the residual of the last
    model.

    ``recordings`` were fitted, ``test_recordings`` were not; ``segments`` and ``test`` are their
    gapless stretches. Without test recordings a part of each recording was held out instead.
    ``since`` is the time in s, on the clock of the recording, at which the effects begin to act,
    or from which the best model fails; None if this is the case from the start. ``transition`` are
    the start and the end in s of the samples that were left out because the effects develop, and
    ``development`` is the time in s after ``since`` within which they reach their full strength;
    None if they appear at once, or are not known. ``uncertain`` are the given standard deviations
    of nominal values, by parameter. ``doubt`` is the reason why the recordings contradict what was
    stated about them, such as a unit, '' if they do not. ``uses_pressures`` is whether measured
    pressures of a load that moves have shown effects of the pressure path. ``is_complete`` is
    whether the search has ended by itself; if it was stopped, the last model is the best one that
    it had accepted.
    """

    verdict: Verdict
    quantity: str
    unit: str
    noise: Noise
    stages: tuple[Stage, Stage, Stage]
    effects: tuple[Finding, ...]
    candidates: tuple[Candidate, ...]
    structure: Structure
    segments: tuple[Segment, ...]
    test: tuple[Segment, ...]
    recordings: tuple[Recording, ...]
    test_recordings: tuple[Recording, ...]
    since: Estimate | None
    transition: tuple[float, float] | None
    development: float | None
    uncertain: Mapping[str, str]
    doubt: str
    uses_pressures: bool
    is_complete: bool

    @property
    def regressors(self) -> str:
        """The signals from which ``structure`` predicts the residual, as in a sentence."""
        if self.quantity == 'pressure':
            return 'command, pressure and time'
        return 'pressure, position, velocity and time'

    @property
    def joint(self) -> Joint:
        """The identified joint: the re-tuned one with the effects that were found.

        Raises ParameterError if the identified parameters describe no valid joint, or the
        recordings contradict what was stated about them.
        """
        self.refuse_invalid()

        def present(effects: Sequence[Effect]) -> list[Effect]:
            return [effect for effect in effects if effect.is_present]

        return self.stages[-1].model.map_effects(present)

    def refuse_invalid(self) -> None:
        """Raise ParameterError if the identified parameters describe no valid joint."""
        if self.doubt:
            raise ParameterError(f'no joint was identified: {self.doubt}')
        if problem := self.stages[-1].problem:
            raise ParameterError(
                f'the identified parameters describe no joint that can be simulated: {problem}'
            )

    @property
    def added(self) -> tuple[str, ...]:
        """The names of the places of the effects that were added to the last model.

        If an effect is alike in all muscles, each muscle still has its own initial value of the
        effect. These are not counted as further places.
        """
        found = dict.fromkeys(place_of(name) for name in self.stages[-1].parameters)
        return tuple(
            name for name in found if name and not (muscle_of(name) and effect_of(name) in found)
        )

    @property
    def untestable(self) -> tuple[str, ...]:
        """The effects that the recordings could not have shown."""
        names = [c.effect for c in self.candidates if c.decision == 'untestable']
        return tuple(dict.fromkeys(names))

    @property
    def tested(self) -> tuple[str, ...]:
        """The effects that were tried and that the recordings could show."""
        names = dict.fromkeys(c.effect for c in self.candidates)
        return tuple(name for name in names if name not in self.untestable)
