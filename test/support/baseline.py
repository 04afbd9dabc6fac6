# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The PID law as a parameter of tests, which are skipped where simple-pid is not installed."""

import importlib.util

import pytest

from pam_ros.control.pid import Pid

needs_simple_pid = pytest.mark.skipif(
    importlib.util.find_spec('simple_pid') is None, reason='the PID law needs simple-pid'
)


def pid(*more):
    """Return the PID law and *more* values of the same set of parameters."""
    return pytest.param(Pid, *more, marks=needs_simple_pid)
