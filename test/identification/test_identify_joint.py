# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints of two muscles: what they lack and which muscle has it, on the independent pair."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import ViscousFriction
from pam_ros.errors import ParameterError, RecordingError
from pam_ros.identification.identify import identify
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Pulley
from truth.pair_trials import NAMES, pair_trial

SEED = 901


def nominal(trial):
    d = trial.nominal
    muscle = Muscle(
        *d.constants_si, pressure_unit='Pa', contraction_unit='fraction', zeta=d.zeta, l0=d.l0
    )
    actuator = Actuator(muscle, contraction=d.contraction)
    load = Arm(inertia=d.inertia, mass=d.mass, arm=d.arm)
    return Joint((actuator, actuator), load, Pulley(radius=d.radius))


def recording(trial, **changes):
    given = Recording(
        trial.kind, trial.t, trial.t, trial.commands, trial.angle, muscles=NAMES, unit='rad'
    )
    return replace(given, **changes)


@pytest.fixture(scope='module')
def trial():
    """Return an elbow with a lag in one of its muscles."""
    return pair_trial('pressure_lag@one', SEED)


@pytest.fixture(scope='module')
def lag(trial):
    return trial, identify(nominal(trial), [recording(trial)])


@pytest.mark.needs_numba
def test_an_effect_of_one_muscle_is_named_with_the_muscle(lag):
    trial, found = lag
    assert found.verdict == 'effect_found'
    assert [effect.name for effect in found.effects] == [f'{trial.where}.pressure_lag']
    assert found.unit == 'rad'
    error = found.stages[2].held_error
    assert error < 3.0 * trial.noise
    assert error < 0.2 * found.stages[1].held_error
    assert f'lacks pressure_lag of {trial.where}' in found.sentence


@pytest.mark.needs_numba
def test_the_model_that_is_found_has_the_effect_in_that_muscle_alone(lag):
    trial, found = lag
    model = found.stages[2].model
    has = [any(effect.is_present for effect in actuator.effects) for actuator in model.actuators]
    assert has == [name == trial.where for name in NAMES]
    # Each muscle is a specimen of its own.
    a, b = (muscle.si for muscle in model.muscles)
    assert a != b
    names = set(found.stages[1].parameters)
    assert {f'{name}.{constant}' for name in NAMES for constant in ('a1', 'a5', 'zeta')} < names


@pytest.mark.release
@pytest.mark.needs_numba
def test_friction_is_named_on_the_joint():
    trial = pair_trial('viscous_friction@joint', SEED)
    found = identify(nominal(trial), [recording(trial)])
    assert [effect.name for effect in found.effects] == ['viscous_friction']
    drag = found.effects[0].parameters['coefficient']
    assert drag.unit == 'N m s/rad'
    assert drag.value == pytest.approx(trial.effects[0].values['viscous_ns_m'], rel=0.15)


@pytest.mark.release
@pytest.mark.needs_numba
def test_an_effect_of_both_muscles_alike_is_named_without_a_muscle():
    trial = pair_trial('dead_time@both', SEED)
    found = identify(nominal(trial), [recording(trial)])
    assert [effect.name for effect in found.effects] == ['dead_time']
    (delay,) = (p.value for p in found.effects[0].parameters.values())
    assert delay == pytest.approx(trial.effects[0].values['dead_time_s'], abs=1e-3)


@pytest.mark.release
@pytest.mark.needs_numba
def test_a_reservoir_from_which_both_muscles_fill_is_named_with_its_numbers():
    trial = pair_trial('supply@joint', SEED)
    found = identify(nominal(trial), [recording(trial)])
    assert [effect.name for effect in found.effects] == ['supply']
    numbers = {name: p.value for name, p in found.effects[0].parameters.items()}
    true = trial.reservoir
    assert numbers['share'] == pytest.approx(true.share, rel=0.05)
    assert numbers['level'] == pytest.approx(true.level, rel=0.02)
    assert numbers['recovery'] == pytest.approx(true.recovery, rel=0.05)
    assert found.stages[2].held_error < 1.1 * trial.noise
    assert found.stages[1].held_error > 10.0 * trial.noise


@pytest.mark.release
@pytest.mark.needs_numba
def test_specimens_and_noise_alone_have_no_effect():
    trial = pair_trial('noise_only', SEED)
    found = identify(nominal(trial), [recording(trial)])
    assert not found.effects
    assert found.verdict in ('parameters_wrong', 'no_missing_effect')
    assert found.stages[1].held_error < CRITERIA.complete * trial.noise


def test_recordings_of_another_joint_are_refused(trial):
    given = recording(trial)
    with pytest.raises(RecordingError, match=r'a recording of 2 muscle\(s\), and the joint has 1'):
        identify(single_muscle_joint(), [given])
    with pytest.raises(RecordingError, match='the position is in m, and the joint moves in rad'):
        identify(antagonistic_joint(), [replace(given, unit='m')])
    single = Recording('one', trial.t, trial.t, trial.commands[:, 0], np.sin(trial.t))
    with pytest.raises(RecordingError, match='one is a recording of 1 muscle'):
        identify(antagonistic_joint(), [single])
    idle = replace(given, name='idle', command=np.where([True, False], 2e5, trial.commands))
    with pytest.raises(
        RecordingError, match=r'idle: agonist.pressure_command is constant at 2000'
    ):
        identify(nominal(trial), [idle])
    with pytest.raises(RecordingError, match='one is a recording of 1 muscle'):
        identify(nominal(trial), [given, single])
    swapped = replace(given, name='swapped', muscles=NAMES[::-1])
    with pytest.raises(RecordingError, match='swapped has the muscles antagonist, agonist, and'):
        identify(nominal(trial), [given, swapped])


def test_a_nominal_joint_with_an_onset_is_refused(trial):
    late = replace(nominal(trial), effects=[ViscousFriction(coefficient=1, onset=9)])
    with pytest.raises(ParameterError) as error:
        identify(late, [recording(trial)])
    assert str(error.value) == (
        'effects.viscous_friction.onset = 9 s is not allowed: a nominal joint takes effects that '
        'act from the start, give 0 or leave the effect out'
    )


# Uncertain nominal values ------------------------------------------------------------------------


@pytest.mark.needs_numba
def test_a_wrong_inertia_that_is_configured_as_uncertain_is_found():
    """Taken as exact it looks like a missing effect, softening in these trials."""
    trial = pair_trial('noise_only', SEED)
    joint = nominal(trial)
    joint = replace(joint, load=replace(joint.load, inertia=0.6 * trial.nominal.inertia))
    before, told = [], []
    found = identify(
        joint,
        [recording(trial)],
        progress=lambda share, text: before.append(list(told)),
        uncertain={'inertia': '60%', 'radius': 1e-9},
        warn=told.append,
    )
    assert found.verdict == 'parameters_wrong'
    nominal_, retuned, _ = found.stages
    estimate = retuned.parameters['inertia']
    assert estimate.unit == 'kg m^2'
    assert estimate.value == pytest.approx(trial.nominal.inertia, rel=0.1)
    assert nominal_.parameters['inertia'].value == joint.load.inertia
    assert retuned.model.load.inertia == estimate.value
    assert retuned.held_error < 1.2 * trial.noise < nominal_.held_error
    assert found.uncertain == {'inertia': '60%', 'radius': '1e-09'}
    # Of a radius that is known to a nanometre a recording says nothing more.
    warnings = [text for text in found.warnings if 'hardly determine' in text]
    assert [text.split()[4] for text in warnings] == ['radius:']
    assert before[0] == told == warnings


def test_an_uncertain_parameter_that_the_joint_lacks_is_refused_before_the_fit():
    trial = pair_trial('noise_only', SEED)
    with pytest.raises(ParameterError, match='the uncertain parameter crank is not one'):
        identify(nominal(trial), [recording(trial)], uncertain={'crank': '5%'})
