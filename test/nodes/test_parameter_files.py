# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``ros2 param dump`` and ``load`` of both nodes, with parameter files that go there and back."""

from pathlib import Path

import pytest

from pam_ros.report.write import write_report
from pam_ros.settings.files import read
from support import results
from support.distribution import IS_JAZZY
from support.harness import Program
from support.ros2param import dump, load, values_of

pytestmark = pytest.mark.at_any_pace

CONFIG = Path(__file__).parents[2] / 'config'
PAIR = {'joint': 'antagonistic', 'muscle': 'dmsp_20_400n'}
EFFECTS = {
    'effects.creep.force': 0.05,
    'effects.coulomb_friction.level': 12.5,
    'effects.coulomb_friction.presliding': 1e-05,
}
TWO = {
    'muscles': ['left', 'right'],
    'muscle': 'dmsp_20_200n',
    'left.mass': 7.5,
    'right.muscle': 'dmsp_10',
    'left.effects.creep.force': 0.02,
}
ELBOW = {
    'joint': 'antagonistic',
    'muscles': ['flexor', 'extensor'],
    'joint_names': ['elbow'],
    'muscle': 'dmsp_20_400n',
    'extensor.muscle': 'dmsp_20_200n',
    'elbow.inertia': 0.03,
}
RIGS = {
    'as_it_is': {},
    'preset': {'muscle': 'dmsp_20_400n'},
    'effects': {'muscle': 'dmsp_20_400n', 'mass': 12.0, **EFFECTS},
    'antagonistic': PAIR,
    'crank': {'joint': 'crank', 'muscle': 'dmsp_20_200n'},
    'two_muscles': TWO,
    'named_pair': ELBOW,
}
# Which joint of the rig is controlled.
CONTROLLED = {'two_muscles': {'joint_name': 'right'}, 'named_pair': {'joint_name': 'elbow'}}


def wait_for(peer, program):
    """Wait until a node is up; fail with what it printed where it has ended instead."""
    names = peer.node.get_node_names
    peer.until(lambda: program.name in names() or not program.is_running, program.name)
    assert program.is_running, program.output


@pytest.mark.parametrize('program', ['pam_sim', 'pam_control'])
@pytest.mark.parametrize('rig', RIGS)
def test_a_dump_starts_the_same_node_again(peer, tmp_path, program, rig):
    parameters = dict(RIGS[rig])
    if program == 'pam_control':
        parameters |= CONTROLLED.get(rig, {})
    node, file = f'/{program}', tmp_path / 'dump.yaml'
    with Program(program, parameters=parameters) as first:
        wait_for(peer, first)
        before = dump(peer, node)
        assert first.stop() == 0
    file.write_text(before, encoding='utf-8')
    with Program(program, '--params-file', str(file)) as again:
        wait_for(peer, again)
        assert dump(peer, node) == before
        assert again.stop() == 0
        assert 'not known' not in again.output


SHIPPED = sorted(p for p in CONFIG.rglob('*.yaml') if 'ros__parameters' in p.read_text())


def can_load(path):
    """Return whether ``ros2 param load`` sends anything of a file.

    Since Kilted it does not send what is under a name with a wildcard, as /**/pam_sim.
    """
    return IS_JAZZY or '\n/**:\n' in path.read_text()


@pytest.fixture(scope='module')
def identified(tmp_path_factory):
    """Return the parameter file of an identification."""
    folder = tmp_path_factory.mktemp('report')
    write_report(folder, *results.friction_result())
    return folder / 'identified.yaml'


def check_load(peer, node, path, *, of_another=False):
    """Load a file: each parameter that can change has its value then, all others a reason.

    They are set one after the other: of another muscle, some make no rig together with what is
    not set yet, and have a reason, too.
    """
    answers = load(peer, node, path)
    values, given = values_of(peer, node), read(path, node[1:])
    if not IS_JAZZY:
        given = {name: value for name, value in given.items() if name in answers}
    assert set(given) <= set(answers)
    shown = peer.describe(node, *(name for name in given if name in values))
    fixed = {description.name for description in shown if description.read_only}
    assert given
    for name, value in given.items():
        if name not in values:
            assert 'undeclared' in answers[name]
        elif name in fixed:
            assert answers[name] == f'Trying to set a read-only parameter: {name}.'
        elif of_another and answers[name]:
            assert 'type' not in answers[name]
        else:
            assert answers[name] == '', answers
            assert values[name] == value
    return fixed


@pytest.mark.parametrize('program', ['pam_sim', 'pam_control'])
def test_what_is_written_loads_into_a_running_node(peer, tmp_path, identified, program):
    """The presets, the settings, a dump of its own and an identified model, one after another."""
    node, file = f'/{program}', tmp_path / 'dump.yaml'
    with Program(program, parameters={'muscle': 'dmsp_20_400n'}) as running:
        wait_for(peer, running)
        others = {'pam_sim': 'control.yaml', 'pam_control': 'sim.yaml'}
        files = [p for p in SHIPPED if p.name != others[program] and can_load(p)]
        for path in (*files, identified):
            check_load(peer, node, path, of_another=True)
        # As a text that is a number for ROS alone.
        assert peer.set_one(node, zeta='1e-05').successful
        assert values_of(peer, node)['zeta'] == 1e-05
        before = dump(peer, node)
        assert 'zeta: 1.0e-05' in before
        file.write_text(before, encoding='utf-8')
        assert {'source', 'muscle'} < check_load(peer, node, file)
        assert dump(peer, node) == before
        assert running.is_running
        assert running.stop() == 0
        assert 'Traceback' not in running.output


@pytest.mark.parametrize('path', [p for p in SHIPPED if p.parent != CONFIG], ids=lambda p: p.stem)
def test_a_preset_loads_whole_into_a_node_that_has_it(peer, path):
    with Program('pam_sim', '--params-file', str(path), parameters={'mass': 6.0}) as sim:
        wait_for(peer, sim)
        check_load(peer, '/pam_sim', path)
        assert sim.is_running


@pytest.mark.parametrize('name', ['muscles', 'joint_names'])
def test_an_empty_list_on_the_command_line_is_an_empty_list(peer, name):
    with Program('pam_sim', parameters={name: []}) as sim:
        wait_for(peer, sim)
        assert values_of(peer, '/pam_sim')[name] == []


def test_an_empty_list_for_a_number_is_refused(domain):
    with Program('pam_sim', '-p', 'mass:=[]') as sim:
        assert sim.wait() == 2
        assert 'mass = [] is not allowed' in sim.output
