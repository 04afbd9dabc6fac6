# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the sliding-mode law knows of its joint: the state, what is learned, and how it rests."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import NamedTuple

from pam_ros.control.allocation import Allocation
from pam_ros.control.compensation import FeedForwardForces
from pam_ros.control.gains import Gains
from pam_ros.control.learning.features import FeatureTuning
from pam_ros.control.learning.learner import Learner
from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.model import ControlModel
from pam_ros.control.observer import Observer
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.rest.gain_reduction import Cause, GainReduction, ReductionTuning
from pam_ros.control.rest.rejection import Rejection, RejectionTuning
from pam_ros.control.rest.standstill import Standstill, StandstillTuning
from pam_ros.control.signals import Pressures, Reference
from pam_ros.control.tuning import JointScale, number


@dataclass(frozen=True)
class EstimateTuning:
    """Tuning numbers of the estimates that belong to no other part."""

    quickest: float = number(
        2.0,
        '',
        'largest factor on the bandwidth of the velocity estimate: beyond it the noise of the '
        'pressure grows and the error of the sine of control does not fall',
    )


class LearnedForce(NamedTuple):
    """What is learned of the forces at the reference: N, N/s and N/m, or in N m and rad."""

    force: float = 0.0
    rate: float = 0.0
    stiffness: float = 0.0


class Feedback(NamedTuple):
    """The sliding surface e'' + decay e' + square e = 0 of a step, and where the error is.

    ``nominal`` and ``damping`` are the stiffness and the damping of the joint, ``stiffness`` is
    with what is learned; ``error`` and ``rate`` are e and e', ``velocity`` is that of the joint.
    """

    square: float
    decay: float
    nominal: float
    stiffness: float
    damping: float
    error: float
    rate: float
    velocity: float


class Estimates:
    """The observer, what is learned, and the parts that set the bandwidths of a step.

    ``observer``, ``learner``, ``losses`` (of configured effects), ``standstill``, ``rejection``
    and ``reduction`` are these parts; ``gains`` are the present ones.
    """

    def __init__(
        self,
        model: ControlModel,
        gains: Gains,
        allocation: Allocation,
        paths: Sequence[PressurePath],
        scale: JointScale,
    ) -> None:
        """Take the nominal joint, with the *scale* of its tuning numbers.

        Call :meth:`start` before the first step.
        """
        self.gains, self._model, self._paths = gains, model, paths
        self._tuning = scale.of(EstimateTuning())
        self._is_lag_configured = any(path.is_lag_configured for path in paths)
        self.losses = FeedForwardForces(model)
        self.observer = Observer(model)
        self.learner = Learner(
            model,
            gains,
            scale.of(LearningTuning()),
            scale.of(FeatureTuning()),
            allocation.reach,
            [path.chamber.zone for path in paths],
            lag_is_configured=self._is_lag_configured,
        )
        self.standstill = Standstill(gains.rest_tolerance, scale.of(StandstillTuning()))
        self.rejection = Rejection(gains, RejectionTuning())
        self.reduction = GainReduction(ReductionTuning())

    def set_gains(self, gains: Gains) -> None:
        """Continue from the present state with other gains."""
        self.gains = gains
        self.learner.set_gains(gains)
        self.rejection.set_gains(gains)
        self.standstill.set_tolerance(gains.rest_tolerance)
        self.reduction.reset()

    def start(self, position: float, disturbance: float) -> None:
        """Start again at rest, with the effort that the model lacks there."""
        chambers = self.chambers
        self.observer.start(position, disturbance)
        self.learner.start(position, chambers, disturbance)
        self.losses.start(position, chambers)
        self.standstill.start()
        self.rejection.start()
        self.reduction.start()
        self._waited = 0.0  # since the last measurement, s

    @property
    def chambers(self) -> Pressures:
        """The predicted pressures in the chambers in Pa."""
        return tuple([path.chamber.pressure for path in self._paths])

    def advance(self, dt: float, commands: Pressures, lost: float, *, is_cut: bool) -> Pressures:
        """Advance all estimates by *dt* s under *commands*; return the pressures in the chambers.

        *lost* is the effort of losses and of what is learned, and *is_cut* is whether a limit cut
        the last commands.
        """
        paths = self._paths
        means = [path.follow(last, dt) for path, last in zip(paths, commands, strict=True)]
        self.observer.predict(dt, means, -lost)
        chambers = self.chambers
        if self.gains.learning:
            inflows, losses = [path.inflow for path in paths], self.losses.effort
            moves = self.standstill.is_moving and not is_cut
            self.learner.go_on(dt, inflows, chambers, losses, moves=moves)
        return chambers

    def take_in(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        age: float,
        *,
        stiffens: bool,
        is_saturated: bool,
    ) -> tuple[float, float]:
        """Take in a measurement; return the newest position and the bandwidth for this step.

        *stiffens* is whether the desired stiffness moves, *is_saturated* whether a command is at
        a limit.
        """
        observer, learner, gains = self.observer, self.learner, self.gains
        self._waited += dt
        error = reference.position - observer.position
        if position is not None:
            position += observer.velocity * age
            error = reference.position - position
        self.standstill.see_error(dt, error, self.standstill.moves(reference))
        scale = gains.rest_factor + (1.0 - gains.rest_factor) * self.standstill.factor
        growth = learner.growth.bandwidth / gains.bandwidth if gains.learning else 1.0
        scale *= growth
        fast = min(scale, self._tuning.quickest) * gains.velocity_bandwidth
        share = self.reduction.share
        scale *= share
        rejection = self.rejection
        moves = self.standstill.is_moving or stiffens
        rejection.see(dt, error, position, moves=moves, quiet=self.reduction.quiet)
        waited = self._waited
        if position is not None:
            observer.correct(
                position,
                waited,
                rejection.between(fast, gains.velocity_bandwidth),
                rejection.between(
                    scale * gains.observer_bandwidth, share * gains.rejection_bandwidth
                ),
            )
            self._waited = 0.0
        if gains.learning:
            learner.see(dt, waited, position, reference.position, rejection.least_error)
        bandwidth = rejection.between(scale * gains.bandwidth, share * gains.bandwidth)
        return observer.position if position is None else position, bandwidth

    def learned_force(self, dt: float, reference: Reference) -> LearnedForce:
        """Return what is learned at the *reference*; a learned lag is inverted from now on."""
        if not self.gains.learning:
            return LearnedForce()
        force, rate = self.learner.feed_forward(dt, reference)
        if not self._is_lag_configured:
            # The inverse of a lag acts on the feedback, too, so that it has the same share.
            share = self.reduction.share
            fill, vent = self.learner.lag
            for path in self._paths:
                path.set_lag(share * fill, share * vent)
        return LearnedForce(force, rate, self.learner.stiffness)

    def feedback(
        self,
        dt: float,
        reference: Reference,
        velocity: float | None,
        chambers: Pressures,
        learned_stiffness: float,
        *,
        is_saturated: bool,
    ) -> Feedback:
        """Return the surface at the *reference* and the error; detect a loop that oscillates."""
        model, observer = self._model, self.observer
        s, v = reference.position, reference.velocity
        k = model.stiffness(chambers, s) + model.gravity_stiffness(s)
        c = model.damping(chambers, s, v)
        # Muscles have no negative stiffness: a learned one that gives it is wrong.
        stiffness = max(k + learned_stiffness, min(k, 0.0))
        square, decay = self._surface_at(stiffness, c)
        self._see_oscillation(dt, v, sqrt(square), is_saturated=is_saturated)
        if velocity is None or not self.gains.use_measured_velocity:
            velocity = observer.velocity
        error = s - observer.position
        return Feedback(square, decay, k, stiffness, c, error, v - velocity, velocity)

    def _see_oscillation(
        self, dt: float, speed: float, bandwidth: float, *, is_saturated: bool
    ) -> None:
        """Detect a loop of this *bandwidth* that oscillates, and reduce what makes it do so."""
        rejection = self.rejection
        rejects = rejection.level > 0.0 and not rejection.is_least
        if rejects:
            bandwidth = max(self.gains.rejection_surface, bandwidth)
        cause = self.reduction.see(
            dt,
            rejection.error,
            speed,
            rejection.least_error,
            bandwidth,
            suspect=Cause.LEVEL if rejects else Cause.SHARE,
            is_cut=rejects and is_saturated,
            is_disturbed=rejection.level > 0.0,
        )
        if cause is Cause.LEVEL:
            rejection.lower()
        elif cause is Cause.SHARE:
            self.learner.forget()

    def _surface_at(self, k: float, c: float) -> tuple[float, float]:
        """Return w^2 and 2 z w for the stiffness *k* and the damping *c* of the joint."""
        gains, inertia = self.gains, self._model.inertia
        square = max(k / inertia, gains.surface_bandwidth * gains.surface_bandwidth)
        decay = max(2.0 * gains.surface_damping * sqrt(square), c / inertia)
        level, quick = self.rejection.level, gains.rejection_surface
        square += level * (max(quick * quick, square) - square)
        decay += level * (max(2.0 * gains.rejection_damping * quick, decay) - decay)
        share = self.reduction.share
        # Without feedback the error has the dynamics of the joint itself.
        own, passive = max(k, 0.0) / inertia, c / inertia
        return share * square + (1.0 - share) * own, share * decay + (1.0 - share) * passive
