# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page on joints: its parameters are those of the code; its transmission moves as it must."""

import importlib
import sys

import numpy as np
import pytest
import yaml
from scipy.integrate import quad, solve_ivp

from pam_ros import Arm, Joint, Simulation, equilibrium
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.settings.control import settings_of
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, joint_table
from support import joints, paper
from support.joint_models import UNEQUAL, actuators
from support.pages import DOCS, blocks, code, part, rows

PAGE = DOCS / 'joints.md'
_, _, OWN, _ = blocks(PAGE, 'python')


def shown():
    """Return what the table says: (joint, parameter) -> default and range as texts."""
    return {
        (kind, name): (default, allowed)
        for names, kinds, default, allowed, _ in rows(part(PAGE, 'joint parameters'))
        for kind in code(kinds)
        for name in code(names)
    }


def written(default, unit):
    if isinstance(default, str):
        return f'`{default}`'
    return f'{default:.5g} {"" if unit == "fraction" else unit}'.strip()


def test_the_parameters_of_joints_are_those_of_the_code():
    expected = {
        (kind.name, name): (written(default, about.unit), about.allowed(of))
        for kind in ARRANGEMENTS
        for name, (of, default, about) in joint_table(kind).items()
        if not name.startswith('effects.')
    }
    assert shown() == expected


def test_the_file_of_a_lever_is_for_both_programs():
    (text,) = blocks(PAGE, 'yaml')
    given = yaml.safe_load(text)['/**']['ros__parameters']
    assert given['joint'] == 'lever'
    for table, build in (
        (Scene(given).table(), Scene(given).build),
        settings_of(given),
    ):
        assert given.keys() <= table.keys()
        build(checked(table, given))


@pytest.fixture
def cam(monkeypatch, tmp_path):
    """Return the page's transmission as a file of a user."""
    (tmp_path / 'cam.py').write_text(OWN, encoding='utf-8')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'cam', raising=False)
    return importlib.import_module('cam')


# The cam by itself: its radius over the angle; how far it has drawn is an integral of that.
RADIUS, GROWTH = 0.035, 0.4


def radius(angle):
    return RADIUS * np.exp(GROWTH * angle)


@pytest.mark.slow
def test_a_transmission_of_ones_own_moves_as_its_equations_say(cam):
    zeta, sides = 0.15, (1.0, -1.0)
    at_zero = [0.09 * UNEQUAL[0].l0, 0.12 * UNEQUAL[1].l0]
    joint = Joint(
        actuators(UNEQUAL, (0.09, 0.12), zeta=zeta),
        Arm(inertia=joints.OF_PULLEY, mass=joints.M, arm=joints.ARM, hanging_at=-0.4),
        cam.Cam(RADIUS, GROWTH),
    )
    bar = (4.0, 3.0)

    def rhs(_, state):
        angle, rate = state
        tau = -joints.M * paper.G * joints.ARM * np.sin(angle + 0.4)
        for i, side in enumerate(sides):
            r = side * radius(side * angle)
            y = at_zero[i] + quad(radius, 0.0, side * angle, epsabs=1e-13)[0]
            k, m = UNEQUAL[i].stiffness(bar[i], y), joints.J / (2.0 * r * r)
            tau += r * (UNEQUAL[i].force(bar[i], y) - 2.0 * zeta * np.sqrt(m * k) * r * rate)
        return rate, tau / joints.J

    t = np.linspace(0.0, 1.0, 51)
    found = solve_ivp(rhs, (0.0, 1.0), (0.25, 0.0), 'DOP853', t, rtol=1e-9, atol=1e-11)
    rig = Simulation([joint], 5e-4)
    rig.reset([4e5, 3e5], [0.25], [0.0])
    angle = [0.25]
    for _ in t[1:]:
        rig.advance(40)
        angle.append(rig.position[0])
    assert np.ptp(angle) > 0.05
    np.testing.assert_allclose(angle, found.y[0], atol=1e-8)
    rig.advance(20_000)
    assert rig.position[0] == pytest.approx(equilibrium(joint, [4e5, 3e5]), abs=1e-9)
