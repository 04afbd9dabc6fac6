# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the pages show as code: of a known kind, from the public names; examples are held to it.

The examples themselves are tests of their pages, see ``conftest.py`` at the top.
"""

import re
from pathlib import Path

import pytest
import yaml

from pam_ros import Braid, equilibrium, load_muscle
from pam_ros.settings.files import read
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from support.assertions import no_error
from support.pages import DOCS, PAGES, blocks, fences

KINDS = {'bash', 'console', 'python', 'text', 'xml', 'yaml'}
each_page = pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)


@each_page
def test_blocks_are_of_a_known_kind_and_end(page):
    opened = fences(page)[::2]
    closed = fences(page)[1::2]
    assert set(opened) <= KINDS
    assert closed == [''] * len(opened)


# An effect, which this tutorial writes, is a part of the package.
OUTSIDE = [page for page in PAGES if page.name != 'add_an_effect.md' and blocks(page, 'python')]


@pytest.mark.parametrize('page', OUTSIDE, ids=lambda page: page.name)
def test_examples_import_from_the_public_face_alone(page):
    modules = {
        module
        for example in blocks(page, 'python')
        for module in re.findall(r'^from (pam_ros\S*) import', example, re.MULTILINE)
    }
    assert modules <= {'pam_ros', 'pam_ros.effects'}


@pytest.mark.slow
@pytest.mark.needs_numba
def test_parameter_files_of_a_tutorial_make_the_joints_of_its_examples(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = DOCS / 'tutorials' / 'your_own_muscle_and_joint.md'
    names = {}
    for example in blocks(page, 'python'):
        exec(example, names)
    braid, *files = blocks(page, 'yaml')
    Path('braid.yaml').write_text(braid, encoding='utf-8')
    geometry = yaml.safe_load(braid)['/**']['ros__parameters'].pop('braid')
    muscle = load_muscle('braid.yaml')
    assert muscle == Braid(**geometry).muscle(l0=0.185, p_max=500e3, kappa_max=0.28)
    for file, name in zip(files, ('elbow', 'lever', 'crank'), strict=True):
        Path('joint.yaml').write_text(file, encoding='utf-8')
        given = read(Path('joint.yaml'))
        scene = Scene(given)
        assert given.keys() <= scene.table().keys()
        (made,) = scene.build(checked(scene.table(), given)).joints
        expected = names[name]
        assert made.transmission == expected.transmission
        assert made.load == expected.load
        muscles = zip(made.actuators, expected.actuators, strict=True)
        assert all(one.contraction == other.contraction for one, other in muscles)
        pressures = [300e3, 200e3][: len(made.actuators)]
        assert equilibrium(made, pressures) == pytest.approx(
            equilibrium(expected, pressures), rel=1e-12
        )


def evaluated(source, tmp_path):
    """Return what is wrong with a page of one example, as its evaluation says it."""
    sybil = pytest.importorskip('sybil')
    from sybil.parsers.markdown import CodeBlockParser

    from support.examples import evaluate

    page = tmp_path / 'page.md'
    page.write_text(f'# A page\n\n```python\n{source}\n```\n', encoding='utf-8')
    document = sybil.Document.parse(str(page), CodeBlockParser('python', evaluate))
    (example,) = document.examples()
    example.evaluate()


@pytest.mark.parametrize(
    'source',
    [
        'print(1 + 1)  # 2',
        'x = 3  # nothing is said\nprint("first")\nprint(\n    x\n)  # 3',
        'print("a")  # a\nprint("b")  # b',
    ],
)
def test_an_example_that_prints_its_stated_output_passes(source, tmp_path):
    with no_error():
        evaluated(source, tmp_path)


@pytest.mark.parametrize(
    ('source', 'said'),
    [
        ('print(1 + 1)  # 3', "'3' is not printed"),
        ('print(\n    1\n)  # 3', "'3' is not printed"),
        ('print("b")  # b\nprint("a")  # b', "'b' is not printed"),
        ('for x in []:\n    print(x)', 'nothing is printed'),
        ('print(nosuch)', 'nosuch'),
    ],
)
def test_an_example_that_does_not_fails(source, said, tmp_path):
    with pytest.raises(Exception, match=said):
        evaluated(source, tmp_path)
