# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What takes long is told of once, and what does not is not."""

from threading import Event

import pytest

from pam_ros.processes.notice import notice


def test_what_takes_long_is_told_of_while_it_lasts():
    told = Event()
    with notice(0.01, told.set):
        assert told.wait(60.0)


def test_what_ends_before_is_not_told_of():
    told = Event()
    with notice(0.2, told.set):
        pass
    assert not told.wait(0.4)


def test_nor_is_what_fails():
    told = Event()
    with pytest.raises(ZeroDivisionError), notice(0.2, told.set):
        raise ZeroDivisionError
    assert not told.wait(0.4)
