# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``ros2 param dump`` and ``ros2 param load`` do, over the same services of rclpy."""

import yaml
from rclpy.parameter import parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient


def _client(peer, node):
    client = AsyncParameterClient(peer.node, node)
    peer.until(client.services_are_ready, f'the parameters of {node}')
    return client


def _answer(peer, future):
    peer.until(future.done, 'the answer of a parameter service')
    return future.result()


def values_of(peer, node):
    """Return all parameters of a node in the order of their names."""
    client = _client(peer, node)
    names = sorted(_answer(peer, client.list_parameters()).result.names)
    values = _answer(peer, client.get_parameters(names)).values
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
    """Load a file as ``ros2 param load`` does; return name -> reason of what is not taken.

    All that are sent are answered: else the command ends in a traceback.
    """
    sent = parameter_dict_from_yaml_file(str(path), use_wildcard=True)
    future = _client(peer, node).load_parameter_file(str(path), use_wildcard=True)
    results = _answer(peer, future).results
    refused = {}
    for name, result in zip(sent, results, strict=True):
        if not result.successful:
            assert result.reason, name
            refused[name] = result.reason
    return refused
