# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of a node as a text, for users who do not have ``ros2 param describe``."""

from typing import Any

import yaml
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from pam_ros.errors import ParameterError

OF_ROS = ('qos_overrides.', 'start_type_description_service')  # listed only if *part* is given


def parameter_list(node: Node, part: str) -> str:
    """Return the parameters of *node* whose names contain *part*, in the order of declaration.

    Each has a line ``name: value``, as in a parameter file, and a line with its description, unit
    and range. Raises ParameterError if no name contains *part*.
    """
    values = {name: p.value for name, p in node.get_parameters_by_prefix('').items()}
    names = [name for name in values if part in name and (part or not is_of_ros(name))]
    if not names:
        raise ParameterError(
            f'no parameter of {node.get_name()} has {part!r} in its name: without a text, '
            '--parameters lists all'
        )
    abouts = node.describe_parameters(names)
    return '\n'.join(line for one in abouts for line in lines_about(one, values[one.name]))


def lines_about(about: ParameterDescriptor, value: Any) -> list[str]:
    """Return the line with a *value*, and the one with its description, if there is one."""
    facts = [about.description, about.additional_constraints]
    facts.append('can be set only at the start' if about.read_only else '')
    text = '; '.join(filter(None, facts))
    first = f'{about.name}: {value_text(value)}'
    return [first, f'    {text}'] if text else [first]


def value_text(value: Any) -> str:
    """Return a value as a parameter file has it, in one line."""
    dumped: str = yaml.safe_dump(value, default_flow_style=True, width=10**6)
    return dumped.splitlines()[0]


def is_of_ros(name: str) -> bool:
    """Return whether a parameter is one that ROS adds to each node or topic."""
    return name.startswith(OF_ROS)
