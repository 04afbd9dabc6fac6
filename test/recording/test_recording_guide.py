# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""docs/recordings.md: its examples run, and it names every parameter."""

import re

import pytest
import yaml

from pam_ros.excitation.programme import plan, programme
from pam_ros.excitation.segments import SEGMENTS
from pam_ros.excitation.settings import Excitation
from pam_ros.parameters import described
from pam_ros.recording.mapping import read_mapping
from pam_ros.settings.recording_list import recording_files
from support.pages import ROOT, blocks, text_of

PAGE = ROOT / 'docs' / 'recordings.md'
GUIDE = text_of(PAGE)


def test_the_rules_can_be_understood(tmp_path):
    rules = re.findall(r"^--column '?([^'\n#]+?)'?\s*(?:#.*)?$", GUIDE, re.MULTILINE)
    assert len(rules) == 5
    assert len(list(read_mapping(rules))) == 5
    columns, recordings = blocks(PAGE, 'yaml')
    assert sorted(yaml.safe_load(columns)) == ['columns']
    (tmp_path / 'columns.yaml').write_text(columns)
    assert len(list(read_mapping(file=tmp_path / 'columns.yaml'))) == 2
    (tmp_path / 'recordings.yaml').write_text(recordings)
    files, params = recording_files(tmp_path / 'recordings.yaml')
    assert params == 'dmsp_20_400n'
    assert [one.numbers for one in files] == [{'mass': 10.0}, {'mass': 20.0}]


@pytest.mark.parametrize('name', described(Excitation))
def test_every_parameter_is_in_the_table_with_its_default(name):
    row = next(line for line in GUIDE.splitlines() if re.match(rf'\|.*`{name}`', line))
    cells = [cell.strip() for cell in row.strip('|').split('|')]
    names = re.findall(r'`(\w+)`', cells[0])
    default = described(Excitation)[name][1]
    if default == '':
        assert cells[1] == ''
    elif default == tuple(SEGMENTS):
        assert cells[1] == f'all {len(SEGMENTS)}'
    else:
        assert float(cells[1].split(',')[names.index(name)]) == float(default)


def test_the_plan_is_what_is_printed():
    chosen = Excitation()
    lines = plan(programme(chosen), chosen).splitlines()
    for line in (*lines[:3], lines[-1]):
        assert line in GUIDE
