# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every source file: its header."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEADER = ['# Copyright 2026 The pam_ros authors', '# SPDX-License-Identifier: Apache-2.0']
FOLDERS = ('pam_ros', 'test', 'launch', 'benchmarks', 'tools')
FILES = sorted(
    path.relative_to(ROOT)
    for path in [ROOT / 'setup.py', *(p for f in FOLDERS for p in (ROOT / f).rglob('*.py'))]
)


@pytest.mark.parametrize('path', FILES, ids=str)
def test_file_says_whose_it_is(path):
    lines = (ROOT / path).read_text(encoding='utf-8').splitlines()
    start = 1 if lines[0].startswith('#!') else 0
    assert lines[start : start + 2] == HEADER


def test_license_is_apache():
    text = (ROOT / 'LICENSE').read_text(encoding='utf-8')
    assert 'Apache License' in text
    assert 'END OF TERMS AND CONDITIONS' in text
