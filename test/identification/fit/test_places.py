# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where effects act in a joint, and what sizes they have there."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.fit.places import (
    effect_of,
    muscle_of,
    place_of,
    places_of,
    spelled,
)
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint

RADIUS, LENGTH = 0.04, 0.4
ELBOW = antagonistic_joint(Muscle(l0=LENGTH), radius=RADIUS, load=Arm(mass=1.0))
RIG = single_muscle_joint(load=Mass(mass=20.0))
NAMES = ('flexor', 'extensor')
EFFECT = {effect.name: effect for effect in EFFECTS}


def test_one_muscle_on_a_mass_has_each_effect_once_and_as_it_is():
    places = places_of(RIG)
    assert {name: place.effect for name, place in places.items()} == EFFECT
    assert places['creep'].indices(RIG.layout, 0) == [RIG.layout.index(EFFECT['creep'])]
    assert places['payload'].rows == (at.JOINT,)


def test_what_acts_in_muscles_can_be_in_all_or_in_each():
    places = places_of(ELBOW, NAMES)
    in_muscles = [e.name for e in EFFECTS if not e.acts_on_joint()]
    expected = [e.name for e in EFFECTS]
    expected += [f'{muscle}.{effect}' for muscle in NAMES for effect in in_muscles]
    assert sorted(places) == sorted(expected)
    layout = ELBOW.layout
    both, second = places['leak'], places['extensor.leak']
    assert both.rows == (at.MUSCLE, at.MUSCLE + 1)
    assert second.rows == (at.MUSCLE + 1,)
    assert second.indices(layout, 0) == [layout.index(EFFECT['leak'], 0, 1)]
    assert both.indices(layout, 0) == [layout.index(EFFECT['leak'], 0, i) for i in (0, 1)]
    assert second.flat('rate') == 'extensor.effects.leak.rate'
    assert both.flat('rate') == 'effects.leak.rate'


def test_places_overlap_where_they_share_a_row_and_an_effect():
    places = places_of(ELBOW, NAMES)
    both, first, second = (places[n] for n in ('leak', 'flexor.leak', 'extensor.leak'))
    assert both.overlaps(first)
    assert first.overlaps(both)
    assert not first.overlaps(second)
    assert not first.overlaps(places['flexor.creep'])


def test_muscles_without_names_are_numbered():
    assert {'muscle_1.creep', 'muscle_2.creep'} < {*places_of(ELBOW)}


@pytest.mark.parametrize(
    ('name', 'effect', 'muscle', 'words'),
    [
        ('creep', 'creep', '', 'creep'),
        ('flexor.pressure_lag', 'pressure_lag', 'flexor', 'pressure_lag of flexor'),
    ],
)
def test_parts_of_a_name(name, effect, muscle, words):
    assert (effect_of(name), muscle_of(name), spelled(name)) == (effect, muscle, words)


def test_a_parameter_belongs_to_a_place():
    assert place_of('effects.creep.time') == 'creep'
    assert place_of('flexor.effects.creep.time') == 'flexor.creep'
    assert place_of('a1') == place_of('flexor.a1') == ''


def test_sizes_on_a_joint_that_turns_are_those_at_the_arm():
    """What moves a muscle's end by d turns the joint by d / r; a force F has the torque r F."""
    friction, plain = places_of(ELBOW)['coulomb_friction'], places_of(RIG)['coulomb_friction']
    scale = {p.name: p.scale for p in friction.parameters}
    before = {p.name: p.scale for p in plain.parameters}
    assert scale['level'] == pytest.approx(RADIUS * before['level'])
    assert scale['stribeck_speed'] == pytest.approx(before['stribeck_speed'] / RADIUS)
    assert friction.fit_starts[0]['level'] == pytest.approx(RADIUS * plain.fit_starts[0]['level'])
    assert friction.states[0].spread == pytest.approx(RADIUS * plain.states[0].spread)
    assert {p.name: p.unit for p in friction.parameters}['level'] == 'N m'
    viscous = places_of(ELBOW)['viscous_friction']
    assert viscous.example['coefficient'] == pytest.approx(RADIUS**2 * 30.0)
    assert places_of(ELBOW)['payload'].example == {'mass': 1.5}
    # Nothing changes on a load that slides.
    for one, declared in zip(
        plain.parameters, EFFECT['coulomb_friction'].parameters(), strict=True
    ):
        assert one == replace(declared, low=declared.fit_low, high=declared.fit_high)
    assert plain.fit_starts == EFFECT['coulomb_friction'].fit_starts()
    assert plain.example == EFFECT['coulomb_friction'].example().given
    assert plain.states == EFFECT['coulomb_friction'].states


def test_a_stop_is_where_the_muscle_would_have_its_contraction():
    stop = places_of(ELBOW)['end_stop']
    assert stop.example['upper'] == pytest.approx(0.2 * LENGTH / RADIUS)
    t = np.linspace(0.0, 10.0, 500)
    angle = 0.6 * np.sin(t)
    places = [start['upper'] for start in stop.guess(t, t, angle, t, 'rad') if 'upper' in start]
    assert places
    assert all(0.3 < place < 0.6 for place in places)


def test_where_a_memory_begins_is_each_muscles_own():
    """All else of an effect in both is one number for both."""
    both, layout = places_of(ELBOW, NAMES)['hysteresis'], ELBOW.layout
    parameters = [p.name for p in EFFECT['hysteresis'].parameters()]
    initial, slip = parameters.index('initial'), parameters.index('slip')
    places = [layout.index(EFFECT['hysteresis'], initial, i) for i in (0, 1)]
    assert both.split(layout, initial) == [
        ('flexor.effects.hysteresis.initial', (places[0],)),
        ('extensor.effects.hysteresis.initial', (places[1],)),
    ]
    ((name, indices),) = both.split(layout, slip)
    assert (name, len(indices)) == ('effects.hysteresis.slip', 2)
    alone = places_of(ELBOW, NAMES)['extensor.hysteresis']
    assert alone.split(layout, initial) == [('extensor.effects.hysteresis.initial', (places[1],))]
