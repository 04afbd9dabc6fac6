# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A plugin that collects test files as that of launch_testing does, for ``pytest -p``.

It imports each file by pytest's default way, whatever ``--import-mode`` says, to see whether it
describes a launch test: a file in no package is a module of its bare name, from its own folder.
"""

import inspect

import pytest
from _pytest.pathlib import import_path

# From pytest 8.1 on this is not the default.
NAMESPACES = 'consider_namespace_packages'
OPTIONS = {NAMESPACES: False} if NAMESPACES in inspect.signature(import_path).parameters else {}


def pytest_pycollect_makemodule(module_path, parent):
    """Import the file, and collect it as usual unless it describes a launch test.

    It is only collected where launch_testing is installed, whose own plugin then takes it.
    """
    try:
        module = import_path(module_path, root=None, **OPTIONS)
    except SyntaxError:  # which the collection shows better
        module = None
    if hasattr(module, 'generate_test_description'):
        return None
    return pytest.Module.from_parent(parent, path=module_path)
