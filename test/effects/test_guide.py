# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The tutorial that adds an effect: it names all there is, and its example works."""

import importlib
import re

import pytest

import pam_ros
from pam_ros.effects import EFFECTS, base
from pam_ros.effects.base import PLACES, Compensation
from support.assertions import no_error
from support.pages import ROOT, blocks

GUIDE = ROOT / 'docs' / 'tutorials' / 'add_an_effect.md'


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
    monkeypatch.setattr(pam_ros, 'ChokedValve', new, raising=False)
    with no_error():
        importlib.import_module('test_choked_valve').test_chamber_fills_along_a_ramp()
