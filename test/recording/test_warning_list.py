# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A warning that several recordings have appears once, with their names or their number."""

import numpy as np
import pytest

from pam_ros.recording.recording import Recording
from pam_ros.recording.warning_list import warning_list


def recording(name, *warnings):
    return Recording(name, np.linspace(0.0, 1.0, 5), warnings=warnings)


def test_warnings_of_different_recordings_keep_their_order():
    found = warning_list(
        [recording('a', 'short', 'coarse'), recording('b'), recording('c', 'slow')]
    )
    assert found == [('a', 'short'), ('a', 'coarse'), ('c', 'slow')]


@pytest.mark.parametrize(
    ('names', 'listed'),
    [
        ('ab', 'a, b'),
        ('abc', 'a, b, c'),
        ('abcd', 'a, b and 2 more'),
        ('abcdefghijklm', 'a, b and 11 more'),
    ],
)
def test_a_warning_of_several_recordings_appears_once(names, listed):
    some = [recording(name, 'poor excitation', f'only of {name}') for name in names]
    found = warning_list(some)
    assert found[0] == (listed, 'poor excitation')
    assert found[1:] == [(name, f'only of {name}') for name in names]


def test_a_recording_that_has_a_warning_twice_is_named_once():
    assert warning_list([recording('a', 'gap', 'gap')]) == [('a', 'gap')]
