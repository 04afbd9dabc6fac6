# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How much a search will simulate: from the size of its problem, and from its rounds so far.

The numbers were counted in identifications of 15 recordings or sets of them: simulated ones with
none, one, two or three missing effects, of one muscle and of a joint of two, with a free load, at
prescribed lengths and with measured pressures, and those of a real electric drive and a muscle.
"""

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pam_ros.identification.fit.solve import levenberg_marquardt
from pam_ros.identification.search.setting import Model, Setting
from pam_ros.identification.work import Forecast
from pam_ros.identification.workers import thread_count

# Simulations for each starting value of all effects that can be tried, which number 64 for one
# muscle and 168 for two. In a first round with an accepted effect they were 32 to 65, and in all
# rounds of a search that found two effects 140 to 470, of which the last ones take up to twice as
# long. In a round without an accepted effect they were 11 to 14, which take as long as 22 others.
# With 500 instead of 800, 2 of 14 first forecasts were too short, by factors of 1.5 and 2.4.
LEAST, MOST = 22.0, 800.0
# The same from the second, third and a later round on, relative to the round before: 1 to 8 times,
# 0.7 to 3.8 times, and 0.6 times as many, before they take longer.
LATER = ((1.0, 12.0), (0.7, 5.0), (0.5, 3.0))
CONFIRMING = 1.3  # most simulations of the last step, relative to the last round
# Simulations of a first round in the time of one fit from a start: 45 in the time of 3.5 to 8.4.
PER_FIT = 7.5
PARALLEL = 1.2  # fits that two threads or more complete while one would complete one
TIMED = 2  # fits, of which the faster counts


def begin_search(model: Model, setting: Setting) -> None:
    """Time the fit with which an effect is tried first, and state how fast a search will be.

    *model* is the re-tuned one. The kernel is that with all effects, as in the search, and is
    compiled here if it has not been compiled yet.
    """
    known = model.solution
    problem = replace(known.problem, active=setting.joint.library)
    nominal = np.clip(np.zeros(known.u.size), *problem.bounds)
    start = replace(
        known, problem=problem, u=nominal, r=problem.residuals(nominal), is_fresh=False
    )

    def seconds() -> float:
        began = time.perf_counter()
        levenberg_marquardt(start, setting.budget.screening, renew=False).most_likely()
        return time.perf_counter() - began

    fastest = min(seconds() for _ in range(TIMED))
    parallel = min(float(thread_count()), PARALLEL)
    setting.work.begin_search(parallel * PER_FIT * problem.steps / fastest)


def of_search(setting: Setting) -> Forecast:
    """Return the forecast of a whole search."""
    starts = sum(len(place.fit_starts) for place in setting.places.values())
    one = setting.problem.steps * starts
    return Forecast(LEAST * one, MOST * one)


def of_rounds(setting: Setting, rounds: Sequence[float]) -> Forecast:
    """Return the forecast of the next round of a search and what follows in it.

    *rounds* are the numbers of time steps that its rounds so far have simulated.
    """
    if not rounds:
        return of_search(setting)
    least, most = LATER[min(len(rounds), len(LATER)) - 1]
    return Forecast(least * rounds[-1], most * rounds[-1])


def of_confirming(rounds: Sequence[float]) -> Forecast:
    """Return the forecast of the last step of a search with these *rounds*."""
    return Forecast(0.0, CONFIRMING * max(rounds[-1:], default=0.0))
