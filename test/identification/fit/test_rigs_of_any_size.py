# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The same rig in other sizes: the same typical sizes and verdict, in other numbers."""

from dataclasses import replace

import pytest

from pam_ros.identification.fit.places import places_of
from pam_ros.identification.identify import identify
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.sizes import REFERENCE, sizes_of
from support import bench_truth
from support.marks import at_release
from support.scaled import scaled_muscle
from truth import effect


def scaled(joint, recording, force, pressure, length):
    """Return a hanging rig and its recording in another size; the pendulum of times follows."""
    muscle, time = joint.muscle, length**0.5
    other = scaled_muscle(muscle, force, pressure, length)
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
