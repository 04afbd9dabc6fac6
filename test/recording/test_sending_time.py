# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Times of sending on the clock of the recorder: delays, lost messages, clocks that are set."""

import numpy as np
import pytest

from pam_ros.recording.sending_time import LIMIT, WINDOW, SendingTime

US, MS, SECOND = 10**3, 10**6, 10**9
START = 10**18
LEAST = 80 * US  # delay of transmission


def times_of(sent, received, together=1):
    """Return the times of messages of which so many are taken *together*."""
    time = SendingTime()
    pairs = list(zip(map(int, sent), map(int, received), strict=True))
    batches = [pairs[i : i + together] for i in range(0, len(pairs), together)]
    return np.array([one for batch in batches for one in time.of(batch)])


def sent_at(rate=500, duration=30.0):
    return START + np.arange(round(rate * duration)) * (SECOND // rate)


@pytest.mark.parametrize('difference', [0, 3600 * SECOND, -3600 * SECOND])
def test_delays_are_not_in_the_times_whatever_the_clocks_differ_by(difference):
    sent = sent_at()
    rng = np.random.default_rng(1)
    delay = LEAST + rng.exponential(300 * US, sent.size).astype(int)
    times = times_of(sent, sent + difference + delay)
    late = times - (sent + difference)
    assert late[500:].max() < LEAST + 30 * US
    assert (times <= sent + difference + delay).all()
    assert (np.diff(times) >= 0).all()


def test_a_message_that_was_sent_again_keeps_its_time():
    """As with Fast DDS 3: those after it have their own time of receipt, which is earlier."""
    sent = sent_at()
    received = sent + LEAST
    received[4000] += 3 * SECOND
    received[6000:6100] = received[6100]
    assert (times_of(sent, received) == sent + LEAST).all()


def test_a_recorder_that_was_stopped_has_the_times_of_sending():
    sent = sent_at()
    received = sent + LEAST
    stopped = slice(5000, 5900)
    received[stopped] = received[5900]
    assert (times_of(sent, received) == sent + LEAST).all()


@pytest.mark.parametrize('drift', [50e-6, -50e-6])
def test_clocks_that_drift_differ_by_a_millisecond_at_most(drift):
    sent = sent_at(100, 600.0)
    exact = sent + (drift * (sent - START)).astype(int) + LEAST
    assert np.abs(times_of(sent, exact) - exact).max() <= 2 * WINDOW * abs(drift)


def test_a_publisher_whose_clock_is_set_begins_anew_with_the_time_of_receipt():
    real = sent_at()
    for step in (-2 * SECOND, 2 * SECOND, -3600 * SECOND, 3600 * SECOND):
        sent = real + np.where(np.arange(real.size) < 7000, 0, step)
        assert (times_of(sent, real + LEAST) == real + LEAST).all(), step


def test_a_clock_of_the_recorder_that_is_set_is_followed():
    sent = sent_at()
    received = sent + LEAST - np.where(np.arange(sent.size) < 7000, 0, LIMIT + MS)
    assert (times_of(sent, received) == received).all()


def test_a_first_message_that_was_sent_again_has_its_time_by_those_after_it():
    sent = sent_at()
    received = sent + LEAST
    received[0] += 2 * SECOND
    assert (times_of(sent, received, together=1001) == sent + LEAST).all()


def test_times_are_in_the_order_of_sending_when_receipts_are_not():
    """The first messages are taken late; those after a lost one had arrived without a delay."""
    sent = sent_at(10_000, 1.0)
    received = sent + LEAST
    received[:300] = received[300]
    for together in (1, 100, 1000):
        times = times_of(sent, received, together)
        assert (np.diff(times) >= 0).all()
        assert (times[600:] == received[600:]).all()
        assert (times <= received).all()


def test_the_first_message_has_the_time_of_its_receipt():
    assert SendingTime().of([(START, START + 7 * SECOND)]) == [START + 7 * SECOND]


def test_no_messages_have_no_times():
    assert SendingTime().of([]) == []
