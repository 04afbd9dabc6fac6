# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a source file imports, found without running it."""

import ast

BY_NAME = ('find_spec', 'import_module')  # with the module's name as a plain string


def imported(path):
    """Return the names of the top packages that a Python file imports, anywhere in it."""
    return {name.partition('.')[0] for name in modules_of(path)}


def modules_of(path, known=()):
    """Return the modules that a Python file imports, anywhere in it, in dotted names.

    ``from a import b`` imports ``a.b`` where that is one of the *known* modules, else ``a``.
    """
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            inner = (f'{node.module}.{alias.name}' for alias in node.names)
            names.update(name if name in known else node.module for name in inner)
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = getattr(node.func, 'attr', getattr(node.func, 'id', None))
            if called in BY_NAME:
                names.add(node.args[0].value)
    return names
