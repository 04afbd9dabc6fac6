# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The guide in docs/effects.md: its example works, and its tables are those of the library.

Run as a script, this file writes the tables anew.
"""

import importlib
import re
from pathlib import Path

import pytest

import pam_ros.effects
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import PLACES

GUIDE = Path(__file__).parents[2] / 'docs' / 'effects.md'


def effects_table():
    """Return the table of effects in Markdown."""
    rows = [
        '| effect | what it is | acts on | source | mistaken for | told apart by |',
        '|---|---|---|---|---|---|',
    ]
    for e in EFFECTS:
        places = ', '.join(place for place in PLACES if getattr(e, place))
        rivals = ', '.join(f'`{name}`' for name in e.rivals) or '-'
        rows.append(
            f'| `{e.name}` | {e.text} | {places} | {e.source} | {rivals} | {e.experiment} |'
        )
    return '\n'.join(rows)


def parameters_table():
    """Return the table of parameters in Markdown, strengths in bold."""
    rows = ['| parameter | unit | range | default | meaning |', '|---|---|---|---|---|']
    for e in EFFECTS:
        for p in e.parameters:
            name = f'`effects.{e.name}.{p.name}`'
            if p.strength:
                name = f'**{name}**'
            span = f'{p.low:g} to {p.high:g}'
            rows.append(f'| {name} | {p.unit or "-"} | {span} | {p.default:g} | {p.text} |')
    return '\n'.join(rows)


def with_tables(text):
    """Return the guide with both tables as they must be."""
    for name, table in (('effects', effects_table()), ('parameters', parameters_table())):
        marks = f'<!-- {name} -->', f'<!-- /{name} -->'
        begin = text.index(marks[0]) + len(marks[0])
        text = f'{text[:begin]}\n{table}\n{text[text.index(marks[1]) :]}'
    return text


@pytest.fixture
def blocks():
    """Return the guide's blocks of Python: the example and its test."""
    return re.findall(r'^```python\n(.*?)^```', GUIDE.read_text(), re.MULTILINE | re.DOTALL)


def test_tables_are_those_of_the_library():
    text = GUIDE.read_text()
    assert text == with_tables(text), f'run python {Path(__file__).name} to write them anew'


def test_example_works_and_passes_its_test(blocks, tmp_path, monkeypatch):
    (tmp_path / 'choked_valve.py').write_text(blocks[0])
    (tmp_path / 'test_choked_valve.py').write_text(blocks[1])
    monkeypatch.syspath_prepend(tmp_path)
    new = importlib.import_module('choked_valve').EFFECT
    # The one line.
    monkeypatch.setattr(pam_ros.effects, 'EFFECTS', (*EFFECTS[:2], new, *EFFECTS[2:]))
    importlib.import_module('test_choked_valve').test_chamber_fills_along_a_ramp()


if __name__ == '__main__':
    GUIDE.write_text(with_tables(GUIDE.read_text()))
