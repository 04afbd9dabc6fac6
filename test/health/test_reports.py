# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a controller reports of joint states that arrive late."""

import pytest

from pam_ros.control.loop import LATE
from pam_ros.health.reports import Reports


class Silent:
    """A logger of which nothing is expected."""


@pytest.fixture
def reports():
    return Reports(Silent())


def said(reports, punctual, late):
    for seconds in (*(0.5 * LATE for _ in range(punctual)), *late):
        reports.delay(seconds)
    return reports.received(0.01, '').delay


def test_many_late_states_are_told_with_their_number_and_the_latest(reports):
    words = said(reports, 80, [0.05] * 19 + [0.21])
    assert words.startswith('20 of 100 joint_states were late')
    assert 'by up to 0.21 s' in words


def test_they_are_told_once(reports):
    assert said(reports, 80, [0.05] * 20)
    assert not said(reports, 100, [])
    assert not reports.received(0.01, '').delay


def test_all_late_states_are_counted_as_those_of_the_warning():
    reports = Reports(Silent())
    assert said(reports, 8, [0.05] * 2 + [LATE]).startswith('2 of 11 ')
    assert not said(reports, 99, [0.05])
    assert reports.received(0.01, '').late == 3


def test_single_late_states_are_usual(reports):
    assert not said(reports, 95, [0.3] * 5)
