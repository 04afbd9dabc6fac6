# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A request of which only a part took effect is noticed, once."""

from pam_ros.health.partial_change import TOGETHER, PartialChange


def test_it_is_said_once_for_a_request_whatever_came_first():
    now = [0.0]
    change = PartialChange(lambda: now[0])
    assert change.accept(['a1']) == ''
    assert change.accept(['a2']) == ''
    said = change.refuse(['a4'])
    assert said.startswith('of one request a1, a2 took effect and a4 did not: ')
    assert '~/set_parameters_atomically' in said
    assert change.refuse(['a5']) == change.accept(['a6']) == ''
    now[0] += 2.0 * TOGETHER  # another request
    assert change.refuse(['a4']) == ''
    assert change.accept(['a1']).startswith('of one request a1 took effect and a4 did not: ')


def test_a_parameter_alone_is_no_mixture():
    now = [0.0]
    change = PartialChange(lambda: now[0])
    # A slider that goes beyond what is allowed, and back.
    assert [change.accept(['mass']), change.refuse(['mass']), change.accept(['mass'])] == [''] * 3
    now[0] += 2.0 * TOGETHER
    assert change.refuse(['zeta']) == ''
