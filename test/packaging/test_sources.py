# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every source file: its header, and that nothing is left of a merge."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
HEADER = ['# Copyright 2026 The pam_ros authors', '# SPDX-License-Identifier: Apache-2.0']
FOLDERS = ('pam_ros', 'test', 'launch', 'benchmarks', 'examples', 'tools')
FILES = sorted(
    path.relative_to(ROOT)
    for path in [ROOT / 'setup.py', *(p for f in FOLDERS for p in (ROOT / f).rglob('*.py'))]
)
# Pages and settings as well, at the top and in these folders.
WRITTEN = ('.html', '.js', '.j2', '.json', '.md', '.py', '.rst', '.toml', '.txt', '.xml', '.yaml')
WRITTEN += ('.ipynb',)
TEXTS = sorted(
    path.relative_to(ROOT)
    for path in [
        *ROOT.iterdir(),
        *(p for f in (*FOLDERS, 'config', 'docs', 'urdf') for p in (ROOT / f).rglob('*')),
    ]
    if path.suffix in WRITTEN
)
CONFLICT = re.compile(r'^(<{7}|>{7}) ', re.MULTILINE)


def test_files_say_whose_they_are():
    for path in FILES:
        lines = (ROOT / path).read_text(encoding='utf-8').splitlines()
        start = 1 if lines[0].startswith('#!') else 0
        assert lines[start : start + 2] == HEADER, path


def test_files_hold_no_unresolved_conflict():
    assert len(TEXTS) > 100
    for path in TEXTS:
        assert not CONFLICT.search((ROOT / path).read_text(encoding='utf-8')), path


def test_the_pages_are_among_the_texts():
    assert {Path('README.md'), Path('docs/python.md'), Path('CHANGELOG.rst')} <= set(TEXTS)


def test_license_is_apache():
    text = (ROOT / 'LICENSE').read_text(encoding='utf-8')
    assert 'Apache License' in text
    assert 'END OF TERMS AND CONDITIONS' in text
