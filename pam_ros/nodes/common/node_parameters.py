# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""ROS parameters from tables of values with descriptions and ranges, checked as a whole."""

from collections.abc import Callable
from typing import Any, Generic, TypeVar

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

from pam_ros.errors import PamError, shown
from pam_ros.health.partial_change import PartialChange
from pam_ros.nodes.common.rclpy_internals import declare_texts, overrides_of
from pam_ros.parameters import Parameter
from pam_ros.plain_yaml import EXPONENTIAL
from pam_ros.settings.tables import Table, checked, refuse_mistyped

T = TypeVar('T')


class NodeParameters(Generic[T]):
    """The parameters of a node, and the object that is built from them.

    *table* has their names and descriptions (see :mod:`pam_ros.settings.tables`). *build* returns
    the object that the node uses, for a complete set of values; it raises PamError for values that
    do not fit together, and has no side effects. A set of changes is accepted or rejected as a
    whole, with the message of that error; *apply* is called with the new object. A whole number is
    accepted as a float, and so is a text such as 1e-05: the command line sends that number as a
    text. ``values`` and ``built`` are the current ones.

    Raises PamError if the node was started with values that are not allowed.
    """

    def __init__(
        self,
        node: Node,
        table: Table,
        build: Callable[[dict[str, Any]], T],
        apply: Callable[[T], None],
    ) -> None:
        """Declare all of *table* on *node* with the values that it was started with."""
        self._node, self._table = node, table
        self._build, self._apply = build, apply
        self.values = checked(table, overrides_of(node))
        self.built = build(self.values)
        self._last = self.values, self.built  # the last ones that were checked
        self._partial = PartialChange()
        for name, (kind, _, about) in table.items():
            descriptor, value = describe(about, kind), self.values[name]
            if kind is tuple:
                declare_texts(node, name, value, descriptor)
            else:
                node.declare_parameter(name, value, descriptor, ignore_override=True)
        node.add_pre_set_parameters_callback(self._to_float)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._take)

    def refuse_mistyped(self) -> None:
        """Raise PamError for a given parameter whose name is similar to that of a declared one.

        For other names that are not declared there is a warning: they may belong to another node.
        Call this after everything is declared, also publishers and subscriptions.
        """
        known = [name for name in overrides_of(self._node) if self._node.has_parameter(name)]
        for name in refuse_mistyped(overrides_of(self._node), [*known, *self._table]):
            self._node.get_logger().warning(
                shown(f'parameter {name} does not exist here and is not used')
            )

    def _to_float(self, parameters: list[RosParameter]) -> list[RosParameter]:
        return [
            RosParameter(p.name, RosParameter.Type.DOUBLE, float(p.value))
            if p.name in self._table and self._table[p.name][0] is float and _is_number(p)
            else p
            for p in parameters
        ]

    def _changed(self, parameters: list[RosParameter]) -> dict[str, Any]:
        changes = {p.name: p.value for p in parameters if p.name in self._table}
        return {**self.values, **changes}

    def _are_ours(self, parameters: list[RosParameter]) -> bool:
        return any(p.name in self._table for p in parameters)

    def _check(self, parameters: list[RosParameter]) -> SetParametersResult:
        if self._are_ours(parameters):
            try:
                self._make(parameters)
            except PamError as error:
                mixture = self._partial.refuse(p.name for p in parameters)
                self._warn(mixture)
                reason = f'{error}; {mixture}' if mixture else str(error)
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _take(self, parameters: list[RosParameter]) -> None:
        if self._are_ours(parameters):
            self.values, self.built = self._make(parameters)
            self._apply(self.built)
            self._warn(self._partial.accept(p.name for p in parameters))

    def _warn(self, mixture: str) -> None:
        if mixture:
            self._node.get_logger().warning(mixture)

    def _make(self, parameters: list[RosParameter]) -> tuple[dict[str, Any], T]:
        """Return the values after a change and their object, built once to check and to apply."""
        values = checked(self._table, self._changed(parameters))
        if values != self._last[0]:
            self._last = values, self._build(values)
        return self._last


def _is_number(parameter: RosParameter) -> bool:
    """Return whether a whole number is given, or a text that ROS reads as a number in files."""
    if parameter.type_ == RosParameter.Type.STRING:
        return EXPONENTIAL.fullmatch(parameter.value) is not None
    return parameter.type_ == RosParameter.Type.INTEGER


def describe(about: Parameter, kind: type) -> ParameterDescriptor:
    """Return the ROS description: text, unit, allowed values, and a range for sliders."""
    unit = f' [{about.unit}]' if about.unit else ''
    descriptor = ParameterDescriptor(description=about.text + unit, read_only=not about.live)
    bounded = about.low is not None or about.high is not None
    if about.choices or bounded:
        descriptor.additional_constraints = about.allowed(tuple if kind is tuple else float)
    if about.low is not None and about.high is not None:
        if kind is float:
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=about.low, to_value=about.high)
            ]
        else:
            descriptor.integer_range = [
                IntegerRange(from_value=int(about.low), to_value=int(about.high))
            ]
    return descriptor
