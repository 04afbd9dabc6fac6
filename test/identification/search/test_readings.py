# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Units, signs, masses and muscles that are not as stated, in recordings of the truth plant."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from pam_ros.effects import ViscousFriction
from pam_ros.identification.search.readings import likely_mistake
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.run import simulate
from pam_ros.rig.transmissions import Pulley
from pam_ros.settings.nominal import nominal_joint, package_muscles
from support import bench_truth
from support.searches import setting_of
from truth import effect
from truth.pair_trials import pair_trial

PSI, INCH = 6894.757, 0.0254
MUSCLES = {'dmsp_20_400n': bench_truth.nominal().muscle}
LAG = effect('pressure_lag', fill_s=0.05, vent_s=0.05)


def doubt_of(recording, pool, model=None, muscles=MUSCLES):
    joint = model or bench_truth.nominal()
    setting = setting_of([recording], pool, joint, muscles=recording.muscles)
    return likely_mistake(setting, muscles)


@pytest.fixture(scope='module')
def recordings():
    """Return rigs that lack nothing, friction, and a lag."""
    missing = {'nothing': (), 'friction': (effect('coulomb_friction'),), 'lag': (LAG,)}
    return {name: bench_truth.free(*some, seed=4) for name, some in missing.items()}


def test_nothing_is_concluded_if_the_constants_are_uncertain(recordings, pool):
    given = [scaled(recordings['nothing'], command=1e3 / PSI)]
    setting = replace(setting_of(given, pool), uncertain={'a5': '50%'})
    assert likely_mistake(setting, MUSCLES) is None


def scaled(recording, **factors):
    return replace(
        recording, **{name: f * getattr(recording, name) for name, f in factors.items()}
    )


@pytest.mark.parametrize('missing', ['nothing', 'friction', 'lag'])
@pytest.mark.parametrize(
    ('change', 'words'),
    [
        (partial(scaled, command=1e3 / PSI), ['6.895', 'psi', 'kPa']),
        (partial(scaled, command=0.1), ['10 times', 'MPa', 'bar']),
        (partial(scaled, position=0.01 / INCH), ['2.54', 'inch', 'cm']),
        (partial(scaled, position=0.1), ['10 times', 'cm', 'mm']),
        (lambda one: replace(one, position=0.11 - one.position), ['opposite sign']),
        (lambda one: one, []),
    ],
    ids=['psi', 'bar', 'inch', 'cm', 'sign', 'right'],
)
def test_what_was_mistaken_is_named(recordings, missing, change, words, pool):
    doubt = doubt_of(change(recordings[missing]), pool)
    assert (doubt is not None) == bool(words)
    if doubt is not None:
        assert all(word in doubt.reason for word in words), doubt.reason
        assert '--column' in doubt.remedy


def with_muscle(joint, **changes):
    (actuator,) = joint.actuators
    return replace(
        joint, actuators=(replace(actuator, muscle=replace(actuator.muscle, **changes)),)
    )


@pytest.mark.parametrize(
    ('model', 'words'),
    [
        (bench_truth.nominal(mass=20.0 * 9.80665), ['the mass is 20 kg', 'N']),
        (
            with_muscle(bench_truth.nominal(), l0=0.15),
            ['the muscle is dmsp_20_400n with l0 = 0.4'],
        ),
    ],
    ids=['mass', 'muscle'],
)
def test_the_mass_or_the_muscle_can_be_what_was_mistaken(recordings, model, words, pool):
    doubt = doubt_of(recordings['friction'], pool, model)
    assert doubt is not None
    assert all(word in doubt.reason for word in words), doubt.reason


@pytest.mark.parametrize(
    'missing',
    [
        [effect('payload', payload_kg=6.0)],
        [effect('length_offset', kappa_offset=0.02)],
        [effect('payload', payload_kg=6.0), effect('viscous_friction', viscous_ns_m=60.0)],
    ],
    ids=['payload', 'length offset', 'payload and viscous friction'],
)
def test_an_effect_is_not_mistaken_for_a_muscle_that_differs_little(missing, pool):
    assert doubt_of(bench_truth.free(*missing, seed=4), pool, muscles=package_muscles()) is None


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        (partial(scaled, position=-1.0), ['the angle has the opposite sign']),
        (lambda one: replace(one, command=one.command[:, ::-1]), ['muscles are exchanged']),
        (partial(scaled, command=1e3 / PSI), ['6.895', 'psi']),
        (partial(scaled, position=np.pi / 180.0), ['57.3', 'rad', 'deg']),
        (lambda one: one, []),
    ],
    ids=['sign', 'exchanged', 'psi', 'deg', 'right'],
)
def test_a_joint_of_two_muscles(change, words, pool):
    trial = pair_trial('creep@one', 3)
    d = trial.nominal
    units = {'pressure_unit': 'Pa', 'contraction_unit': 'fraction'}
    muscle = Muscle(*d.constants_si, **units, zeta=d.zeta, l0=d.l0)
    actuator = Actuator(muscle, contraction=d.contraction)
    load = Arm(inertia=d.inertia, mass=d.mass, arm=d.arm)
    joint = Joint((actuator, actuator), load, Pulley(radius=d.radius))
    recording = Recording(
        'pair', trial.t, trial.t, trial.commands, trial.angle, muscles=('a', 'b'), unit='rad'
    )
    doubt = doubt_of(change(recording), pool, joint, {})
    assert (doubt is not None) == bool(words)
    if doubt is not None:
        assert all(word in doubt.reason for word in words), doubt.reason


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        (partial(scaled, force=1.0 / 4.448222), ['4.448', 'lbf']),
        (partial(scaled, command=1e3 / PSI), ['6.895', 'psi']),
        (lambda one: one, []),
    ],
    ids=['lbf', 'psi', 'right'],
)
def test_a_muscle_at_prescribed_lengths(change, words, pool):
    recording = bench_truth.held(effect('hysteresis'), seed=2)
    doubt = doubt_of(change(recording), pool)
    assert (doubt is not None) == bool(words)
    if doubt is not None:
        assert all(word in doubt.reason for word in words), doubt.reason


def test_a_load_without_a_rest_position_raises_no_doubt(pool):
    drive = nominal_joint('emps').joint
    t = np.arange(0.0, 12.0, 0.01)
    command = 2.0 * np.sin(t) + 0.5 * np.sin(3.1 * t) + 0.2
    load = replace(drive, effects=(ViscousFriction(coefficient=200.0),))
    position = simulate(load, t, command, position=0.0).position
    # Without the friction the mass is soon far away.
    assert doubt_of(Recording('drive', t, t, command, position), pool, drive) is None
