# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A long task is announced once, and a short one is not."""

from threading import Event

import pytest

from pam_ros.processes.notice import notice


def test_a_long_task_is_announced_while_it_runs():
    announced = Event()
    with notice(0.01, announced.set):
        assert announced.wait(60.0)


def test_a_short_task_is_not_announced():
    announced = Event()
    with notice(0.2, announced.set):
        pass
    assert not announced.wait(0.4)


def test_nor_is_what_fails():
    announced = Event()
    with pytest.raises(ZeroDivisionError), notice(0.2, announced.set):
        raise ZeroDivisionError
    assert not announced.wait(0.4)
