# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The threads of an identification: what happens in the others if a call fails in one of them."""

import threading
import time

import pytest

from pam_ros.identification import workers
from pam_ros.identification.workers import Workers


@pytest.fixture(autouse=True)
def two_threads(monkeypatch):
    monkeypatch.setattr(workers.os, 'cpu_count', lambda: 2)


def test_results_are_in_the_order_of_the_arguments():
    with Workers(lambda: None) as pool:
        found = list(pool.map(lambda a, b: time.sleep(0.05 / a) or a - b, [1, 2, 3], [1, 1, 1]))
        assert list(pool.map(abs, [])) == []
    assert found == [0, 1, 2]


def test_the_caller_is_updated_in_its_own_thread_while_it_waits(monkeypatch):
    monkeypatch.setattr(workers, 'PAUSE', 0.02)
    threads = []
    with Workers(lambda: threads.append(threading.current_thread())) as pool:
        list(pool.map(time.sleep, [0.2]))
    assert len(threads) >= 3
    assert set(threads) == {threading.current_thread()}


def test_after_a_failure_nothing_continues_in_the_background():
    """The calls that run end before the exception is raised, and none begins afterwards."""
    began, ended = [], []
    both = threading.Barrier(2)

    def call(n):
        began.append(n)
        if n < 2:
            both.wait(10.0)
        if n == 0:
            raise ValueError('failed')
        time.sleep(0.2)
        ended.append(n)

    with Workers(lambda: None) as pool:
        with pytest.raises(ValueError, match='failed'):
            pool.map(call, range(20))
        assert {*began} == {0, *ended} >= {0, 1}
        count = len(began)
        assert list(pool.map(abs, [-1])) == [1]
    assert len(began) == count <= 3
