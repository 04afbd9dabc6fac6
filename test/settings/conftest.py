# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files for all tests of the settings."""

import pytest


@pytest.fixture
def file(tmp_path):
    """Return a function that writes values, as YAML in braces, to a file and returns its path."""

    def made(values):
        path = tmp_path / 'given.yaml'
        path.write_text('/**: {ros__parameters: {' + values + '}}\n')
        return str(path)

    return made
