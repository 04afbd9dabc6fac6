# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pneumatic artificial muscles: simulate, control, identify.

The names in ``__all__`` are the public interface, which ``docs/python.md`` describes. All other
names of the package are internal and may change. ``__init__.pyi`` lists the public names, for type
checkers as well. A name is imported when it is first used, so that programs that need only a part
of the package do not wait for the rest.
"""

import ast
from importlib import import_module
from pathlib import Path
from typing import Any

_HERE = Path(__file__).parent


def _modules_of_names(file: Path) -> dict[str, str]:
    """Return the module of each name that *file* imports; ``*`` stands for all effects."""
    found = {}
    for node in ast.parse(file.read_text(encoding='utf-8')).body:
        if isinstance(node, ast.ImportFrom):
            for name in node.names:
                if name.name == '*':
                    found |= _modules_of_names(_HERE / 'effects' / '__init__.py')
                else:
                    found[name.name] = str(node.module)
    return found


_MODULES = _modules_of_names(_HERE / '__init__.pyi')
__all__ = list(_MODULES)


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used (PEP 562)."""
    if name not in _MODULES:
        raise AttributeError(f'module pam_ros has no attribute {name}')
    value = getattr(import_module(_MODULES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return __all__
