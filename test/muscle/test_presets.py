# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The muscles and rigs that come with the package: complete, whole, and true to their source."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
import yaml

from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.step_limit import longest_step

CONFIG = Path(__file__).parents[2] / 'config'
MUSCLES = sorted((CONFIG / 'muscles').glob('*.yaml'))
OF_MUSCLE = {field.name for field in fields(Muscle)}
OF_LOAD = {field.name for field in fields(Mass)}


def load(path):
    content = yaml.safe_load(path.read_text(encoding='utf-8'))
    # What is for one program alone stands below its name: how exactly values are known.
    assert {*content} - {'pam_identify'} == {'/**'}
    assert list(content['/**']) == ['ros__parameters']
    return content['/**']['ros__parameters']


def rig(path):
    values = load(path)
    muscle = Muscle(**{k: v for k, v in values.items() if k in OF_MUSCLE})
    return single_muscle_joint(muscle, Mass(**{k: v for k, v in values.items() if k in OF_LOAD}))


# Those of one muscle; joints are tested where files become joints.
RIGS = [p for p in sorted((CONFIG / 'rigs').glob('*.yaml')) if 'joint' not in load(p)]


def preset(name):
    return rig(CONFIG / 'muscles' / f'{name}.yaml')


def test_the_published_muscles_are_there():
    names = {path.stem for path in MUSCLES}
    assert names == {'dmsp_20_400n', 'dmsp_20_200n', 'dmsp_10', 'dmsp_20_festo'}


@pytest.mark.parametrize('path', MUSCLES + RIGS, ids=lambda path: path.stem)
def test_every_preset_makes_a_rig_and_documents_it(path):
    values = load(path)
    # inside_diameter is of no use where there is no muscle.
    missing = OF_MUSCLE | OF_LOAD if path in MUSCLES else OF_MUSCLE - {'inside_diameter'}
    assert missing - set(values) == set()
    assert set(values) <= OF_MUSCLE | OF_LOAD
    assert len(values['source']) > 20
    for name, value in values.items():
        # ROS gives a whole number in a file another type than a float.
        assert isinstance(value, (float, str)), f'{name}: {value!r}'
    model = rig(path)
    assert longest_step(model) > 2e-3


def test_the_400_mm_muscle_is_the_default_one():
    values = load(CONFIG / 'muscles' / 'dmsp_20_400n.yaml')
    assert Muscle(**{k: v for k, v in values.items() if k in OF_MUSCLE}) == Muscle(
        source=values['source']
    )
    assert preset('dmsp_20_400n').load == Mass()


def data_sheet(folder, size):
    table = np.genfromtxt(
        folder / f'festo_dmsp{size}_datasheet_points.csv', delimiter=',', names=True
    )
    p, kappa = table['pressure_kPa'] * 1e3, table['contraction_fraction']
    some = (p <= 600e3) & (kappa >= 0.0) & (table['force_N'] >= 0.0)
    return p[some], kappa[some], table['force_N'][some]


@pytest.mark.parametrize(
    ('name', 'size', 'share'),
    # RMS difference from the maker's curves as a share of the rated force. Sárosi's constants
    # are of muscles that he measured, which were stronger than the data sheet has them.
    [
        ('dmsp_20_festo', 20, 0.0052),
        ('dmsp_20_400n', 20, 0.09),
        ('dmsp_20_200n', 20, 0.065),
        ('dmsp_10', 10, 0.085),
    ],
)
def test_static_force_agrees_with_the_data_sheet(shared_data, name, size, share):
    muscle = preset(name).muscle
    p, kappa, force = data_sheet(shared_data, size)
    error = muscle.force(p, kappa) - force
    assert np.sqrt(np.mean(error**2)) <= share * muscle.force_max


def test_cylinder_is_an_area():
    model = preset('../rigs/cylinder_25mm')
    assert model.muscle.is_load_only
    area = np.pi * 0.0125**2
    np.testing.assert_allclose(
        model.muscle.force([0.0, 1e5, 7e5], 0.02), [0, 1e5 * area, 7e5 * area]
    )
    assert (model.muscle.p_min, model.muscle.p_max) == (0.0, 8e5)


def test_emps_is_a_mass_and_a_force():
    model = preset('../rigs/emps')
    assert model.muscle.is_load_only
    assert model.load == Mass(mass=95.0, mount='horizontal')
    np.testing.assert_allclose(model.muscle.force([-2.0, 1.0], 0.2), [-70.30130376, 35.15065188])
    assert model.muscle.p_min == -10.0  # volts, either way
