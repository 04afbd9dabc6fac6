# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A plugin that collects test files as that of launch_testing does, for ``pytest -p``.

It imports each file by pytest's default way, whatever ``--import-mode`` says, to see whether it
describes a launch test: a file in no package is a module of its bare name, from its own folder.
"""

import pytest
from _pytest.pathlib import import_path


def pytest_pycollect_makemodule(module_path, parent):
    """Import the file, and collect it as usual unless it describes a launch test."""
    try:
        module = import_path(module_path, root=None, consider_namespace_packages=False)
    except SyntaxError:  # which the collection shows better
        module = None
    assert not hasattr(module, 'generate_test_description'), 'no stand-in for launch tests'
    return pytest.Module.from_parent(parent, path=module_path)
