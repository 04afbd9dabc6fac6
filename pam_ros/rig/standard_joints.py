# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The two usual joints in one call: one muscle that lifts a mass, two muscles on a pulley."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from pam_ros.arguments import one_each
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Effect
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.effect_values import library_of, split_effects
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.transmissions import Pulley, Straight


def single_muscle_joint(
    muscle: Muscle | None = None,
    load: Mass | None = None,
    effects: Sequence[Effect] = (),
    library: Sequence[type[Effect]] | None = None,
) -> Joint:
    """Return one muscle on a mass, the paper's rig, with *effects* in the muscle and on the mass.

    None stands for the default: ``Muscle()``, ``Mass()``, and EFFECTS as the library.
    Raises ParameterError as Joint does.
    """
    in_muscle, on_joint = split_effects(effects)
    return Joint(
        (Actuator(Muscle() if muscle is None else muscle, in_muscle),),
        Mass() if load is None else load,
        Straight(),
        on_joint,
        library_of(EFFECTS if library is None else library),
    )


def antagonistic_joint(
    muscle: Muscle | None = None,
    antagonist: Muscle | None = None,
    *,
    radius: float = 0.04,
    load: Arm | None = None,
    contraction: ArrayLike = 0.1,
    effects: Sequence[Effect] = (),
    library: Sequence[type[Effect]] | None = None,
) -> Joint:
    """Return two antagonistic muscles on a pulley of *radius* m.

    *muscle* turns the pulley in the positive direction, *antagonist* in the negative one (default:
    the same as *muscle*). *contraction* is that of the muscles at angle 0 as a fraction, one
    number for both or (2,). *load* is the load on the pulley (default: ``Arm()``). Of *effects*,
    those of a muscle are in both muscles, and those of a load on the joint; for muscles with
    different effects create a ``Joint`` of two ``Actuator``. Raises ParameterError as Joint does.
    """
    in_muscle, on_joint = split_effects(effects)
    first = Muscle() if muscle is None else muscle
    muscles = (first, first if antagonist is None else antagonist)
    at_zero = one_each('contraction', contraction, 2, 'muscle').tolist()
    return Joint(
        tuple(
            Actuator(each, in_muscle, share) for each, share in zip(muscles, at_zero, strict=True)
        ),
        Arm() if load is None else load,
        Pulley(radius=radius),
        on_joint,
        library_of(EFFECTS if library is None else library),
    )
