# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels bound to effects: what their names on disk depend on, and plain Python instead."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Compensation
from pam_ros.rig.bind import bind
from pam_ros.rig.layout import layout_of
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Lever, Pulley, Straight
from support.made_effects import effect_with

ROOT = Path(__file__).parents[2]
SOURCE = '''
from math import cos
from pam_ros.compiled import scalar

SCALE = 2.0

@scalar
def helper(v):
    return SCALE * v

def outside(f, p, y, v, t, h, x, i, xn, q, j):
    """Say something."""
    return f - q[j] * helper(v)
'''


def function_of(source):
    names = {}
    exec(compile(source, 'effect.py', 'exec'), names)
    return names['outside']


def effect_of(source, name='drag'):
    return effect_with(name, treated=Compensation.MODEL, outside=function_of(source))


def loops(effects, active, transmission=Straight.equations, load=Mass.equations, muscles=1):
    kernel = bind(layout_of(effects, transmission, load, muscles), active)
    return [f.__qualname__ for f in vars(kernel).values()]


@pytest.mark.skipif(not HAVE_NUMBA, reason='nothing is kept on disk without numba')
def test_kernels_on_disk_are_distinguished_by_code_and_place():
    one, other = effect_of(SOURCE), effect_of(SOURCE.replace('f - q[j]', 'f + q[j]'))
    names = loops((one,), (one,))
    again = effect_of(SOURCE)
    assert loops((again,), (again,)) == names  # the same code: found on disk
    assert loops((other,), (other,)) != names
    assert loops((one,), ()) != names
    first = effect_of(SOURCE, 'first')
    assert loops((first, one), (one,)) != names  # the parameter is at another place
    assert len(set(names)) == len(names)


@pytest.mark.skipif(not HAVE_NUMBA, reason='nothing is kept on disk without numba')
def test_kernels_on_disk_differ_by_transmission_load_and_number_of_muscles():
    """A change of one function of the geometry, or of the load, is another kernel."""
    before = loops((), (), Pulley.equations, Arm.equations, 2)
    assert loops((), (), replace(Pulley.equations), Arm.equations, 2) == before  # the same code
    others = [
        loops((), (), Lever.equations, Arm.equations, 2),
        loops((), (), replace(Pulley.equations, arm=twice), Arm.equations, 2),
        loops((), (), Pulley.equations, replace(Arm.equations, fall=twice), 2),
        loops((), (), Pulley.equations, Arm.equations, 1),
        loops((), (), Pulley.equations, Arm.equations, 3),
    ]
    for i, one in enumerate(others):
        for other in [before, *others[:i]]:
            # Those that step; a joint that is held does not care how its load falls.
            assert set(one[:3]).isdisjoint(other[:3])


def twice(s, *_):
    return 2.0 * s


@pytest.mark.skipif(not HAVE_NUMBA, reason='nothing is kept on disk without numba')
def test_the_fingerprint_is_the_same_in_every_process():
    code = (
        'from pam_ros.rig.standard_joints import single_muscle_joint\n'
        'from pam_ros.rig.bind import bind\n'
        'm = single_muscle_joint(); print(bind(m.layout, m.library).advance.__qualname__)'
    )
    model = single_muscle_joint()
    here = bind(model.layout, model.library).advance.__qualname__
    for seed in ('1', '2'):
        assert run(code, {'PYTHONHASHSEED': seed}) == here


def run(code, environment=None, arguments=()):
    """Run code in a Python of its own; return what it printed."""
    done = subprocess.run(
        [sys.executable, '-c', code, *arguments],
        cwd=ROOT,
        env={**os.environ, **(environment or {})},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


CAM = """
from dataclasses import dataclass
from math import exp
from typing import ClassVar

from pam_ros import Transmission, TransmissionEquations, parameter_field
from pam_ros.compiled import scalar

GROWTH = 0.5  # 1/rad


@scalar
def radius(s, q, j):
    return q[j] * exp(GROWTH * s)


def travel(s, i, q, j):
    return (radius(s, q, j) - q[j]) / GROWTH


def arm(s, i, q, j):
    return radius(s, q, j)


def arm_slope(s, i, q, j):
    return GROWTH * radius(s, q, j)


def coordinate(travel, i, q, j):
    return travel / q[j]


@dataclass(frozen=True)
class Cam(Transmission):
    at_zero: float = parameter_field(0.04, 'radius at 0', 'm', low=0.0, high=1.0, above_low=True)
    equations: ClassVar = TransmissionEquations('cam', True, 1, travel, arm, arm_slope, coordinate)
"""

RUN_CAM = """
import runpy, sys
from importlib import import_module
from pam_ros import Actuator, Arm, Joint, Simulation
from pam_ros.rig.bind import bind

folder, name = sys.argv[1:]
sys.path.insert(0, folder)
if name.endswith('.py'):
    cam = runpy.run_path(folder + '/' + name)['Cam']
else:
    cam = import_module(name).Cam
joint = Joint((Actuator(contraction=0.1),), Arm(), cam(), library=())
rig = Simulation([joint], 5e-4)
rig.reset(3e5, 0.1, 0.0)
rig.advance(100)
compiled = bind(joint.layout, ()).advance.stats.cache_misses
print(rig.position[0], 'compiled' if compiled else 'found')
"""


@pytest.mark.slow
@pytest.mark.skipif(not HAVE_NUMBA, reason='nothing is kept on disk without numba')
def test_a_kernel_on_disk_does_not_ask_for_the_file_of_a_transmission(tmp_path):
    """The file is renamed, moved, run as a script, and changed."""
    steps = [
        (CAM, 'here', 'cam'),
        (CAM, 'here', 'spiral'),
        (CAM, 'there', 'cam'),
        (CAM, 'there', 'script.py'),
        (CAM.replace('GROWTH = 0.5', 'GROWTH = 0.3'), 'there', 'cam'),
    ]
    found = []
    for source, folder, name in steps:
        shutil.rmtree(tmp_path / folder, ignore_errors=True)
        (tmp_path / folder).mkdir()
        (tmp_path / folder / name).with_suffix('.py').write_text(source, encoding='utf-8')
        cache = {'NUMBA_CACHE_DIR': str(tmp_path / 'cache')}
        found.append(run(RUN_CAM, cache, [str(tmp_path / folder), name]).split())
    assert [how for _, how in found] == ['compiled', 'found', 'found', 'found', 'compiled']
    assert len({position for position, _ in found[:4]}) == 1
    assert found[4][0] != found[0][0]


RUN = """
import json, sys
import numpy as np
if {blocked}:
    sys.modules['numba'] = None  # as if it were not installed
from pam_ros.compiled import HAVE_NUMBA
from pam_ros.effects import CoulombFriction, Creep, DeadTime, PressureLag
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.transmissions import Lever, Pulley
assert HAVE_NUMBA is not {blocked}
in_muscle = [
    PressureLag(fill=0.05, vent=0.1), DeadTime(delay=0.01), Creep(stiffness=300.0, time=0.5)
]
effects = [*in_muscle, CoulombFriction(level=5.0)]
found = []
for model in (single_muscle_joint(), single_muscle_joint(load=Mass(mass=8.0), effects=effects)):
    rig = Simulation([model])
    for p in (4e5, 1e5, 6e5):
        rig.command(p)
        rig.advance(100)
        found += [*rig.position, *rig.velocity, *rig.pressure, *np.ravel(rig.muscle_outputs())]
    run = simulate(model, [0.0, 0.05, 0.1], [2e5, 5e5], [0.0, 0.031])
    found += [*run.position, *run.velocity, *run.force]
on_load = [CoulombFriction(level=0.3)]
two = Actuator(contraction=0.1), Actuator(contraction=0.1)
lagging = Actuator(effects=in_muscle, contraction=0.1), two[1]
for model in (
    Joint(two, Arm(), Pulley()),
    Joint(lagging, Arm(), Pulley(), on_load),
    Joint(two, Arm(), Lever()),
):
    rig = Simulation([model])
    for p in ([4e5, 3e5], [1e5, 5e5]):
        rig.command(p)
        rig.advance(100)
        found += [*rig.position, *rig.velocity, *rig.pressure,
                  *np.ravel(rig.muscle_outputs()), *np.ravel(rig.joint_outputs())]
    run = simulate(model, [0.0, 0.05, 0.1], [[2e5, 3e5], [4e5, 2e5]], [0.0, 0.031])
    held = simulate_held(model, [0.0, 0.1], [[2e5, 3e5], [4e5, 2e5]], [0.0, 0.2])
    found += [*run.position, *run.velocity, *run.force.ravel(), *held.force.ravel()]
print(json.dumps([float(each) for each in found]))
"""


@pytest.mark.slow
@pytest.mark.skipif(not HAVE_NUMBA, reason='there is only plain Python here')
def test_plain_python_gives_what_the_compiled_kernel_gives():
    compiled, plain = (json.loads(run(RUN.format(blocked=b))) for b in (False, True))
    assert len(compiled) == 2 * (3 * 7 + 9) + 3 * (2 * (4 + 8 + 3) + 12 + 4)
    np.testing.assert_allclose(plain, compiled, rtol=1e-12, atol=1e-12)


def test_joints_of_all_kinds_share_the_chains_of_their_effects():
    """What a process has compiled for a muscle, a joint of two needs no more."""
    alone, pair = (
        bind(layout_of(EFFECTS, transmission, load, muscles), EFFECTS).advance
        for transmission, load, muscles in (
            (Straight.equations, Mass.equations, 1),
            (Pulley.equations, Arm.equations, 2),
        )
    )
    names = {name for name in names_of(alone) if name.endswith('_chain')}
    assert len(names) == 9
    for name in names:
        assert names_of(alone)[name] is names_of(pair)[name]


def names_of(function):
    return getattr(function, 'py_func', function).__globals__


@pytest.mark.slow
def test_an_effect_of_ones_own_acts():
    """2 N s/m of drag for a size of 1: a load that falls is slowed by just that."""
    drag = effect_of(SOURCE)
    load = Mass(mass=10.0)
    bare, slowed = (
        Simulation([single_muscle_joint(load=load, effects=effects, library=(drag,))])
        for effects in ((), [drag(size=30.0)])
    )
    for rig in (bare, slowed):
        rig.reset([3e5], [0.05], [0.7])
    difference = slowed.muscle_outputs().acceleration[0] - bare.muscle_outputs().acceleration[0]
    assert difference == pytest.approx(-30.0 * 2.0 * 0.7 / 10.0)
