# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Learn from motion what the declared model lacks, and feed it forward.

A second, fast observer estimates the whole force that the model misses. It is explained by two
hypotheses, side by side: friction, hysteresis and stiffness alone (:mod:`.features`), or these
and a lag of the pressure that nobody declared. Both are linear regressions over the same filter
as the observer's, the lag's time constants by their sensitivities (Ljung 1999, chapter 11). The
one that predicts better is used, weighed by how much of the missing force it explains; nothing
is used before the load has moved for a while.

What is learned acts as a feed-forward along the reference. It is bounded and, driven by the
reference alone, cannot destabilise the loop. A learned lag is inverted, and one that is found to
be short lets the bandwidth grow.
"""

from math import exp

import numpy as np
from numpy.typing import NDArray

from pam_ros.control import features as beside
from pam_ros.control.features import Features
from pam_ros.control.gains import Gains
from pam_ros.control.inner_model import InnerModel
from pam_ros.control.observer import Observer
from pam_ros.control.pressure_path import Chamber
from pam_ros.control.regression import Regression
from pam_ros.control.signals import Reference

Array = NDArray[np.float64]

FAST = 60.0  # rad/s of the observer, and of the filter of the features
EVERY = 0.01  # s between two samples of the regressions
NOISE = 1.0  # N^2
FORGOTTEN = 0.01  # share of the prior variance per second
LAG_SPREAD, LAG_HIGH = 0.05, 0.2  # s
JUDGE, CENTRE = 1.0, 2.0  # s over which prediction errors, and the mean force, are averaged
CONVINCED = 1.5  # s of motion after which what is learned is trusted
FLOOR = 1.0  # N^2 of missing force that is not worth a word
WORSE, LOST = 0.7, 0.6  # ratios of errors at which a lag is doubted, or sought anew
DOUBT = 0.5  # s of motion for which it must be doubted to be dropped
RESTART = 2.0  # s of motion
BLEND, GROW = 0.2, 0.2  # s
MARGIN = 3.0  # periods of a lag that make a decay time
MOST = 200.0  # N that are fed forward at most

_SPREAD, _LOW, _HIGH = (
    np.array(a + b)
    for a, b in (
        (beside.SPREAD, (LAG_SPREAD, LAG_SPREAD)),
        (beside.LOW, (0.0, 0.0)),
        (beside.HIGH, (LAG_HIGH, LAG_HIGH)),
    )
)
_N = beside.COUNT


class _Sensitivity:
    """How the pressure of a chamber changes with its two time constants, Pa/s."""

    def __init__(self) -> None:
        self.fill = self.vent = 0.0

    def follow(self, rate: float, fills: bool, tau: float, dt: float) -> None:
        """Go on by *dt* s in which the pressure went at *rate* Pa/s."""
        share = 1.0 - exp(-dt / max(tau, dt))
        self.fill += share * ((-rate if fills else 0.0) - self.fill)
        self.vent += share * ((0.0 if fills else -rate) - self.vent)


class Learner:
    """What has been learned, and the feed-forward that comes of it.

    trust
        0 to 1: how far what has been learned is used
    lag
        (fill, vent) in s: the lag that is to be inverted, where none is declared
    bandwidth
        1/s: what the lag allows, between the two bandwidths of the gains
    """

    def __init__(self, model: InnerModel, gains: Gains, lag_is_declared: bool) -> None:
        """Make one that has learned nothing."""
        self._model, self.gains = model, gains
        self._lag_is_declared = lag_is_declared
        self._observer = Observer(model)
        self._wanted, self._actual = Features(), Features()
        self.start(0.0, 0.0, 0.0)

    def start(self, position: float, pressure: float, disturbance: float) -> None:
        """Forget everything; the load rests at *position* m, the chamber at *pressure* Pa."""
        self.trust = 0.0
        self.lag = (0.0, 0.0)
        self.bandwidth = self.gains.bandwidth
        self._observer.start(position, disturbance)
        self._wanted.start(position)
        self._actual.start(position)
        self._chamber = Chamber()
        self._chamber.pressure = pressure
        self._declared = pressure
        self._sensitivity = _Sensitivity()
        plain = _SPREAD.copy()
        plain[_N:] = 0.0
        self._plain = Regression(plain, _LOW, _HIGH, NOISE)
        self._lagged = Regression(_SPREAD, _LOW, _HIGH, NOISE)
        for one in (self._plain, self._lagged):
            one.theta[beside.CONSTANT] = -disturbance
        # Three equal poles, like the observer's: of the features, and of the force by which the
        # learned chamber differs from the declared one.
        self._filter = np.zeros((3, _N + 5))
        self._filter[:, beside.CONSTANT] = 1.0
        self._input = np.zeros(_N + 5)
        self._plain_error = self._lagged_error = self._whole = 1.0
        self._plain_miss = self._lagged_miss = 1.0
        self._centre, self._has_learned = 0.0, False
        self._moved = self._restarted = self._waited = 0.0
        self._prefers_lag = False
        self._doubt = 0.0
        self._share = 0.0

    @property
    def _weights(self) -> Array:
        share = self._share
        mix: Array = share * self._lagged.theta + (1.0 - share) * self._plain.theta
        return mix

    def feed_forward(self, dt: float, reference: Reference) -> tuple[float, float]:
        """Return the force in N that the reference needs more than modelled, and its rate."""
        self._wanted.follow(dt, reference.position, reference.velocity)
        values = self._wanted.values
        self._input[_N + 3] = self._plain.theta[:_N].dot(values)
        self._input[_N + 4] = self._lagged.theta[:_N].dot(values)
        self._share += dt / BLEND * (self._prefers_lag - self._share)
        weights = self._weights.tolist()
        force = rate = 0.0
        if self.trust > 0.0:
            for n in range(beside.CONSTANT):
                weight = self.trust * weights[n]
                force += weight * self._wanted.values[n]
                rate += weight * self._wanted.rates[n]
        used = self.trust * self._share
        self.lag = (used * weights[_N], used * weights[_N + 1])
        self._let_grow(dt)
        if abs(force) > MOST:
            return (MOST if force > 0.0 else -MOST), 0.0
        return force, rate

    def _let_grow(self, dt: float) -> None:
        """Let the bandwidth follow what the lag allows."""
        low, high = self.gains.bandwidth, self.gains.fast_bandwidth
        wanted = low
        if self.trust > 0.0 and not self._lag_is_declared:
            lag = float(self._lagged.theta[_N:].max())
            decay = self.trust * max(MARGIN * lag, 1.0 / high) + (1.0 - self.trust) / low
            wanted = min(max(1.0 / decay, low), high)
        self.bandwidth += dt / GROW * (wanted - self.bandwidth)

    def see(self, dt: float, waited: float, position: float | None) -> None:
        """Take in a measured *position* in m, the first for *waited* s, if there is a new one."""
        if position is not None:
            self._observer.correct(position, waited, FAST, FAST)
        observer = self._observer
        self._input[:_N] = self._actual.follow(dt, observer.position, observer.velocity)

    def go_on(
        self, dt: float, inflow: float, declared: float, losses: float, may_learn: bool
    ) -> None:
        """Go on by *dt* s with *inflow* Pa at the chamber, in it *declared* Pa as declared.

        *losses* are those in N that declared effects have along the reference: not to be learned.
        """
        share = 1.0 - exp(-FAST * dt)
        stages = self._filter
        stages[0] += share * (self._input - stages[0])
        stages[1] += share * (stages[0] - stages[1])
        stages[2] += share * (stages[1] - stages[2])
        if may_learn:
            self._moved += dt
            self._waited += dt
            if self._waited >= EVERY - 1e-9:
                self._learn(self._waited)
                self._waited = 0.0
        self._advance(dt, inflow, declared, losses)

    def _advance(self, dt: float, inflow: float, declared: float, losses: float) -> None:
        """Let the observer and the learned chamber go on, and see how they depend on the lag."""
        observer, gain = self._observer, self._model.gain(self._observer.position)
        mean = 0.5 * (self._declared + declared)
        self._declared = declared
        if self._lag_is_declared:
            observer.predict(dt, mean, -losses)
            return
        chamber = self._chamber
        chamber.fill, chamber.vent = self._lagged.theta[_N:].tolist()
        before = chamber.pressure
        fills = inflow > before
        pressure = chamber.follow(inflow, dt)
        rate = (chamber.pressure - before) / dt
        self._sensitivity.follow(rate, fills, chamber.fill if fills else chamber.vent, dt)
        self._input[_N] = -gain * self._sensitivity.fill
        self._input[_N + 1] = -gain * self._sensitivity.vent
        self._input[_N + 2] = gain * (pressure - mean)
        observer.predict(dt, pressure, -losses)

    def _learn(self, span: float) -> None:
        """Let both hypotheses take in the force that is missing now, *span* s after the last."""
        phi = self._filter[2, : _N + 2]
        missing = -self._observer.disturbance
        as_declared = missing - self._filter[2, _N + 2]
        plain = as_declared - float(phi[:_N] @ self._plain.theta[:_N])
        lagged = missing - float(phi[:_N] @ self._lagged.theta[:_N])
        share = min(span / JUDGE, 1.0)
        self._plain_error += share * (plain * plain - self._plain_error)
        self._lagged_error += share * (lagged * lagged - self._lagged_error)
        self._plain_miss += share * (
            (as_declared - self._filter[2, _N + 3]) ** 2 - self._plain_miss
        )
        self._lagged_miss += share * ((missing - self._filter[2, _N + 4]) ** 2 - self._lagged_miss)
        if not self._has_learned:
            # A load that nobody declared is no evidence of anything else.
            self._centre, self._has_learned = as_declared, True
        self._centre += min(span / CENTRE, 1.0) * (as_declared - self._centre)
        self._whole += share * ((as_declared - self._centre) ** 2 - self._whole)
        self._choose(span)
        forgotten = FORGOTTEN * span
        self._plain.update(phi, plain, forgotten)
        self._lagged.update(phi, lagged, forgotten)

    def _choose(self, span: float) -> None:
        """Prefer a hypothesis, restart one that is lost, and say how far to trust."""
        is_worse = self._plain_error < WORSE * self._lagged_error
        self._doubt = self._doubt + span if is_worse else 0.0
        if self._lag_is_declared or self._doubt > DOUBT:
            self._prefers_lag = False
        elif self._lagged_error < self._plain_error:
            self._prefers_lag = True
        is_used = self._prefers_lag or self._share > 0.05 or self._lag_is_declared
        is_lost = self._plain_error < LOST * self._lagged_error
        if is_lost and not is_used and self._moved - self._restarted > RESTART:
            self._restart_lagged()
        error = self._lagged_miss if self._prefers_lag else self._plain_miss
        explained = 1.0 - (error + FLOOR) / (self._whole + 1e-9)
        practice = 1.0 - exp(-((self._moved / CONVINCED) ** 2))
        self.trust = min(max(1.25 * explained, 0.0), 1.0) * practice

    def _restart_lagged(self) -> None:
        """Let the hypothesis with a lag begin anew from the one without, at no lag."""
        self._restarted = self._moved
        self._lagged_error = self._plain_error
        self._lagged.theta = self._plain.theta.copy()
        self._lagged.covariance = self._plain.covariance.copy()
        self._lagged.covariance[_N:, _N:] = np.diag(_SPREAD[_N:] ** 2)
        self._observer.disturbance += float(self._filter[2, _N + 2])
        self._filter[:, _N + 2] = 0.0
        self._input[_N:] = 0.0
        self._chamber.pressure = self._declared
        self._sensitivity = _Sensitivity()
