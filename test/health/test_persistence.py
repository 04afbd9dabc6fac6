# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which conditions last."""

from pam_ros.health.persistence import Persistence


def looks(persistence, found):
    return [(persistence.look(one == '1'), persistence.lasts) for one in found]


def test_a_condition_lasts_from_the_looks_in_a_row_that_find_it():
    begins, lasts = zip(*looks(Persistence(3, 2), '110111011001'), strict=True)
    assert begins == tuple(i == 5 for i in range(12))
    assert lasts == tuple(5 <= i < 10 for i in range(12))


def test_it_begins_again_after_it_has_ended():
    begins, _ = zip(*looks(Persistence(2, 1), '110110111'), strict=True)
    assert [i for i, one in enumerate(begins) if one] == [1, 4, 7]


def test_nothing_lasts_after_it_is_cleared():
    persistence = Persistence(2, 2)
    looks(persistence, '111')
    persistence.clear()
    assert not persistence.lasts
    assert looks(persistence, '11') == [(False, False), (True, True)]
