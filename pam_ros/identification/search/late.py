# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The search for effects that begin during a recording, at once or over some seconds.

While an effect develops, the search for effects that jump fits whatever comes closest to this
transition, and may name another effect. Therefore, if it leaves more than noise, the search is
repeated without the samples of the first seconds. The effects that it finds have their full
strength in all other samples. If no jump of them explains the samples that were left out, they
have developed.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from pam_ros.identification.data.parts import parts_in_time, run_of
from pam_ros.identification.fit.extend import memories
from pam_ros.identification.fit.onset import EARLIER, index_of_onset
from pam_ros.identification.fit.solve import converge, initial_solution
from pam_ros.identification.fit.unknowns import onset_unknown
from pam_ros.identification.search.forecast import of_search
from pam_ros.identification.search.onset import OnsetEstimate, shares_after
from pam_ros.identification.search.search import Search, find_effects
from pam_ros.identification.search.setting import Model, Setting, rms, transfer
from pam_ros.identification.search.starts import without_idle
from pam_ros.identification.work import Forecast
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
# Times in s that are left out after the moment, each if the one before is too short; the short
# ones are used if less than 5 s could be fitted after the first one.
LONG, SHORT = (8.0, 16.0), (4.0, 2.0)
APART = 0.05  # s, between the onsets at which a jump is tried
FINEST = 1e-4  # s, accuracy of the best of them


@dataclass(frozen=True, eq=False)
class Late:
    """A recording in which something begins *since* a time, and how it is divided.

    ``setting`` is that of the search for effects that act from the start. ``shares`` are those of
    the parts of a whole recording, and ``least`` is the time in s that must be fitted.
    """

    setting: Setting
    since: OnsetEstimate
    recording: Recording
    shares: tuple[float, float]
    least: float

    def setting_after(self, transition: float) -> Setting | None:
        """Return the setting in which effects begin, and develop in *transition* s; 0: they jump.

        None if too little comes after this time.
        """
        end = self.since.time + transition
        whole = self.setting.parts
        shares = shares_after(replace(self.since, time=end), whole, self.shares, self.least)
        if shares is None:
            return None
        parts = parts_in_time(self.recording, *shares)
        late = replace(self.setting, parts=parts, onset=self.since.time)
        if not transition:
            return late
        start = min(self.since.low, self.since.time)
        # Runs are simulated through this time, but not compared.
        without = [replace(one, division=one.division.without(start, end)) for one in parts]
        return replace(late, parts=without, transition=(start, end))


def find_late_effects(late: Late) -> Search:
    """Find the effects that begin late, at once or over some seconds, or act from the start.

    A model that lacks an effect from the start can also fail only in the middle, for example if
    the load reaches an end stop there for the first time. If the effects explain as much when they
    act from the start, none of them begins later. The best model has no effects if something
    begins, but those that come closest may be wrong.
    """
    jump = late.setting_after(0.0)
    if jump is None:
        return find_effects(late.setting)
    # Then the effects may develop, or act from the start.
    with late.setting.work.part('', Forecast(0.0, 0.5 * of_search(jump).high)):
        found = find_effects(jump)
    other = None if leaves_only_noise(found) else _developing(late, found)
    if other is not None:
        return other
    return found if begins_late(found) else find_effects(late.setting)


def _developing(late: Late, jump: Search) -> Search | None:
    """Return the search of effects that develop, None if those of *jump* or none do not.

    The best model has no effects if it is not known which ones develop.
    """
    long, short = ([*filter(None, map(late.setting_after, times))] for times in (LONG, SHORT))
    best, is_same = jump, False
    work = late.setting.work
    for setting in long or short[:1]:
        # It is not known whether the effects of a search that was stopped are better.
        after = None if work.is_stopped else find_effects(setting)
        if after is None or work.is_stopped:
            break
        is_same = {*after.best.effects} == {*jump.best.effects}
        if not (begins_late(after) and is_no_worse_on_the_same(after, best)):
            break
        if explains_transition(after, best):
            return None if best is jump else best
        best = after
        if leaves_only_noise(best):
            return best
    if best is not jump and long:
        return best
    if not begins_late(jump):
        return None
    if short and not long and not is_same:
        # After a short transition they may develop further, and no jump was confirmed.
        return without_names(best)
    return None if explains_beginning(jump) else without_names(jump)


def without_names(search: Search) -> Search:
    """Return *search* with the re-tuned model as its best one."""
    return replace(search, best=search.retuned)


def explains_beginning(jump: Search) -> bool:
    """Return whether effects that jump explain the time after the moment as well as later times.

    This time is half of what is fitted after the moment, and at most LONG[0]. Its error may be
    larger than that of the other half, or the noise, by the factor 1/``left``.
    """
    setting, start = jump.setting, jump.setting.onset
    assert start is not None
    end = max(float(part.segment.t[part.fit][-1]) for part in setting.parts if part.fit.any())
    middle = start + min(LONG[0], 0.5 * (end - start))
    first, rest = error_between(jump.best, start, middle), error_between(jump.best, middle, end)
    return first <= max(setting.noise, rest) / setting.criteria.left


def leaves_only_noise(search: Search) -> bool:
    """Return whether the best model of a search leaves only noise in what was fitted."""
    setting = search.setting
    return search.best.errors.fit <= setting.criteria.complete * setting.noise


def begins_late(search: Search) -> bool:
    """Return whether the effects of a search explain more if they begin late.

    The cost of the unknowns is not compared: the derivative by an onset between two commands may
    be 0, and then its cost is not known.
    """
    best, setting = search.best, search.setting
    if not best.effects:
        return False
    gain = _from_start(best, setting).solution.cost - best.solution.cost
    return gain > setting.criteria.margin


def is_no_worse_on_the_same(after: Search, before: Search) -> bool:
    """Return whether the free run is no worse than before, on the samples of the later search."""
    setting = after.setting
    a, b = setting.errors(before.best.nearest), after.best.errors
    return b.free_run * b.fit <= setting.criteria.worse * a.free_run * a.fit


def explains_transition(after: Search, before: Search) -> bool:
    """Return whether effects that were found without a transition explain it as well.

    If *before* is a search for effects that jump, they may jump at any time. If it has left out a
    shorter transition, they have their full strength since then, and the rest must be explained.
    The error may be larger than that of the fit, or the noise, by the factor 1/``left``.
    """
    setting = after.setting
    assert setting.transition is not None
    assert setting.onset is not None
    start, end = setting.transition
    most = max(setting.noise, after.best.errors.fit) / setting.criteria.left
    if before.setting.transition is not None:
        return error_between(after.best, before.setting.transition[1], end) <= most

    def error(onset: float) -> float:
        return error_between(after.best, start, end, onset)

    onsets = np.arange(setting.onset - EARLIER, end, APART)
    errors = [error(float(onset)) for onset in onsets]
    near = float(onsets[int(np.argmin(errors))])
    best = minimize_scalar(
        error, bounds=(near - APART, near + APART), method='bounded', options={'xatol': FINEST}
    )
    return min(float(best.fun), *errors) <= most


def error_between(model: Model, start: float, end: float, onset: float | None = None) -> float:
    """Return the RMSE of *model* from *start* to *end* s, with its own or another *onset* in s.

    Its unit is m or rad, and it is 0 if there are no samples.
    """
    setting, known = model.setting, model.nearest
    segments = [part.segment for part in setting.thin if part.known.any()]
    runs = [run_of(s, s.t < end) for s in segments if s.t[0] < end]
    problem, u = transfer(known, runs)
    k = index_of_onset(known)
    assert k is not None
    if onset is not None:
        moved = onset_unknown(problem.segments, onset)
        own = problem.unknowns
        problem = replace(problem, unknowns=(*own[:k], moved, *own[k + 1 :]))
        u = np.where(np.arange(u.size) == k, 0.0, u)
    pairs = zip(problem.predict(u), runs, strict=True)
    e = np.concatenate([(run - s.target)[s.t >= start] for run, s in pairs])
    return rms(e) if e.size else 0.0


def _from_start(late: Model, setting: Setting) -> Model:
    """Return the model with the same effects, acting from the start of the recording."""
    known = late.solution
    k = index_of_onset(known)
    assert k is not None
    unknowns = known.problem.unknowns
    problem = replace(known.problem, unknowns=(*unknowns[:k], *unknowns[k + 1 :]))
    memory = [one for name in late.effects for one in memories(problem, setting.places[name])]
    whole = replace(problem, unknowns=(*problem.unknowns, *memory))
    u = np.concatenate([np.delete(known.u, k), np.zeros(len(memory))])
    plain = without_idle(
        initial_solution(whole, u, known.discrepancy, setting.pool), setting.noise
    )
    return setting.model(late.effects, converge(plain, setting.budget.iterations, setting.pool))
