# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Call a service of a running node, and print its answer."""

from typing import Any

from rclpy.node import Node
from std_srvs.srv import Empty, SetBool, Trigger

from pam_ros.command.options import Options
from pam_ros.errors import PamError, shown
from pam_ros.nodes.command.graph import Graph, Steps
from pam_ros.nodes.command.requests import request
from pam_ros.nodes.common.spin import REFUSALS, sentence

KINDS: dict[str, Any] = {
    'std_srvs/srv/Trigger': Trigger,
    'std_srvs/srv/SetBool': SetBool,
    'std_srvs/srv/Empty': Empty,
}


def call_service(node: Node, graph: Graph, options: Options) -> Steps[None]:
    """Call the service of the options; raises PamError if its answer is that it failed."""
    (name,) = options.names
    yield from graph.until(
        lambda: _found(node, graph, options),
        f'the service {name}',
        lambda: _missing(graph, options, name),
    )
    if not options.node and '/' not in name:
        yield from graph.survey()
    found = _found(node, graph, options)
    if len(found) > 1:
        one = found[0].rpartition('/')[0]
        raise PamError(
            f'{" and ".join(found)} have this name: choose one with --node, as in --node {one}'
        )
    (service,) = found
    kind = graph.services()[service]
    fields = _fields(service, kind, options)
    response = yield from request(node, graph, KINDS[kind], service, is_patient=True, **fields)
    if not getattr(response, 'success', True):
        raise PamError(f'{service}: {response.message}')
    print(shown(getattr(response, 'message', '') or 'done'))


def _found(node: Node, graph: Graph, options: Options) -> list[str]:
    """Return the full names of the services that are meant."""
    (name,) = options.names
    services = graph.services()
    if '/' in name:
        try:
            full = node.resolve_service_name(name)
        except REFUSALS as error:
            raise PamError(f'{name!r} is not the name of a service: {sentence(error)}') from None
        return [full] if full in services else []
    return [full for full in _callable_services(graph, options) if full.rpartition('/')[2] == name]


def _callable_services(graph: Graph, options: Options) -> list[str]:
    """Return the services of the node that is named, or of the nodes in the namespace."""
    only = graph.expanded(options.node) if options.node else ''
    owners = {full: full.rpartition('/')[0] for full in graph.services()}
    return sorted(
        full
        for full, owner in owners.items()
        if graph.services()[full] in KINDS
        and (owner == only if only else owner.rpartition('/')[0] == graph.space)
    )


def _missing(graph: Graph, options: Options, name: str) -> str:
    others = _callable_services(graph, options)
    if others:
        shorts = ', '.join(full.removeprefix(f'{graph.space}/') for full in others)
        return f'there is no service {name!r} after {graph.wait:g} s: there are {shorts}'
    return graph.missing_node(
        f'there is no service {name!r} in the namespace {graph.space or "/"}',
        graph.expanded(options.node or 'pam_sim'),
    )


def _fields(service: str, kind: str, options: Options) -> dict[str, bool]:
    """Return the fields of the request; raises PamError if they do not suit the service."""
    if kind not in KINDS:
        raise PamError(f'{service} is {kind}: pam_command calls Trigger, SetBool and Empty only')
    if KINDS[kind] is SetBool:
        if options.switch is None:
            raise PamError(f'{service} switches something: give true or false after its name')
        return {'data': options.switch}
    if options.switch is not None:
        raise PamError(f'{service} takes no value: leave out {str(options.switch).lower()}')
    return {}
