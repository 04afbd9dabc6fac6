# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Learn from motion what the nominal model lacks, and feed it forward.

A second, fast observer estimates the whole force that the model lacks. Two hypotheses explain
this force in parallel: friction, hysteresis and a force over the position alone
(:mod:`.features`), or these and an unmodelled lag of the pressure. Both are linear regressions,
filtered in the same way as the observer; the time constants of the lag are estimated by their
sensitivities (Ljung 1999, chapter 11). The hypothesis that predicts better is used. Its weight is
the share of the missing force that it explains. Nothing is used before the load has moved for a
while.

The learned force acts as a feed-forward along the reference. It is bounded, and since only the
reference drives it, it cannot destabilise the loop. Its slope over the position is an additional
stiffness of the joint, for the feedback. A learned lag is inverted; if the lag is found to be
short, the bandwidth grows (:mod:`.growth`). A loop that oscillates ends the use of everything that
was learned; learning begins again.
"""

from collections.abc import Sequence
from math import exp

import numpy as np

from pam_ros.control.gains import Gains
from pam_ros.control.learned import Learned
from pam_ros.control.learning.cascade import Cascade
from pam_ros.control.learning.features import (
    CONSTANT,
    COUNT,
    SLOPES,
    STRIBECK,
    Features,
    FeatureTuning,
)
from pam_ros.control.learning.growth import Growth
from pam_ros.control.learning.lagged_chambers import LaggedChambers
from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.learning.regression import Regression, dot
from pam_ros.control.learning.variance import RunningVariance
from pam_ros.control.model import ControlModel, Pressures
from pam_ros.control.observer import Observer
from pam_ros.control.signals import Reference

# Columns of the filter: the features; the sensitivity of the missing force to both time constants;
# and efforts: the difference of the learned chambers from those of the law, the difference from
# chambers without a lag, the efforts that the two hypotheses give along the reference, and those
# of configured effects.
_N = COUNT
_FILL, _VENT, _FROM_LAW, _FROM_NO_LAG, _PLAIN, _LAGGED, _CONFIGURED, _COLUMNS = range(_N, _N + 8)
_LAGS = slice(_FILL, _VENT + 1)  # of a column or of a parameter
_UNKNOWNS = _VENT + 1


class Learner:
    """The learned parameters, and the feed-forward that results from them.

    weight
        0 to 1: the weight with which the learned parameters are used
    lag
        (fill, vent) in s: the lag to be inverted, if no lag is configured
    stiffness
        learned additional stiffness in N/m at the reference, with this weight
    growth
        the bandwidth that the lag allows

    For a revolute joint, read rad for m, and N m for N. All muscles of a joint are assumed to
    have the same lag.
    """

    def __init__(
        self,
        model: ControlModel,
        gains: Gains,
        tuning: LearningTuning,
        features: FeatureTuning,
        reach: tuple[float, float],
        zones: Sequence[float],
        *,
        lag_is_configured: bool,
    ) -> None:
        """Start without learned parameters; *tuning* and *features* are in the joint's units.

        *reach* is the range of positions at which the load can be held, *zones* are the configured
        dead zones of the valves in Pa.
        """
        self._model = model
        self._tuning, self._features = tuning, features
        self._zones = zones
        self._lag_is_configured = lag_is_configured
        self._observer = Observer(self._model)
        self._wanted, self._actual = Features(features, reach), Features(features, reach)
        lags = (tuning.lag_spread,) * 2, (0.0, 0.0), (tuning.lag_high,) * 2
        priors = features.spreads, features.lows, features.highs
        spread, low, high = (np.array(a + b) for a, b in zip(priors, lags, strict=True))
        self._priors = spread, low, high
        self.growth = Growth(gains, tuning)
        self._restarts = 0
        self._begin()
        self.start(0.0, [0.0] * len(self._model.muscles), 0.0)

    def _begin(self) -> None:
        """Begin without learned parameters."""
        spread, low, high = self._priors
        plain, noise = spread.copy(), self._tuning.noise
        plain[_LAGS] = 0.0
        self._plain = Regression(plain, low, high, noise)
        alike = np.eye(_UNKNOWNS)
        alike[_FILL, _VENT] = alike[_VENT, _FILL] = self._tuning.lag_alike
        self._lagged = Regression(spread, low, high, noise, alike)
        self.weight = self.stiffness = 0.0
        self.lag = (0.0, 0.0)
        first = self._tuning.first
        self._plain_error = self._lagged_error = first
        self._plain_miss = self._lagged_miss = first
        self._moved = self._restarted = 0.0
        self._prefers_lag = False
        self._dropped_lag: tuple[float, float] | None = None
        self._share = self._explained = self._understood = self._known = 0.0
        # Of the force that is neither learned nor configured, and of that with what is configured.
        self._missing, self._total = RunningVariance(first), RunningVariance(first)

    def set_gains(self, gains: Gains) -> None:
        """Continue with other gains, which bound the bandwidth."""
        self.growth.set_gains(gains)

    def start(self, position: float, pressures: Pressures, disturbance: float) -> None:
        """Start again: the load rests at *position*, the chambers are at *pressures* Pa.

        What was learned stays, except for the constant force, which is *disturbance* now: another
        load may be on the rig.
        """
        self._observer.start(position, disturbance)
        self._wanted.start(position)
        self._actual.start(position)
        self._chambers = LaggedChambers(self._zones, pressures)
        self._nominal = pressures
        for one in (self._plain, self._lagged):
            one.forget(CONSTANT, -disturbance)
        # Three equal poles, like the observer's, for the features and for the difference in force
        # between the learned chamber and the nominal one.
        columns = [0.0] * _COLUMNS
        columns[CONSTANT] = 1.0
        self._filter = Cascade(columns)
        self._input = [0.0] * _COLUMNS
        self._missing.start()
        self._total.start()
        self._waited = self._doubt = 0.0
        self.growth.start()

    def forget(self) -> None:
        """Begin again without learned parameters, from the present state.

        For a loop that oscillates: what was learned before may be the cause, and what is learned
        from an oscillation, such as a long lag, sustains it.
        """
        if self.weight == 0.0:
            return
        self._begin()
        self._restarts += 1
        self.start(self._observer.position, self._nominal, self._observer.disturbance)

    @property
    def learned(self) -> Learned:
        """The learned parameters as figures for users."""
        weights = [float(one) for one in self._weights]
        fill, vent = (self._share * float(one) for one in self._lagged.theta[_LAGS])
        return Learned(
            motion=self._moved,
            missing=float(self._missing.value) ** 0.5,
            noise=self._tuning.floor**0.5,
            explained=float(self._explained),
            weight=float(self.weight),
            friction=sum(weights[:STRIBECK]),
            breakaway=weights[STRIBECK],
            stiffness=self._slope(weights),
            lag=None if self._lag_is_configured else (fill, vent),
            dropped_lag=self._dropped_lag,
            restarts=self._restarts,
        )

    @property
    def _weights(self) -> list[float]:
        share, thetas = self._share, zip(self._lagged.theta, self._plain.theta, strict=True)
        return [share * lagged + (1.0 - share) * plain for lagged, plain in thetas]

    def _slope(self, weights: Sequence[float]) -> float:
        """Return the slope of the learned force over the position at the reference, N/m."""
        knot, share = self._wanted.place
        before, behind = weights[SLOPES][knot : knot + 2]
        return (before + share * (behind - before)) / self._features.stroke

    def feed_forward(self, dt: float, reference: Reference) -> tuple[float, float]:
        """Return the effort that the reference needs beyond the model, and its rate."""
        most = self._tuning.most
        self._wanted.follow(dt, reference.position, reference.velocity)
        values = self._wanted.values
        self._input[_PLAIN] = dot(values, self._plain.theta)
        self._input[_LAGGED] = dot(values, self._lagged.theta)
        self._share += dt / self._tuning.blend * (self._prefers_lag - self._share)
        force, rate = self._learned_force()
        understood = 0.0 if self._lag_is_configured else self._understood
        self.growth.follow(dt, max(self._lagged.theta[_LAGS]), understood, self._known)
        if abs(force) > most:
            return (most if force > 0.0 else -most), 0.0
        return force, rate

    def _learned_force(self) -> tuple[float, float]:
        """Return the learned force along the reference and its rate; sets stiffness and lag."""
        if self.weight == 0.0:  # at the beginning, for a long time
            self.lag = (0.0, 0.0)
            self.stiffness = 0.0
            return 0.0, 0.0
        weights, rates = self._weights, self._wanted.rates
        force = rate = 0.0
        for n in range(CONSTANT):
            used = self.weight * weights[n]
            force += used * self._wanted.values[n]
            rate += used * rates[n]
        self.stiffness = self.weight * self._slope(weights)
        share = self.weight * self._share
        self.lag = (share * weights[_FILL], share * weights[_VENT])
        return force, rate

    def see(
        self,
        dt: float,
        waited: float,
        position: float | None,
        reference: float,
        negligible: float,
    ) -> None:
        """Take in a measured *position*, if any; the previous one came *waited* s before.

        *negligible* is the error to the *reference* below which no faster loop is needed.
        """
        observer = self._observer
        if position is not None:
            observer.correct(position, waited, self._tuning.fast, self._tuning.fast)
        self.growth.see(dt, reference - observer.position, negligible)
        self._input[:_N] = self._actual.follow(dt, observer.position, observer.velocity)

    def go_on(
        self,
        dt: float,
        inflows: Pressures,
        nominal: Pressures,
        losses: float,
        *,
        moves: bool,
    ) -> None:
        """Advance by *dt* s with *inflows* Pa at the inlets of the chambers.

        *nominal* are the pressures in Pa of the nominal chambers. *losses* is the effort that
        configured effects take along the reference: it is not learned again. The law learns while
        the load *moves*, unless the limits of pressure cut the wanted effort.
        """
        self._filter.follow(dt, self._tuning.fast, self._input)
        self._input[_CONFIGURED] = losses
        if moves:
            self._moved += dt
            self._waited += dt
            if self._waited >= self._tuning.every - 1e-9:
                self._learn(self._waited)
                self._waited = 0.0
        self._advance(dt, inflows, nominal, losses)

    def _advance(self, dt: float, inflows: Pressures, nominal: Pressures, losses: float) -> None:
        """Advance the observer and the learned chambers, with their sensitivities to the lag."""
        observer = self._observer
        means = [0.5 * (a + b) for a, b in zip(self._nominal, nominal, strict=True)]
        self._nominal = nominal
        if self._lag_is_configured:
            observer.predict(dt, means, -losses)
            return
        places = [muscle.at(observer.position) for muscle in self._model.muscles]
        fill, vent = self._lagged.theta[_LAGS]
        found = self._chambers.follow(dt, inflows, (fill, vent), places, means)
        self._input[_FILL], self._input[_VENT] = found.by_fill, found.by_vent
        self._input[_FROM_LAW], self._input[_FROM_NO_LAG] = found.less, found.late
        observer.predict(dt, found.pressures, -losses)

    def _learn(self, span: float) -> None:
        """Update both hypotheses with the missing force, *span* s after the last update."""
        filtered = self._filter.output
        phi = filtered[:_UNKNOWNS]
        missing = -self._observer.disturbance
        as_nominal = missing - filtered[_FROM_LAW]
        # The force that would be missing without an inverted lag: all that is to be explained.
        unlearned = missing - filtered[_FROM_NO_LAG]
        plain = as_nominal - dot(phi[:_N], self._plain.theta)
        lagged = missing - dot(phi[:_N], self._lagged.theta)
        share = min(span / self._tuning.judge, 1.0)
        self._plain_error += share * (plain * plain - self._plain_error)
        self._lagged_error += share * (lagged * lagged - self._lagged_error)
        self._plain_miss += share * ((as_nominal - filtered[_PLAIN]) ** 2 - self._plain_miss)
        self._lagged_miss += share * ((missing - filtered[_LAGGED]) ** 2 - self._lagged_miss)
        centring = min(span / self._tuning.centre, 1.0)
        self._missing.see(unlearned, centring, share)
        self._total.see(unlearned + filtered[_CONFIGURED], centring, share)
        self._choose(span)
        forgotten = self._tuning.forgotten * span
        # Early samples were taken with other estimates of the lag, so that they are only roughly
        # right: the uncertainty of the lag grows faster at the beginning.
        early = self._tuning.early * span * exp(-self._moved / self._tuning.settled)
        by_parameter = np.array([forgotten] * _N + [forgotten + early] * 2)
        self._plain.update(phi, plain, forgotten)
        self._lagged.update(phi, lagged, by_parameter)

    def _choose(self, span: float) -> None:
        """Select a hypothesis, restart one that has diverged, and find the weight."""
        tuning = self._tuning
        is_worse = self._plain_error < tuning.worse * self._lagged_error
        self._doubt = self._doubt + span if is_worse else 0.0
        if self._lag_is_configured or self._doubt > tuning.doubt:
            if self._prefers_lag and max(self.lag) > tuning.every:
                self._dropped_lag = float(self.lag[0]), float(self.lag[1])
            self._prefers_lag = False
        elif self._lagged_error < self._plain_error:
            self._prefers_lag = True
        if self._prefers_lag and max(self.lag) > tuning.every:
            self._dropped_lag = None
        is_used = self._prefers_lag or self._share > 0.05 or self._lag_is_configured
        is_lost = self._plain_error < tuning.lost * self._lagged_error
        if is_lost and not is_used and self._moved - self._restarted > tuning.restart:
            self._restart_lagged()
        error = self._lagged_miss if self._prefers_lag else self._plain_miss
        practice = 1.0 - exp(-((self._moved / tuning.convinced) ** 2))
        self._explained = self._share_explained(error, self._missing)
        self.weight = min(1.25 * self._explained, 1.0) * practice
        self._understood = min(1.25 * self._share_explained(error, self._total), 1.0) * practice
        # Errors above the assumed noise make the lag less certain.
        excess = max(self._lagged_error / tuning.noise, 1.0)
        self._known = max(1.0 - excess * self._lagged.uncertainty(_LAGS), 0.0) * practice

    def _share_explained(self, error: float, force: RunningVariance) -> float:
        """Return the share of a *force* that is explained with a mean square *error*."""
        least = 1e-9 * self._tuning.first
        return max(1.0 - (error + self._tuning.floor) / (force.value + least), 0.0)

    def _restart_lagged(self) -> None:
        """Restart the hypothesis with a lag from the one without, with a lag of 0."""
        self._restarted = self._moved
        self._lagged_error = self._plain_error
        self._lagged.restart_from(self._plain, _LAGS)
        self._observer.disturbance += self._filter.stages[_FROM_LAW][2]
        stages = self._filter.stages
        pairs = zip(stages[_FROM_NO_LAG], stages[_FROM_LAW], strict=True)
        one, two, three = (from_no_lag - from_law for from_no_lag, from_law in pairs)
        stages[_FROM_NO_LAG], stages[_FROM_LAW] = (one, two, three), (0.0, 0.0, 0.0)
        self._input[_N:] = [0.0] * (_COLUMNS - _N)
        self._chambers.restart(self._nominal)
