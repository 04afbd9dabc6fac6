# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that begin to act in the middle of a simulation, against closed forms and DOP853."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pam_ros.effects import (
    CoulombFriction,
    Creep,
    DeadTime,
    EndStop,
    Hysteresis,
    Leak,
    Payload,
    PressureLag,
    PressureOffset,
    ViscousFriction,
)
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import paper
from support.joint_models import pair

# A force source of 0.01 N/Pa moves 5 kg on a rail.
GAIN, MASS, PRESSURE = 0.01, 5.0, 100.0
SOURCE = Muscle(
    a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=GAIN, a6=0.0, zeta=0.0, pressure_unit='Pa',
    contraction_unit='fraction', l0=1.0,
)  # fmt: skip
PUSH = GAIN * PRESSURE / MASS
T = np.arange(200) / 100.0


def on_rail(effects):
    return single_muscle_joint(SOURCE, Mass(mass=MASS, mount='horizontal'), effects)


def pushed(effects, t=T):
    return simulate(on_rail(effects), t, [PRESSURE], [t[0]], position=0.0)


@pytest.mark.parametrize('onset', [0.7, 0.7041, 1.2])
def test_viscous_friction_from_a_moment_on(onset):
    """Until then a parabola, then the speed approaches that at which friction balances the pull.

    The moment may lie on a sample or between two.
    """
    c = 20.0
    run = pushed([ViscousFriction(coefficient=c, onset=onset)])
    since, rate = np.maximum(T - onset, 0.0), c / MASS
    last = PUSH / rate
    v = np.where(onset >= T, PUSH * T, last + (PUSH * onset - last) * np.exp(-rate * since))
    np.testing.assert_allclose(run.velocity, v, atol=1e-9)


def test_several_effects_begin_one_after_the_other():
    """A load that becomes twice as heavy, and then half of that again: two kinks of the speed."""
    effects = [Payload(mass=MASS, onset=0.5), PressureOffset(offset=PRESSURE, onset=1.0)]
    run = pushed(effects)
    v = PUSH * np.where(T < 0.5, T, np.where(T < 1.0, 0.25 + 0.5 * T, T - 0.25))
    np.testing.assert_allclose(run.velocity, v, atol=1e-9)


def test_two_effects_begin_between_two_samples():
    effects = [Payload(mass=MASS, onset=0.5), PressureOffset(offset=PRESSURE, onset=1.0)]
    run = pushed(effects, t=np.array([0.0, 0.4, 1.5, 2.0]))
    np.testing.assert_allclose(run.velocity, PUSH * np.array([0.0, 0.4, 1.25, 1.75]), atol=1e-9)


@pytest.mark.parametrize(('onset', 'mass'), [(0.0, 2 * MASS), (T[-1], MASS), (50.0, MASS)])
def test_what_begins_at_the_ends_acts_always_or_never(onset, mass):
    run = pushed([Payload(mass=MASS, onset=onset)])
    np.testing.assert_allclose(run.velocity, PUSH * MASS / mass * T, atol=1e-9)


def test_the_onset_is_on_the_clock_of_the_stamps():
    """A run whose stamps begin behind the onset has the effect from its start on."""
    effects = [Payload(mass=MASS, onset=10.5)]
    run = pushed(effects, t=T + 10.0)
    np.testing.assert_allclose(run.velocity, PUSH * np.minimum(T, 0.25 + 0.5 * T), atol=1e-9)
    later = pushed(effects, t=T + 11.0)
    np.testing.assert_allclose(later.velocity, 0.5 * PUSH * T, atol=1e-9)


def test_a_leak_begins_with_a_full_chamber():
    leak = {'rate': 0.5, 'refill': 0.2, 'onset': 0.5}
    run = pushed([Leak(**leak)])
    pace, rest = 1.0 / 0.2 + 0.5, PRESSURE / (1.0 + 0.5 * 0.2)
    p = rest + (PRESSURE - rest) * np.exp(-pace * np.maximum(T - 0.5, 0.0))
    np.testing.assert_allclose(run.pressure, p, rtol=1e-9)


def test_a_command_that_has_acted_has_acted_whatever_delay_begins():
    """The command of 0.95 s is in the chamber at 1 s; those of 0.98 s and later come late."""
    joint = on_rail([DeadTime(delay=0.1, onset=1.0)])
    at = [0.0, 0.95, 1.05]
    run = simulate(joint, T, [1.0, 2.0, 3.0], at, position=0.0)
    p = np.where(T <= 0.95, 1.0, np.where(T < 1.155, 2.0, 3.0))
    np.testing.assert_array_equal(run.pressure, p)


def test_a_muscle_gets_friction_and_a_load_while_the_load_falls():
    """The paper's muscle against DOP853, which begins again at the moment with the other load."""
    muscle, more, c, onset = Muscle(zeta=0.05), 4.0, 30.0, 0.3137
    effects = [Payload(mass=more, onset=onset), ViscousFriction(coefficient=c, onset=onset)]
    t = np.linspace(0.0, 1.0, 201)
    joint = single_muscle_joint(muscle, Mass(mass=20.0), effects)
    run = simulate(joint, t, [4e5], [0.0], position=0.02, step=2e-4)

    def motion(mass, drag):
        free = paper.pendulum(lambda _: 4.0, mass, muscle.zeta)

        def braked(t, x):
            v, a = free(t, x)
            return v, a - drag * v / mass

        return braked

    exact = {'method': 'DOP853', 'rtol': 1e-11, 'atol': 1e-13, 'dense_output': True}
    first = solve_ivp(motion(20.0, 0.0), (0.0, onset), [-0.02, 0.0], **exact)
    second = solve_ivp(motion(20.0 + more, c), (onset, 1.0), first.y[:, -1], **exact)
    expected = -np.where(t <= onset, first.sol(t)[0], second.sol(t)[0])
    np.testing.assert_allclose(run.position, expected, atol=1e-7)


@pytest.mark.parametrize(
    'effect',
    [
        Creep(stiffness=300.0, time=0.5),
        Hysteresis(slip=3.0),
        PressureLag(fill=0.05, vent=0.1),
        CoulombFriction(level=0.2),
    ],
    ids=lambda effect: effect.name,
)
def test_stepped_and_over_stamps_it_is_the_same(effect):
    """Also in one of two muscles, of which the other has had the effect from the start on."""
    always, late = [effect], [replace(effect, onset=0.25)]
    is_on_joint = effect.acts_on_joint()
    joint = pair(load=late) if is_on_joint else pair(effects=(always, late))
    t, at = np.arange(601) * 1e-3, [0.0, 0.1, 0.2, 0.4]
    commands = 1e5 * np.array([[3.0, 3.0], [4.0, 2.5], [2.0, 3.5], [2.5, 3.0]])
    run = simulate(joint, t, commands, at)
    rig, found = Simulation([joint]), []
    rig.reset(commands[0], run.position[:1], 0.0)
    for k in range(t.size):
        found.append([rig.position[0], *rig.pressure])
        if k / 1e3 in at:
            rig.command(commands[at.index(k / 1e3)])
        rig.advance()
    np.testing.assert_allclose(run.position, np.array(found)[:, 0], atol=1e-12)
    np.testing.assert_allclose(run.pressure, np.array(found)[:, 1:], rtol=1e-12)
    other = pair(load=always) if is_on_joint else pair(effects=(always, always))
    differs = simulate(other, t, commands, at, position=run.position[0])
    assert np.abs(differs.position - run.position).max() > 1e-5


def test_stages_are_joints_without_what_has_not_begun():
    late = [Leak(rate=0.1, onset=20.0), EndStop(stiffness=1e5, onset=5.0)]
    always = [Creep(stiffness=10.0)]
    joint = single_muscle_joint(effects=[*late, *always])
    times, stages = zip(*joint.stages, strict=True)
    assert times == (0.0, 5.0, 20.0)
    assert [sorted(effect.name for effect in stage.all_effects) for stage in stages] == [
        ['creep'],
        ['creep', 'end_stop'],
        ['creep', 'end_stop', 'leak'],
    ]
    assert joint.at_start is stages[0]
    assert Leak(rate=0.1) in stages[2].all_effects
    np.testing.assert_array_equal(stages[2].parameters(), joint.parameters())
    plain = single_muscle_joint(effects=always)
    assert plain.stages == ((0.0, plain),)
    # What never acts never begins.
    absent = single_muscle_joint(effects=[Leak(rate=0.0, onset=3.0)])
    assert [time for time, _ in absent.stages] == [0.0]


def test_a_stage_that_is_no_joint_is_refused():
    """No muscle carries 3.5 t until a part of them is gone; 50 g are too light for the step."""
    with pytest.raises(ParameterError, match='mass = 3500 kg and this muscle do not fit together'):
        single_muscle_joint(load=Mass(mass=3500.0), effects=[Payload(mass=-1000.0, onset=5.0)])
    joint = single_muscle_joint(load=Mass(mass=0.05), effects=[Payload(mass=20.0, onset=5.0)])
    with pytest.raises(ParameterError, match=r'does not resolve a mass of 0\.05 kg'):
        simulate(joint, T, [3e5], [0.0])


@pytest.mark.parametrize('onset', [-1.0, float('nan'), float('inf'), 'soon'])
def test_an_onset_that_is_no_time_is_refused(onset):
    with pytest.raises(ParameterError, match=r'effects\.leak\.onset'):
        single_muscle_joint(effects=[Leak(rate=0.1, onset=onset)])


def test_a_prescribed_motion_takes_no_onset():
    joint = Joint((Actuator(Muscle(), [Creep(stiffness=10.0, onset=2.0)]),))
    with pytest.raises(ParameterError) as error:
        simulate_held(joint, [0.0, 1.0], [3e5, 3e5], [0.03, 0.03])
    assert str(error.value) == (
        'effects.creep.onset = 2 s is not allowed: simulate_held takes effects that act from the '
        'start, give 0 or leave the effect out'
    )
    actuator = replace(joint.actuators[0], effects=[Creep(stiffness=10.0, onset=0.0)])
    held = simulate_held(Joint((actuator,)), [0.0, 1.0], [3e5, 3e5], [0.03, 0.03])
    assert np.all(np.isfinite(held.force))
