# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects as version 0.1.0 described them, as effects of today."""

from collections.abc import Mapping

from pam_ros.effects.base import Effect
from pam_ros.effects.names import EffectName
from pam_ros.rig.effect_values import effects_from
from pam_ros.settings.former_names import renamed
from pam_ros.settings.tables import effects_of


def effects_of_0_1_0(effects: Mapping[str, Mapping[str, float]]) -> tuple[Effect, ...]:
    """Return *effects*, given by the names that files of 0.1.0 have."""
    flat = {
        EffectName(effect, name).flat: value
        for effect, values in effects.items()
        for name, value in values.items()
    }
    return effects_from(effects_of(renamed(flat)[0]))
