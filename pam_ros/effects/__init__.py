# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The library of effects that the paper's model lacks: one line each, in the order they act."""

from pam_ros.effects import viscous_friction
from pam_ros.effects.base import Effect

EFFECTS: tuple[Effect, ...] = (viscous_friction.EFFECT,)

__all__ = ['EFFECTS', 'Effect']
