# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The share of the feedback gains: lower for a loop that oscillates, and for nothing else.

The loops are those of a mass on a spring with a damper (equations of their own), with feedback
that is a second spring and a damper, measured with a delay, and scaled by the share.
"""

import math
from collections import deque
from itertools import pairwise

import numpy as np
import pytest

from pam_ros.control.rest.gain_reduction import Cause, GainReduction, ReductionTuning
from pam_ros.control.rest.oscillation import OscillationTuning

DT, LEAST, BANDWIDTH = 2e-3, 40e-6, 20.0
TUNING = ReductionTuning()
QUICKEST = OscillationTuning().quickest
QUICK, SLOW = 1.3 * BANDWIDTH, 0.7 * BANDWIDTH  # rad/s of an error


def calm(t):
    return 0.0


def sine(frequency, amplitude=1e-3):
    return lambda t: amplitude * math.sin(frequency * t)


def reduction():
    return GainReduction(TUNING)


def see(it, error, seconds, speed=calm, **more):
    """Let *it* see an *error* (s -> m) and the *speed* of the reference; return all shares."""
    shares = []
    for n in range(round(seconds / DT)):
        it.see(DT, error(n * DT), speed(n * DT), LEAST, BANDWIDTH, **more)
        shares.append(it.share)
    return shares


class Loop:
    """A mass of 1 kg on a spring, whose natural frequency is BANDWIDTH, with delayed feedback."""

    def __init__(self, delay, damping=0.1, gain=1.0):
        """Rest 1 mm away from the reference; *gain* is that of the feedback to the spring."""
        self.it, self._gain = reduction(), gain
        self._damping = 2.0 * damping * BANDWIDTH
        self._seen = deque([(1e-3, 0.0)] * (round(delay / DT) + 1))
        self._e, self._v, self._t = 1e-3, 0.0, 0.0

    def run(self, seconds, force=calm):
        """Return the errors and the shares of some *seconds* under a *force* in N (s -> N)."""
        rows = []
        for _ in range(round(seconds / DT)):
            e, v = self._seen[0]
            own = self.it.share * self._gain * (BANDWIDTH**2 * e + 1.2 * BANDWIDTH * v)
            for _ in range(20):
                push = force(self._t) - own - self._damping * self._v - BANDWIDTH**2 * self._e
                self._v += DT / 20 * push
                self._e += DT / 20 * self._v
                self._t += DT / 20
            self._seen.popleft()
            self._seen.append((self._e, self._v))
            self.it.see(DT, self._e, 0.0, LEAST, BANDWIDTH)
            rows.append((self._e, self.it.share))
        return np.array(rows).T

    def held(self, seconds, force, share):
        """Return half of the range of the errors of the last 2 s with a constant *share*."""
        self.it.see = lambda *seen: setattr(self.it, 'share', share)
        errors, _ = self.run(seconds, force)
        return 0.5 * np.ptp(errors[-1000:])


def shaking(ratio, size=0.4):
    """Return a force in N at a *ratio* of the bandwidth."""
    return lambda t: size * math.sin(ratio * BANDWIDTH * t)


@pytest.mark.parametrize('delay', [0.05, 0.08, 0.12])
@pytest.mark.parametrize('damping', [0.1, 0.2])
def test_a_loop_that_a_delay_makes_unstable_comes_to_rest(delay, damping):
    assert Loop(delay, damping).held(4.0, calm, 1.0) > 5e-3
    errors, shares = Loop(delay, damping).run(12.0)
    assert np.max(np.abs(errors)) < 0.05
    assert np.max(np.abs(errors[-1000:])) < 2.0 * LEAST
    # It keeps what the loop allows.
    assert TUNING.least <= shares[-1] <= TUNING.lower + 12.0 * TUNING.forget
    assert all(b >= a for a, b in pairwise(shares[-1000:]))


def test_without_a_delay_the_gains_are_kept():
    errors, shares = Loop(0.0).run(5.0)
    assert set(shares) == {1.0}
    assert abs(errors[-1]) < 1e-6


@pytest.mark.parametrize('ratio', [1.0, 1.15, 1.3])
def test_a_force_that_the_feedback_reduces_leaves_the_gains_as_they_are(ratio):
    force = shaking(ratio)
    loop = Loop(0.002, damping=0.1, gain=2.0)
    errors, shares = loop.run(30.0, force)
    alone = Loop(0.002, damping=0.1, gain=2.0).held(10.0, force, 0.0)
    assert min(shares) == TUNING.least  # the test
    # Back after it, and no second test.
    later = shares[3000:]
    assert min(later) == 1.0
    assert 0.5 * np.ptp(errors[-1000:]) < 0.6 * alone


def test_a_force_whose_motion_the_feedback_makes_larger_lowers_it_while_it_lasts():
    force = shaking(1.3, 2.0)
    loop = Loop(0.03, gain=0.3)
    errors, shares = loop.run(20.0, force)
    alone = Loop(0.03, gain=0.3).held(10.0, force, 0.0)
    with_all = Loop(0.03, gain=0.3).held(10.0, force, 1.0)
    assert with_all > 1.5 * alone
    assert shares[-1] <= TUNING.lower
    assert 0.5 * np.ptp(errors[-1000:]) < 1.2 * alone
    shares = loop.run(5.0)[1]
    assert shares[-1] == 1.0


@pytest.mark.parametrize('delay', [0.05, 0.08])
def test_a_delay_is_found_behind_a_force(delay):
    """The share that this delay allows is used while the force lasts, and afterwards."""
    loop = Loop(delay, damping=0.1)
    errors, _ = loop.run(20.0, shaking(1.1))
    assert np.max(np.abs(errors)) < 0.05
    errors, shares = loop.run(15.0)
    assert np.max(np.abs(errors[-1000:])) < 4.0 * LEAST
    assert shares[-1] < 0.8


def test_it_says_when_the_loop_was_the_cause():
    loop, said = Loop(0.08), []
    original = loop.it.see
    loop.it.see = lambda *seen: said.append((original(*seen), loop.it.share))
    loop.run(10.0)
    causes = [cause for cause, _ in said if cause is not None]
    assert causes
    assert set(causes) == {Cause.SHARE}
    # The share was that of the test, and is the lower one from now on.
    n = next(n for n, (cause, _) in enumerate(said) if cause is not None)
    assert said[n - 1][1] == TUNING.least
    assert said[n][1] == pytest.approx(TUNING.lower)


def test_while_disturbances_are_rejected_it_names_their_level_and_keeps_the_share():
    it, causes = reduction(), []
    for n in range(round(3.0 / DT)):
        error = sine(QUICK)(n * DT)
        causes.append(it.see(DT, error, 0.0, LEAST, BANDWIDTH, suspect=Cause.LEVEL))
        assert it.share == 1.0
    assert causes.count(Cause.LEVEL) > 3
    assert Cause.SHARE not in causes


def test_there_is_no_quiet_in_a_test_and_while_swings_rise():
    it = reduction()
    see(it, calm, 1.0)
    assert it.quiet == pytest.approx(1.0)
    see(it, sine(QUICK), 0.6)
    assert it.share == TUNING.least
    assert it.quiet == 0.0
    it = reduction()
    see(it, lambda t: 1e-3 * math.exp(0.5 * t) * math.sin(SLOW * t), 3.0)
    assert it.quiet == 0.0


def test_a_load_that_bounces_on_a_stop_is_quicker_than_the_loop():
    assert min(see(reduction(), sine(0.9 * QUICKEST * BANDWIDTH), 5.0)) < 1.0
    assert set(see(reduction(), sine(1.2 * QUICKEST * BANDWIDTH), 5.0)) == {1.0}


def test_a_slow_error_and_noise_change_nothing():
    assert set(see(reduction(), sine(SLOW), 20.0)) == {1.0}
    assert set(see(reduction(), sine(QUICK, 0.9 * LEAST), 20.0)) == {1.0}


@pytest.mark.parametrize(('size', 'is_found'), [(0.9, False), (1.1, True)])
def test_swings_smaller_than_the_motion_of_the_reference_are_none(size, is_found):
    """The error swings by *size* times the distance of the reference in half a period."""
    speed = 0.02  # m/s
    swing = size * speed * math.pi / BANDWIDTH
    shares = see(reduction(), sine(QUICK, 0.5 * swing), 5.0, lambda t: speed)
    assert (min(shares) < 1.0) == is_found


def test_the_speed_of_the_reference_is_remembered_for_a_period():
    """A reference that comes to rest leaves an error that has followed it."""
    swing = 0.5 * 0.02 * math.pi / BANDWIDTH
    shares = see(reduction(), sine(QUICK, 0.5 * swing), 2.0, lambda t: 0.02 if t < 0.5 else 0.0)
    first = next(n for n, share in enumerate(shares) if share < 1.0) * DT
    forgotten = 0.5 + TUNING.memory * math.log(2.0)  # until the swing is large enough
    assert forgotten < first < forgotten + 4.0 * math.pi / QUICK


def test_after_an_oscillation_the_share_rises_slowly():
    loop = Loop(0.05)
    before = loop.run(10.0)[1][-1]
    assert before < 1.0
    later = see(loop.it, calm, 20.0)
    assert later[-1] == pytest.approx(before + 20.0 * TUNING.forget, rel=1e-3)
    assert see(loop.it, calm, 1.0 / TUNING.forget)[-1] == 1.0


def test_a_start_keeps_the_share_and_other_gains_do_not():
    loop = Loop(0.08)
    kept = loop.run(10.0)[1][-1]
    assert kept < 1.0
    loop.it.start()
    assert loop.it.share == pytest.approx(kept)
    loop.it.reset()
    assert set(see(loop.it, calm, 1.0)) == {1.0}


def test_a_start_ends_a_test():
    it = reduction()
    see(it, sine(QUICK), 0.6)
    assert it.share == TUNING.least
    it.start()
    assert it.share == 1.0
    assert set(see(it, calm, 5.0)) == {1.0}
