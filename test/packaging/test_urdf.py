# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Robot descriptions: valid, named as joint_states is, and of the models that they show."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from urdf_parser_py.urdf import URDF

from pam_ros.rig import statics
from pam_ros.rig.arrangements import ANTAGONISTIC
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.sim import SimSettings

FOLDER = Path(__file__).parents[2] / 'urdf'
FILES = sorted(FOLDER.glob('*.urdf'))
JOINT = SimSettings().joint_name
(PAIR,) = RigParameters({'joint': ANTAGONISTIC.name}).build_joints({})  # with all defaults
each = pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)


@pytest.fixture(autouse=True)
def _no_complaint(capfd):
    """The parser prints what it does not know."""
    yield
    assert capfd.readouterr() == ('', '')


def robot(path):
    return URDF.from_xml_string(path.read_bytes())


def moving(described):
    """Return the joints that joint_states has to name."""
    return [j for j in described.joints if j.type != 'fixed' and j.mimic is None]


def transform(origin):
    """Return the 4x4 matrix of an origin: rotations about the fixed x, y, z in that order."""
    found = np.eye(4)
    if origin is not None:
        found[:3, :3] = rotation(origin.rpy or (0.0, 0.0, 0.0))
        found[:3, 3] = origin.xyz or (0.0, 0.0, 0.0)
    return found


def rotation(rpy):
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def place(described, link, value):
    """Return the pose of a link in the world where the joint is at *value*."""
    pose = np.eye(4)
    while link != described.get_root():
        name, parent = described.parent_map[link]
        joint = described.joint_map[name]
        at = 0.0 if joint.type == 'fixed' else value
        if joint.mimic:
            at = joint.mimic.multiplier * value + (joint.mimic.offset or 0.0)
        moved = np.eye(4)
        if joint.type == 'prismatic':
            moved[:3, 3] = at * np.array(joint.axis)
        elif joint.type == 'revolute':
            moved[:3, :3] = turned(np.array(joint.axis), at)
        pose = transform(joint.origin) @ moved @ pose
        link = parent
    return pose


def turned(axis, angle):
    """Rodrigues' formula."""
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k


def test_there_is_one_for_the_rig_and_one_for_the_pair():
    assert [path.stem for path in FILES] == ['antagonistic_pair', 'rig']


@each
def test_it_is_a_valid_tree_that_hangs_on_the_world(path):
    described = robot(path)
    described.check_valid()
    assert described.get_root() == 'world'
    links = [link.name for link in described.links]
    assert len(set(links)) == len(links) == len(described.joints) + 1
    assert set(described.parent_map) == set(links) - {'world'}
    for link in links:
        described.get_chain('world', link)
    # A root with inertia is not taken by the tree that robot_state_publisher builds.
    assert described.link_map['world'].inertial is None


@each
def test_its_joint_has_the_name_in_joint_states(path):
    assert [joint.name for joint in moving(robot(path))] == [JOINT]


@each
def test_whatever_moves_has_an_inertia_that_a_body_can_have(path):
    described = robot(path)
    for joint in described.joints:
        inertial = described.link_map[joint.child].inertial
        if joint.type == 'fixed':
            assert inertial is None
            continue
        assert inertial.mass > 0.0
        principal = np.linalg.eigvalsh(inertial.inertia.to_matrix())
        assert principal[0] > 0.0
        assert principal[2] <= principal[0] + principal[1] + 1e-12


@each
def test_joints_have_axes_of_unit_length_and_limits(path):
    for joint in robot(path).joints:
        if joint.type != 'fixed':
            assert np.linalg.norm(joint.axis) == 1.0
            assert joint.limit.lower < 0.0 < joint.limit.upper
            assert joint.limit.effort > 0.0
            assert joint.limit.velocity > 0.0


@each
def test_what_is_seen_has_a_material_that_is_defined(path):
    described = robot(path)
    known = {material.name for material in described.materials}
    seen = [visual for link in described.links for visual in link.visuals]
    assert len(seen) > 5
    assert {visual.material.name for visual in seen} == known


def test_the_rig_is_the_default_one():
    described, model = robot(FOLDER / 'rig.urdf'), single_muscle_joint()
    (joint,), muscle = moving(described), model.muscle
    assert joint.type == 'prismatic'
    assert joint.limit.lower == pytest.approx(muscle.kappa_min * muscle.l0)
    assert joint.limit.upper == pytest.approx(muscle.kappa_max * muscle.l0)
    assert joint.limit.effort == muscle.force_max
    inertial = described.link_map['load'].inertial
    assert inertial.mass == Mass().mass
    # Of a cylinder as it is drawn.
    shape = next(v for v in described.link_map['load'].visuals if v.name == 'weight').geometry
    across = inertial.mass * (3.0 * shape.radius**2 + shape.length**2) / 12.0
    assert inertial.inertia.ixx == inertial.inertia.iyy == pytest.approx(across, rel=1e-3)
    assert inertial.inertia.izz == pytest.approx(0.5 * inertial.mass * shape.radius**2)


@pytest.mark.parametrize('y', [-0.016, 0.0, 0.1])
def test_contraction_lifts_the_load(y):
    described = robot(FOLDER / 'rig.urdf')
    hook, end = (place(described, link, y) for link in ('muscle', 'load'))
    np.testing.assert_allclose(end[:3, :3], np.eye(3))
    np.testing.assert_allclose(hook[:3, 3] - end[:3, 3], [0.0, 0.0, 0.4 - y], atol=1e-15)


def test_the_pair_is_the_default_one():
    described = robot(FOLDER / 'antagonistic_pair.urdf')
    (joint,), load, radius = moving(described), PAIR.load, PAIR.transmission.radius
    assert joint.type == 'revolute'
    assert (joint.limit.lower, joint.limit.upper) == pytest.approx(statics.span(PAIR))
    assert joint.limit.effort == pytest.approx(radius * PAIR.muscles[0].force_max)
    inertial = described.link_map['arm'].inertial
    com = np.array(inertial.origin.xyz)
    assert inertial.mass == load.mass
    np.testing.assert_allclose(com, [0.0, 0.0, -load.arm])
    about_pivot = inertial.inertia.iyy + inertial.mass * com @ com
    assert about_pivot == pytest.approx(PAIR.inertia)
    # The ends of the muscles are drawn with a mass, though the model has none for them.
    ends = sum(described.link_map[f'end_{i}'].inertial.mass for i in (1, 2))
    assert ends * radius**2 < 0.01 * PAIR.inertia


@pytest.mark.parametrize('angle', [-1.4, -0.3, 0.0, 0.8, 1.4])
def test_the_pairs_muscles_have_their_lengths(angle):
    described = robot(FOLDER / 'antagonistic_pair.urdf')
    for i, muscle in enumerate(PAIR.muscles):
        hook = place(described, f'muscle_{i + 1}', angle)
        end = place(described, f'end_{i + 1}', angle)
        length = muscle.l0 * (1.0 - statics.contraction(PAIR, i, angle))
        np.testing.assert_allclose(hook[:3, 3] - end[:3, 3], [0.0, 0.0, length], atol=1e-12)
        limit = described.joint_map[f'contraction_{i + 1}'].limit
        assert limit.lower - 1e-9 <= (1 - 2 * i) * 0.04 * angle <= limit.upper + 1e-9


def test_the_belt_leaves_the_pulley_where_it_is_wound():
    """A point of the rim moves with the end of the muscle on its side; the arm swings there."""
    described, h = robot(FOLDER / 'antagonistic_pair.urdf'), 1e-7
    for i, x in ((1, 0.04), (2, -0.04)):
        rim = [place(described, 'arm', a) @ [x, 0.0, 0.0, 1.0] for a in (-h, h)]
        ends = [place(described, f'end_{i}', a)[:, 3] for a in (-h, h)]
        np.testing.assert_allclose(rim[1] - rim[0], ends[1] - ends[0], atol=1e-14)
        assert place(described, f'end_{i}', 0.0)[0, 3] == x
    weight = place(described, 'arm', 0.5) @ [0.0, 0.0, -0.25, 1.0]
    np.testing.assert_allclose(
        weight[:3], [0.25 * np.sin(0.5), 0.0, 0.5 - 0.25 * np.cos(0.5)], atol=1e-15
    )


@each
def test_check_urdf_takes_it_where_it_is_installed(path):
    try:
        done = subprocess.run(
            ['check_urdf', path], capture_output=True, text=True, check=False, timeout=60
        )
    except FileNotFoundError:
        pytest.skip('check_urdf is not installed: sudo apt install liburdfdom-tools')
    assert done.returncode == 0, done.stdout + done.stderr
