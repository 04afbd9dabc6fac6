# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes of rigs, and the same rig in other sizes: the same answer in other numbers."""

from dataclasses import replace

import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.sizes import REFERENCE, Sizes, sizes_of
from pam_ros.identification.identify import identify
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from support import bench_truth
from support.marks import at_release
from truth import effect

LARGE = Sizes(force=10.0, pressure=100.0, length=0.1)
FACTORS = {
    '': 1.0,
    'fraction': 1.0,
    's': 1.0,
    '1/s': 1.0,
    '1/fraction': 1.0,
    'Hz': 1.0,
    'N': 10.0,
    'kg': 10.0,
    'Pa': 100.0,
    '1/Pa': 0.01,
    'Pa/s': 100.0,
    'm': 0.1,
    'm/s': 0.1,
    's/m': 10.0,
    'N/m': 100.0,
    'N/Pa': 0.1,
    'N s/m': 100.0,
    'N s/(m Pa)': 1.0,
}


def test_the_factor_of_every_unit_of_the_library():
    units = {p.unit for one in EFFECTS for p in (*one.parameters(), *one.states)}
    assert units <= {*FACTORS}
    for unit, factor in FACTORS.items():
        assert LARGE.factor(unit) == pytest.approx(factor), unit
        assert REFERENCE.factor(unit) == 1.0


def scaled(joint, recording, force, pressure, length):
    """Return a hanging rig and its recording in another size; the pendulum of times follows."""
    muscle, time = joint.muscle, length**0.5
    by_pressure = {name: getattr(muscle, name) * force / pressure for name in ('a1', 'a4', 'a5')}
    by_force = {name: getattr(muscle, name) * force for name in ('a2', 'a6', 'force_max')}
    other = replace(
        muscle, **by_pressure, **by_force, l0=muscle.l0 * length, p_max=muscle.p_max * pressure
    )
    times = {name: getattr(recording, name) * time for name in ('t', 'command_t')}
    values = {'command': recording.command * pressure, 'position': recording.position * length}
    rig = single_muscle_joint(other, Mass(mass=joint.load.mass * force))
    return rig, replace(recording, **times, **values)


@pytest.mark.parametrize(
    ('force', 'pressure', 'length'),
    [(0.03, 1.0, 1.0), (20.0, 8.0, 1.0), (1.0, 0.013, 1.0), (1.0, 1.0, 0.1), (10.0, 5.0, 5.0)],
)
def test_typical_sizes_follow_the_rig(force, pressure, length):
    joint, recording = bench_truth.nominal(), bench_truth.free(duration=5.0)
    rig, _ = scaled(joint, recording, force, pressure, length)
    sizes = sizes_of(rig)
    pairs = ((sizes.force, force), (sizes.pressure, pressure), (sizes.length, length))
    assert all(wanted / 6.0 < own < 6.0 * wanted for own, wanted in pairs)
    friction, before = (places_of(one)['coulomb_friction'] for one in (rig, joint))
    for p, plain in zip(friction.parameters, before.parameters, strict=True):
        factor = sizes.factor(plain.unit)
        for name in ('low', 'high', 'scale', 'default'):
            assert getattr(p, name) == pytest.approx(factor * getattr(plain, name))
    level = before.fit_starts[0]['level']
    assert friction.fit_starts[0]['level'] == pytest.approx(sizes.force * level)
    assert sizes_of(single_muscle_joint(Muscle(), Mass(mass=20.0))) == REFERENCE


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('force', 'pressure', 'length'),
    [
        (0.03, 0.013, 1.0),
        at_release(20.0, 8.0, 1.0),
        at_release(1.0, 1.0, 0.1),
        at_release(0.1, 3.0, 3.0),
    ],
)
def test_a_rig_of_any_size_has_the_same_verdict(force, pressure, length):
    joint = bench_truth.nominal()
    recording = bench_truth.free(effect('coulomb_friction'), seed=5, duration=20.0)
    found = [
        identify(*scaled(joint, recording, *sizes))
        for sizes in ((1.0, 1.0, 1.0), (force, pressure, length))
    ]
    names = [[one.name for one in each.effects] for each in found]
    assert names == 2 * [['coulomb_friction']]
    levels = [each.effects[0].parameters['level'].value for each in found]
    assert levels[1] == pytest.approx(force * levels[0], rel=2e-3)
    errors = [each.stages[2].held_error / each.stages[1].held_error for each in found]
    assert errors[1] == pytest.approx(errors[0], rel=0.2)
