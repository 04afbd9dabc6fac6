# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A cached property is computed once, and objects of a class do not wait for each other."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import FrozenInstanceError, dataclass
from threading import Barrier

import pytest

from pam_ros.cached_property import cached_property

PATIENCE = 30.0  # s


@dataclass(frozen=True, eq=False)
class Squared:
    """A frozen object with a property that is expensive to compute."""

    number: float
    log: list

    @cached_property
    def square(self):
        """The square of the number."""
        self.log.append(self.number)
        return self.number**2


def test_it_is_computed_once_for_each_object():
    log = []
    two, three = Squared(2.0, log), Squared(3.0, log)
    assert log == []
    assert [two.square, two.square, three.square, two.square] == [4.0, 4.0, 9.0, 4.0]
    assert log == [2.0, 3.0]


def test_the_class_has_its_description():
    assert Squared.square.__doc__ == 'The square of the number.'


def test_a_frozen_object_remains_frozen():
    two = Squared(2.0, [])
    with pytest.raises(FrozenInstanceError):
        two.square = 5.0
    assert two.square == 4.0


def test_an_error_is_not_stored():
    class Fragile:
        tries = 0

        @cached_property
        def value(self):
            self.tries += 1
            if self.tries == 1:
                raise ValueError('not yet')
            return self.tries

    one = Fragile()
    with pytest.raises(ValueError, match='not yet'):
        _ = one.value
    assert one.value == 2
    assert one.value == 2


def test_threads_compute_it_for_several_objects_at_once():
    # Each waits for the other one inside the property. With a lock of the class none would come.
    both = Barrier(2, timeout=PATIENCE)

    class Slow:
        @cached_property
        def value(self):
            both.wait()
            return id(self)

    one, other = Slow(), Slow()
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(lambda a: a.value, (one, other))) == [id(one), id(other)]
