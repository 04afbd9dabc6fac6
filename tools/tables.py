# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Write the tables of docs/effects.md again, from the library of effects: ``make tables``."""

from pathlib import Path

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import ONSET, Effect
from pam_ros.effects.parameter import EffectParameter
from pam_ros.excitation.command import command_line

GUIDE = Path(__file__).parents[1] / 'docs' / 'effects.md'


def names(effects: tuple[str, ...]) -> str:
    """Return names of effects as Markdown shows them."""
    return ', '.join(f'`{name}`' for name in effects) or '-'


def acts_on(effect: type[Effect]) -> str:
    """Return whether it acts on the joint or in a muscle, and at which places of the kernel."""
    places = ', '.join(effect.equations.places)
    return f'{"joint" if effect.acts_on_joint() else "muscle"}: {places}'


def effects_table(library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the table of effects in Markdown."""
    rows = [
        '| effect | what it is | acts on | source | trace in the residual | a controller |',
        '|---|---|---|---|---|---|',
    ]
    rows += [
        f'| `{e.name}` | {e.text} | {acts_on(e)} | {e.source} | {e.signature} | '
        f'{e.compensation.value} |'
        for e in library
    ]
    return '\n'.join(rows)


def experiments_table(library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the table of experiments in Markdown, each with its command if there is one."""
    rows = ['| effect | mistaken for | distinguished by | command |', '|---|---|---|---|']
    for e in library:
        command = '-' if e.excitation is None else f'`{command_line(e.excitation)}`'
        rows.append(f'| `{e.name}` | {names(e.rivals)} | {e.experiment} | {command} |')
    return '\n'.join(rows)


def parameters_table(library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the table of parameters in Markdown, strengths in bold."""
    rows = ['| parameter | unit | range | default | meaning |', '|---|---|---|---|---|']
    rows += [_row(e.name, p) for e in library for p in e.parameters()]
    return '\n'.join([*rows, _row('<name>', ONSET)])


def _row(effect: str, p: EffectParameter) -> str:
    """Return the row of a parameter of an effect."""
    name = f'`effects.{effect}.{p.name}`'
    if p.strength:
        name = f'**{name}**'
    return f'| {name} | {p.unit or "-"} | {p.low:g} to {p.high:g} | {p.default:g} | {p.text} |'


def with_tables(text: str, library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the guide *text* with all tables as they must be."""
    tables = {
        'effects': effects_table(library),
        'experiments': experiments_table(library),
        'parameters': parameters_table(library),
    }
    for name, table in tables.items():
        marks = f'<!-- {name} -->', f'<!-- /{name} -->'
        begin = text.index(marks[0]) + len(marks[0])
        text = f'{text[:begin]}\n{table}\n{text[text.index(marks[1]) :]}'
    return text


if __name__ == '__main__':
    GUIDE.write_text(with_tables(GUIDE.read_text(encoding='utf-8')), encoding='utf-8')
