# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""YAML files of users: plain data, and what is refused before it costs time or memory."""

import os
from pathlib import Path

import pytest
import yaml

from pam_ros.errors import ParameterError
from pam_ros.plain_yaml import MOST_BYTES, read_yaml

LAUGHS = 'a: &a [x]\n' + ''.join(
    f'{name}: &{name} [{", ".join([f"*{before}"] * 9)}]\n'
    for before, name in zip('abcdefghij', 'bcdefghijk', strict=True)
)


@pytest.fixture
def file(tmp_path):
    def made(content):
        path = tmp_path / 'given.yaml'
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return made


def test_plain_data(file):
    text = """
        numbers: [1, -2, 0x10, 2.5, 6e5, .5e-1, .inf]
        texts: [plain, '6e5', "a b", !!str 7, 2026-11-22, 2020-13-45]
        others: {true: no, null: ~}
    """
    assert read_yaml(file(text)) == {
        'numbers': [1, -2, 16, 2.5, 6e5, 0.05, float('inf')],
        'texts': ['plain', '6e5', 'a b', '7', '2026-11-22', '2020-13-45'],
        'others': {True: False, None: None},
    }


def test_a_byte_order_mark_does_no_harm(file):
    assert read_yaml(file('a: 1'.encode('utf-8-sig'))) == {'a': 1}


@pytest.mark.parametrize(
    ('content', 'words'),
    [
        ('b: 1\na: 1\nb: 2', 'line 3, column 1: b is there twice: give it once'),
        ('x: {mass: 1, mass: 1}', 'line 1, column 14: mass is there twice'),
        ('a: [', 'line [12], column .: while parsing a flow node'),
        ('a: 1\n---\na: 1', 'another document'),
        ('a: \0', 'control characters|special characters'),
        (b'a: \xff', "cannot be read: 'utf-8' codec"),
        (
            'a: !!python/object:os.system {}',
            'line 1, column 4: the tag .*os.system is not allowed',
        ),
        ('a: !foo 3', 'the tag !foo is not allowed'),
        ('a: !!timestamp x', 'the tag .*timestamp is not allowed'),
        ('a: !!int abc', "line 1, column 4: 'abc' is not a whole number"),
        ('a: !!int ', "'' is not a whole number"),
        ('a: !!float x', "'x' is not a number"),
        ('a: !!bool x', "'x' is not true or false"),
        ('a: 0x_', "'0x_' is not a whole number"),
        ('a: ' + '9' * 5000, 'is not a whole number'),
        ('{[1]: 2}', 'unhashable key'),
        # PyYAML 6.0.4 has a limit of its own, which it meets while it looks ahead.
        ('a: ' + '[' * 5000 + ']' * 5000, 'more than 32 mappings or lists|nesting depth'),
        ('a: ' + '[' * 100 + ']' * 100, 'more than 32 mappings or lists'),
        ('a: ' + '{a: ' * 5000 + '}' * 5000, 'more than 32 mappings or lists'),
        ('a: &a {b: *a}', 'anchors and aliases'),
        ('a: &a [*a]', 'anchors and aliases'),
        ('a: *b', 'anchors and aliases'),
        (LAUGHS, 'line 1, column 4: anchors and aliases'),
        ('#' * (MOST_BYTES + 1), 'more than 4000000 bytes'),
    ],
)
@pytest.mark.parametrize('loader', ['CSafeLoader', 'SafeLoader'])
def test_what_is_refused(file, monkeypatch, loader, content, words):
    monkeypatch.setattr('pam_ros.plain_yaml._Base', getattr(yaml, loader, yaml.SafeLoader))
    path = file(content)
    with pytest.raises(ParameterError, match=words) as caught:
        read_yaml(path)
    assert str(caught.value).startswith(str(path))


def test_what_is_not_a_file_is_not_read(tmp_path):
    os.mkfifo(tmp_path / 'pipe')
    for path in (tmp_path, tmp_path / 'pipe', Path('/dev/zero')):
        with pytest.raises(ParameterError, match='it is not a file'):
            read_yaml(path)


@pytest.mark.parametrize('name', ['absent', 'x' * 5000, 'a\0b'])
def test_a_file_that_is_not_there(tmp_path, name):
    with pytest.raises(ParameterError, match='cannot be read'):
        read_yaml(tmp_path / name)
