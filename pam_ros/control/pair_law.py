# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sliding-mode law for an antagonistic pair: an angle, and a stiffness beside it.

The joint, with G the torque of gravity and d what is not known of it:

    J theta'' = tau(p, theta) - c theta' - G(theta) + d

The error e = r - theta shall obey e'' + 2 z w e' + w^2 e = 0, and the wanted torque is that of
:mod:`pam_ros.control.sliding_mode`, with torques in place of forces:

    tau = J r'' + G(r) + c r' + losses          equivalent control, model along the reference
        + (2 z w J - c) e' + (w^2 J - K) e      the rest of it
        + k J sat(s / Phi)                      switching, or super-twisting
        - d^                                    disturbance observer
    s = e' + int (2 z w e' + w^2 e) dt

Torque and stiffness are both affine in the pressures, so that the torque and the wanted stiffness
together are two linear equations for them (:mod:`pam_ros.rig.pair`), solved **at the reference**:
the joint's own spring, K = r^2 (k_1 + k_2) and that of gravity, then pulls the load to it without
noise and without lag, which -K e above takes account of. Co-contraction is so the common mode of
the two pressures, and does not move the angle. Where the limits of pressure leave not both, the
torque comes first; where they leave not the torque, the integral stops.

Sources: as in :mod:`pam_ros.control.sliding_mode`; angle and stiffness of a pair controlled apart
after Tondu & Lopez, IEEE Control Systems Magazine 20 (2), 2000.
"""

from collections.abc import Iterable
from math import sqrt

from pam_ros.control.co_contraction import CoContraction, StiffnessCourse
from pam_ros.control.gains import SUPER_TWISTING
from pam_ros.control.limits import Limiter, Limits
from pam_ros.control.observer import Observer
from pam_ros.control.pair_gains import PairGains
from pam_ros.control.pair_losses import PairLosses
from pam_ros.control.pair_model import PairModel
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.signals import PairTerms, Reference
from pam_ros.control.standstill import Standstill
from pam_ros.control.switching import Surface
from pam_ros.rig.joint_model import JointModel

REST_SPEED, REST_ACCELERATION = 1e-3, 1e-2  # rad/s, rad/s^2 below which a reference rests

Both = tuple[float, float]


def _both(values: Iterable[float]) -> Both:
    one, two = values
    return one, two


class PairLaw:
    """The law for two muscles against each other; ``terms`` holds what its last step found."""

    def __init__(
        self,
        model: JointModel,
        gains: PairGains,
        limits: Limits | None = None,
        co_contraction: CoContraction | None = None,
    ) -> None:
        """Make it for a declared joint, at rest at 0 rad; see :meth:`start`."""
        limits = limits or Limits()
        told = co_contraction or CoContraction()
        self.model, self.gains = model, gains
        self.rig = rig = PairModel(model, limits)
        self.terms = PairTerms()
        self._limiters = [Limiter(*range_, limits.pressure_rate) for range_ in rig.ranges]
        self._paths = [PressurePath(muscle, gains.pressure_time) for muscle in rig.muscles]
        self._losses = PairLosses(rig)
        self._observer = Observer(rig)
        self._standstill = Standstill(gains.rest_tolerance)
        self._surface = Surface()
        self._stiffness = StiffnessCourse(told.wanted(rig), told.co_contraction_rate)
        self.start(0.5 * (rig.reach[0] + rig.reach[1]))

    def set_gains(self, gains: PairGains) -> None:
        """Go on from the present state with other gains."""
        self.gains = gains
        self._standstill.tolerance = gains.rest_tolerance
        for path in self._paths:
            path.quickest = gains.pressure_time

    def set_co_contraction(self, told: CoContraction) -> None:
        """Go on to another stiffness, or at another rate; raises RangeError out of reach."""
        self._stiffness.tell(told.wanted(self.rig))
        self._stiffness.rate = told.co_contraction_rate

    def stiffen(self, stiffness: float) -> None:
        """Take a stiffness in N m/rad; raises RangeError where it cannot be had at the reference.

        On the way to other angles it is kept as nearly as the limits of pressure leave it.
        """
        self.rig.refuse_stiffness(stiffness, self.terms.reference)
        self._stiffness.tell(stiffness)

    def start(self, position: float, pressure: Both | None = None) -> None:
        """Begin anew at *position* rad.

        Where the pressures are not known, it is taken that the load rests as the model says, with
        the stiffness that was told.
        """
        rig = self.rig
        if pressure is None:
            goal = self._stiffness.goal
            chambers = rig.split(rig.gravity(position), goal, position).pressures
            pressure = _both(
                path.command_at_rest(p) for path, p in zip(self._paths, chambers, strict=True)
            )
        for limiter, path, p in zip(self._limiters, self._paths, pressure, strict=True):
            limiter.start(p)
            path.start(limiter.last)
        chambers = self._chambers
        self._stiffness.start(rig.stiffness(chambers, position))
        disturbance = rig.gravity(position) - rig.effort(chambers, position)
        self._observer.start(position, disturbance)
        self._losses.start(position, chambers)
        self._standstill.start()
        self._surface.start()
        self._waited = 0.0  # since the last measurement, s
        self._offset = 0.0 if self.gains.observer else disturbance
        self._lost = 0.0
        self._foreseen: Both | None = None  # pressures of the last step, Pa
        self.terms = PairTerms(reference=position, position=position)
        self._note(self._commands)

    @property
    def _chambers(self) -> Both:
        return self._paths[0].chamber.pressure, self._paths[1].chamber.pressure

    @property
    def _commands(self) -> Both:
        return self._limiters[0].last, self._limiters[1].last

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> Both:
        """Return the gauge pressures in Pa to command from now on, *dt* s after the last call.

        Otherwise as :meth:`pam_ros.control.signals.PositionLaw.update` says, rad for m.
        """
        self._go_on(dt)
        moves = (
            abs(reference.velocity) > REST_SPEED or abs(reference.acceleration) > REST_ACCELERATION
        )
        self._take_in(dt, reference, position, age, moves)
        torque, foreseen = self._wanted_torque(dt, reference, velocity)
        stiffness = self._stiffness.stiffness
        wanted = self.rig.split(torque, stiffness, reference.position)
        ahead = self.rig.split(foreseen, stiffness, reference.position).pressures
        before, self._foreseen = self._foreseen or ahead, ahead
        lines = self.rig.lines(reference.position)
        cut, commands = wanted.short, []
        for i, (path, limiter) in enumerate(zip(self._paths, self._limiters, strict=True)):
            rate = (ahead[i] - before[i]) / dt
            asked = path.command_for(wanted.pressures[i], rate)
            commands.append(limiter.limit(asked, dt))
            cut += lines[i].b * (asked - commands[i])
        self.terms.cut = cut
        self._integrate(dt, cut)
        self._note(_both(commands))
        return self.terms.pressures

    def _note(self, commands: Both) -> None:
        """Put the pressures and what they make of the stiffness into the terms."""
        terms = self.terms
        terms.pressures = commands
        terms.pressure = 0.5 * (commands[0] + commands[1])
        terms.co_contraction = self._stiffness.stiffness
        terms.stiffness = self.rig.stiffness(self._chambers, terms.position)

    def _go_on(self, dt: float) -> None:
        """Let all estimates go on by *dt* s under the last commands."""
        mean = _both(
            path.follow(limiter.last, dt)
            for path, limiter in zip(self._paths, self._limiters, strict=True)
        )
        self._observer.predict(dt, mean, -self._lost)
        self._stiffness.follow(dt)

    def _take_in(
        self, dt: float, reference: Reference, position: float | None, age: float, moves: bool
    ) -> None:
        """Take in a measurement and find the bandwidths for this step."""
        observer, gains = self._observer, self.gains
        self._waited += dt
        error = reference.position - observer.position
        if position is not None:
            position += observer.velocity * age
            error = reference.position - position
        self._standstill.see_error(dt, error, moves)
        scale = gains.rest_factor + (1.0 - gains.rest_factor) * self._standstill.factor
        self._bandwidth = scale * gains.bandwidth
        if position is not None:
            fast, slow = scale * gains.velocity_bandwidth, scale * gains.observer_bandwidth
            observer.correct(position, self._waited, fast, slow)
            self._waited = 0.0

    def _wanted_torque(
        self, dt: float, reference: Reference, velocity: float | None
    ) -> tuple[float, float]:
        """Return the wanted torque in N m, and its part that is foreseen."""
        rig, gains, observer, terms = self.rig, self.gains, self._observer, self.terms
        inertia, chambers = rig.mass, self._chambers
        y, v, a, _ = reference
        k = rig.stiffness(chambers, y) + rig.gravity_stiffness(y)
        c = rig.damping(chambers, y, v)
        self._square = max(k / inertia, gains.surface_bandwidth * gains.surface_bandwidth)
        self._decay = max(2.0 * gains.surface_damping * sqrt(self._square), c / inertia)
        if velocity is None or not gains.use_measured_velocity:
            velocity = observer.velocity
        self._error, self._error_rate = y - observer.position, v - velocity

        self._lost = self._losses.follow(dt, reference, chambers)
        foreseen = inertia * a + rig.gravity(y) + c * v + self._lost
        shaping = (self._decay * inertia - c) * self._error_rate
        shaping += (self._square * inertia - k) * self._error
        switching = self._switching(dt)
        taken = -observer.disturbance if gains.observer else -self._offset
        terms.reference, terms.speed = y, v
        terms.position, terms.velocity = observer.position, velocity
        terms.error = self._error
        terms.equivalent = foreseen + shaping
        terms.switching, terms.observer = switching, taken
        terms.bandwidth = self._bandwidth
        return terms.equivalent + switching + taken, foreseen

    def _switching(self, dt: float) -> float:
        """Return the switching torque in N m; sets the sliding variable."""
        gains, inertia, surface = self.gains, self.rig.mass, self._surface
        if gains.switching == SUPER_TWISTING:
            term = surface.twist(self._error_rate, dt, *gains.super_twisting(inertia))
        else:
            term = surface.drive(self._error_rate, self._bandwidth, gains.switching_gain(inertia))
        self.terms.surface = surface.value
        return inertia * term

    def _integrate(self, dt: float, cut: float) -> None:
        """Integrate the surface; at a limit, only away from it (anti-windup)."""
        growth = (self._decay * self._error_rate + self._square * self._error) * dt
        if growth * cut <= 0.0:
            self._surface.integral += growth
