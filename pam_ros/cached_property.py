# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The ``cached_property`` of functools, without the lock that it has before Python 3.12.

That lock is shared by all objects of a class: while a thread computes the property of one object,
no other thread can compute it for another one. Fits that run in parallel would wait for each
other. Without it two threads that need the value at the same time both compute it.
"""

import sys
from typing import TYPE_CHECKING

__all__ = ['cached_property']

if TYPE_CHECKING or sys.version_info >= (3, 12):
    from functools import cached_property
else:

    class cached_property:  # noqa: N801
        """A property that is computed once and stored in the object's ``__dict__``."""

        def __init__(self, function):
            self.function = function
            self.__doc__ = function.__doc__

        def __set_name__(self, owner, name):
            self.name = name

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            stored = instance.__dict__
            if self.name not in stored:
                stored[self.name] = self.function(instance)
            return stored[self.name]
