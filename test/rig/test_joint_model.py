# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What makes a joint, and what the kernel is given of it."""

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Effect, EffectParameter
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.rig.joints.parallel import ParallelLoad
from pam_ros.rig.layout import L0, MASS, ZETA
from pam_ros.rig.model import Load
from support import joints
from support.joint_models import UNEQUAL, muscle, pair, parallel

SOURCE = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)
LAG = {'pressure_lag': {'fill': 0.1, 'vent': 0.2}}
RUB = {'coulomb_friction': {'level': 0.5}}


def test_by_default_it_is_a_pair_that_hangs():
    model = JointModel()
    assert model.joint.name == 'antagonistic_pair'
    assert model.rest(3e5) == pytest.approx(0.0, abs=1e-12)
    assert model.present == ((), (), ())
    assert model.active == ()


REFUSED = [
    ({'actuators': (Actuator(),)}, '1 muscles make no antagonistic_pair: give 2'),
    ({'load': Load()}, 'Load is the load of no joint: give one of ParallelLoad, PulleyArm'),
    ({'effects': {'magic': {}}}, 'effects.magic is not known: give one of payload, viscous_'),
    (
        {'actuators': (Actuator(effects={'magic': {}}), Actuator())},
        'effects.magic is not known: give one of dead_time, ',
    ),
    ({'effects': LAG}, 'effects.pressure_lag acts in a muscle: give it there'),
    (
        {'actuators': (Actuator(), Actuator(effects=RUB))},
        'effects.coulomb_friction acts on the load: give it there',
    ),
    (
        {'effects': {'end_stop': {'upper': 4.0}}},
        'effects.end_stop.upper = 4.0 is not allowed: give -3.14159 to 3.14159 rad',
    ),
    (
        {'effects': {'viscous_friction': {'coefficient': -1.0}}},
        'effects.viscous_friction.coefficient = -1.0 is not allowed: give 0 to 10000 N m s/rad',
    ),
    (
        {'actuators': (Actuator(), Actuator(SOURCE))},
        'muscle 2 of antagonistic_pair has no stiffness: a1, a2 and a4 are 0',
    ),
    (
        {'load': PulleyArm(contraction_1=0.6)},
        'the muscles of antagonistic_pair are never within kappa_min and kappa_max together: '
        'mend contraction_1, contraction_2 or the lengths l0',
    ),
    (
        {'load': ParallelLoad(mass=9000.0)},
        'mass = 9000 kg and these muscles make no parallel: no equilibrium: with 0 and 0 kPa the',
    ),
]


@pytest.mark.parametrize(('parts', 'sentence'), REFUSED)
def test_what_makes_no_joint_is_refused_with_a_sentence(parts, sentence):
    with pytest.raises(ParameterError) as error:
        JointModel(**parts)
    assert str(error.value).startswith(sentence)


def test_an_effect_on_muscle_and_load_at_once_has_no_place_in_a_joint():
    def anywhere(*_):
        return 0.0

    strength = EffectParameter('strength', 0.0, '', '', 0.0, 1.0, scale=1.0, strength=True)
    both = Effect('both', '', '', (strength,), '', '', (), force=anywhere, outside=anywhere)
    with pytest.raises(ParameterError, match=r'effects\.both acts in a muscle'):
        JointModel(effects={'both': {'strength': 1.0}}, library=(both,))


@pytest.mark.parametrize(
    ('model', 'step', 'sentence'),
    [
        (pair(), 0.0, 'a physics step of 0 s is not allowed: give more than 0'),
        (pair(), 0.1, 'a physics step of 100 ms does not resolve an inertia of 0.07 kg m^2 on '),
        (
            parallel(50.0),
            0.1,
            'a physics step of 100 ms does not resolve a mass of 50 kg on these',
        ),
    ],
)
def test_a_step_that_resolves_nothing_is_refused(model, step, sentence):
    with pytest.raises(ParameterError) as error:
        model.check_step(step)
    assert str(error.value).startswith(sentence)


def test_pressures_are_one_a_muscle_or_one_for_all():
    model = pair()
    assert model.each(2e5) == [2e5, 2e5]
    assert model.each([2e5, 3e5]) == [2e5, 3e5]
    with pytest.raises(ValueError, match='broadcast'):
        model.each([1.0, 2.0, 3.0])


def test_rows_hold_everything_in_si():
    model = pair(effects=(LAG, {}), load=RUB | {'payload': {'mass': 0.5}})
    one, two, load = model.rows()
    j = joints.J + 0.5 * joints.ARM**2
    for row, strand in ((one, UNEQUAL[0]), (two, UNEQUAL[1])):
        np.testing.assert_array_equal(row[:6], muscle(strand).si)
        assert (row[ZETA], row[L0]) == (joints.ZETA, strand.l0)
        assert row[MASS] == pytest.approx(j / (2.0 * joints.R**2))
    # The load's lengths are angles, its mass the declared inertia: effects reckon with these.
    assert (load[MASS], load[L0]) == (pytest.approx(joints.J), 1.0)
    at = model.layout.parameter_at
    np.testing.assert_array_equal(one[at['pressure_lag'] :][:2], [0.1, 0.2])
    np.testing.assert_array_equal(two[at['pressure_lag'] :][:2], [0.0, 0.0])
    assert load[at['coulomb_friction']] == 0.5
    assert model.moved_mass == joints.M + 0.5
    assert model.inertia == pytest.approx(j)
    assert [[e.name for e in each] for each in model.present] == [
        ['pressure_lag'],
        [],
        ['payload', 'coulomb_friction'],
    ]
    assert model.active == EFFECTS


def test_a_load_that_slides_has_lengths_in_m():
    model = parallel(50.0)
    *_, load = model.rows()
    assert (load[MASS], load[L0]) == (50.0, UNEQUAL[0].l0)
    assert model.inertia == 50.0
