# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The complete text of a message type, as rosbag2 embeds it in a bag (``ros2msg``)."""

import re
import sys
from pathlib import Path

from ament_index_python.packages import get_package_share_directory

_RULE = '=' * 80
_FIELD = re.compile(r'^\s*([A-Za-z][\w/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*', re.MULTILINE)
_PRIMITIVES = frozenset(
    ('bool', 'byte', 'char', 'string', 'wstring', 'float32', 'float64')
) | frozenset(f'{sign}int{bits}' for sign in ('', 'u') for bits in (8, 16, 32, 64))


def message_text(kind: str) -> str:
    """Return the .msg of *kind* (``package/msg/Name``) and of all types that it contains.

    The result is '' if one of them is not installed as .msg.
    """
    texts: dict[str, str] = {}
    waiting = [kind]
    while waiting:
        name = waiting.pop(0)
        if name in texts:
            continue
        package, _, short = name.split('/')
        file = _share(package) / 'msg' / f'{short}.msg'
        if not file.is_file():
            return ''
        texts[name] = file.read_text(encoding='utf-8')
        waiting += _parts(texts[name], package)
    first, *others = texts
    return '\n'.join(
        [texts[first], *(f'{_RULE}\nMSG: {_brief(name)}\n{texts[name]}' for name in others)]
    )


def _share(package: str) -> Path:
    try:
        return Path(get_package_share_directory(package))
    except (LookupError, OSError):
        # ROS from wheels: no index is sourced, the packages are in the environment itself.
        return Path(sys.prefix) / 'share' / package


def _parts(text: str, package: str) -> list[str]:
    """Return the full names of the message types that the fields of *text* have."""
    plain = re.sub(r'#.*', '', text)
    names = []
    for name in _FIELD.findall(plain):
        if name in _PRIMITIVES:
            continue
        parts = name.split('/')
        names.append(f'{parts[0] if len(parts) > 1 else package}/msg/{parts[-1]}')
    return names


def _brief(name: str) -> str:
    package, _, short = name.split('/')
    return f'{package}/{short}'
