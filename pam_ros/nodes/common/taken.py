# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Subscriptions whose messages are taken from the middleware, without callbacks."""

from typing import Any

from rclpy.callback_groups import CallbackGroup


class Taken(CallbackGroup):
    """Subscriptions that no executor serves: the program takes their messages itself.

    The middleware keeps them until then, with the time at which each was received.
    """

    def can_execute(self, entity: Any) -> bool:
        """Leave it to the program."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Leave it to the program."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Nothing has begun."""


def never(message: bytes) -> None:
    """Do nothing: a subscription needs a callback, but this one is never called."""
