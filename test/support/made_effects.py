# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of tests: of one strength, with functions that a test gives."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations
from pam_ros.effects.parameter import strength


def effect_with(called='made', unit='', treated=Compensation.FEEDBACK, has=(), **functions):
    """Return an effect so *called*, whose strength has a *unit*, with the hidden states *has*."""

    @dataclass(frozen=True)
    class Made(Effect):
        size: float = strength('its size', unit, high=1e3, scale=1.0)

        name: ClassVar = called
        text: ClassVar = 'an effect of a test'
        source: ClassVar = ''
        signature: ClassVar = ''
        experiment: ClassVar = ''
        compensation: ClassVar = treated
        states: ClassVar = has
        equations: ClassVar = EffectEquations(**functions)

        @classmethod
        def fit_starts(cls):
            return ({'size': 1.0},)

        @classmethod
        def example(cls):
            return cls(size=1.0)

    return Made
