# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sentence on a long wait of a simulator in lockstep."""

from pam_ros.nodes.sim import lockstep
from pam_ros.nodes.sim.lockstep import Turns


def test_a_long_wait_is_reported_until_all_muscles_are_commanded(monkeypatch):
    monkeypatch.setattr(lockstep, 'PATIENCE', 0)
    turns = Turns(None, 2)
    assert turns.complaint.endswith('s so far: no node publishes commands')
    turns.take(0)
    assert turns.complaint
    turns.take(1)
    assert turns.complaint == ''
    turns.begin()
    assert turns.complaint


def test_a_short_wait_is_not_reported():
    assert Turns(None, 1).complaint == ''
