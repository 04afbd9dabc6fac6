# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the page on the model shows runs as it stands."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[1] / 'docs' / 'model.md'
EXAMPLES = re.findall(r'```python\n(.*?)```', PAGE.read_text(encoding='utf-8'), re.DOTALL)
SHOWN = [
    ['a1: -0.044 +- ', 'a3: -0.33 +- ', 'a6: -264 +- ', '\n0.214\n'],
    ['0.0973 m, 196.1 N', '[0.06445245 0.07952174 0.10558803]'],
]


@pytest.mark.parametrize('which', range(len(SHOWN)))
def test_examples_run_and_show_what_they_should(which, capsys):
    assert len(EXAMPLES) == len(SHOWN)
    exec(compile(EXAMPLES[which], str(PAGE), 'exec'), {})
    printed = capsys.readouterr().out
    for part in SHOWN[which]:
        assert part in printed, printed
