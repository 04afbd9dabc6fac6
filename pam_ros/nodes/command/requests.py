# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Requests to services, and those for the parameters of a node."""

from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python

from pam_ros.command.absence import AbsentError
from pam_ros.nodes.command.graph import Graph, Steps


def request(
    node: Node, graph: Graph, kind: Any, service: str, *, is_patient: bool = False, **fields: Any
) -> Steps[Any]:
    """Send one request to *service*, and return its response.

    If *is_patient*, the response is awaited as long as the node runs. Raises AbsentError if there
    is no response.
    """
    client = node.create_client(kind, service)
    try:
        yield from graph.until(
            client.service_is_ready,
            f'the service {service}',
            lambda: graph.missing(f'there is no service {service}'),
        )
        future = client.call_async(kind.Request(**fields))

        def is_over() -> bool:
            return future.done() or (is_patient and not client.service_is_ready())

        unanswered = f'{service} has not answered'
        if is_patient:
            while not is_over():
                yield False
        else:
            what = f'the answer of {service}'
            yield from graph.until(
                is_over,
                what,
                lambda: f'{unanswered} within {graph.wait:g} s: is its node stopped?',
            )
        if not future.done():
            raise AbsentError(f'{unanswered}: its node has ended')
        return future.result()
    finally:
        node.destroy_client(client)


def parameter_names(node: Node, graph: Graph, of: str) -> Steps[list[str]]:
    """Return the names of all parameters of the node with the full name *of*."""
    response = yield from request(node, graph, ListParameters, f'{of}/list_parameters')
    return list(response.result.names)


def parameter_values(node: Node, graph: Graph, of: str, names: list[str]) -> Steps[dict[str, Any]]:
    """Return the values of the parameters *names* of the node *of*, which has all of them."""
    response = yield from request(node, graph, GetParameters, f'{of}/get_parameters', names=names)
    values = [parameter_value_to_python(value) for value in response.values]
    return dict(zip(names, map(_plain, values), strict=False))


def _plain(value: Any) -> Any:
    """Return a value with a list in the place of an array."""
    is_one = value is None or isinstance(value, bool | int | float | str)
    return value if is_one else list(value)


def descriptions(
    node: Node, graph: Graph, of: str, names: list[str]
) -> Steps[dict[str, ParameterDescriptor]]:
    """Return the descriptions of the parameters *names* of the node *of*."""
    service = f'{of}/describe_parameters'
    response = yield from request(node, graph, DescribeParameters, service, names=names)
    return {about.name: about for about in response.descriptors}


def all_values(node: Node, graph: Graph, of: str) -> Steps[dict[str, Any]]:
    """Return all parameters of the node *of*; none if it offers none."""
    if f'{of}/list_parameters' not in graph.services():
        return {}
    names = yield from parameter_names(node, graph, of)
    return (yield from parameter_values(node, graph, of, names))
