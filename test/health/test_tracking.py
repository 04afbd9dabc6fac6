# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which errors and saturations of a controller are reported."""

from types import SimpleNamespace

import numpy as np
import pytest

from pam_ros.control.loop import BLIND, RUNNING
from pam_ros.control.plausibility import MotionBounds
from pam_ros.control.signals import Terms
from pam_ros.health.tracking import Tracking

DT = 0.01
TRAVEL = 0.12  # m; an error is large above a tenth of it
BOUNDS = MotionBounds(0.0, TRAVEL, 10.0, TRAVEL / 200.0, 'm')


class Motion:
    """A loop whose errors and saturations are given."""

    def __init__(self):
        terms = Terms()
        self.tracking, self.terms, self.warnings = Tracking(), terms, []
        self.loop = SimpleNamespace(
            state=RUNNING,
            starts=1,
            time=5.0,
            law=SimpleNamespace(terms=terms),
            plausibility=SimpleNamespace(bounds=BOUNDS),
        )

    def run(self, seconds, error, cut=lambda t: 0.0):
        """Go on for so long; return the warnings of all steps."""
        warnings = []
        for t in np.arange(0.0, seconds, DT):
            self.terms.error, self.terms.cut = float(error(t)), float(cut(t))
            self.loop.time += DT
            self.tracking.record(self.loop)
            warnings.append(self.tracking.warning)
        return warnings


def constant(value):
    return lambda t: value


@pytest.mark.parametrize(
    'error',
    [
        constant(-44.0),
        constant(0.013),
        lambda t: 0.03 * np.sin(2.0 * np.pi * t / 1.3),
        lambda t: 0.02 + 0.001 * t,
    ],
    ids=['constant', 'just_too_large', 'oscillation', 'growing'],
)
def test_a_large_error_that_lasts_is_reported(error):
    motion = Motion()
    warnings = motion.run(6.0, error)
    assert not any(warnings[: int(2.9 / DT)])
    assert all(warnings[int(3.1 / DT) :])
    assert 'the error is larger than 0.012 m, a tenth of the travel' in warnings[-1]


@pytest.mark.parametrize(
    ('error', 'cut'),
    [
        (constant(0.011), constant(0.0)),
        (lambda t: 0.1 * np.exp(-t / 2.0), lambda t: t < 4.0),
        (lambda t: 0.1 * ((t % 2.0) < 0.2), lambda t: (t % 2.0) < 0.2),
        (constant(0.005), lambda t: (t % 1.5) > 0.05),
        (constant(0.0004), constant(30.0)),
    ],
    ids=['small', 'slow_approach', 'steps', 'saturation_with_breaks', 'saturation_without_error'],
)
def test_a_short_error_or_saturation_is_not_reported(error, cut):
    assert not any(Motion().run(12.0, error, cut))


def test_a_saturation_that_lasts_is_reported_though_the_error_is_not_large():
    warnings = Motion().run(6.0, constant(0.002), constant(-30.0))
    assert not any(warnings[: int(2.9 / DT)])
    assert 'the command is at a limit of pressure for more than 3 s' in warnings[-1]
    assert 'an error of 0.002 m does not shrink' in warnings[-1]


def test_a_warning_does_not_flicker_and_ends():
    motion = Motion()
    motion.run(4.0, constant(0.02))
    assert all(motion.run(2.0, constant(0.0)))
    assert all(motion.run(3.0, constant(0.02)))
    assert not motion.run(5.0, constant(0.0))[-1]


def test_a_new_start_begins_with_nothing():
    motion = Motion()
    motion.run(5.0, constant(0.02))
    motion.loop.starts += 1
    assert not any(motion.run(2.5, constant(0.02)))


def test_only_a_running_loop_counts():
    motion = Motion()
    motion.loop.state = BLIND
    assert not any(motion.run(5.0, constant(0.02)))
