# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of a node as a text, for users who do not have ``ros2 param describe``."""

import yaml
from rclpy.node import Node

from pam_ros.errors import ParameterError

OF_ROS = ('qos_overrides.', 'start_type_description_service')  # listed only if *part* is given


def parameter_list(node: Node, part: str) -> str:
    """Return the parameters of *node* whose names contain *part*, in the order of declaration.

    Each has a line ``name: value``, as in a parameter file, and a line with its description, unit
    and range. Raises ParameterError if no name contains *part*.
    """
    values = {name: p.value for name, p in node.get_parameters_by_prefix('').items()}
    names = [name for name in values if part in name and (part or not name.startswith(OF_ROS))]
    if not names:
        raise ParameterError(
            f'no parameter of {node.get_name()} has {part!r} in its name: without a text, '
            '--parameters lists all'
        )
    lines = []
    for about in node.describe_parameters(names):
        value = yaml.safe_dump(values[about.name], default_flow_style=True, width=10**6)
        facts = [about.description, about.additional_constraints]
        facts.append('can be set only at the start' if about.read_only else '')
        lines.append(f'{about.name}: {value.splitlines()[0]}')
        lines.append(f'    {"; ".join(filter(None, facts))}')
    return '\n'.join(line for line in lines if line.strip())
