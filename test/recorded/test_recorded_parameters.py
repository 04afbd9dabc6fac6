# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the nodes in version 0.1.0 are still there, and its files make the same joint.

``parameters.json`` holds its tables: what it configured when it was started with what GIVEN says.
``identified.yaml`` was written by its ``pam_identify``.
"""

import json
from pathlib import Path

import pytest
import yaml

from pam_ros.settings import excite
from pam_ros.settings.control import settings_of
from pam_ros.settings.files import read
from pam_ros.settings.former_names import renamed
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from support.by_name import by_name

HERE = Path(__file__).parent
RECORDED = json.loads((HERE / 'parameters.json').read_text(encoding='utf-8'))
IDENTIFIED = HERE / 'identified.yaml'
NOW = {
    'pam_sim': Scene({}).table(),
    'pam_sim antagonistic': Scene({'joint': 'antagonistic'}).table(),
    'pam_control': settings_of({})[0],
    'pam_control antagonistic': settings_of({'joint': 'antagonistic'})[0],
    'pam_excite': excite.settings_of({})[0],
}
# Defaults that have changed since, as the change log says.
CHANGED = {'state_timeout': 0.5}


def test_each_table_is_looked_at():
    assert NOW.keys() == RECORDED.keys()
    assert min(map(len, RECORDED.values())) > 90


@pytest.mark.parametrize('table', RECORDED)
def test_parameters_are_as_they_were(table):
    for name, recorded in RECORDED[table].items():
        kind, default, unit, low, high, choices, live, above_low = recorded
        now, sentence = renamed({name: default})
        if not now:  # a constant, which is what the default was
            assert sentence == '', name
            continue
        ((now_name, default),) = now.items()
        if now_name.rpartition('.')[2] == 'slip_ratio':  # its values have another meaning
            low, high = 1.0, 2.5e3
        if now_name == 'radius':  # with products of lengths that are 0
            low, above_low = 1e-4, False
        if now_name == 'effects.coulomb_friction.presliding' and unit == 'rad':
            high = 0.01  # what 0.2 mm is at a short arm
        now_kind, now_default, about = NOW[table][now_name]
        assert now_kind.__name__ == kind, name
        default = CHANGED.get(name, default)
        assert (list(now_default) if kind == 'tuple' else now_default) == default, name
        assert type(now_default) is now_kind, name
        assert about.unit == unit, name
        assert (about.low, about.high, about.above_low) == (low, high, above_low), name
        assert set(choices) <= set(about.choices), name
        assert bool(choices) is bool(about.choices), name
        assert about.live is live, name
        assert about.text, name


# What pam_identify wrote -----------------------------------------------------------------------


def written():
    """Return the values of the file, read without the package."""
    found = {}

    def flatten(table, prefix):
        for name, value in table.items():
            if isinstance(value, dict):
                flatten(value, f'{prefix}{name}.')
            else:
                found[f'{prefix}{name}'] = value

    (content,) = yaml.safe_load(IDENTIFIED.read_text(encoding='utf-8')).values()
    flatten(content['ros__parameters'], '')
    return found


def by_pam_sim():
    scene = Scene({})
    (joint,) = scene.build(checked(scene.table(), read(IDENTIFIED, 'pam_sim'))).joints
    return joint


def by_pam_control():
    table, build = settings_of({})
    return build(checked(table, read(IDENTIFIED, 'pam_control'))).law.joint


def by_preset():
    """Return what ``muscle:=identified.yaml`` makes."""
    given = {'muscle': str(IDENTIFIED)}
    scene = Scene(given)
    (joint,) = scene.build(checked(scene.table(), given)).joints
    return joint


def by_preset_of_control():
    given = {'muscle': str(IDENTIFIED)}
    table, build = settings_of(given)
    return build(checked(table, given)).law.joint


READERS = [by_pam_sim, by_pam_control, by_preset, by_preset_of_control]


@pytest.mark.parametrize('reader', READERS, ids=lambda reader: reader.__name__)
def test_an_identified_file_makes_its_joint_to_the_bit(reader):
    joint, values = reader(), written()
    for name in ('a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'zeta', 'l0', 'p_min', 'p_max', 'source'):
        assert getattr(joint.muscle, name) == values[name], name
    for name in ('kappa_min', 'kappa_max', 'force_max', 'inside_diameter', 'pressure_unit'):
        assert getattr(joint.muscle, name) == values[name], name
    assert (joint.load.mass, joint.load.mount) == (values['mass'], values['mount'])
    row = {effect.name: effect for effect in joint.all_present}
    assert list(row) == ['pressure_lag', 'coulomb_friction']
    (lag, friction) = (
        {
            name.rpartition('.')[2]: value
            for name, value in values.items()
            if name.startswith(f'effects.{effect}.')
        }
        for effect in row
    )
    assert by_name(joint.actuators[0].effects)['pressure_lag'].values.items() >= lag.items()
    assert by_name(joint.effects)['coulomb_friction'].values.items() >= friction.items()


def test_both_programs_make_the_same_joint_of_it():
    joints = [reader() for reader in READERS]
    assert all(joint == joints[0] for joint in joints)
    assert (
        nominal_joint(IDENTIFIED).joint.parameters().tobytes() == joints[0].parameters().tobytes()
    )
