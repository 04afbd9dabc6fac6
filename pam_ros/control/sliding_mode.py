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
lower feedback gains (:mod:`.rest.gain_reduction`). A load that sticks and slips
is pushed to its goal (:mod:`.rest.stiction`). The law learns from the motion (:mod:`.learning`),
and configured effects are compensated (:mod:`.compensation`, :mod:`.pressure_path`).

Sources: Slotine & Li, Applied Nonlinear Control, 1991, chapter 7; Lilly & Quesada 2004 (sliding
mode for a muscle, boundary layer under wrong coefficients); Levant 1993; Han 2009 (observer);
Tondu & Lopez, IEEE Control Systems Magazine 20 (2), 2000 (angle and stiffness of a pair apart).
"""

from dataclasses import dataclass
from typing import NamedTuple

from pam_ros.arguments import instance
from pam_ros.control.co_contraction import CoContraction, StiffnessReference
from pam_ros.control.estimates import Estimates, Feedback, LearnedForce
from pam_ros.control.gains import Gains
from pam_ros.control.law import JointLaw
from pam_ros.control.learned import Learned
from pam_ros.control.limits import Limits
from pam_ros.control.rest.stiction import Stiction, StictionTuning
from pam_ros.control.signals import (
    Pressures,
    Reference,
    Terms,
    start_arguments,
    step_arguments,
)
from pam_ros.control.switching import Surface
from pam_ros.control.tuning import number, scale_of
from pam_ros.rig.joint import Joint


@dataclass(frozen=True)
class LawTuning:
    """Tuning numbers of the law that belong to no other part."""

    stuck_rate: float = number(
        30.0, 'N/s', 'largest rate at which a contact is loaded: control, friction at rest'
    )


class _Wanted(NamedTuple):
    """The wanted effort, its part along the reference, and the rate of that part."""

    effort: float
    foreseen: float
    rate: float


class SlidingMode(JointLaw):
    """The law for one joint; ``terms`` holds the results of its last step."""

    gains: Gains

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
        self.gains = instance('gains', gains, Gains, 'Gains')
        super().__init__(joint, gains, limits, co_contraction, gains.pressure_time)
        scale = scale_of(self.model)
        self._tuning = scale.of(LawTuning())
        self._estimates = Estimates(self.model, gains, self.allocation, self._paths, scale)
        self._stiction = Stiction(gains.rest_tolerance, scale.of(StictionTuning()))
        self._surface = Surface()
        self._stiffness = StiffnessReference(
            self._co_contraction.wanted(self.allocation), self._co_contraction.co_contraction_rate
        )
        low, high = self.allocation.reach
        self.start(0.5 * (low + high) if high < float('inf') else 0.0)

    def set_gains(self, gains: Gains) -> None:
        """Continue from the present state with other gains; ParameterError as for a new law."""
        gains.require(revolute=self.joint.is_revolute)
        self.gains = gains
        self._estimates.set_gains(gains)
        for path in self._paths:
            path.set_quickest(gains.pressure_time)

    def set_co_contraction(self, wanted: CoContraction) -> None:
        """Approach another stiffness, or at another rate; raises RangeError out of reach."""
        self._stiffness.set_goal(wanted.wanted(self.allocation))
        self._stiffness.set_rate(wanted.co_contraction_rate)

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
            pressures = self._at_rest(position, self._stiffness.goal)
        for limiter, path, pressure in zip(self._limiters, self._paths, pressures, strict=True):
            limiter.start(pressure)
            path.start(limiter.last)
        chambers = self._estimates.chambers
        # The force that the model lacks for a load at rest here.
        disturbance = model.gravity(position) - model.effort(chambers, position)
        self._stiffness.start(model.stiffness(chambers, position))
        self._estimates.start(position, disturbance)
        self._stiction.start()
        self._surface.start()
        self.allocation.start()
        self._pushed: float | None = None  # the effort of the last push
        self._offset = 0.0 if self.gains.observer else disturbance
        self._lost = 0.0  # the effort of losses and of what is learned in the last step
        self.terms = Terms(reference=position, position=position)
        self._note_pressures(self._commands, chambers, self._stiffness.stiffness)

    @property
    def learned(self) -> Learned | None:
        """What was learned from the motion, None with ``gains.learning`` off."""
        return self._estimates.learner.learned if self.gains.learning else None

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
        estimates, terms = self._estimates, self.terms
        chambers = estimates.advance(dt, self._commands, self._lost, is_cut=terms.cut != 0.0)
        self._stiffness.follow(dt)
        stiffens = self.allocation.can_stiffen and self._stiffness.is_moving
        seen, bandwidth = estimates.take_in(
            dt, reference, position, age, stiffens=stiffens, is_saturated=terms.saturated
        )
        learned = estimates.learned_force(dt, reference)
        feedback = estimates.feedback(
            dt,
            reference,
            velocity,
            chambers,
            learned.stiffness,
            is_saturated=terms.saturated,
        )
        wanted = self._wanted_effort(dt, reference, chambers, bandwidth, learned, feedback)
        effort = self._push(dt, reference.position - seen, bandwidth, wanted.effort)
        cut = self._command(dt, reference.position, effort, wanted)
        self._integrate(dt, seen, bandwidth, feedback, effort, cut)
        self._note_pressures(self._commands, chambers, self._stiffness.stiffness)
        return self.terms.pressures

    def _wanted_effort(
        self,
        dt: float,
        reference: Reference,
        chambers: Pressures,
        bandwidth: float,
        learned: LearnedForce,
        feedback: Feedback,
    ) -> _Wanted:
        """Return the wanted effort, and set the terms that it consists of."""
        model, gains, terms, surface = self.model, self.gains, self.terms, self._surface
        estimates = self._estimates
        inertia = model.inertia
        s, v, a, jerk = reference
        k, c = feedback.nominal, feedback.damping
        losses = estimates.losses.effort
        lost = estimates.losses.follow(dt, reference, chambers)
        rate = k * v + c * a + inertia * jerk + (lost - losses) / dt
        self._lost = lost + learned.force
        foreseen = inertia * a + model.gravity(s) + c * v
        shaping = (feedback.decay * inertia - c) * feedback.rate
        shaping += (feedback.square * inertia - feedback.stiffness) * feedback.error
        switching = inertia * surface.drive(
            feedback.rate, bandwidth, gains.switching_gain(inertia)
        )
        taken = -estimates.observer.disturbance if gains.observer else -self._offset
        terms.reference, terms.speed, terms.position = s, v, estimates.observer.position
        terms.velocity, terms.error = feedback.velocity, feedback.error
        terms.surface, terms.bandwidth = surface.value, bandwidth
        terms.equivalent = foreseen + lost + shaping
        terms.switching, terms.observer, terms.learned = switching, taken, learned.force
        terms.rejection = estimates.rejection.level
        terms.highest_rejection = estimates.rejection.highest
        terms.feedback = estimates.reduction.share
        wanted = terms.equivalent + switching + taken + learned.force
        return _Wanted(wanted, foreseen + self._lost, rate + learned.rate)

    def _push(self, dt: float, error: float, bandwidth: float, effort: float) -> float:
        """Return the effort to apply: pushes where the load sticks and slips, else *effort*.

        *error* is that of the newest measured position.
        """
        stiction, standstill = self._stiction, self._estimates.standstill
        pushed = None
        if standstill.is_moving or self._estimates.rejection.level > 0.0:
            stiction.start()
        else:
            pushed = stiction.follow(dt, error, effort, standstill.stiffness)
        if pushed is not None:
            self._pushed = pushed
            return pushed
        if self._pushed is not None:
            # The law continues from the effort of the last push.
            missing = self._pushed - effort
            self._surface.shift(missing / (self.model.inertia * bandwidth))
            effort, self._pushed = self._pushed, None
        return effort

    def _command(self, dt: float, s: float, effort: float, wanted: _Wanted) -> float:
        """Command the pressures for an *effort* at s; return what the limits cut of it."""
        stiffness = self._stiffness.stiffness
        split = self.allocation.split(effort, stiffness, s)
        rates = self.allocation.rates(dt, wanted.foreseen, wanted.rate, stiffness, s)
        cut = split.short
        for i, gain in enumerate(self.allocation.gains(s)):
            asked = self._paths[i].command_for(split.pressures[i], rates[i])
            cut += gain * (asked - self._limiters[i].limit(asked, dt))
        self.terms.cut = cut
        return cut

    def _integrate(
        self,
        dt: float,
        seen: float,
        bandwidth: float,
        feedback: Feedback,
        effort: float,
        cut: float,
    ) -> None:
        """Integrate the surface, and observe how the load responds to the wanted *effort*."""
        standstill, inertia = self._estimates.standstill, self.model.inertia
        spring = feedback.square * feedback.error
        if standstill.stiffness > 1.0 and self._estimates.rejection.level == 0.0:
            # Load the contact of a stuck load faster, but not faster than can be observed.
            most = max(abs(spring), self._tuning.stuck_rate / (inertia * bandwidth))
            spring = min(max(spring * standstill.stiffness, -most), most)
        growth = (feedback.decay * feedback.rate + spring) * dt
        if self._pushed is None:
            self._surface.integrate(growth, cut)
        standstill.see_force(dt, effort, seen, feedback.stiffness)
