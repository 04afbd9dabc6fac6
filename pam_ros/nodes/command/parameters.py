# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Set, get and list the parameters of running nodes."""

from typing import Any

from rcl_interfaces.msg import ParameterDescriptor, ParameterType
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

from pam_ros.command.options import Options
from pam_ros.command.parameter_values import refuse_unknown, value_of
from pam_ros.errors import PamError, shown
from pam_ros.nodes.command.graph import Graph, Steps
from pam_ros.nodes.command.requests import (
    descriptions,
    parameter_names,
    parameter_values,
    request,
)
from pam_ros.nodes.common.parameter_list import is_of_ros, lines_about, value_text

# The type of a parameter, or of the items of a list, and whether it is a list.
KINDS = {
    ParameterType.PARAMETER_BOOL: (bool, False),
    ParameterType.PARAMETER_INTEGER: (int, False),
    ParameterType.PARAMETER_DOUBLE: (float, False),
    ParameterType.PARAMETER_STRING: (str, False),
    ParameterType.PARAMETER_BOOL_ARRAY: (bool, True),
    ParameterType.PARAMETER_INTEGER_ARRAY: (int, True),
    ParameterType.PARAMETER_DOUBLE_ARRAY: (float, True),
    ParameterType.PARAMETER_STRING_ARRAY: (str, True),
}
OF_PARAMETERS = '/list_parameters'  # the service that a node with parameters has
OF_ALL = 'use_sim_time'  # a parameter of each node


def set_parameters(node: Node, graph: Graph, options: Options) -> Steps[None]:
    """Set parameters of one node, all or none, and print their new values."""
    names = [name for name, _ in options.pairs]
    found = yield from _nodes_with(node, graph, options, names)
    if len(found) > 1:
        raise PamError(
            f'{", ".join(found)} have {", ".join(names)}: choose one with --node, as in '
            f'--node {found[0]}'
        )
    (one,) = found
    abouts = yield from descriptions(node, graph, one, names)
    parameters = [_parameter(abouts[name], text) for name, text in options.pairs]
    response = yield from request(
        node,
        graph,
        SetParametersAtomically,
        f'{one}/set_parameters_atomically',
        parameters=[parameter.to_parameter_msg() for parameter in parameters],
    )
    if not response.result.successful:
        raise PamError(f'{one} refuses: {response.result.reason}{_more(abouts, names)}')
    values = yield from parameter_values(node, graph, one, names)
    _print({one: values})


def get_parameters(node: Node, graph: Graph, options: Options) -> Steps[None]:
    """Print the values of parameters, of each node that has all of them."""
    names = list(dict.fromkeys(options.names))
    values = {}
    for one in (yield from _nodes_with(node, graph, options, names)):
        values[one] = yield from parameter_values(node, graph, one, names)
    _print(values)


def list_parameters(node: Node, graph: Graph, options: Options) -> Steps[None]:
    """Print the parameters whose names contain a text: value, description, unit and range."""
    (part,) = options.names
    nodes = yield from _nodes(graph, options)
    is_found = False
    for one in nodes:
        of_node = yield from parameter_names(node, graph, one)
        names = [n for n in of_node if part in n and (part or not is_of_ros(n))]
        if not names or (not options.node and names == [OF_ALL]):
            continue
        values = yield from parameter_values(node, graph, one, names)
        abouts = yield from descriptions(node, graph, one, names)
        if len(nodes) > 1:
            print(f'# {one}')
        is_found = True
        for name in names:
            print('\n'.join(map(shown, lines_about(abouts[name], values[name]))))
    if not is_found:
        raise PamError(
            f'no parameter of {", ".join(nodes)} has {part!r} in its name: without a text, '
            'pam_command list prints all'
        )


def _nodes(graph: Graph, options: Options) -> Steps[list[str]]:
    """Return the node that is named, or all with parameters in the namespace; wait for them."""
    if options.node:
        wanted = graph.expanded(options.node)
        yield from graph.until(
            lambda: f'{wanted}{OF_PARAMETERS}' in graph.services(),
            f'the node {wanted}',
            lambda: graph.missing_node(f'there is no node {wanted} with parameters', wanted),
        )
        return [wanted]
    where = graph.space or '/'
    yield from graph.until(
        lambda: _in_namespace(graph),
        f'a node in the namespace {where}',
        lambda: graph.missing_node(
            f'there is no node with parameters in the namespace {where}', f'{graph.space}/pam_sim'
        ),
    )
    yield from graph.survey()
    return _in_namespace(graph)


def _in_namespace(graph: Graph) -> list[str]:
    nodes = [
        name.removesuffix(OF_PARAMETERS)
        for name in graph.services()
        if name.endswith(OF_PARAMETERS)
    ]
    return sorted(one for one in nodes if one.rpartition('/')[0] == graph.space)


def _nodes_with(node: Node, graph: Graph, options: Options, names: list[str]) -> Steps[list[str]]:
    """Return the nodes that have all parameters *names*; raises PamError if there is none."""
    nodes = yield from _nodes(graph, options)
    of_node = {}
    for one in nodes:
        of_node[one] = yield from parameter_names(node, graph, one)
    found = [one for one in nodes if set(names) <= set(of_node[one])]
    if found:
        return found
    every = [name for known in of_node.values() for name in known]
    for name in names:
        if name not in every:
            raise refuse_unknown(name, every, ' or '.join(nodes))
    raise PamError(f'no node has all of {", ".join(names)}: give those of one node at a time')


def _more(abouts: dict[str, ParameterDescriptor], names: list[str]) -> str:
    """Return what is added to the reason of a refusal: allowed values, and what is unchanged."""
    allowed = [f'{n}: {abouts[n].additional_constraints}' for n in names]
    text = ''.join(f'; {one}' for one in allowed if not one.endswith(': '))
    return f'{text}; none of them is changed' if len(names) > 1 else text


def _parameter(about: ParameterDescriptor, text: str) -> Parameter:
    if about.type not in KINDS:
        raise PamError(f'{about.name} has a type that cannot be given on a command line')
    kind, is_list = KINDS[about.type]
    value = value_of(about.name, text, kind, about.description, is_list=is_list)
    return Parameter(about.name, Parameter.Type(about.type), value)


def _print(values: dict[str, dict[str, Any]]) -> None:
    """Print values as in a parameter file; of several nodes with the node before each."""
    for one, of_node in values.items():
        for name, value in of_node.items():
            node = f'{one} ' if len(values) > 1 else ''
            print(shown(f'{node}{name}: {value_text(value)}'))
