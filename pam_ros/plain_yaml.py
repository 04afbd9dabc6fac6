# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read a YAML file of a user: only plain data, within limits of size and nesting.

All YAML files of users are read here. Plain data are mappings, lists, texts, numbers, true, false
and null. Aliases are refused, as in ROS: with aliases a short file can describe data without end.
"""

import re
from pathlib import Path
from typing import Any

import yaml

from pam_ros.errors import ParameterError, printable

MOST_BYTES = 4_000_000  # the metadata of a bag of ten thousand files have about 3 MB
DEEPEST = 32  # levels of nested mappings and lists
# ROS reads this as a number; YAML 1.1 only if it has a point and a signed exponent, else as text.
EXPONENTIAL = re.compile(r'^[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)[eE][-+]?[0-9]+$')
_TAG = 'tag:yaml.org,2002:'
_KINDS = {'str': 'a text', 'int': 'a whole number', 'float': 'a number', 'bool': 'true or false'}
_PLAIN_TAGS = {_TAG + kind for kind in (*_KINDS, 'null', 'seq', 'map')}
_Base: Any = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)  # the fast one, if available


class _Loader(_Base):  # type: ignore[misc]
    """YAML as ROS reads it: 6e5 is a number, 2026-11-22 a text. A key is there once."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> Any:
        """Return the mapping; raises a YAMLError for a key that is there twice."""
        seen: set[tuple[str, str]] = set()
        for key, _ in node.value:
            if (one := (key.tag, str(key.value))) in seen:
                what = f'{printable(str(key.value))} is there twice: give it once'
                raise yaml.MarkedYAMLError(problem=what, problem_mark=key.start_mark)
            seen.add(one)
        return super().construct_mapping(node, deep)


_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != _TAG + 'timestamp']
    for first, resolvers in _Base.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(
    _TAG + 'float',
    EXPONENTIAL,
    list('-+.0123456789'),
)


def _scalar(kind: str) -> Any:
    """Return the constructor of a *kind* of scalar, with a YAMLError for an invalid text."""
    construct = _Base.yaml_constructors[_TAG + kind]

    def checked(loader: Any, node: yaml.Node) -> Any:
        try:
            return construct(loader, node)
        except (ValueError, LookupError):  # from constructors of numbers and booleans
            what = f'{node.value!r} is not {_KINDS[kind]}'
            raise yaml.MarkedYAMLError(problem=what, problem_mark=node.start_mark) from None

    return checked


for _kind in _KINDS:
    _Loader.add_constructor(_TAG + _kind, _scalar(_kind))


def read_yaml(path: Path) -> Any:
    """Return the plain data in the YAML file at *path*; raises ParameterError if not valid."""
    try:
        if path.exists() and not path.is_file():
            # A device may have no end, and a pipe may have no writer.
            raise ParameterError(f'{path} cannot be read: it is not a file')
        with path.open('rb') as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise ParameterError(f'{path} has more than {MOST_BYTES} bytes, which are the most')
        text = data.decode('utf-8-sig')
    except OSError as error:
        raise ParameterError(f'{path} cannot be read: {error.strerror}') from error
    except ValueError as error:  # bytes that are not allowed in a path or in UTF-8
        raise ParameterError(f'{path} cannot be read: {error}') from error
    try:
        _refuse_other_than_plain(text)
        return yaml.load(text, _Loader)
    except yaml.YAMLError as error:
        raise ParameterError(f'{path} is not valid YAML: {_reason(error)}') from error


def plain_text(text: str) -> str:
    """Return *text* in one line that YAML reads as the same text.

    Trailing colons and leading # are removed from each word: ``ros2 param load`` parses a value
    that it has read from a file as YAML a second time. The caller ensures that the first word is
    not an indicator of YAML.
    """
    words = (word.rstrip(':').lstrip('#') for word in printable(text).split())
    return ' '.join(filter(None, words))


def _refuse_other_than_plain(text: str) -> None:
    """Raise a YAMLError for tags, anchors and deep nesting, before any data are constructed."""
    depth = 0
    for event in yaml.parse(text, _Base):
        problem, tag = None, getattr(event, 'tag', None)
        if isinstance(event, yaml.AliasEvent) or getattr(event, 'anchor', None):
            problem = 'anchors and aliases (& and *) are not allowed: write the values out'
        elif tag not in (None, '!', *_PLAIN_TAGS):
            problem = f'the tag {tag} is not allowed: give plain values'
        elif isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > DEEPEST:
                problem = f'more than {DEEPEST} mappings or lists are within each other'
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if problem is not None:
            mark: Any = event.start_mark
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


def _reason(error: yaml.YAMLError) -> str:
    """Return the problem and its position in one line."""
    mark = getattr(error, 'problem_mark', None)
    if mark is None:
        return ' '.join(str(error).split())
    texts = (getattr(error, 'context', None), getattr(error, 'problem', None))
    what = ', '.join(text for text in texts if text)
    return f'line {mark.line + 1}, column {mark.column + 1}: {what}'
