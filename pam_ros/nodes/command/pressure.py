# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Command pressures: find who receives them, check them, publish them as often as is needed."""

from collections.abc import Sequence
from functools import partial
from time import monotonic, monotonic_ns

from rclpy.node import Node

from pam_ros.command.absence import AbsentError
from pam_ros.command.options import Options
from pam_ros.command.rig import Rig, checked_pressure, count, ordered, rig_of
from pam_ros.errors import PamError, shown
from pam_ros.nodes.command.graph import Graph, Steps, say
from pam_ros.nodes.command.reference import acknowledged, matched
from pam_ros.nodes.command.requests import all_values
from pam_ros.nodes.common.commands import ArrayCommand, EachCommand
from pam_ros.nodes.common.spin import TickingNode
from pam_ros.recording.bag.topics import FLOAT64, FLOAT64_ARRAY

UNKNOWN_RIG = 0.1  # s between commands for a rig whose time-out is not known
CHECK = 1.0  # s between checks for other publishers
ONE, ALL = 'pressure_command', 'pressure_commands'


def command_pressure(node: TickingNode, graph: Graph, options: Options) -> Steps[None]:
    """Command the pressures until Ctrl-C, for the time of the options, or once."""
    muscles = [muscle for muscle, _ in options.pressures if muscle]
    one, array = node.resolve_topic_name(ONE), node.resolve_topic_name(ALL)
    own = [node.resolve_topic_name(f'{muscle}/{ONE}') for muscle in muscles] or [one]

    def has_own() -> bool:
        return all(graph.receivers(topic, FLOAT64) for topic in own)

    def has_all() -> bool:
        return bool(graph.receivers(array, FLOAT64_ARRAY))

    def missing() -> str:
        has_one = bool(muscles) and bool(graph.receivers(one, FLOAT64))
        hint = f'; {one} has a subscriber: leave out the names of muscles' if has_one else ''
        return graph.missing_topic([*own, array], FLOAT64) + hint

    what = f'a subscriber of {" or ".join([*own, array])}'
    yield from graph.until(lambda: has_own() or has_all(), what, missing)
    yield from graph.settle()
    number = len(options.pressures)
    if has_own() and (muscles or number == 1):
        rigs = []
        for topic in own:
            rigs.append((yield from _rig(node, graph, graph.receivers(topic, FLOAT64))))
        pressures = [
            checked_pressure(_muscle(topic, rig), amount, rig)
            for topic, rig, (_, amount) in zip(own, rigs, options.pressures, strict=True)
        ]
        topics, rig = own, rigs[0]
        commands: ArrayCommand | EachCommand = EachCommand(node, topics)
    elif has_all():
        rig = yield from _rig(node, graph, graph.receivers(array, FLOAT64_ARRAY))
        pressures = ordered(options.pressures, rig)
        names = rig.muscles if rig else [str(i + 1) for i in range(number)]
        topics = [array]
        commands = ArrayCommand(node, array, names)
    else:
        who = ', '.join(graph.receivers(one, FLOAT64))
        raise PamError(f'{count(number, "pressure")} for one muscle of {who}: give one')
    period = UNKNOWN_RIG if rig is None else rig.repeat
    is_once = options.hold == 0.0 or (options.hold is None and period is None)
    if is_once:  # otherwise other publishers are found while it goes on
        yield from graph.survey()
    every = dict.fromkeys([*topics, one, array])
    others = _warn(graph, every)
    for topic, publisher in zip(topics, commands.publishers, strict=True):
        yield from matched(graph, topic, publisher)
    commands.publish(pressures)
    for topic, publisher in zip(topics, commands.publishers, strict=True):
        # A lost message is sent again after seconds only, in which the rig would vent.
        again = None if is_once else partial(commands.publish, pressures)
        yield from acknowledged(graph, topic, publisher, again)
    receivers = dict.fromkeys(name for topic in topics for name in _receivers(graph, topic))
    values = ', '.join(f'{pressure:g} Pa' for pressure in pressures)
    print(
        shown(
            f'{", ".join(receivers)} received {values} on {", ".join(topics)}'
            f'{_what_follows(rig, period, options.hold)}'
        ),
        flush=True,
    )
    if is_once:
        return
    end = None if options.hold is None else monotonic() + options.hold
    often = period or UNKNOWN_RIG
    yield from _repeat(node, graph, commands, pressures, topics, often, end, every, others)


def _receivers(graph: Graph, topic: str) -> list[str]:
    return graph.receivers(topic, FLOAT64) or graph.receivers(topic, FLOAT64_ARRAY)


def _rig(node: Node, graph: Graph, receivers: Sequence[str]) -> Steps[Rig | None]:
    """Return the first of *receivers* with the parameters of a rig, None if there is none."""
    for one in receivers:
        rig = rig_of(one, (yield from all_values(node, graph, one)))
        if rig is not None:
            return rig
    return None


def _muscle(topic: str, rig: Rig | None) -> str:
    """Return the muscle of *rig* that a topic of one muscle commands."""
    if rig is None:
        return ''
    name = topic.split('/')[-2]
    return name if name in rig.muscles else rig.muscles[0]


def _what_follows(rig: Rig | None, period: float | None, hold: float | None) -> str:
    """Return the end of the sentence: how long the pressures are commanded, and why."""
    if period is None and hold is None:
        return ', and keeps this command'
    vents = f': it vents {rig.timeout:g} s after the last command' if rig and rig.timeout else ''
    if hold == 0.0:
        return vents
    often = f', repeated {1.0 / (period or UNKNOWN_RIG):g} times a second'
    if hold is not None:
        return f'{often} for {hold:g} s{vents}'
    if rig is not None and rig.period is not None:
        vents = ': in lockstep each command simulates one period'
    return f'{often} until Ctrl-C{vents or ", because its time-out is not known"}'


def _warn(graph: Graph, topics: Sequence[str] | dict[str, None]) -> set[str]:
    """Warn of other nodes that publish *topics*; return their names."""
    others = {name for topic in topics for name in graph.senders(topic)}
    if others:
        names = ' and '.join(sorted(others))
        say(
            f'warning: {names} commands pressures as well: the rig follows the newest command '
            'of either'
        )
    return others


def _repeat(
    node: TickingNode,
    graph: Graph,
    commands: ArrayCommand | EachCommand,
    pressures: Sequence[float],
    topics: Sequence[str],
    period: float,
    end: float | None,
    every: dict[str, None],
    known: set[str],
) -> Steps[None]:
    """Publish *pressures* every *period* s until *end*, or until a signal requests the end.

    *known* are the other publishers of the topics *every* of which the user was warned.
    """
    node.ticker.start(1.0 / period, monotonic_ns())
    checked = monotonic()
    while end is None or monotonic() < end:
        commands.publish(pressures)
        yield True
        if monotonic() - checked >= CHECK:
            checked = monotonic()
            if not all(_receivers(graph, topic) for topic in topics):
                raise AbsentError(f'no node receives {", ".join(topics)} any more')
            now = {name for topic in every for name in graph.senders(topic)}
            if now - known:
                _warn(graph, every)
            known = now
    for topic, publisher in zip(topics, commands.publishers, strict=True):
        yield from acknowledged(graph, topic, publisher)
