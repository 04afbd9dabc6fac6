# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Write what the pages show of the library of effects again: ``make pages``.

docs/effects.md has a table of all effects and one of how to distinguish them. Each effect has a
page of its own in docs/effects/, with a picture. Everything on it is declared by the effect.
"""

import inspect
import re
import sys
from collections.abc import Iterable
from pathlib import Path

from effect_signature import Signature, draw, signature_of

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import ONSET, Compensation, Effect
from pam_ros.effects.parameter import EffectParameter
from pam_ros.excitation.command import command_line

DOCS = Path(__file__).parents[1] / 'docs'
GUIDE, FOLDER, PICTURES = DOCS / 'effects.md', DOCS / 'effects', DOCS / 'images' / 'effects'
NOTE = '<!-- make pages writes this page from pam_ros/effects/{name}.py: change that file. -->'
CONTROLLER = {
    Compensation.PATH: 'inverts it: from the desired pressure it computes the command.',
    Compensation.MODEL: 'inverts it as a part of the model, since it has no memory.',
    Compensation.FEED_FORWARD: 'runs its equations along the reference, and adds the force that '
    'they require.',
    Compensation.FEEDBACK: 'does nothing in advance; the feedback compensates it.',
}


def linked(effects: Iterable[str], folder: str = '') -> str:
    """Return names of effects as Markdown links them, from a page beside their *folder*."""
    return ', '.join(f'[`{name}`]({folder}{name}.md)' for name in effects) or '-'


def acts_on(effect: type[Effect]) -> str:
    """Return whether it acts on the joint or in a muscle, and at which places of the kernel."""
    places = ', '.join(effect.equations.places)
    return f'{"joint" if effect.acts_on_joint() else "muscle"}: {places}'


def effects_table(library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the table of effects in Markdown."""
    rows = [
        '| effect | what it is | acts on | trace in the residual |',
        '|---|---|---|---|',
    ]
    rows += [
        f'| {linked([e.name], "effects/")} | {e.text} | {acts_on(e)} | {e.signature} |'
        for e in library
    ]
    return '\n'.join(rows)


def experiments_table(library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the table of what distinguishes effects in Markdown."""
    rows = ['| effect | mistaken for | distinguished by |', '|---|---|---|']
    rows += [
        f'| {linked([e.name], "effects/")} | {linked(e.rivals, "effects/")} | {e.experiment} |'
        for e in library
    ]
    return '\n'.join(rows)


def with_tables(text: str, library: tuple[type[Effect], ...] = EFFECTS) -> str:
    """Return the guide *text* with both tables as they must be."""
    tables = {'effects': effects_table(library), 'experiments': experiments_table(library)}
    for name, table in tables.items():
        marks = f'<!-- {name} -->', f'<!-- /{name} -->'
        begin = text.index(marks[0]) + len(marks[0])
        text = f'{text[:begin]}\n{table}\n{text[text.index(marks[1]) :]}'
    return text


def parameters_table(effect: type[Effect]) -> str:
    """Return the table of the parameters of an effect in Markdown, strengths in bold."""
    rows = ['| parameter | unit | range | default | meaning |', '|---|---|---|---|---|']
    return '\n'.join([*rows, *(_row(effect.name, p) for p in (*effect.parameters(), ONSET))])


def _row(effect: str, p: EffectParameter) -> str:
    """Return the row of a parameter of an effect."""
    name = f'`effects.{effect}.{p.name}`'
    if p.strength:
        name = f'**{name}**'
    return f'| {name} | {p.unit or "-"} | {p.low:g} to {p.high:g} | {p.default:g} | {p.text} |'


def page(effect: type[Effect], shown: Signature) -> str:
    """Return the page of an effect, with its *shown* signature."""
    parts = [
        f'# {effect.name}\n\n{NOTE.format(name=effect.name)}',
        _about(effect),
        _facts(effect),
        f'## Equation\n\n```text\n{effect.equation}\n```',
        _signature(effect, shown),
        f'## Parameters\n\n{parameters_table(effect)}',
        _use(effect),
        _experiment(effect),
        f'All effects, and what the symbols mean: [effects](../effects.md). Its source: '
        f'[`pam_ros/effects/{effect.name}.py`](../../pam_ros/effects/{effect.name}.py).',
    ]
    return '\n\n'.join(parts) + '\n'


def _about(effect: type[Effect]) -> str:
    """Return the docstring of its file as Markdown: a summary, and more where there is more."""
    text = inspect.getdoc(sys.modules[effect.__module__]) or ''
    return text.replace('``', '`')


def _facts(effect: type[Effect]) -> str:
    """Return the list of what can be said in a line each."""
    states = ', '.join(dict.fromkeys(_family(state.name) for state in effect.states))
    lines = [
        f'Acts on the {acts_on(effect)}.',
        f'Source: {effect.source}.',
        f'Trace in the residual: {effect.signature}.',
        f'Hidden states: {states or "none"}.',
        f'If it is configured, the controller {CONTROLLER[effect.compensation]}',
    ]
    if effect.contains:
        lines.append(f'Special case: {linked(effect.contains)}.')
    return '\n'.join(f'- {line}' for line in lines)


def _family(state: str) -> str:
    """Return the name of a hidden state without its number: elements have one each."""
    return re.sub(r' \d+$', 's', state)


def _signature(effect: type[Effect], shown: Signature) -> str:
    """Return the picture and its numbers."""
    return (
        f'## Signature\n\n![{effect.signature}](../images/effects/{effect.name}.png)\n\n'
        f'A load of 10 kg hangs from the default muscle, with `{effect.example()!r}` and without '
        f'it. The residual is {shown.rms:.3g} mm RMS and at most {shown.largest:.3g} mm.'
    )


def _use(effect: type[Effect]) -> str:
    """Return how it is switched on in the simulator and from Python."""
    example = effect.example()
    given = ' '.join(f'-p {_ros(effect.name, k, v)}' for k, v in example.given.items())
    name = type(example).__name__
    return (
        f'## Use\n\n```console\n$ ros2 run pam_ros pam_sim --ros-args {given}\n```\n\n'
        f'```python\nfrom pam_ros import {name}, single_muscle_joint\n\n'
        f'effect = {example!r}\njoint = single_muscle_joint(effects=[effect])\n```'
    )


def _ros(effect: str, parameter: str, value: float) -> str:
    """Return a parameter as the command line of ROS takes it: a float, never an integer."""
    return f'effects.{effect}.{parameter}:={value!r}'


def _experiment(effect: type[Effect]) -> str:
    """Return how to distinguish it from the effects that it is mistaken for."""
    parts = ['## How to distinguish it']
    if effect.rivals:
        parts.append(f'It is mistaken for {linked(effect.rivals)}.')
    parts.append(f'What to record: {effect.experiment}.')
    if effect.excitation is not None:
        parts.append(
            f'```console\n$ ros2 run pam_ros {command_line(effect.excitation)}\n```\n\n'
            'Add the limits of your muscle, by `-p muscle:=NAME` or a parameter file, see '
            '[`pam_excite`](../recordings.md#pam_excite-a-programme-that-distinguishes-the-effects).'
        )
    return '\n\n'.join(parts)


def main() -> None:
    """Write all pages and pictures."""
    GUIDE.write_text(with_tables(GUIDE.read_text(encoding='utf-8')), encoding='utf-8')
    for folder in (FOLDER, PICTURES):
        folder.mkdir(exist_ok=True)
        for file in folder.iterdir():
            if file.stem not in {effect.name for effect in EFFECTS}:
                file.unlink()
    for effect in EFFECTS:
        shown = signature_of(effect.example())
        (FOLDER / f'{effect.name}.md').write_text(page(effect, shown), encoding='utf-8')
        draw(effect.example(), shown, PICTURES / f'{effect.name}.png')


if __name__ == '__main__':
    main()
