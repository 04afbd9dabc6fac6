# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of the demonstration: made at once, or refused with a sentence."""

import pytest

from pam_ros.demo.stage import DemoStage
from pam_ros.errors import PamError


def test_the_folder_is_made_with_those_above_it(tmp_path):
    assert DemoStage(tmp_path / 'new' / 'demo').folder.is_dir()


def test_a_folder_that_cannot_be_made_is_one_sentence(tmp_path):
    (tmp_path / 'file').write_text('', encoding='utf-8')
    with pytest.raises(PamError) as refused:
        DemoStage(tmp_path / 'file' / 'demo')
    assert str(refused.value) == f'{tmp_path / "file" / "demo"} cannot be made: Not a directory'
