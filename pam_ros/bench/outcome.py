# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How the runs of a bench ended: an outcome for each scenario, controller and seed."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from pam_ros.cached_property import cached_property


class Status(str, Enum):
    """How a run ended; each is also the text of its value."""

    words: str  # for readers

    COMPLETED = 'completed', 'completed'
    DIED = 'died', 'died'
    SILENT = 'silent', 'never answered'
    STOPPED_ANSWERING = 'stopped_answering', 'stopped answering'
    FLOODED = 'flooded', 'sent far more commands than there were states'
    NOT_FINITE = 'not_finite', 'sent a command that is not finite'
    SEVERAL_PUBLISHERS = 'several_publishers', 'was not the only node that sent commands'
    INVALID_STATE = 'invalid_state', 'brought the rig to a state that is not valid'

    def __new__(cls, value: str, words: str) -> 'Status':
        """Create a member with its *value* and its *words*."""
        member = str.__new__(cls, value)
        member._value_, member.words = value, words
        return member

    def __str__(self) -> str:
        """Return the value, on each version of Python."""
        return str(self.value)


@dataclass(frozen=True)
class Outcome:
    """One run of a controller in a scenario with a seed.

    ``reason`` is a sentence on a run that was not completed, else ''. ``scores`` are by name, in
    SI or in the unit of the score; none is below 0, and one that is None has no meaning in the
    run. A value that is not finite is replaced by None. ``is_real_time`` is true if the run kept
    real time, since the controller does not follow simulated time. ``seconds`` is the wall time
    of the run and ``simulated`` the simulated time, both in s.
    """

    scenario: str
    controller: str
    seed: int
    status: Status
    reason: str
    scores: Mapping[str, float | None]
    is_revolute: bool
    is_real_time: bool
    seconds: float
    simulated: float = 0.0

    def __post_init__(self) -> None:
        finite = {
            name: float(value) if value is not None and math.isfinite(value) else None
            for name, value in self.scores.items()
        }
        object.__setattr__(self, 'scores', finite)

    @property
    def is_completed(self) -> bool:
        """Whether the controller controlled the rig until the end."""
        return self.status is Status.COMPLETED


@dataclass(frozen=True)
class NotRun:
    """A run that could not be performed, by no fault of the controller; *reason* is a sentence."""

    scenario: str
    controller: str
    seed: int
    reason: str


@dataclass(frozen=True)
class ScoreAbout:
    """What a score is; lower is better. ``unit`` is 'position' for m or rad, by the joint.

    ``source`` is what the definition is from, or ''. ``is_of_machine`` is true if the score
    depends on the machine and on what else runs on it.
    """

    name: str
    unit: str
    text: str
    source: str
    is_of_machine: bool

    def unit_for(self, *, revolute: bool) -> str:
        """Return the unit of the score for a revolute or a prismatic joint."""
        if self.unit == 'position':
            return 'rad' if revolute else 'm'
        return self.unit


@dataclass(frozen=True)
class ScenarioAbout:
    """What a scenario is, and the name of the score by which its controllers are compared."""

    text: str
    main_score: str


@dataclass(frozen=True)
class Provenance:
    """The origin of results: command line, date (UTC, ISO 8601), and versions of libraries.

    ``files`` has the SHA-256 of each scenario file by the name of its scenario.
    """

    command: str
    date: str
    versions: Mapping[str, str]
    files: Mapping[str, str]


@dataclass(frozen=True)
class Results:
    """All outcomes of a bench, with what they are about.

    ``about`` has the scenarios by name, ``controllers`` the names in the order in which they were
    given, ``scores`` the descriptions of the scores. A scenario, controller and seed have one
    outcome, or are in ``not_run``.
    """

    about: Mapping[str, ScenarioAbout]
    controllers: tuple[str, ...]
    scores: tuple[ScoreAbout, ...]
    outcomes: tuple[Outcome, ...]
    provenance: Provenance
    not_run: tuple[NotRun, ...] = ()

    @property
    def seeds(self) -> list[int]:
        """The seeds of all outcomes, in ascending order."""
        return sorted({outcome.seed for outcome in self.outcomes})

    def runs(self, scenario: str, controller: str) -> list[Outcome]:
        """Return the outcomes of *controller* in *scenario*, by seed."""
        return self._runs.get((scenario, controller), [])

    def lacking(self, scenario: str, controller: str) -> list[NotRun]:
        """Return the runs of *controller* in *scenario* that could not be performed."""
        return [
            one for one in self.not_run if (one.scenario, one.controller) == (scenario, controller)
        ]

    @cached_property
    def _runs(self) -> dict[tuple[str, str], list[Outcome]]:
        found: dict[tuple[str, str], list[Outcome]] = {}
        for outcome in sorted(self.outcomes, key=lambda outcome: outcome.seed):
            found.setdefault((outcome.scenario, outcome.controller), []).append(outcome)
        return found

    def score(self, name: str) -> ScoreAbout:
        """Return the description of the score *name*, which must exist."""
        return next(score for score in self.scores if score.name == name)

    def unit(self, scenario: str, score: str) -> str:
        """Return the unit of *score* in *scenario*, whose runs have one kind of joint."""
        revolute = any(
            run.is_revolute for name in self.controllers for run in self.runs(scenario, name)
        )
        return self.score(score).unit_for(revolute=revolute)
