# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sliding-mode position law.

The rig, contraction positive, with d what is not known of it:

    m y'' = F(p, y) - c y' - m g + d

The error e = r - y shall obey e'' + 2 z w e' + w^2 e = 0, written as a sliding variable with
integral action (Utkin & Shi 1996: there is no reaching phase from a bumpless start)

    s = e' + int (2 z w e' + w^2 e) dt,

and the wanted force is

    F = m (r'' + g) + c r' + losses             equivalent control, model along the reference
      + (2 z w m - c) e' + (w^2 m - k) e        the rest of it
      + K m sat(s / Phi)                        switching, or super-twisting
      - d^                                      disturbance observer

so that s' = -K sat(s / Phi) + (d^ - d) / m: see :class:`pam_ros.control.gains.Gains` for what
follows. The pressure is the explicit inverse of the force law **at the reference**, not at the
load: F(p, r) = F(p, y) - k e, so the muscle's own spring pulls the load to the reference, without
noise and without lag, and -k e above takes account of it. w is the muscle's own sqrt(k / m) unless
the gains ask for more; then (w^2 m - k) e is nothing.

While the reference rests, the bandwidths shrink as the goal is reached (:mod:`.standstill`); what
motion shows is learned (:mod:`.learning`); declared effects are compensated
(:mod:`.compensation`, :mod:`.pressure_path`).

Sources: Slotine & Li, Applied Nonlinear Control, 1991, chapter 7; Lilly & Quesada 2004 (sliding
mode for a muscle, boundary layer under wrong coefficients); Levant 1993; Han 2009 (observer).
"""

from math import sqrt

from pam_ros.control.compensation import Losses
from pam_ros.control.gains import SUPER_TWISTING, Gains
from pam_ros.control.inner_model import InnerModel
from pam_ros.control.learning import Learner
from pam_ros.control.limits import Limiter, Limits
from pam_ros.control.observer import Observer
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.signals import Reference, Terms
from pam_ros.control.standstill import Standstill
from pam_ros.control.stiction import Stiction
from pam_ros.control.switching import Surface
from pam_ros.rig.model import RigModel

REST_SPEED, REST_ACCELERATION = 1e-4, 1e-3  # m/s, m/s^2 below which a reference rests
QUICKEST = 2.0  # times its bandwidth that the velocity estimate grows to
STICTION_TOLERANCE = 1.5  # rest tolerances that a load which sticks and slips may be off
STUCK_RATE = 30.0  # N/s at most with which a contact is loaded


class SlidingMode:
    """The law for one muscle; ``terms`` holds what its last step found."""

    def __init__(self, model: RigModel, gains: Gains, limits: Limits | None = None) -> None:
        """Make it for a declared rig, at rest at 0 m; see :meth:`start`."""
        self.model, self.gains = model, gains
        limits = limits or Limits()
        self.terms = Terms()
        self._rig = rig = InnerModel(model)
        self._limiter = Limiter(*limits.range_for(model), limits.pressure_rate)
        self._path = PressurePath(model, gains.pressure_time)
        self._losses = Losses(model)
        self._observer = Observer(rig)
        self._learner = Learner(rig, gains, self._path.is_lag_declared)
        self._standstill = Standstill(gains.rest_tolerance)
        self._stiction = Stiction(STICTION_TOLERANCE * gains.rest_tolerance)
        self._surface = Surface()
        self.start(0.0)

    def set_gains(self, gains: Gains) -> None:
        """Go on from the present state with other gains."""
        self.gains = self._learner.gains = gains
        self._path.quickest = gains.pressure_time
        self._standstill.tolerance = gains.rest_tolerance

    def start(self, position: float, pressure: float | None = None) -> None:
        """Begin anew; what was learned is forgotten.

        Where *pressure* is not known, it is taken that the load rests as the model says.
        """
        rig = self._rig
        if pressure is None:
            chamber = rig.pressure_for(rig.weight, position)
            pressure = self._path.command_at_rest(chamber)
        self._limiter.start(pressure)
        pressure = self._limiter.last
        self._path.start(pressure)
        chamber = self._path.chamber.pressure
        # What the model lacks to explain that the load rests here.
        disturbance = rig.weight - rig.force(chamber, position)
        self._observer.start(position, disturbance)
        self._learner.start(position, chamber, disturbance)
        self._losses.start(position, chamber)
        self._standstill.start()
        self._stiction.start()
        self._pushed: float | None = None
        self._surface.start()
        self._waited = 0.0  # since the last measurement, s
        self._offset = 0.0 if self.gains.observer else disturbance
        self._foreseen = rig.weight
        self._lost, self._may_learn = 0.0, False
        self.terms = Terms(reference=position, position=position, pressure=pressure)

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> float:
        """Return the gauge pressure in Pa to command from now on, *dt* s after the last call.

        *reference* is where the load shall be now. *position* is the newest measurement in m,
        taken *age* s ago, None where there was none since the last call. *velocity*, measured in
        m/s, is used if the gains say so.
        """
        self._go_on(dt)
        moves = (
            abs(reference.velocity) > REST_SPEED or abs(reference.acceleration) > REST_ACCELERATION
        )
        self._take_in(dt, reference, position, age, moves)
        force, rate = self._wanted_force(dt, reference, velocity)
        force = self._push(dt, reference, force)
        pressure = self._rig.pressure_for(force, reference.position)
        gain = self._rig.gain(reference.position)
        wanted = self._path.command_for(pressure, rate / gain)
        command = self._limiter.limit(wanted, dt)
        self.terms.pressure, self.terms.cut = command, gain * (wanted - command)
        self._integrate(dt, force, command, wanted)
        return command

    def _take_in(
        self, dt: float, reference: Reference, position: float | None, age: float, moves: bool
    ) -> None:
        """Take in a measurement and find the bandwidths for this step."""
        observer, learner, gains = self._observer, self._learner, self.gains
        self._waited += dt
        error = reference.position - observer.position
        if position is not None:
            position += observer.velocity * age
            error = reference.position - position
        self._standstill.see_error(dt, error, moves)
        scale = gains.rest_factor + (1.0 - gains.rest_factor) * self._standstill.factor
        growth = learner.bandwidth / gains.bandwidth if gains.learning else 1.0
        scale *= growth
        self._bandwidth = scale * gains.bandwidth
        waited = self._waited
        if position is not None:
            fast = min(scale, QUICKEST) * gains.velocity_bandwidth
            observer.correct(position, waited, fast, scale * gains.observer_bandwidth)
            self._waited = 0.0
        self._seen = observer.position if position is None else position
        if gains.learning:
            learner.see(dt, waited, position)

    def _wanted_force(
        self, dt: float, reference: Reference, velocity: float | None
    ) -> tuple[float, float]:
        """Return the wanted force in N, and the rate in N/s at which its foreseen part goes."""
        rig, gains, observer, terms = self._rig, self.gains, self._observer, self.terms
        m, chamber = rig.mass, self._path.chamber.pressure
        y, v, a, jerk = reference
        self._k = k = rig.stiffness(chamber, y)
        c = rig.damping(chamber, y, v)
        self._square = max(k / m, gains.surface_bandwidth * gains.surface_bandwidth)
        self._decay = max(2.0 * gains.surface_damping * sqrt(self._square), c / m)
        if velocity is None or not gains.use_measured_velocity:
            velocity = observer.velocity
        self._error, self._error_rate = y - observer.position, v - velocity

        losses = self._losses.force
        lost = self._losses.follow(dt, reference, chamber, self._foreseen)
        rate = k * v + c * a + m * jerk + (lost - losses) / dt
        learned = learned_rate = 0.0
        if gains.learning:
            learned, learned_rate = self._learner.feed_forward(dt, reference)
            if not self._path.is_lag_declared:
                self._path.chamber.fill, self._path.chamber.vent = self._learner.lag
        self._lost = lost + learned
        self._foreseen = m * a + rig.weight + c * v
        shaping = (self._decay * m - c) * self._error_rate + (self._square * m - k) * self._error

        switching = self._switching(dt)
        taken = -observer.disturbance if gains.observer else -self._offset
        terms.reference, terms.speed = y, v
        terms.position, terms.velocity = observer.position, velocity
        terms.error = self._error
        terms.equivalent = self._foreseen + lost + shaping
        terms.switching, terms.observer, terms.learned = switching, taken, learned
        terms.bandwidth = self._bandwidth
        return terms.equivalent + switching + taken + learned, rate + learned_rate

    def _push(self, dt: float, reference: Reference, force: float) -> float:
        """Return the force to apply: pushes where the load sticks and slips, else *force*."""
        stiction, standstill = self._stiction, self._standstill
        if standstill.is_moving:
            stiction.start()
        pushed = None
        if not standstill.is_moving:
            error = reference.position - self._seen
            pushed = stiction.follow(dt, error, force, standstill.stiffness)
        if pushed is not None:
            self._pushed = pushed
            return pushed
        if self._pushed is not None:
            # The law goes on from the force that was pushed with last.
            self._surface.integral += (self._pushed - force) / (self._rig.mass * self._bandwidth)
            force, self._pushed = self._pushed, None
        return force

    def _switching(self, dt: float) -> float:
        """Return the switching force in N; sets the sliding variable."""
        gains, m, surface = self.gains, self._rig.mass, self._surface
        if gains.switching == SUPER_TWISTING:
            term = surface.twist(self._error_rate, dt, *gains.super_twisting(m))
        else:
            term = surface.drive(self._error_rate, self._bandwidth, gains.switching_gain(m))
        self.terms.surface = surface.value
        return m * term

    def _integrate(self, dt: float, force: float, command: float, wanted: float) -> None:
        """Integrate the surface, and watch how the load answers to the wanted *force* in N."""
        standstill, m = self._standstill, self._rig.mass
        spring = self._square * self._error
        if standstill.stiffness > 1.0:
            # A load that sticks: load its contact faster, though not faster than it can be seen.
            most = max(abs(spring), STUCK_RATE / (m * self._bandwidth))
            spring = min(max(spring * standstill.stiffness, -most), most)
        growth = (self._decay * self._error_rate + spring) * dt
        # Anti-windup: at a limit the integral may only lead away from it.
        is_free = command == wanted or growth * (wanted - command) < 0.0
        if is_free and self._pushed is None:
            self._surface.integral += growth
        standstill.see_force(dt, force, self._seen, self._k)
        self._may_learn = standstill.is_moving and command == wanted

    def _go_on(self, dt: float) -> None:
        """Let all estimates go on by *dt* s under the last command."""
        path = self._path
        mean = path.follow(self._limiter.last, dt)
        self._observer.predict(dt, mean, -self._lost)
        if self.gains.learning:
            pressure, losses = path.chamber.pressure, self._losses.force
            self._learner.go_on(dt, path.inflow, pressure, losses, self._may_learn)
