# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A plugin of pytest: a test that passes without one executed assertion has failed.

Executed means: an ``assert`` statement that was reached, a check of ``numpy.testing``, or one of
``pytest.raises``, ``pytest.warns`` and :func:`no_error`. Helpers in ``test/support`` and
``test/truth`` count as the test does that calls them, assertions in other processes do not.

Examples of pages are not functions of pytest, and are compared by what they print.
"""

import functools
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from _pytest.assertion import rewrite

executed = pytest.StashKey[int]()
_running = None  # the test that runs now


def _note():
    if _running is not None:
        _running.stash[executed] = _running.stash.get(executed, 0) + 1


def _noted(check):
    """Return *check* which notes that it was called."""

    @functools.wraps(check)
    def called(*args, **kwargs):
        _note()
        return check(*args, **kwargs)

    return called


@contextmanager
def no_error() -> Iterator[None]:
    """State that what is within raises nothing, where that is all that a test asks."""
    yield
    _note()


def _assertion_has_passed():
    """Note an ``assert``; return False, so that pytest does not explain why it has passed.

    The explanation of two long lists that are equal, one of integers, would take half an hour.
    """
    _note()
    return False


def pytest_configure():
    """Have each check note that it is called, before any test imports those that are functions.

    What ``assert`` calls when it has passed needs ``enable_assertion_pass_hook`` in the settings
    of pytest. The public hook for it gets the explanation in any case.
    """
    rewrite._check_if_assertion_pass_impl = _assertion_has_passed
    for name in dir(np.testing):
        if name.startswith('assert_'):
            setattr(np.testing, name, _noted(getattr(np.testing, name)))
    for name in ('raises', 'warns'):
        setattr(pytest, name, _noted(getattr(pytest, name)))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Remember which test runs."""
    global _running  # noqa: PLW0603 -- hooks of pytest have no object of ours
    _running = item
    try:
        return (yield)
    finally:
        _running = None


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """Fail a test that has passed without an assertion."""
    result = yield
    if isinstance(item, pytest.Function) and not item.stash.get(executed, 0):
        pytest.fail('it has passed, but executed no assertion: it cannot fail', pytrace=False)
    return result
