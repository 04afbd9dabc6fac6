# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The notebooks run in a fresh kernel, and print and draw what is stored in them.

As pages, with their links and names, they are tested like the others.
"""

import json
import re
import runpy

import pytest

from support.notebooks import alike, code_cells, differences, printed
from support.pages import NOTEBOOKS, ROOT

LARGEST = 300_000  # bytes of a notebook
# What a file has where somebody else's computer, or the time of a run, got into it.
OF_A_MACHINE = re.compile(
    r'/(home|tmp|usr|root|Users|var|opt|mnt)/|[A-Z]:\\\\|iopub|20\d\d-\d\d-\d\d'
)
PYTHON = {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'}

each_notebook = pytest.mark.parametrize('path', NOTEBOOKS, ids=lambda path: path.name)


@pytest.fixture(scope='module')
def tool():
    """Return the functions of ``make notebook``; what they need, the extra ``test`` brings."""
    for needed in ('ipykernel', 'nbclient', 'nbformat'):
        pytest.importorskip(needed)
    return runpy.run_path(str(ROOT / 'tools' / 'notebook.py'))


def stored(path):
    return json.loads(path.read_text(encoding='utf-8'))


def test_there_is_a_notebook():
    assert [path.name for path in NOTEBOOKS] == ['muscle.ipynb']


@pytest.mark.slow
@pytest.mark.needs_numba
@each_notebook
def test_cells_print_and_draw_what_is_stored(path, tool, tmp_path):
    run = tool['executed'](tool['read'](path), tmp_path)
    assert differences(stored(path), run) == []
    assert [*tmp_path.iterdir()] == []  # nothing is left over


@each_notebook
def test_outputs_are_stored_of_a_run_from_top_to_bottom(path):
    cells = code_cells(stored(path))
    assert [cell['execution_count'] for cell in cells] == [*range(1, len(cells) + 1)]
    for cell in cells:
        source = ''.join(cell['source'])
        said, complaint, shown = printed(cell)
        assert complaint == ''
        assert bool(said) is ('print(' in source)
        assert ['image/png' in kinds for kinds in shown] == [True] * source.count('plt.show()')
        # The site says what a picture shows to those who cannot see it.
        assert len(shown) == len(cell['metadata'])


@each_notebook
def test_nothing_of_a_machine_is_stored(path):
    text = path.read_text(encoding='utf-8')
    assert len(text) <= LARGEST
    found = stored(path)
    assert found['metadata'] == {'kernelspec': PYTHON, 'language_info': {'name': 'python'}}
    for cell in found['cells']:
        assert set(cell['metadata']) <= {'mystnb'}
        for output in cell.get('outputs', []):
            assert output.get('metadata', {}) == {}
            output.get('data', {}).pop('image/png', None)
    assert not OF_A_MACHINE.search(json.dumps(found))


def notebook(tool, *sources):
    """Return a notebook of these cells of code."""
    v4 = tool['nbformat'].v4
    return v4.new_notebook(cells=[v4.new_code_cell(source) for source in sources])


@pytest.mark.slow
def test_a_cell_that_raises_fails(tool, tmp_path):
    with pytest.raises(Exception, match='ZeroDivisionError'):
        tool['executed'](notebook(tool, 'x = 0', '1 / x'), tmp_path)


@pytest.mark.slow
def test_a_change_of_a_cell_and_a_warning_are_found(tool, tmp_path):
    cells = ['x = 2', 'print(f"{x} mm")', 'import warnings']
    before = tool['executed'](notebook(tool, *cells), tmp_path)
    cells[0], cells[2] = 'x = 3', 'import warnings\nwarnings.warn("too low")'
    after = tool['executed'](notebook(tool, *cells), tmp_path)
    assert differences(before, before) == []
    printing, complaining = differences(before, after)
    assert printing == 'code cell 2 has stored\n2 mm\n\nand prints\n3 mm\n'
    assert 'too low' in complaining


def test_a_picture_that_is_missing_is_found():
    picture = {'output_type': 'display_data', 'data': {'image/png': '', 'text/plain': ''}}
    drawing, silent = (
        {'cells': [{'cell_type': 'code', 'outputs': outputs}]} for outputs in ([picture], [])
    )
    assert differences(drawing, drawing) == []
    assert len(differences(drawing, silent)) == 1


def test_a_cell_more_is_found():
    cell = {'cell_type': 'code', 'outputs': []}
    with pytest.raises(ValueError, match='zip'):
        differences({'cells': [cell]}, {'cells': [cell, cell]})


@pytest.mark.parametrize(
    ('one', 'other', 'same'),
    [
        ('12.01 N (11.99 to 12.02)', '12.02 N (11.95 to 12.03)', True),
        ('error 0.020 mm', 'error 0.021 mm', True),
        ('error 0.020 mm', 'error 0.022 mm', False),
        ('error 5.11 mm', 'error 5.15 mm', True),
        ('error 5.11 mm', 'error 5.21 mm', False),
        ('2 effects', '3 effects', False),
        ('1500 samples', '1510 samples', True),
        ('1e-05 m', '2e-05 m', False),
        ('-2.29 mm', '2.29 mm', False),
        ('12.01 N', '12.01 kN', False),
        ('12.01 N', '12.01 N 12.01 N', False),
        ('pressure_lag', 'leak', False),
    ],
)
def test_texts_are_alike_where_their_numbers_are_close(one, other, same):
    assert alike(one, other) is same
