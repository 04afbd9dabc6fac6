# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The file of an identified joint has the numbers of the report beside it."""

import json

import pytest
import yaml


def check_identified(file):
    """Compare an ``identified.yaml`` with the last model in the ``report.json`` beside it."""
    report = json.loads((file.parent / 'report.json').read_text(encoding='utf-8'))
    written = _flat(yaml.safe_load(file.read_text(encoding='utf-8'))['/**']['ros__parameters'])
    reported = {
        name: one['value']
        for name, one in report['parameters']['augmented'].items()
        if name in written
    }
    assert {name: written[name] for name in reported} == pytest.approx(reported, rel=1e-9)
    assert len(reported) >= 2, f'{file} has none of the parameters of its report'


def _flat(nested, before=''):
    """Return a mapping with the names of ROS: those of the levels, with dots between them."""
    found = {}
    for name, value in nested.items():
        inner = isinstance(value, dict)
        found |= _flat(value, f'{before}{name}.') if inner else {f'{before}{name}': value}
    return found
