# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The effort that configured effects with a memory take from the joint along the reference.

Friction, hysteresis and creep are fed forward: their equations, which are those of the
simulator, are evaluated along the reference. Since only the reference drives them, they can
neither destabilise the loop nor amplify noise. If the load does not follow the reference, the
difference is part of the disturbance that the observer estimates.
"""

from pam_ros.control.model import ControlModel, Pressures
from pam_ros.control.signals import Reference
from pam_ros.effects.base import Compensation, Effect
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint
from pam_ros.rig.start import start_state

# An effect, and the indices at which its states and its parameters begin in its row.
_Placed = tuple[type[Effect], int, int]


def left_to_feedback(joint: Joint) -> tuple[str, ...]:
    """Return the configured effects for which the controller has no feed-forward."""
    return tuple(
        effect.name for effect in joint.all_present if effect.compensation is Compensation.FEEDBACK
    )


class FeedForwardForces:
    """The effort that configured effects with a feed-forward take along the reference.

    Effects of muscles are evaluated at the muscles' ends, those of the joint at its coordinate.
    """

    def __init__(self, model: ControlModel) -> None:
        """Take those effects that are present in the nominal joint."""
        self._model = model
        joint = model.joint.map_effects(lambda effects: [one.fed_forward() for one in effects])
        self._layout, self._q = joint.layout, joint.parameters()
        self._placed = [
            [
                (
                    effect,
                    self._layout.state_at[effect.name],
                    self._layout.parameter_at[effect.name],
                )
                for effect in row
                if effect.compensation is Compensation.FEED_FORWARD
            ]
            for row in joint.present
        ]
        self._x = self._layout.state()
        self._xn = self._layout.scratch()
        self.effort = 0.0
        self.start(0.0, [0.0] * len(model.muscles))

    def start(self, position: float, pressures: Pressures) -> None:
        """Start again after a long rest at *position*, with *pressures* Pa in the chambers."""
        for _ in range(2):  # the first call may compile the effects, which takes too long later
            self._x = start_state(self._layout, self._q, list(pressures), position, 0.0)
            self._xn[:, : self._layout.width] = self._x
            self.follow(1e-6, Reference(position), pressures)
        self.effort = 0.0

    def follow(self, dt: float, reference: Reference, pressures: Pressures) -> float:
        """Advance by *dt* s to *reference*, chambers at *pressures* Pa; return the effort."""
        if not any(self._placed):
            return 0.0
        s, v = reference.position, reference.velocity
        on_joint, *in_muscles = self._placed
        lost = 0.0
        for i, effects in enumerate(in_muscles):
            if effects:
                muscle = self._model.at(s).muscles[i]
                arm, pull = muscle.arm, muscle.force(pressures[i])
                f = pull
                for effect, k, j in effects:
                    if effect.equations.force is not None:
                        row = at.MUSCLE + i
                        f = effect.equations.force(
                            f, pressures[i], muscle.contraction, arm * v, 0.0, dt,
                            self._x[row], k, self._xn[row], self._q[row], j,
                        )  # fmt: skip
                lost += arm * (pull - f)
        outside = 0.0
        mean = sum(pressures) / len(pressures)
        for effect, k, j in on_joint:
            if effect.equations.outside is not None:
                outside = effect.equations.outside(
                    outside, mean, s, v, 0.0, dt,
                    self._x[at.JOINT], k, self._xn[at.JOINT], self._q[at.JOINT], j,
                )  # fmt: skip
        self._x[:] = self._xn[:, : self._layout.width]
        self.effort = lost - outside
        return self.effort
