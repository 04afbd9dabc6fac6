# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When something that is missing, and that is back, is written to the log."""

import pytest

from pam_ros.health.absence import Absence
from pam_ros.health.health import Level


class Log:
    """A logger that keeps the lines."""

    def __init__(self):
        self.lines = []

    def info(self, line):
        self.lines.append(('info', line))

    def warning(self, line):
        self.lines.append(('warning', line))

    def error(self, line):
        self.lines.append(('error', line))


@pytest.fixture
def log():
    return Log()


def test_a_short_wait_is_not_written(log):
    absence = Absence(log, 'back')
    for now in (0.0, 0.5, 0.9):
        absence.look('missing', now)
    absence.look('', 1.0)
    absence.look('missing', 1.1)
    absence.look('missing', 2.0)
    assert log.lines == []


@pytest.mark.parametrize(
    ('level', 'called'),
    [(Level.OK, 'info'), (Level.WARN, 'warning'), (Level.ERROR, 'error')],
)
def test_a_long_wait_is_written_once_and_its_end_once(log, level, called):
    absence = Absence(log, 'back', level=level)
    for now in range(10):
        absence.look(f'missing since {now} s', float(now))
    assert log.lines == [(called, 'missing since 1 s')]
    for now in range(10, 20):
        absence.look('', float(now))
    assert log.lines == [(called, 'missing since 1 s'), ('info', 'back')]
    absence.look('missing', 20.0)
    absence.look('missing', 21.0)
    assert len(log.lines) == 3


def test_without_patience_it_is_written_at_once(log):
    Absence(log, 'back', 0.0).look('missing', 5.0)
    assert log.lines == [('info', 'missing')]


def test_what_comes_and_goes_is_written_once(log):
    absence = Absence(log, 'back', 0.0)
    for now in range(40):
        absence.look('missing' if now % 4 == 0 else '', float(now), 3.0)
    assert log.lines == [('info', 'missing')]
    for now in range(41, 45):
        absence.look('', float(now), 3.0)
    assert log.lines == [('info', 'missing'), ('info', 'back')]


def test_an_absence_between_two_looks_counts(log):
    absence = Absence(log, 'back', 0.0)
    absence.look('missing', 0.0, 3.0, 1)
    for now in range(1, 20):  # each second one that no look has seen
        absence.look('', float(now), 3.0, now)
    assert log.lines == [('info', 'missing')]
    for now in range(20, 24):
        absence.look('', float(now), 3.0, 19)
    assert log.lines[1:] == [('info', 'back')]


def test_a_time_that_goes_back_begins_the_wait_again(log):
    absence = Absence(log, 'back')
    for now in (100.5, 0.0, 0.5):
        absence.look('missing', now)
    assert log.lines == []
    absence.look('missing', 1.0)
    assert log.lines == [('info', 'missing')]
