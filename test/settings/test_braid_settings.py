# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A muscle by the geometry of its braid: in files, as overrides, for one muscle of several."""

import pytest

from pam_ros.errors import ParameterError
from pam_ros.muscle.braid import Braid
from pam_ros.muscle.constants import CONSTANTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.settings import excite
from pam_ros.settings.files import read, write
from pam_ros.settings.load import load_joint, load_muscle
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import build, checked

GEOMETRY = {
    'braid.radius': 0.0085,
    'braid.angle': 20.0,
    'braid.end_factor': 1.25,
    'braid.bladder': 150.0,
}
FIELDS = {'l0': 0.2, 'p_max': 5e5, 'kappa_min': -0.02, 'kappa_max': 0.28, 'zeta': 0.3}
MUSCLE = Braid(0.0085, 20.0, 1.25, 150.0).muscle(**FIELDS)
FILE = {**GEOMETRY, **FIELDS, 'mass': 5.0}


@pytest.fixture
def file(tmp_path):
    path = tmp_path / 'mine.yaml'
    write(path, FILE)
    return path


def _muscles(given):
    """Return the muscles of these parameters, which need not make a joint."""
    scene = Scene(given)
    values = checked(scene.table(), given)
    return [build(Muscle, scene.of_muscle(values, i)) for i in range(len(scene.muscles))]


def test_a_file_describes_a_muscle_by_its_braid(file):
    assert load_muscle(file) == MUSCLE
    assert load_joint(file).load.mass == 5.0


def test_overrides_describe_it_and_the_constants_of_the_file_do_not_count():
    texts = [f'{name}={value}' for name, value in FILE.items()]
    assert nominal_joint('dmsp_10', texts).joint.muscle == MUSCLE
    assert load_joint('dmsp_20_400n', FILE).muscle == MUSCLE


def test_another_angle_replaces_that_of_the_file(file):
    wanted = Braid(0.0085, 23.0, 1.25, 150.0).muscle(**FIELDS)
    assert load_joint(file, {'braid.angle': 23.0}).muscle == wanted
    assert nominal_joint(file, ['braid.angle=23']).joint.muscle == wanted


def test_an_explicit_constant_has_precedence(file):
    muscle = load_joint(file, a2=200.0).muscle
    assert (muscle.a1, muscle.a2, muscle.a6) == (MUSCLE.a1, 200.0, MUSCLE.a6)
    write(file, {**FILE, 'a2': 200.0})
    assert load_muscle(file).a2 == 200.0
    assert _muscles({'muscle': str(file)})[0].a2 == 200.0


def test_constants_have_the_units_that_are_given(file):
    muscle = load_joint(file, pressure_unit='bar', contraction_unit='percent').muscle
    assert muscle.a1 == pytest.approx(1e5 * MUSCLE.a1)
    assert muscle.si == pytest.approx(MUSCLE.si)


def test_one_muscle_of_a_joint_has_a_braid_of_its_own(file):
    given = {
        **FILE,
        'joint': 'antagonistic',
        'muscles': ('flexor', 'extensor'),
        'extensor.braid.angle': 24.0,
    }
    flexor, extensor = _muscles(given)
    assert flexor == MUSCLE
    assert extensor == Braid(0.0085, 24.0, 1.25, 150.0).muscle(**FIELDS)


def test_a_braid_of_one_muscle_replaces_its_own_constants_of_a_file(tmp_path):
    source = load_muscle('dmsp_10')
    constants = {name: getattr(source, name) for name in CONSTANTS}
    each = {f'{muscle}.{name}': a for muscle in ('a', 'b') for name, a in constants.items()}
    path = tmp_path / 'identified.yaml'
    write(path, {'joint': 'antagonistic', 'muscles': ('a', 'b'), 'muscle': 'dmsp_10', **each})
    plain = load_joint(path)
    joint = load_joint(path, {'b.braid.angle': 22.0})
    assert joint.muscles[0] == plain.muscles[0]
    made = joint.muscles[1]
    assert made.si == Braid(angle=22.0).muscle(kappa_max=made.kappa_max).si
    texts = ['b.braid.angle=22', 'b.braid.radius=0.01']
    assert nominal_joint(path, texts).joint.muscles == joint.muscles


def test_a_preset_with_a_braid_is_one_of_a_muscle(file):
    joint = {'joint': 'antagonistic', 'muscles': ('a', 'b')}
    assert _muscles({**joint, 'muscle': str(file)}) == [MUSCLE, MUSCLE]
    plain = load_muscle('dmsp_10')
    own = {**joint, 'muscle': 'dmsp_10', 'b.muscle': str(file)}
    assert _muscles(own) == [plain, MUSCLE]


def test_all_values_in_force_written_make_the_same_muscle_again(file, tmp_path):
    given = read(file)
    scene = Scene(given)
    values = checked(scene.table(), given)
    assert values['a1'] == MUSCLE.a1
    again = {name: value for name, value in values.items() if value not in ((), '')}
    write(tmp_path / 'again.yaml', again)
    assert load_muscle(tmp_path / 'again.yaml') == MUSCLE


def test_an_excitation_is_planned_for_it(file):
    given = read(file)
    table, build = excite.settings_of(given)
    (muscle,) = build(checked(table, given)).model.muscles
    assert muscle == MUSCLE


@pytest.mark.parametrize('name', ['braid.angle', 'braid.radius'])
def test_without_an_angle_the_constants_count(name):
    given = {name: 0.0 if name == 'braid.angle' else 0.02}
    assert load_joint('dmsp_10', given).muscle == load_muscle('dmsp_10')
    texts = [f'{key}={value}' for key, value in given.items()]
    assert nominal_joint('dmsp_10', texts).joint.muscle == load_muscle('dmsp_10')


@pytest.mark.parametrize(
    ('given', 'message'),
    [
        ({'braid.angle': 60.0}, 'braid.angle = 60.0 is not allowed: give 0 to 54 deg'),
        ({'braid.angle': 0.5}, 'braid.angle = 0.5 is not allowed: give 1 to 54 deg'),
        ({'braid.angel': 20.0}, 'braid.angel is not a parameter: was braid.angle meant'),
        ({'kappa_max': 0.4}, 'kappa_max = 0.4 is not allowed: this braid no longer pulls'),
        ({'braid.radius': 'wide'}, "braid.radius = 'wide' is not allowed"),
        (
            {'a1': 1.0, 'a2': 1.0, 'a3': -1.0, 'a4': -1.0, 'a5': 1.0, 'a6': -1.0},
            'braid.angle has no effect where a1 to a6 are given',
        ),
    ],
)
def test_what_cannot_be_is_refused(file, given, message):
    with pytest.raises(ParameterError, match=message):
        load_joint(file, given)
