# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page on joints: its examples run, and the joint that it adds moves as its equations say."""

import importlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pam_ros.rig import assembly, bind, joint_model, statics
from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints import JOINTS
from pam_ros.rig.rig import Rig
from support import joints, paper
from support.joint_models import muscle

PAGE = Path(__file__).parents[3] / 'docs' / 'joints.md'
USE, AT_REST, OWN = re.findall(r'```python\n(.*?)```', PAGE.read_text(encoding='utf-8'), re.DOTALL)


@pytest.mark.parametrize('example', [USE, AT_REST])
def test_examples_run_and_print_what_their_comments_say(example, capsys):
    exec(compile(example, str(PAGE), 'exec'), {})
    printed = capsys.readouterr().out
    shown = [
        comment
        for line in example.splitlines()
        if line.startswith('print(f') and (comment := line.partition('  # ')[2])
    ]
    assert len(shown) >= 2
    for comment in shown:
        assert comment in printed.splitlines(), printed


@pytest.fixture
def own(monkeypatch, tmp_path):
    """Return the file that the example is, listed among the joints."""
    (tmp_path / 'elbow.py').write_text(OWN, encoding='utf-8')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'elbow', raising=False)
    elbow = importlib.import_module('elbow')
    for module in (bind, joint_model, assembly):
        monkeypatch.setattr(module, 'JOINTS', (*JOINTS, elbow.JOINT))
    bind.bind_joints.cache_clear()
    yield elbow
    bind.bind_joints.cache_clear()


# The elbow by itself: where the muscle is anchored, and where the crank has its end.
MASS, ARM, CRANK, ANCHOR = 1.5, 0.15, 0.1, 0.35


def contraction(angle):
    """Return how far the muscle has shortened, by the distance between two points."""
    anchor, end = np.array([0.0, ANCHOR]), CRANK * np.array([np.cos(angle), np.sin(angle)])
    return 0.1 * 0.4 + np.hypot(ANCHOR, CRANK) - np.linalg.norm(end - anchor)


def slope(angle, h=1e-6):
    return (contraction(angle + h) - contraction(angle - h)) / (2.0 * h)


def test_a_joint_of_ones_own_moves_as_its_equations_say(own):
    zeta, inertia = 0.15, MASS * ARM**2
    model = JointModel(own.Forearm(), (Actuator(muscle(joints.LONG, zeta)),))
    assert statics.contraction(model, 0, 0.4) * 0.4 == pytest.approx(contraction(0.4))
    assert statics.arm(model, 0, 0.4) == pytest.approx(slope(0.4), rel=1e-8)

    def rhs(_, state):
        angle, rate = state
        y, r = contraction(angle), slope(angle)
        c = 2.0 * zeta * np.sqrt(inertia / r**2 * joints.LONG.stiffness(2.0, y))
        tau = r * (joints.LONG.force(2.0, y) - c * r * rate) - MASS * paper.G * ARM * np.cos(angle)
        return rate, tau / inertia

    t = np.linspace(0.0, 1.0, 101)
    found = solve_ivp(rhs, (0.0, 1.0), (0.2, 0.0), 'DOP853', t, rtol=1e-9, atol=1e-11)
    rig = Rig([model], 5e-4)
    rig.reset([2e5], [0.2], [0.0])
    angle = [0.2]
    for _ in t[1:]:
        rig.advance(20)
        angle.append(rig.position[0])
    assert np.ptp(angle) > 0.1
    np.testing.assert_allclose(angle, found.y[0], atol=1e-7)
    rig.advance(10_000)
    assert rig.position[0] == pytest.approx(model.rest(2e5), abs=1e-9)
    assert rig.joint_outputs()[0, 0] == pytest.approx(
        MASS * paper.G * ARM * np.cos(rig.position[0]), rel=1e-6
    )


def test_it_stands_beside_the_others(own):
    """In one rig with a mass on a muscle and a pair: its own kind in the one compiled call."""
    from pam_ros.rig.model import RigModel

    elbow = JointModel(own.Forearm(), (Actuator(),))
    rig, alone = Rig([RigModel(), elbow, JointModel()]), Rig([elbow])
    rig.command([3e5, 2e5, 4e5, 3e5])
    alone.command([2e5])
    for each in (rig, alone):
        each.advance(300)
    assert rig.position.shape == (3,)
    assert rig.pressure.shape == (4,)
    assert rig.position[1] == alone.position[0]
    np.testing.assert_array_equal(rig.outputs()[1], alone.outputs()[0])


def test_it_passes_the_tests_that_every_joint_has_to(own):
    joint = own.JOINT
    g, h = joint.row(own.Forearm(), (muscle(joints.LONG),)), 1e-6
    assert g[0] == own.Forearm().mass
    for s in (-0.3, 0.0, 0.7):
        assert joint.arm(s, 0, g) == pytest.approx(
            (joint.position(s + h, 0, g) - joint.position(s - h, 0, g)) / (2.0 * h), rel=1e-8
        )
        assert joint.coordinate(joint.position(s, 0, g), 0, g) == pytest.approx(s, abs=1e-12)
        j = joint.inertia(1.0, g)
        fall = (joint.fall(s + h, 1.0, j, g) - joint.fall(s - h, 1.0, j, g)) / (2.0 * h)
        assert joint.fall_slope(s, 1.0, j, g) == pytest.approx(fall, rel=1e-7, abs=1e-8)
