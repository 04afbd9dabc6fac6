# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""ROS parameter files as this package reads, finds and writes them."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.settings.files import find, lacking, read, read_known, share, write

ROOT = Path(__file__).parents[2]
MUSCLES = sorted(path.stem for path in (ROOT / 'config' / 'muscles').glob('*.yaml'))


@pytest.fixture
def file(tmp_path):
    def made(text):
        path = tmp_path / 'given.yaml'
        path.write_text(text)
        return path

    return made


@pytest.mark.parametrize(
    'text',
    [
        '/**:\n  ros__parameters:\n    mass: 7\n    effects: {payload: {mass: 2.0}}\n',
        '/**:\n  ros__parameters:\n    mass: 7\n    effects.payload.mass: 2.0\n',
        'pam_sim:\n  ros__parameters:\n    mass: 7\n    effects.payload: {mass: 2.0}\n',
        '/arm/pam_sim:\n  ros__parameters: {mass: 7, effects: {payload.mass: 2.0}}\n',
        'arm:\n  pam_sim:\n    ros__parameters: {mass: 7, effects.payload.mass: 2.0}\n',
        '/**:\n  ros__parameters: {mass: 7, effects.payload.mass: 1.0}\n'
        'pam_sim:\n  ros__parameters: {effects.payload.mass: 2.0}\n'
        'pam_control:\n  ros__parameters: {mass: 99, gains: [1, 2]}\n',
    ],
)
def test_all_forms_of_a_file_say_the_same(file, text):
    assert read(file(text)) == {'mass': 7, 'effects.payload.mass': 2.0}


def test_numbers_are_read_as_ros_reads_them(file):
    text = '/**: {ros__parameters: {p_max: 6e5, mass: 2E+1, zeta: .15, a3: -1.5e-1, l0: 4.e-1}}'
    values = read(file(text))
    assert values == {'p_max': 6e5, 'mass': 20.0, 'zeta': 0.15, 'a3': -0.15, 'l0': 0.4}


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('/**: [', 'is not valid YAML: line 2'),
        ('', 'has no parameters for pam_sim'),
        ('pam_sim: {mass: 20}', 'has no parameters for pam_sim'),
        ('pam_control: {ros__parameters: {mass: 20}}', 'has no parameters for pam_sim'),
        ('/**: {ros__parameters: {mass: [1, 2]}}', 'mass = .* is not a single value'),
        ('/**: {ros__parameters: {mass: }}', 'mass = None is not a single value'),
    ],
)
def test_what_is_no_parameter_file_is_refused_by_name(file, text, sentence):
    path = file(text)
    with pytest.raises(ParameterError, match=sentence) as caught:
        read(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    ('table', 'node', 'has'),
    [
        ('/**', '/pam_sim', True),
        ('/**', '/left/arm/pam_sim', True),
        ('pam_sim', '/pam_sim', True),
        ('/pam_sim', '/pam_sim', True),
        ('pam_sim', '/left/pam_sim', False),
        ('/left/pam_sim', '/left/pam_sim', True),
        ('/left/*', '/left/pam_sim', True),
        ('/*', '/left/pam_sim', False),
        ('/*/pam_sim', '/left/pam_sim', True),
        ('/**/pam_sim', '/pam_sim', True),
        ('/**/pam_sim', '/left/arm/pam_sim', True),
        ('/**/pam_sim', '/left/pam_sim_2', False),
        ('pam_control', '/pam_sim', False),
    ],
)
def test_for_which_nodes_a_table_is(file, table, node, has):
    path = file(f'"{table}": {{ros__parameters: {{mass: 7}}}}')
    sentence = f'{path} has no parameters for {node} and is not used: those that it has are for '
    assert lacking(path, node).startswith(sentence) is not has
    assert (lacking(path, node) == '') is has


def test_a_nested_table_and_a_file_without_one(file):
    nested = file('left: {pam_sim: {ros__parameters: {mass: 7}}}')
    assert lacking(nested, '/left/pam_sim') == ''
    assert lacking(nested, '/pam_sim').endswith('those that it has are for /left/pam_sim')
    assert lacking(file(''), '/pam_sim').endswith('it has no ros__parameters')
    with pytest.raises(ParameterError, match='is not a parameter file: give one with a table ros'):
        lacking(file('t,command_Pa\n0.0,1e5\n'), '/pam_sim')


def test_a_missing_or_unreadable_file_is_refused(tmp_path):
    with pytest.raises(ParameterError, match='cannot be read'):
        read(tmp_path / 'nowhere.yaml')
    with pytest.raises(ParameterError, match='cannot be read'):
        read_known('x' * 5000, {})
    (tmp_path / 'binary').write_bytes(b'\xff\xfe\x00')
    with pytest.raises(ParameterError, match='cannot be read'):
        read(tmp_path / 'binary')


@pytest.mark.parametrize('name', MUSCLES)
def test_every_muscle_of_the_package_is_found(name):
    assert MUSCLES
    assert find(name) == ROOT / 'config' / 'muscles' / f'{name}.yaml'


def test_an_unknown_muscle_is_refused_with_the_known_names():
    with pytest.raises(ParameterError, match=r'dmsp_99 is neither .* dmsp_20_400n'):
        find('dmsp_99')


@given(
    st.dictionaries(
        st.sampled_from(['mass', 'zeta', 'effects.payload.mass', 'effects.creep.gain', 'source']),
        st.one_of(
            st.floats(allow_nan=False, allow_infinity=False),
            st.integers(-(2**31), 2**31),
            st.booleans(),
            st.text(st.characters(exclude_categories=['C', 'Z'])),
        ),
    )
)
def test_what_is_written_is_read_again(tmp_path_factory, values):
    path = tmp_path_factory.mktemp('written') / 'new' / 'rig.yaml'
    write(path, values, 'What it is.\n\nWhere it comes from.')
    if values:
        again = read(path)
        assert again == values
        assert all(type(again[name]) is type(value) for name, value in values.items())
    assert path.read_text().startswith('# What it is.\n#\n# Where it comes from.\n')
    assert list(path.parent.iterdir()) == [path]


def test_a_text_that_looks_like_a_number_stays_a_text(tmp_path):
    path = tmp_path / 'a.yaml'
    write(path, {'source': '1e5', 'frame_id': 'on', 'joint_name': '007'})
    assert read(path) == {'source': '1e5', 'frame_id': 'on', 'joint_name': '007'}


def test_numbers_of_numpy_are_written_as_numbers(tmp_path):
    write(tmp_path / 'a.yaml', {'mass': np.float64(20.0), 'sensor.seed': np.int64(3)})
    assert read(tmp_path / 'a.yaml') == {'mass': 20.0, 'sensor.seed': 3}


def test_a_file_that_cannot_be_written_leaves_the_old_one(tmp_path):
    path = tmp_path / 'a.yaml'
    write(path, {'mass': 20.0})
    with pytest.raises(Exception, match='object'):
        write(path, {'mass': object()})
    assert read(path) == {'mass': 20.0}
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.slow
@pytest.mark.parametrize('folder', ['lib/python3.12/site-packages', 'elsewhere'])
def test_an_installed_package_finds_its_share_folder(tmp_path, folder):
    prefix = tmp_path / 'install'
    package = (prefix if folder.startswith('lib') else tmp_path) / folder / 'pam_ros'
    shutil.copytree(ROOT / 'pam_ros', package, ignore=shutil.ignore_patterns('__pycache__'))
    shutil.copytree(ROOT / 'config', prefix / 'share' / 'pam_ros' / 'config')
    shutil.copy(ROOT / 'package.xml', prefix / 'share' / 'pam_ros')
    code = 'from pam_ros.settings.files import find; print(find("dmsp_20_400n"))'
    result = subprocess.run(
        [sys.executable, '-c', code],
        env={**os.environ, 'PYTHONPATH': str(package.parent), 'AMENT_PREFIX_PATH': str(prefix)},
        cwd=tmp_path,
        text=True,
        capture_output=True,
        check=True,
    )
    found = prefix / 'share' / 'pam_ros' / 'config' / 'muscles' / 'dmsp_20_400n.yaml'
    assert result.stdout.strip() == str(found)
    assert share() == ROOT


def test_a_list_of_texts_is_read_as_a_tuple(tmp_path):
    path = tmp_path / 'arm.yaml'
    path.write_text('/**: {ros__parameters: {muscles: [left, right]}}\n')
    assert read(path) == {'muscles': ('left', 'right')}
