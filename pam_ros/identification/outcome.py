# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The search for effects, after a check of what was stated about the recordings.

Units, signs, loads and clocks that are not as stated would be explained by effects that the rig
does not have.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from pam_ros.identification.by_signal import find_by_signal
from pam_ros.identification.clock_offset import on_one_clock, tests_on_one_clock
from pam_ros.identification.data.by_signal import have_pressures
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.search.different_loads import different_loads
from pam_ros.identification.search.doubt import Doubt
from pam_ros.identification.search.late import Late, find_late_effects
from pam_ros.identification.search.onset import OnsetEstimate, estimate_onset
from pam_ros.identification.search.readings import likely_mistake
from pam_ros.identification.search.search import Search, find_effects, without_effects
from pam_ros.identification.search.setting import Setting
from pam_ros.identification.verdict import NextExperiment, too_little
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint

SettingOf = Callable[[Joint, Sequence[Recording]], Setting]


@dataclass(frozen=True, eq=False)
class Given:
    """Recordings that are fitted, those that test, and the shares of the parts of the former."""

    recordings: tuple[Recording, ...]
    test: tuple[Recording, ...]
    shares: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Outcome:
    """A search, and the time since which its effects act or its re-tuned model fails.

    ``given`` are the recordings with inputs and outputs on one clock, and ``clocks`` has a
    sentence on each correction. ``lacking`` is the reason why the data cannot support a verdict,
    '' if they can; ``doubt`` is this reason if it is about what was stated, else None. ``path`` is
    the search in measured pressures, None without one, and ``note`` a sentence on why they are not
    used, '' if they are.
    """

    search: Search
    since: OnsetEstimate | None
    given: Given
    lacking: str = ''
    doubt: Doubt | None = None
    clocks: tuple[str, ...] = ()
    path: Search | None = None
    note: str = ''

    @property
    def is_complete(self) -> bool:
        """Whether the search and the checks after it have ended by themselves."""
        return not self.search.setting.work.is_stopped

    @property
    def remedy(self) -> NextExperiment | None:
        """What would help instead of another recording, None if nothing else would."""
        if self.doubt:
            return NextExperiment(self.doubt.remedy)
        if not self.is_complete:
            return NextExperiment(
                'Identify again without stopping the search, before you record anything else.'
            )
        return None

    def doubting(self, doubt: Doubt) -> 'Outcome':
        """Return this outcome without effects, since there is a *doubt*."""
        search = replace(self.search, best=self.search.retuned)
        return replace(self, search=search, since=None, lacking=doubt.reason, doubt=doubt)


def search_recordings(
    setting: Setting,
    given: Given,
    setting_of: SettingOf,
    muscles: Mapping[str, Muscle],
) -> Outcome:
    """Search for effects in what is *given*, unless it contradicts what was stated about it.

    *setting* is that of the recordings, and setting_of(joint, recordings) returns one of others.
    *muscles* are those with which the nominal one may have been confused.
    """
    lacking = too_little([part.segment for part in setting.parts], setting.noise, CRITERIA)
    if lacking:
        search = _search(setting, None, given)
        return Outcome(search, None, given, lacking)
    doubt = likely_mistake(setting, muscles)
    if doubt:
        return Outcome(without_effects(setting), None, given).doubting(doubt)

    def again(recordings: Sequence[Recording]) -> Outcome:
        corrected = replace(given, recordings=tuple(recordings))
        own = setting_of(setting.joint, recordings)
        with setting.work.part('with corrected clocks'):
            return _searched(own, corrected)

    first = _searched(setting, given)

    def checked() -> Outcome:
        # Before the clocks, since another load can seem to be another clock, and takes longer.
        doubt = different_loads(first.search, given.recordings)
        if doubt:
            return first.doubting(doubt)
        outcome, recordings, sentences = on_one_clock(first, given.recordings, given.shares, again)
        test, others = tests_on_one_clock(outcome.search, given.test)
        own = replace(given, recordings=tuple(recordings), test=tuple(test))
        return replace(outcome, given=own, clocks=(*sentences, *others))

    return setting.work.attempt(checked) or first


def _searched(setting: Setting, given: Given) -> Outcome:
    since = estimate_onset(setting)
    if since is None and have_pressures(given.recordings):
        found = find_by_signal(setting, given.recordings, given.shares)
        return Outcome(found.search, None, given, path=found.path, note=found.note)
    return Outcome(_search(setting, since, given), since, given)


def _search(setting: Setting, since: OnsetEstimate | None, given: Given) -> Search:
    """Search for effects; for those that begin *since* then, in the parts after that time."""
    if since is None:
        return find_effects(setting)
    (recording,) = given.recordings
    late = Late(setting, since, recording, given.shares, CRITERIA.duration)
    return find_late_effects(late)
