# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/effects.md are those of the library; the example of the tutorial works."""

import importlib
import re
import runpy

import pytest

import pam_ros
from pam_ros.effects import EFFECTS, base
from pam_ros.effects.base import PLACES, Compensation
from pam_ros.excitation.command import command_line
from support.pages import ROOT, blocks

TABLES_PAGE = ROOT / 'docs' / 'effects.md'
GUIDE = ROOT / 'docs' / 'tutorials' / 'add_an_effect.md'
TABLES = runpy.run_path(str(ROOT / 'tools' / 'tables.py'))


def test_tables_are_those_of_the_library():
    text = TABLES_PAGE.read_text(encoding='utf-8')
    assert text == TABLES['with_tables'](text), 'make tables writes them'


def test_the_table_contains_everything_that_each_effect_declares():
    rows = TABLES['effects_table']().splitlines()[2:]
    for effect, row in zip(EFFECTS, rows, strict=True):
        for text in (effect.name, effect.signature, effect.compensation.value):
            assert text in row
        assert f'| {"joint" if effect.acts_on_joint() else "muscle"}: ' in row
        assert row.count('|') == 7


def test_the_table_of_experiments_has_the_command_of_each():
    rows = TABLES['experiments_table']().splitlines()[2:]
    for effect, row in zip(EFFECTS, rows, strict=True):
        for text in (effect.name, effect.experiment, *effect.rivals):
            assert text in row
        command = '-' if effect.excitation is None else f'`{command_line(effect.excitation)}`'
        assert row.endswith(f' | {command} |')
        assert row.count('|') == 5


def test_the_guide_names_every_compensation():
    text = GUIDE.read_text(encoding='utf-8')
    for compensation in Compensation:
        assert f'| `{compensation.name}` |' in text


def test_the_guide_has_the_signature_of_every_place():
    text = GUIDE.read_text(encoding='utf-8')
    signatures = re.findall(r'^``(\w+\([\w, ]+\)) -> ', base.__doc__, re.MULTILINE)
    assert [signature.partition('(')[0] for signature in signatures] == list(PLACES)
    for signature in signatures:
        assert f'| `{signature}` |' in text


@pytest.mark.slow
def test_example_works_and_passes_its_test(tmp_path, monkeypatch):
    example, its_test = blocks(GUIDE, 'python')
    (tmp_path / 'choked_valve.py').write_text(example)
    (tmp_path / 'test_choked_valve.py').write_text(its_test)
    monkeypatch.syspath_prepend(tmp_path)
    new = importlib.import_module('choked_valve').ChokedValve
    # The one line.
    library = (*EFFECTS[:2], new, *EFFECTS[2:])
    monkeypatch.setattr(pam_ros, 'EFFECTS', library, raising=False)
    monkeypatch.setattr(pam_ros.effects, 'ChokedValve', new, raising=False)
    importlib.import_module('test_choked_valve').test_chamber_fills_along_a_ramp()
