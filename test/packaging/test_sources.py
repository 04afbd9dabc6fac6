# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every source file: its header."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
HEADER = ['# Copyright 2026 The pam_ros authors', '# SPDX-License-Identifier: Apache-2.0']
FOLDERS = ('pam_ros', 'test', 'launch', 'benchmarks', 'tools')
FILES = sorted(
    path.relative_to(ROOT)
    for path in [ROOT / 'setup.py', *(p for f in FOLDERS for p in (ROOT / f).rglob('*.py'))]
)


def test_files_say_whose_they_are():
    for path in FILES:
        lines = (ROOT / path).read_text(encoding='utf-8').splitlines()
        start = 1 if lines[0].startswith('#!') else 0
        assert lines[start : start + 2] == HEADER, path


def test_license_is_apache():
    text = (ROOT / 'LICENSE').read_text(encoding='utf-8')
    assert 'Apache License' in text
    assert 'END OF TERMS AND CONDITIONS' in text
