# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The command line of ``pam_command``: what to do, and the values for it, checked."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite

from pam_ros.command.amounts import Amount, amount_of, joined
from pam_ros.errors import PamError
from pam_ros.settings.rig import NAME

WAIT, LONGEST_WAIT = 5.0, 3600.0  # s
LONGEST_HOLD = 86400.0  # s
STIFFNESS = 'N m/rad'
SWITCHES = {'true': True, 'false': False}


@dataclass(frozen=True)
class Options:
    """What a command line asks for.

    ``action`` is its first word, and the fields after ``node`` are those of this action.
    ``pressures`` are pairs of a muscle, '' if none is named, and its pressure. ``pairs`` are names
    and texts of parameters, ``names`` are names of parameters, a part of names, or a service.
    """

    action: str
    wait: float
    node: str
    hold: float | None = None
    pressures: tuple[tuple[str, Amount], ...] = ()
    amount: Amount | None = None
    pairs: tuple[tuple[str, str], ...] = ()
    names: tuple[str, ...] = ()
    switch: bool | None = None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the actions with their arguments to *parser*."""
    actions = parser.add_subparsers(dest='action', required=True, metavar='ACTION')

    def action(name: str, text: str, *, has_node: bool = False) -> argparse.ArgumentParser:
        one = actions.add_parser(name, help=text, description=text, allow_abbrev=False)
        one.add_argument(
            '--wait',
            type=float,
            default=WAIT,
            metavar='SECONDS',
            help=f'how long it waits for the rig (default: {WAIT:g})',
        )
        one.set_defaults(node='')
        if has_node:
            one.add_argument('--node', metavar='NODE', help='the node, such as /pam_sim')
        return one

    pressure = action('pressure', 'command the gauge pressures of the muscles')
    pressure.add_argument(
        'values', nargs='+', metavar='VALUE', help='300e3, 300kPa, 3bar or MUSCLE:=VALUE'
    )
    pressure.add_argument(
        '--hold',
        type=float,
        metavar='SECONDS',
        help='command for this time and end; 0: send the command once (default: until Ctrl-C, '
        'or once if the rig has no time-out)',
    )
    position = action('position', 'send the position reference of a controller')
    position.add_argument('value', metavar='VALUE', help='0.06, 60mm or 20deg')
    position.add_argument('unit', nargs='?', default='', help=argparse.SUPPRESS)
    stiffness = action('stiffness', 'send the desired stiffness of an antagonistic joint')
    stiffness.add_argument('value', metavar='VALUE', help=f'in {STIFFNESS}')
    stiffness.add_argument('unit', nargs='?', default='', help=argparse.SUPPRESS)
    change = action('set', 'set parameters, all or none of them', has_node=True)
    change.add_argument('words', nargs='+', metavar='NAME VALUE', help='or NAME:=VALUE')
    get = action('get', 'print the values of parameters', has_node=True)
    get.add_argument('names', nargs='+', metavar='NAME')
    listing = action('list', 'print parameters with value, text, unit, range', has_node=True)
    listing.add_argument('names', nargs='?', default='', metavar='TEXT', help='part of the names')
    call = action('call', 'call a service and print its answer', has_node=True)
    call.add_argument('names', metavar='SERVICE', help='reset, pause, step, enable, ...')
    call.add_argument(
        'switch', nargs='?', choices=tuple(SWITCHES), help='for services that switch something'
    )


def checked(given: argparse.Namespace) -> Options:
    """Return the options of a parsed command line; raises PamError for values not allowed."""
    _check_seconds('--wait', given.wait, LONGEST_WAIT)
    options = Options(given.action, given.wait, given.node or '')
    match given.action:
        case 'pressure':
            if given.hold is not None:
                _check_seconds('--hold', given.hold, LONGEST_HOLD)
            return replace(options, hold=given.hold, pressures=_pressures(given.values))
        case 'position':
            amount = amount_of(given.value + given.unit, ('m', 'rad'), 'position')
            return replace(options, amount=amount)
        case 'stiffness':
            amount = amount_of(given.value + given.unit, (STIFFNESS,), 'stiffness')
            return replace(options, amount=amount)
        case 'set':
            return replace(options, pairs=_pairs(given.words))
        case 'call':
            switch = SWITCHES.get(given.switch)
            return replace(options, names=(given.names,), switch=switch)
    names = (given.names,) if isinstance(given.names, str) else tuple(given.names)
    return replace(options, names=names)


def _check_seconds(option: str, value: float, highest: float) -> None:
    if not (isfinite(value) and 0.0 <= value <= highest):
        raise PamError(f'{option} {value:g} is not allowed: give 0 to {highest:g} s')


def _pressures(words: Sequence[str]) -> tuple[tuple[str, Amount], ...]:
    found = []
    for word in joined(words):
        muscle, sign, text = word.rpartition(':=')
        if sign and NAME.fullmatch(muscle) is None:
            raise PamError(f'{word!r} does not name a muscle: give MUSCLE:=VALUE')
        what = f'pressure of {muscle}' if muscle else 'pressure'
        found.append((muscle, amount_of(text, ('Pa',), what)))
    muscles = [muscle for muscle, _ in found]
    if any(muscles) and not all(muscles):
        raise PamError('some pressures name a muscle and others do not: name all or none')
    twice = [muscle for muscle in muscles if muscle and muscles.count(muscle) > 1]
    if twice:
        raise PamError(f'{twice[0]} is given twice: give one pressure for each muscle')
    return tuple(found)


def _pairs(words: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Return the names and values of ``name value`` and ``name:=value``, in any order."""
    found: dict[str, str] = {}
    left = list(words)
    while left:
        name, sign, value = left.pop(0).partition(':=')
        if not sign:
            if not left or ':=' in left[0]:
                raise PamError(f'{name} has no value: give NAME VALUE or NAME:=VALUE')
            value = left.pop(0)
        if not name.strip() or not value.strip():
            raise PamError(f'{name}{sign}{value} sets nothing: give NAME VALUE or NAME:=VALUE')
        if name in found:
            raise PamError(f'{name} is given twice: give one value for each parameter')
        found[name] = value.strip()
    return tuple(found.items())
