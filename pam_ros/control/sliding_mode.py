# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sliding-mode position law of every joint.

In the joint, J is its inertia, tau the effort of the muscles, G gravity and d the unknown
disturbance. For one muscle with a mass, J is m, tau its force F, and G m g:

    J s'' = tau(p, s) - c s' - G(s) + d

The error e = r - s should obey e'' + 2 z w e' + w^2 e = 0, written as a sliding variable with
integral action (Utkin & Shi 1996: there is no reaching phase from a bumpless start)

    sigma = e' + int (2 z w e' + w^2 e) dt,

and the wanted effort, with the estimated disturbance d^, is

    tau = J r'' + G(r) + c r' + losses          equivalent control, model along the reference
        + (2 z w J - c) e' + (w^2 J - k) e      feedback of the equivalent control
        + K J sat(sigma / Phi)                  switching
        - d^                                    disturbance observer

so that sigma' = -K sat(sigma / Phi) + (d^ - d) / J, with the consequences in
:class:`pam_ros.control.gains.Gains`. k is the stiffness of the joint, with that of gravity, and c
its damping. The pressures are the explicit inverse of the force law **at the reference**, not at
the load (:mod:`.allocation`): tau(p, r) - G(r) = tau(p, s) - G(s) - k e. So the joint's own spring
pulls the load to the reference, without noise and without lag, and -k e above accounts for it. If
the gains require no higher w, w is the joint's own sqrt(k / J), and (w^2 J - k) e is 0.
Antagonistic muscles have the stiffness as a second set-point, which does not move the coordinate.

While the reference rests, the bandwidths shrink as the goal is reached (:mod:`.rest.standstill`)
and grow when a disturbance moves the load (:mod:`.rest.rejection`). A loop that oscillates gets
lower feedback gains (:mod:`.gain_reduction`). A load that sticks and slips
is pushed to its goal (:mod:`.rest.stiction`). The law learns from the motion (:mod:`.learning`),
and configured effects are compensated (:mod:`.compensation`, :mod:`.pressure_path`).

Sources: Slotine & Li, Applied Nonlinear Control, 1991, chapter 7; Lilly & Quesada 2004 (sliding
mode for a muscle, boundary layer under wrong coefficients); Levant 1993; Han 2009 (observer);
Tondu & Lopez, IEEE Control Systems Magazine 20 (2), 2000 (angle and stiffness of a pair apart).
"""

from dataclasses import dataclass
from math import sqrt

from pam_ros.arguments import instance
from pam_ros.control.allocation import allocation_of
from pam_ros.control.co_contraction import CoContraction, StiffnessReference
from pam_ros.control.compensation import FeedForwardForces
from pam_ros.control.gain_reduction import GainReduction, ReductionTuning
from pam_ros.control.gains import Gains
from pam_ros.control.learning.features import FeatureTuning
from pam_ros.control.learning.learned import Learned
from pam_ros.control.learning.learner import Learner
from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.limits import Limiter, Limits
from pam_ros.control.model import ControlModel
from pam_ros.control.observer import Observer
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.rest.oscillation import OscillationTuning
from pam_ros.control.rest.rejection import Rejection, RejectionTuning
from pam_ros.control.rest.standstill import Standstill, StandstillTuning
from pam_ros.control.rest.stiction import Stiction, StictionTuning
from pam_ros.control.signals import (
    Pressures,
    Reference,
    Terms,
    start_arguments,
    step_arguments,
)
from pam_ros.control.switching import Surface
from pam_ros.control.tuning import number, scaled
from pam_ros.rig.joint import Joint


@dataclass(frozen=True)
class LawTuning:
    """Tuning numbers of the law that belong to no other part."""

    quickest: float = number(
        2.0,
        '',
        'largest factor on the bandwidth of the velocity estimate: beyond it the noise of the '
        'pressure grows and the error of the sine of control does not fall',
    )
    stuck_rate: float = number(
        30.0, 'N/s', 'largest rate at which a contact is loaded: control, friction at rest'
    )


class SlidingMode:
    """The law for one joint; ``terms`` holds the results of its last step."""

    def __init__(
        self,
        joint: Joint,
        gains: Gains | None = None,
        limits: Limits | None = None,
        co_contraction: CoContraction | None = None,
    ) -> None:
        """Take the nominal joint, at rest in the middle of its reach; see :meth:`start`.

        Of the joint's effects, only those without an onset are used. Raises ParameterError for
        gains of the other kind of joint (``Gains.for_joint``).
        """
        gains = Gains.for_joint(joint) if gains is None else gains
        limits = Limits() if limits is None else limits
        wanted = CoContraction() if co_contraction is None else co_contraction
        self.joint = joint = instance('joint', joint, Joint, 'a Joint').at_start
        self.gains = instance('gains', gains, Gains, 'Gains')
        instance('limits', limits, Limits, 'Limits')
        instance('co_contraction', wanted, CoContraction, 'a CoContraction')
        gains.require(revolute=joint.is_revolute)
        self.model = model = ControlModel(joint)
        self.allocation = allocation_of(model, limits)
        self.terms = Terms()
        length, force = 1.0 / model.arm, model.arms
        self._tuning = scaled(LawTuning(), length, force)
        self._limiters = [
            Limiter(low, high, limits.pressure_rate) for low, high in self.allocation.ranges
        ]
        self._paths = [
            PressurePath(joint, i, gains.pressure_time) for i in range(len(model.muscles))
        ]
        self._is_lag_configured = any(path.is_lag_configured for path in self._paths)
        self._losses = FeedForwardForces(model)
        self._observer = Observer(model)
        self._learner = Learner(
            model,
            gains,
            scaled(LearningTuning(), length, force),
            scaled(FeatureTuning(), length, force),
            self.allocation.reach,
            [path.chamber.zone for path in self._paths],
            lag_is_configured=self._is_lag_configured,
        )
        self._standstill = Standstill(
            gains.rest_tolerance, scaled(StandstillTuning(), length, force)
        )
        self._stiction = Stiction(gains.rest_tolerance, scaled(StictionTuning(), length, force))
        self._rejection = Rejection(gains, RejectionTuning(), OscillationTuning())
        self._reduction = GainReduction(ReductionTuning())
        self._surface = Surface()
        self._stiffness = StiffnessReference(
            wanted.wanted(self.allocation), wanted.co_contraction_rate
        )
        low, high = self.allocation.reach
        self.start(0.5 * (low + high) if high < float('inf') else 0.0)

    def set_gains(self, gains: Gains) -> None:
        """Continue from the present state with other gains; ParameterError as for a new law."""
        gains.require(revolute=self.joint.is_revolute)
        self.gains = self._learner.growth.gains = self._rejection.gains = gains
        for path in self._paths:
            path.quickest = gains.pressure_time
        self._standstill.tolerance = gains.rest_tolerance
        self._reduction.reset()

    def set_co_contraction(self, wanted: CoContraction) -> None:
        """Approach another stiffness, or at another rate; raises RangeError out of reach."""
        self._stiffness.set_goal(wanted.wanted(self.allocation))
        self._stiffness.rate = wanted.co_contraction_rate

    def stiffen(self, stiffness: float) -> None:
        """Set a stiffness; raises RangeError if it is not possible at the reference.

        In N/m or N m/rad. At other positions it is kept as nearly as the limits of pressure
        allow.
        """
        self.allocation.refuse_stiffness(stiffness, self.terms.reference)
        self._stiffness.set_goal(stiffness)

    def start(self, position: float, pressures: Pressures | None = None) -> None:
        """Start again; what was learned stays, except for the constant force.

        If *pressures* are not known, it is assumed that the load rests as the model predicts, with
        the set stiffness. Raises ParameterError in the cases of
        :meth:`pam_ros.control.signals.PositionLaw.start`.
        """
        model = self.model
        start_arguments(self.joint, position, pressures)
        if pressures is None:
            goal = self._stiffness.goal
            chambers = self.allocation.split(model.gravity(position), goal, position).pressures
            pressures = tuple(
                path.command_at_rest(p) for path, p in zip(self._paths, chambers, strict=True)
            )
        for limiter, path, pressure in zip(self._limiters, self._paths, pressures, strict=True):
            limiter.start(pressure)
            path.start(limiter.last)
        chambers = self._chambers
        # The force that the model lacks for a load at rest here.
        disturbance = model.gravity(position) - model.effort(chambers, position)
        self._stiffness.start(model.stiffness(chambers, position))
        self._observer.start(position, disturbance)
        self._learner.start(position, chambers, disturbance)
        self._losses.start(position, chambers)
        self._standstill.start()
        self._stiction.start()
        self._rejection.start()
        self._reduction.start()
        self._pushed: float | None = None
        self._surface.start()
        self.allocation.start()
        self._waited = 0.0  # since the last measurement, s
        self._offset = 0.0 if self.gains.observer else disturbance
        self._lost = 0.0
        self.terms = Terms(reference=position, position=position)
        self._note(self._commands, chambers)

    @property
    def learned(self) -> Learned | None:
        """What was learned from the motion, None with ``gains.learning`` off."""
        return self._learner.learned if self.gains.learning else None

    @property
    def _chambers(self) -> Pressures:
        return tuple([path.chamber.pressure for path in self._paths])

    @property
    def _commands(self) -> Pressures:
        return tuple(limiter.last for limiter in self._limiters)

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> Pressures:
        """Return the gauge pressures in Pa to command from now on, *dt* s after the last call.

        *reference* is the desired position now. *position* is the newest measurement in m or
        rad, taken *age* s ago, None if there was none since the last call. *velocity*, measured
        in m/s or rad/s, is used with ``use_measured_velocity`` of the gains. For numbers that are
        not finite see :meth:`pam_ros.control.signals.PositionLaw.update`.
        """
        position, velocity = step_arguments(self.joint, dt, reference, position, velocity, age)
        chambers = self._go_on(dt)
        self._take_in(dt, reference, position, age)
        effort, foreseen, rate = self._wanted_effort(dt, reference, velocity, chambers)
        effort = self._push(dt, reference, effort)
        stiffness, s = self._stiffness.stiffness, reference.position
        wanted = self.allocation.split(effort, stiffness, s)
        rates = self.allocation.rates(dt, foreseen, rate, stiffness, s)
        cut, commands = wanted.short, []
        for i, gain in enumerate(self.allocation.gains(s)):
            asked = self._paths[i].command_for(wanted.pressures[i], rates[i])
            commands.append(self._limiters[i].limit(asked, dt))
            cut += gain * (asked - commands[i])
        self.terms.cut = cut
        self._integrate(dt, effort, cut)
        self._note(tuple(commands), chambers)
        return self.terms.pressures

    def _note(self, commands: Pressures, chambers: Pressures) -> None:
        """Set the terms of the pressures and of the resulting stiffness."""
        terms = self.terms
        terms.pressures = commands
        if self.allocation.can_stiffen:
            terms.co_contraction = self._stiffness.stiffness
            terms.stiffness = self.model.stiffness(chambers, terms.position)

    def _go_on(self, dt: float) -> Pressures:
        """Advance all estimates by *dt* s under the last commands; return the chambers' Pa."""
        paths = self._paths
        means = [
            path.follow(limiter.last, dt)
            for path, limiter in zip(paths, self._limiters, strict=True)
        ]
        self._observer.predict(dt, means, -self._lost)
        chambers = self._chambers
        if self.gains.learning:
            inflows, losses = [path.inflow for path in paths], self._losses.effort
            moves = self._standstill.is_moving and self.terms.cut == 0.0
            self._learner.go_on(dt, inflows, chambers, losses, moves=moves)
        self._stiffness.follow(dt)
        return chambers

    def _take_in(
        self, dt: float, reference: Reference, position: float | None, age: float
    ) -> None:
        """Take in a measurement and find the bandwidths for this step."""
        observer, learner, gains = self._observer, self._learner, self.gains
        self._waited += dt
        error = reference.position - observer.position
        if position is not None:
            position += observer.velocity * age
            error = reference.position - position
        self._standstill.see_error(dt, error, self._standstill.moves(reference))
        scale = gains.rest_factor + (1.0 - gains.rest_factor) * self._standstill.factor
        growth = learner.growth.bandwidth / gains.bandwidth if gains.learning else 1.0
        scale *= growth
        fast = min(scale, self._tuning.quickest) * gains.velocity_bandwidth
        share = self._reduction.share
        scale *= share
        rejection = self._rejection
        stiffens = self.allocation.can_stiffen and self._stiffness.is_moving
        moves = self._standstill.is_moving or stiffens
        rejection.see(dt, error, position, moves=moves, is_cut=self.terms.saturated)
        self._bandwidth = rejection.between(scale * gains.bandwidth, share * gains.bandwidth)
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
        self._seen = observer.position if position is None else position
        if gains.learning:
            learner.see(dt, waited, position, reference.position, rejection.least_error)

    def _wanted_effort(
        self, dt: float, reference: Reference, velocity: float | None, chambers: Pressures
    ) -> tuple[float, float, float]:
        """Return the wanted effort, its predicted part, and the rate of that part."""
        model, gains, observer, terms = self.model, self.gains, self._observer, self.terms
        inertia = model.inertia
        s, v, a, jerk = reference
        k = model.stiffness(chambers, s) + model.gravity_stiffness(s)
        c = model.damping(chambers, s, v)
        learned = learned_rate = added = 0.0
        if gains.learning:
            learned, learned_rate = self._learner.feed_forward(dt, reference)
            added = self._learner.stiffness
            if not self._is_lag_configured:
                # The inverse of a lag acts on the feedback, too, so that it has the same share.
                share = self._reduction.share
                fill, vent = self._learner.lag
                for path in self._paths:
                    path.chamber.fill, path.chamber.vent = share * fill, share * vent
        # Muscles have no negative stiffness: a learned one that gives it is wrong.
        self._k = max(k + added, min(k, 0.0))
        self._find_surface(c)
        rejection = self._rejection
        if rejection.level == 0.0 or rejection.is_least:
            # Before that, an oscillation lowers the highest level of the rejection.
            bandwidth, least = sqrt(self._square), rejection.least_error
            if self._reduction.see(dt, rejection.error, v, least, bandwidth):
                self._learner.forget()
        if velocity is None or not gains.use_measured_velocity:
            velocity = observer.velocity
        self._error, self._error_rate = s - observer.position, v - velocity

        losses = self._losses.effort
        lost = self._losses.follow(dt, reference, chambers)
        rate = k * v + c * a + inertia * jerk + (lost - losses) / dt
        self._lost = lost + learned
        foreseen = inertia * a + model.gravity(s) + c * v
        shaping = (self._decay * inertia - c) * self._error_rate
        shaping += (self._square * inertia - self._k) * self._error

        surface = self._surface
        switching = inertia * surface.drive(
            self._error_rate, self._bandwidth, gains.switching_gain(inertia)
        )
        terms.surface = surface.value
        taken = -observer.disturbance if gains.observer else -self._offset
        terms.reference, terms.speed = s, v
        terms.position, terms.velocity = observer.position, velocity
        terms.error = self._error
        terms.equivalent = foreseen + lost + shaping
        terms.switching, terms.observer, terms.learned = switching, taken, learned
        terms.bandwidth = self._bandwidth
        terms.rejection, terms.highest_rejection = rejection.level, rejection.highest
        terms.feedback = self._reduction.share
        wanted = terms.equivalent + switching + taken + learned
        return wanted, foreseen + self._lost, rate + learned_rate

    def _find_surface(self, c: float) -> None:
        """Find w^2 and 2 z w of the surface; *c* is the damping of the joint."""
        gains, inertia = self.gains, self.model.inertia
        square = max(self._k / inertia, gains.surface_bandwidth * gains.surface_bandwidth)
        decay = max(2.0 * gains.surface_damping * sqrt(square), c / inertia)
        level, quick = self._rejection.level, gains.rejection_surface
        square += level * (max(quick * quick, square) - square)
        decay += level * (max(2.0 * gains.rejection_damping * quick, decay) - decay)
        share = self._reduction.share
        # Without feedback the error has the dynamics of the joint itself.
        own, passive = max(self._k, 0.0) / inertia, c / inertia
        self._square = share * square + (1.0 - share) * own
        self._decay = share * decay + (1.0 - share) * passive

    def _push(self, dt: float, reference: Reference, effort: float) -> float:
        """Return the effort to apply: pushes where the load sticks and slips, else *effort*."""
        stiction, standstill = self._stiction, self._standstill
        is_moved = standstill.is_moving or self._rejection.level > 0.0
        if is_moved:
            stiction.start()
        pushed = None
        if not is_moved:
            error = reference.position - self._seen
            pushed = stiction.follow(dt, error, effort, standstill.stiffness)
        if pushed is not None:
            self._pushed = pushed
            return pushed
        if self._pushed is not None:
            # The law continues from the effort of the last push.
            missing = self._pushed - effort
            self._surface.integral += missing / (self.model.inertia * self._bandwidth)
            effort, self._pushed = self._pushed, None
        return effort

    def _integrate(self, dt: float, effort: float, cut: float) -> None:
        """Integrate the surface, and observe how the load responds to the wanted *effort*."""
        standstill, inertia = self._standstill, self.model.inertia
        spring = self._square * self._error
        if standstill.stiffness > 1.0 and self._rejection.level == 0.0:
            # Load the contact of a stuck load faster, but not faster than can be observed.
            most = max(abs(spring), self._tuning.stuck_rate / (inertia * self._bandwidth))
            spring = min(max(spring * standstill.stiffness, -most), most)
        growth = (self._decay * self._error_rate + spring) * dt
        if self._pushed is None:
            self._surface.integrate(growth, cut)
        standstill.see_force(dt, effort, self._seen, self._k)
