# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""docs/recordings.md: its examples run, and it names every parameter."""

import re
from pathlib import Path

import pytest
import yaml

from pam_ros.excitation.programme import plan, programme
from pam_ros.excitation.settings import Excitation
from pam_ros.parameters import described
from pam_ros.recording.mapping import read_mapping

GUIDE = (Path(__file__).parents[2] / 'docs' / 'recordings.md').read_text(encoding='utf-8')


def blocks(kind):
    return re.findall(rf'```{kind}\n(.*?)```', GUIDE, re.DOTALL)


def test_the_rules_can_be_understood(tmp_path):
    rules = re.findall(r"^--column '?([^'\n#]+?)'?\s*(?:#.*)?$", GUIDE, re.MULTILINE)
    assert len(rules) == 5
    assert len(list(read_mapping(rules))) == 5
    (columns,) = blocks('yaml')
    assert sorted(yaml.safe_load(columns)) == ['columns']
    (tmp_path / 'columns.yaml').write_text(columns)
    assert len(list(read_mapping(file=tmp_path / 'columns.yaml'))) == 2


@pytest.mark.parametrize('name', described(Excitation))
def test_every_parameter_is_in_the_table_with_its_default(name):
    row = next(line for line in GUIDE.splitlines() if re.match(rf'\|.*`{name}`', line))
    cells = [cell.strip() for cell in row.strip('|').split('|')]
    names = re.findall(r'`(\w+)`', cells[0])
    default = described(Excitation)[name][1]
    if default == '':
        assert cells[1] == ''
    else:
        assert float(cells[1].split(',')[names.index(name)]) == float(default)


def test_the_plan_is_what_is_printed():
    chosen = Excitation()
    lines = plan(programme(chosen), chosen).splitlines()
    for line in (*lines[:3], lines[-1]):
        assert line in GUIDE
