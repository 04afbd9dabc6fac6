# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of a scenario: messages that are lost or delayed, and outages of the rig.

Which messages are lost follows from the seed of the run and the number of the state alone, so that
all controllers meet the same losses.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.bench.references import SOONEST
from pam_ros.errors import ParameterError, printable
from pam_ros.parameters import Parameter, check_all, described, parameter_field
from pam_ros.similar_names import similar

FREEZE, RESTART, STOP = KINDS = ('freeze', 'restart', 'stop')
MOST_LOST = 0.9
SHORTEST = 0.01  # s of an outage
LONGEST = 1.0  # s of a delay, and of the mean drop-out
# Streams of random numbers: a fault of one kind does not change those of another kind.
STATES, COMMANDS, DELAYS = 1, 2, 3

Described = TypeVar('Described')


def _loss(what: str) -> Any:
    """Return a dataclass field for the share of messages that are lost."""
    return parameter_field(
        0.0, f'share of the {what} that are lost', low=0.0, high=MOST_LOST, live=False
    )


def _seconds(text: str) -> Any:
    return parameter_field(0.0, text, 's', low=0.0, high=LONGEST, live=False)


@dataclass(frozen=True)
class StateFaults:
    """Faults of the messages from the rig to the controller. Raises ParameterError."""

    loss: float = _loss('states')
    dropout: float = _seconds('mean length of a drop-out, in which all states are lost')

    def __post_init__(self) -> None:
        """Check the values."""
        check_all(self)
        _need_loss(self.loss, self.dropout)


@dataclass(frozen=True)
class CommandFaults:
    """Faults of the messages from the controller to the rig. Raises ParameterError."""

    loss: float = _loss('commands')
    dropout: float = _seconds('mean length of a drop-out, in which all commands are lost')
    delay: float = _seconds('time after which a command acts')
    jitter: float = _seconds('largest additional delay; it is distributed uniformly from 0')

    def __post_init__(self) -> None:
        """Check the values."""
        check_all(self)
        _need_loss(self.loss, self.dropout)


def _need_loss(loss: float, dropout: float) -> None:
    if dropout and not loss:
        raise ParameterError(f'dropout = {dropout:g} s has no effect: give the share loss as well')


@dataclass(frozen=True)
class MessageFaults:
    """Faults of all messages between the rig and the controller."""

    states: StateFaults = StateFaults()
    commands: CommandFaults = CommandFaults()


NO_FAULTS = MessageFaults()


@dataclass(frozen=True)
class Outage:
    """From *time* in s on the rig sends no states and takes no commands, for *duration* in s.

    With ``freeze`` the valves keep their pressures. With ``restart`` they vent. With ``stop`` they
    vent and the rig does not return, so that *duration* is infinite.
    """

    kind: str
    time: float
    duration: float = inf

    @property
    def end(self) -> float:
        """The time in s at which states return."""
        return self.time + self.duration


class Draws(NamedTuple):
    """The faults of the n periods of a run.

    ``states_lost`` and ``commands_lost`` (n,) are true where the state of a period, or the command
    that answers it, is lost. ``delays`` (n,) are the delays of these commands in s.
    """

    states_lost: NDArray[np.bool_]
    commands_lost: NDArray[np.bool_]
    delays: NDArray[np.float64]


def draw(messages: MessageFaults, rate: float, count: int, seed: int) -> Draws:
    """Return the faults of a run with *count* states, which are sent at *rate* in Hz."""
    states, commands = messages.states, messages.commands
    states_lost = _losses(states.loss, states.dropout * rate, count, _random(seed, STATES))
    commands_lost = _losses(commands.loss, commands.dropout * rate, count, _random(seed, COMMANDS))
    jitter = commands.jitter * _random(seed, DELAYS).random(count)
    return Draws(states_lost, commands_lost, commands.delay + jitter)


def _random(seed: int, stream: int) -> np.random.Generator:
    return np.random.default_rng((seed, stream))


def _losses(
    share: float, length: float, count: int, random: np.random.Generator
) -> NDArray[np.bool_]:
    """Return which of *count* messages are lost, in drop-outs of so many messages on average.

    This is the model of Gilbert (Bell System Technical Journal 39, 1960, 1253-1265): a chain of
    two states. Independent losses have the mean length 1 / (1 - share); none can be shorter. The
    first message is never lost, since with it the run begins.
    """
    ends = min(1.0 / max(length, 1.0), 1.0 - share)  # probability after each lost message
    begins = share * ends / (1.0 - share)
    lost = np.zeros(count, dtype=bool)
    for k, value in enumerate(random.random(count).tolist()):
        lost[k] = k > 0 and (value >= ends if lost[k - 1] else value < begins)
    return lost


# From a YAML file ------------------------------------------------------------------------------


def messages_of(given: Any) -> MessageFaults:
    """Return the faults that the mapping ``messages`` of a scenario describes.

    Raises ParameterError for a key or a value that is not allowed.
    """
    parts = {'states': StateFaults, 'commands': CommandFaults}
    _refuse_keys('messages', given, parts)
    return MessageFaults(
        **{key: _build(f'messages.{key}', given[key], parts[key]) for key in given}
    )


def _build(what: str, given: Any, cls: type[Described]) -> Described:
    _refuse_keys(what, given, described(cls))
    try:
        return cls(**given)
    except ParameterError as error:
        raise ParameterError(f'{what}.{error}') from error


def outages_of(given: Any, duration: float) -> tuple[Outage, ...]:
    """Return the outages in the list of a scenario that takes *duration* in s.

    Raises ParameterError for a key or a value that is not allowed, and for outages that overlap
    or last beyond the end.
    """
    if not isinstance(given, list):
        raise ParameterError('outages is not a list of mappings, each with kind and time')
    found: list[Outage] = []
    for k, one in enumerate(given):
        what = f'outages[{k}]'
        outage = _outage(what, one, duration)
        before = found[-1].end if found else -inf
        if before == inf:
            raise ParameterError(f'{what} comes after the kind {STOP}, from which no rig returns')
        if outage.time <= before:
            raise ParameterError(
                f'{what}.time = {outage.time:g} s is not after the end of the outage before it, '
                f'{before:g} s'
            )
        found.append(outage)
    return tuple(found)


def _outage(what: str, given: Any, duration: float) -> Outage:
    about = {
        'kind': (str, Parameter('what happens to the rig', choices=KINDS)),
        'time': (float, Parameter('time of its begin', 's', low=SOONEST, high=duration)),
        'duration': (float, Parameter('length', 's', low=SHORTEST, high=duration)),
    }
    _refuse_keys(what, given, about)
    values: dict[str, Any] = {}
    for key, (kind, allowed) in about.items():
        is_last = key == 'duration' and values['kind'] == STOP
        if is_last and key in given:
            raise ParameterError(f'{what}.{key} is not allowed for the kind {STOP}: leave it out')
        if key in given:
            values[key] = allowed.check(f'{what}.{key}', given[key], kind)
        elif not is_last:
            raise ParameterError(f'{what}.{key} is missing')
    outage = Outage(**values)
    if duration < outage.end < inf:
        raise ParameterError(
            f'{what} ends at {outage.end:g} s, after the scenario, which takes {duration:g} s: '
            f'make it shorter, or give kind: {STOP}'
        )
    return outage


def _refuse_keys(what: str, given: Any, known: Mapping[str, object]) -> None:
    """Raise ParameterError unless *given* is a mapping whose keys are *known*."""
    keys = ', '.join(known)
    if not isinstance(given, dict):
        shown = printable(repr(given))
        raise ParameterError(f'{what} = {shown} is not allowed: give a mapping with {keys}')
    for key in given:
        if key not in known:
            alike = similar(str(key), known)
            hint = f'was {alike} meant?' if alike else f'give {keys}'
            raise ParameterError(f'{what}.{key} is not known: {hint}')
