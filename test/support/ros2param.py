# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``ros2 param dump`` and ``ros2 param load`` do, over the same services of rclpy."""

import yaml
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient


def _client(peer, node):
    client = AsyncParameterClient(peer.node, node)
    peer.until(client.services_are_ready, f'the parameters of {node}')
    return client


def values_of(peer, node):
    """Return all parameters of a node in the order of their names."""
    client = _client(peer, node)
    names = sorted(peer.answer(client.list_parameters, f'{node}/list_parameters').result.names)
    values = peer.answer(lambda: client.get_parameters(names), f'{node}/get_parameters').values
    return dict(zip(names, map(parameter_value_to_python, values), strict=True))


def dump(peer, node):
    """Return what ``ros2 param dump`` prints: all parameters in tables within each other."""
    table = {}
    for name, value in values_of(peer, node).items():
        *groups, last = name.split('.')
        inner = table
        for group in groups:
            inner = inner.setdefault(group, {})
        inner[last] = value
    return yaml.dump({node: {'ros__parameters': table}}, default_flow_style=False)


def load(peer, node, path):
    """Load a file as ``ros2 param load`` does; return name -> reason, '' of what is taken.

    All that are sent are answered: else the command ends in a traceback. Since Kilted it does not
    send what is under a name with a wildcard, as /**/pam_sim.
    """
    client = _client(peer, node)
    set_parameters, sent = client.set_parameters, []

    def note(parameters, *more, **named):
        sent[:] = [parameter.name for parameter in parameters]
        return set_parameters(parameters, *more, **named)

    client.set_parameters = note
    results = peer.answer(
        lambda: client.load_parameter_file(str(path), use_wildcard=True), f'{node}/set_parameters'
    ).results
    answers = dict(zip(sent, results, strict=True))
    assert all(bool(result.reason) != result.successful for result in answers.values()), answers
    return {name: result.reason for name, result in answers.items()}
