# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read and write ROS parameter files without ROS, and find those that come with the package.

A file contains a table for each node name, ``/**`` for all nodes, with dotted or nested names::

    /**:
      ros__parameters:
        mass: 20.0
        effects:
          creep: {gain: 0.05}
"""

import logging
import os
import re
import tempfile
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from pam_ros.errors import ParameterError, printable, shown
from pam_ros.plain_yaml import read_yaml
from pam_ros.rig.arrangements import LOAD
from pam_ros.settings.tables import Table, Value, refuse_mistyped, refuse_unknown_effects

TABLE = 'ros__parameters'
PRESETS = ('muscles', 'rigs')


class _Dumper(yaml.SafeDumper):
    """YAML with quoted texts, so that every parser reads them as texts."""


class _Text(str):
    """A string value, as opposed to a name."""


_Dumper.add_representer(
    _Text, lambda dumper, text: dumper.represent_scalar('tag:yaml.org,2002:str', text, style="'")
)


def share() -> Path:
    """Return the folder that contains ``config/``: the checkout or the package's share folder."""
    here = Path(__file__)
    checkout = here.resolve().parents[2]
    prefixes = [*here.parents, *(Path(p) for p in _ament_prefixes())]
    for folder in (checkout, *(prefix / 'share' / 'pam_ros' for prefix in prefixes)):
        if (folder / 'package.xml').is_file() and (folder / 'config').is_dir():
            return folder
    raise ParameterError('the folder config/ of pam_ros was not found: is the package installed?')


def _ament_prefixes() -> list[str]:
    return [p for p in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep) if p]


def find(name: str) -> Path:
    """Return the file of *name*: a path, or the name of a muscle or rig of the package.

    ``dmsp_20_400n`` stands for ``config/muscles/dmsp_20_400n.yaml``. Raises ParameterError, with a
    list of the names of the package, if there is no such file.
    """
    path = Path(name)
    try:
        if path.is_file():
            return path
    except OSError as error:  # too long for a path
        raise ParameterError(f'{name} cannot be read: {error.strerror}') from error
    known = {stem: file for folder in PRESETS for stem, file in presets(folder).items()}
    if name in known:
        return known[name]
    raise ParameterError(
        f'{name} is neither a parameter file nor a muscle or rig of this package: give a path or '
        'one of ' + ', '.join(known)
    )


def presets(folder: str) -> dict[str, Path]:
    """Return the files of this package in a *folder* of ``config``, by their names."""
    return {file.stem: file for file in sorted((share() / 'config' / folder).glob('*.yaml'))}


def read(path: Path, node: str = 'pam_sim') -> dict[str, Value]:
    """Return the parameters in *path* for a node of this name, by dotted names.

    Tables of other nodes are ignored. Raises ParameterError if the file cannot be read or has no
    table for this node.
    """
    if not any(_is_for(name, node) for name, _ in _tables(read_yaml(path))):
        raise ParameterError(
            f'{path} has no parameters for {node}: a parameter file has a table {TABLE} below '
            f'/** or {node}'
        )
    return read_any(path, node)


def read_any(path: Path, node: str) -> dict[str, Value]:
    """Return the parameters in *path* for a node of this name; none if it has no table for it.

    Raises ParameterError if the file cannot be read.
    """
    tables = [table for name, table in _tables(read_yaml(path)) if _is_for(name, node)]
    values: dict[str, Value] = {}
    for table in tables:
        for name, read in flattened(table):
            is_list = isinstance(read, list) and all(isinstance(text, str) for text in read)
            if not (is_list or isinstance(read, bool | int | float | str)):
                raise ParameterError(
                    f'{path}: {name} = {read!r} is not a single value, nor a list of texts'
                )
            values[name] = tuple(read) if is_list else read
    return values


def lacking(path: Path, node: str) -> str:
    """Return a sentence if *path* has no parameters for the node with this full name, else ''.

    Table names are matched as in ROS: ``*`` stands for one part of a name, ``**`` for any number.
    Raises ParameterError if the file cannot be read or is not a parameter file.
    """
    content = read_yaml(path)
    if not isinstance(content, dict | None):
        raise ParameterError(f'{path} is not a parameter file: give one with a table {TABLE}')
    tables = dict.fromkeys(name for name, _ in _tables(content))
    if any(_pattern(name).fullmatch(node) for name in tables):
        return ''
    found = f'those that it has are for {", ".join(tables)}' if tables else f'it has no {TABLE}'
    return f'{path} has no parameters for {node} and is not used: {found}'


def _pattern(name: str) -> re.Pattern[str]:
    """Return a pattern of the full names of nodes that a table with this *name* is for."""
    parts = name.strip('/').split('/')
    each = [{'*': '[^/]+', '**': '.*'}.get(part, re.escape(part)) for part in parts]
    return re.compile('/' + '/'.join(each).replace('.*/', '(.*/)?'))


@cache
def _warn(sentence: str) -> None:
    """Log a sentence, once in this process; without a handler it is printed on stderr."""
    logging.getLogger('pam_ros').warning('%s', shown(sentence))


def _tables(content: Any, name: str = '') -> Iterator[tuple[str, Any]]:
    """Yield each parameter table of a file with the name of its node, namespaces included."""
    if isinstance(content, dict):
        for key, value in content.items():
            if key == TABLE:
                yield name, value
            else:
                yield from _tables(value, f'{name}/{key}'.replace('//', '/'))


def _is_for(name: str, node: str) -> bool:
    last = name.rsplit('/', 1)[-1]
    return last in (node, '*', '**')


def flattened(table: Any, prefix: str = '') -> Iterator[tuple[str, Any]]:
    """Yield the values of nested mappings with their dotted names."""
    if isinstance(table, dict):
        for key, value in table.items():
            yield from flattened(value, f'{prefix}.{key}' if prefix else str(key))
    elif prefix:
        yield prefix, table


def read_known(name: str, table: Table) -> dict[str, Value]:
    """Return the values of a file or muscle *name*.

    Raises ParameterError for the file of a joint, for a mistyped name of *table*, and for an
    effect that does not exist.
    """
    path = find(name)
    values = read(path)
    if values.get('joint', LOAD.name) != LOAD.name:
        raise ParameterError(
            f'{path} describes a joint ({values["joint"]}), not a muscle: give it as a parameter '
            'file (--params-file)'
        )
    try:
        refuse_unknown_effects(values)
        refuse_mistyped(values, table)
    except ParameterError as error:
        raise ParameterError(f'{path}: {error}') from error
    return values


def write(path: Path, values: Mapping[str, Value], about: str = '', node: str = '/**') -> None:
    """Write flat *values* as a ROS parameter file for *node*, with *about* as its comment.

    The file is written completely or not at all.
    """
    nested: dict[str, Any] = {}
    for name, value in values.items():
        *groups, last = name.split('.')
        table = nested
        for group in groups:
            table = table.setdefault(group, {})
        plain = value.item() if isinstance(value, np.generic) else value
        table[last] = _Text(plain) if isinstance(plain, str) else plain
    text = ''.join(f'# {printable(line)}'.rstrip() + '\n' for line in about.splitlines())
    text += yaml.dump({node: {TABLE: nested}}, Dumper=_Dumper, sort_keys=False, allow_unicode=True)
    write_whole(path, text)


def write_whole(path: Path, text: str) -> None:
    """Write *text* as the file *path*, completely or not at all; raises OSError.

    Folders that do not exist are made.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(
        'w', dir=path.parent, prefix=f'.{path.name}', delete=False, encoding='utf-8'
    ) as file:
        part = Path(file.name)
        try:
            file.write(text)
            file.close()
            part.chmod(0o644)
            part.replace(path)
        except BaseException:
            part.unlink(missing_ok=True)
            raise
