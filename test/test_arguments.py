# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What public functions and classes do not take: each entrance, with each kind of wrong input."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from pam_ros import (
    EFFECTS,
    Actuator,
    Arm,
    Gains,
    Joint,
    Limits,
    Mass,
    Muscle,
    PamError,
    Pid,
    PidGains,
    Pulley,
    Recording,
    Simulation,
    SlidingMode,
    Transmission,
    co_contraction_pressures,
    equilibrium,
    fit_static_map,
    identify,
    joint_stiffness,
    joint_stiffness_range,
    load_joint,
    load_muscle,
    read_mapping,
    read_recording,
    simulate,
    simulate_held,
    simulate_pressure,
    single_muscle_joint,
    write_csv,
)
from pam_ros.effects import Creep, PressureLag, ViscousFriction
from support.assertions import no_error

ONE = single_muscle_joint()
STRAND = Actuator(contraction=0.1)
ELBOW = Joint((STRAND, STRAND), Arm(), Pulley())
T = [0.0, 0.005, 0.02]
COMMAND = [3e5, 4e5, 2e5]
COMMANDS = [[3e5, 2e5], [4e5, 2e5], [2e5, 3e5]]
STILL = [0.02, 0.02, 0.02]


def recorded(**changes):
    """Return a recording with every array."""
    arrays = {name: [1.0, 2.0, 3.0] for name in ('position', 'velocity', 'force', 'pressure')}
    given = {'t': T, 'command_t': T, 'command': COMMAND, **arrays, 'kind': 'free', 'gaps': ()}
    return Recording('made', **given | changes)


P, KAPPA = (a.ravel() for a in np.meshgrid([2e5, 4e5, 6e5], np.linspace(0.0, 0.25, 6)))
FORCE = Muscle().force(P, KAPPA)


def mapped(**changes):
    """Fit a static map that determines the constants, with some of it changed."""
    return fit_static_map(**{'p': P, 'kappa': KAPPA, 'force': FORCE} | changes)


# Arrays ----------------------------------------------------------------------------------------
# Each with a good value, and what is wrong with it in addition to what is wrong everywhere.

ANY_LENGTH = 'any length'
STAMPS = 'stamps'
EMPTY_IS_GOOD = 'empty is good'
ARRAYS = {
    'simulate t': (lambda v: simulate(ONE, v, COMMAND, T), T, {STAMPS, ANY_LENGTH}),
    'simulate command_t': (lambda v: simulate(ONE, T, COMMAND, v), T, {STAMPS}),
    'simulate command': (lambda v: simulate(ONE, T, v), COMMAND, set()),
    'simulate command of two': (lambda v: simulate(ELBOW, T, v), COMMANDS, set()),
    'simulate_pressure t': (
        lambda v: simulate_pressure(ONE, v, COMMAND, T),
        T,
        {STAMPS, ANY_LENGTH},
    ),
    'simulate_pressure command': (lambda v: simulate_pressure(ONE, T, v), COMMAND, set()),
    'simulate_held t': (lambda v: simulate_held(ONE, v, COMMAND, STILL), T, {STAMPS}),
    'simulate_held pressure': (lambda v: simulate_held(ONE, T, v, STILL), COMMAND, set()),
    'simulate_held pressure of two': (
        lambda v: simulate_held(ELBOW, T, v, STILL),
        COMMANDS,
        set(),
    ),
    'simulate_held position': (lambda v: simulate_held(ONE, T, COMMAND, v), STILL, set()),
    'simulate_held velocity': (lambda v: simulate_held(ONE, T, COMMAND, STILL, v), STILL, set()),
    'rig.command pressure': (lambda v: Simulation([ELBOW, ONE]).command(v), COMMAND, set()),
    'rig.reset pressure': (lambda v: Simulation([ELBOW, ONE]).reset(v, 0.0, 0.0), COMMAND, set()),
    'rig.reset position': (
        lambda v: Simulation([ELBOW, ONE]).reset(0.0, v, 0.0),
        [0.1, 0.0],
        set(),
    ),
    'rig.reset velocity': (
        lambda v: Simulation([ELBOW, ONE]).reset(0.0, 0.0, v),
        [0.1, 0.0],
        set(),
    ),
    'equilibrium p': (lambda v: equilibrium(ELBOW, v), [3e5, 2e5], set()),
    'joint_stiffness p': (lambda v: joint_stiffness(ELBOW, v, 0.1), [3e5, 2e5], set()),
    'joint_stiffness s': (
        lambda v: joint_stiffness(ELBOW, 3e5, v),
        [0.1, 0.2],
        {ANY_LENGTH, EMPTY_IS_GOOD},
    ),
    'muscle.force p': (lambda v: Muscle().force(v, [0.1, 0.2, 0.0]), COMMAND, set()),
    'muscle.force kappa': (lambda v: Muscle().force([3e5, 2e5, 1e5], v), STILL, set()),
    'muscle.stiffness p': (lambda v: Muscle().stiffness(v, [0.1, 0.2, 0.0]), COMMAND, set()),
    'muscle.damping mass': (lambda v: Muscle().damping(3e5, STILL, v), [5.0, 6.0, 7.0], set()),
    'muscle.gain kappa': (lambda v: Muscle().gain(v), STILL, {ANY_LENGTH, EMPTY_IS_GOOD}),
    'muscle.potential kappa': (lambda v: Muscle().potential(COMMAND, v), STILL, set()),
    'muscle.pressure_for_force wanted': (
        lambda v: Muscle().pressure_for_force(v, STILL),
        [200.0, 300.0, 400.0],
        set(),
    ),
    'recording t': (lambda v: recorded(t=v), T, {STAMPS}),
    'recording command_t': (lambda v: recorded(command_t=v), T, {STAMPS}),
    'recording command': (lambda v: recorded(command=v), COMMAND, set()),
    'recording position': (lambda v: recorded(position=v), STILL, set()),
    'recording velocity': (lambda v: recorded(velocity=v), STILL, set()),
    'recording force': (lambda v: recorded(force=v), STILL, set()),
    'recording pressure': (lambda v: recorded(pressure=v), STILL, set()),
    'recording gaps': (
        lambda v: recorded(gaps=v),
        [[0.1, 0.2], [0.4, 0.5]],
        {ANY_LENGTH, EMPTY_IS_GOOD},
    ),
    'fit_static_map p': (lambda v: mapped(p=v), P, set()),
    'fit_static_map kappa': (lambda v: mapped(kappa=v), KAPPA, set()),
    'fit_static_map force': (lambda v: mapped(force=v), FORCE, set()),
}
# Where single numbers stand for all, and shapes are broadcast, more dimensions may be no mistake.
BROADCAST = {name for name in ARRAYS if name.startswith(('muscle.', 'joint_stiffness s'))}


def changed(good, last):
    """Return *good* with another last number."""
    found = np.array(good)
    found[(-1,) * found.ndim] = last
    return found


def wrong(name):
    """Return the kinds of wrong input for an entrance, by name."""
    _, good, about = ARRAYS[name]
    shaped = np.array(good)
    found = {
        'NaN': changed(good, np.nan),
        'inf': changed(good, np.inf),
        'minus inf': changed(good, -np.inf),
        'strings': shaped.astype(str),
        'words': ['a', 'b', 'c'],
        'text': '3e5',
        'None': [None] * len(good),
        'objects': [object()] * len(good),
        'complex': shaped * 1j,
        'ragged': [[1.0], [2.0, 3.0]],
        'truth': shaped > 0.0,
        'dict': {'a': 1.0},
    }
    if name not in BROADCAST:
        found['more dimensions'] = shaped[None, ..., None]
    if ANY_LENGTH not in about:
        found['too short'] = shaped[:-1]
        found['too long'] = np.concatenate([shaped, shaped[-1:] + 1.0])
    if EMPTY_IS_GOOD not in about:
        found['empty'] = []
    if STAMPS in about:
        found['not increasing'] = shaped[::-1]
        found['one goes back'] = changed(good, -1.0)
    return found


def refusal(call, *arguments, **named):
    """Return the sentence with which a call is refused."""
    with pytest.raises(PamError) as error:
        call(*arguments, **named)
    sentence = str(error.value)
    assert '\n' not in sentence
    assert len(sentence) < 250
    return sentence


@pytest.mark.parametrize('name', ARRAYS)
def test_a_wrong_array_is_refused_with_a_sentence_that_names_it(name):
    call, _, _ = ARRAYS[name]
    for kind, value in wrong(name).items():
        sentence = refusal(call, value)
        assert name.removesuffix(' of two').split(' ')[1] in sentence, kind
        assert 'give' in sentence or 'must have one shape' in sentence, kind


FORMS = {
    'list': np.ndarray.tolist,
    'tuple': lambda a: tuple(a.tolist()),
    'array': np.array,
    'float32': lambda a: a.astype(np.float32),
    'every second': lambda a: np.repeat(a, 2, axis=0)[::2],
}


@pytest.mark.slow
@pytest.mark.parametrize('name', ARRAYS)
def test_a_good_array_is_taken_in_each_form(name):
    call, good, _ = ARRAYS[name]
    for form in FORMS.values():
        with no_error():
            call(form(np.array(good)))


def test_whole_numbers_are_numbers():
    run = simulate(ONE, [0, 1], [300_000], [0])
    np.testing.assert_array_equal(run.pressure, [3e5, 3e5])
    assert equilibrium(ONE, 300_000) == equilibrium(ONE, 3e5)


# Which shapes commands may have ---------------------------------------------------------------


def test_one_row_of_commands_is_for_the_muscles_at_one_stamp():
    row, matrix = (simulate(ELBOW, T, u, [0.0]) for u in ([3e5, 2e5], [[3e5, 2e5]]))
    np.testing.assert_array_equal(row.pressure, [[3e5, 2e5]] * 3)
    np.testing.assert_array_equal(row.position, matrix.position)
    held = simulate_held(ELBOW, [0.0], [3e5, 2e5], [0.1], [0.0])
    np.testing.assert_array_equal(held.pressure, [[3e5, 2e5]])


def test_commands_of_one_muscle_are_a_row_or_a_column():
    row, column = (simulate(ONE, T, u) for u in (COMMAND, np.array(COMMAND)[:, None]))
    np.testing.assert_array_equal(row.position, column.position)
    assert column.pressure.shape == (3,)


@pytest.mark.parametrize(
    ('joint', 'at', 'command', 'sentence'),
    [
        (
            ONE,
            np.linspace(0.0, 1.0, 1000),
            [3e5, 4e5],
            'command has the shape (2,): give (1000,), one number for each stamp of command_t',
        ),
        (
            ELBOW,
            [0.0, 0.01],
            [3e5, 2e5],
            'command has the shape (2,): give (2, 2), a row for each stamp of command_t and a '
            'column for each muscle',
        ),
        (ELBOW, [0.0], [3e5], 'command has the shape (1,): give (1, 2), a row for each stamp'),
        (ELBOW, [0.0], 3e5, 'command has the shape (): give (1, 2), a row for each stamp'),
        (ONE, [0.0], 3e5, 'command has the shape (): give (1,), one number for each stamp'),
        (ONE, [0.0], [[3e5, 2e5]], 'command has the shape (1, 2): give (1,), one number for each'),
    ],
)
def test_commands_of_other_shapes_are_never_spread_over_stamps_and_muscles(
    joint, at, command, sentence
):
    assert refusal(simulate, joint, T, command, at).startswith(sentence)


def test_equal_stamps_are_good_for_a_run_and_not_where_there_is_a_gradient():
    simulate(ONE, [0.0, 0.01, 0.01], [1e5, 3e5], [0.0, 0.0])
    assert refusal(simulate_held, ONE, [0.0, 0.01, 0.01], COMMAND, STILL) == (
        't[2] = 0.01 s follows 0.01 s: give ascending stamps, no two of them equal'
    )
    assert refusal(simulate_held, ONE, [0.0], [3e5], [0.02]) == (
        't has the shape (1,): give at least two stamps, or one stamp and the velocity'
    )


def test_one_number_is_for_all_muscles_and_joints_of_a_rig_and_one_in_a_list_is_not():
    rig = Simulation([ELBOW, ONE])
    rig.reset(2e5, 0.01, 0.0)
    np.testing.assert_array_equal(rig.pressure, [2e5] * 3)
    np.testing.assert_array_equal(rig.position, [0.01] * 2)
    rig.command(3e5)
    rig.advance()
    np.testing.assert_array_equal(rig.pressure, [3e5] * 3)
    assert refusal(rig.command, [3e5]) == (
        'pressure has the shape (1,): give (3,), one number for each muscle, or one for all'
    )


def test_a_refused_command_or_start_leaves_the_rig_as_it_was():
    rig = Simulation([ELBOW])
    rig.reset([3e5, 2e5], [0.1], [0.0])
    rig.advance(5)
    before = rig.time, rig.position, rig.pressure
    refusal(rig.command, [4e5, np.nan])
    refusal(rig.reset, [4e5, 4e5], [0.0], [np.nan])
    refusal(rig.advance, -1)
    for old, now in zip(before, (rig.time, rig.position, rig.pressure), strict=True):
        np.testing.assert_array_equal(old, now)


# Numbers ---------------------------------------------------------------------------------------

NUMBERS = {
    'simulate position': lambda v: simulate(ONE, T, COMMAND, position=v),
    'simulate velocity': lambda v: simulate(ONE, T, COMMAND, velocity=v),
    'simulate step': lambda v: simulate(ONE, T, COMMAND, step=v),
    'simulate hidden.creep.force': lambda v: simulate(
        single_muscle_joint(effects=[Creep(stiffness=300.0, time=0.5)]),
        T,
        COMMAND,
        hidden={'creep': {creep_state(): v}},
    ),
    'simulate_pressure step': lambda v: simulate_pressure(ONE, T, COMMAND, step=v),
    'simulate_held step': lambda v: simulate_held(ONE, T, COMMAND, STILL, step=v),
    'rig step': lambda v: Simulation([ONE], v),
    'rig pressure': lambda v: Simulation([ONE]).command_one(0, v),
    'joint_stiffness_range s': lambda v: joint_stiffness_range(ELBOW, v),
    'joint_stiffness_range effort': lambda v: joint_stiffness_range(ELBOW, 0.1, v),
    'co_contraction_pressures s': lambda v: co_contraction_pressures(ELBOW, v, 60.0),
    'co_contraction_pressures stiffness': lambda v: co_contraction_pressures(ELBOW, 0.1, v),
    'actuator contraction': lambda v: Actuator(contraction=v),
    'mass mass': lambda v: Mass(mass=v),
    'muscle.equilibrium p': lambda v: Muscle().equilibrium(v, 100.0),
    'muscle.equilibrium load': lambda v: Muscle().equilibrium(3e5, v),
    'fit_static_map slack_at': lambda v: mapped(slack_at=v),
}
NO_NUMBERS = {
    'NaN': np.nan,
    'inf': np.inf,
    'text': '0.1',
    'list': [0.1, 0.2],
    'truth': True,
    'huge': 10**400,
    'object': object(),
}


def creep_state():
    (creep,) = (effect for effect in EFFECTS if effect.name == 'creep')
    return creep.states[0].name


@pytest.mark.parametrize('name', NUMBERS)
def test_what_is_not_a_number_is_refused_with_a_sentence_that_names_it(name):
    what = name.split(' ')[1].replace('creep.force', f'creep.{creep_state()}')
    for kind, value in NO_NUMBERS.items():
        sentence = refusal(NUMBERS[name], value)
        assert sentence.startswith(f'{what} = '), kind
        assert 'is not allowed: give' in sentence, kind


@pytest.mark.parametrize('step', [0.0, -1e-3])
def test_a_step_is_above_0(step):
    sentence = f'step = {step} is not allowed: give more than 0 s'
    assert refusal(simulate_held, ONE, T, COMMAND, STILL, step=step) == sentence
    for call in (lambda: simulate(ONE, T, COMMAND, step=step), lambda: Simulation([ONE], step)):
        assert refusal(call).startswith(f'a physics step of {step:g} s is not allowed: give more')


@pytest.mark.parametrize(
    ('steps', 'sentence'),
    [
        (-50, 'steps = -50 is not allowed: give a whole number, at least 0'),
        (1.9, 'steps = 1.9 is not allowed: give a whole number'),
        (np.nan, 'steps = nan is not allowed: give a whole number'),
        ('3', "steps = '3' is not allowed: give a whole number"),
        (None, 'steps = None is not allowed: give a whole number'),
        ([1, 2], 'steps = [1, 2] is not allowed: give a whole number'),
    ],
)
def test_a_rig_advances_by_whole_steps(steps, sentence):
    assert refusal(Simulation([ONE]).advance, steps) == sentence


@pytest.mark.parametrize('steps', [0, 3, np.int64(3), np.array(3)])
def test_whole_steps_of_each_kind_are_taken(steps):
    rig = Simulation([ONE])
    rig.advance(steps)
    assert rig.time == pytest.approx(1e-3 * int(steps))


@pytest.mark.parametrize('muscle', [-1, 2, 0.5, '0', None])
def test_a_muscle_that_a_rig_does_not_have_is_not_commanded(muscle):
    assert refusal(Simulation([ELBOW]).command_one, muscle, 3e5).startswith(
        f'muscle = {muscle!r} is not allowed: give a whole number'
    )


# Objects ---------------------------------------------------------------------------------------

LAG = (PressureLag(fill=0.1),)
OBJECTS = {
    'joint of an actuator': (Joint, (STRAND,), 'actuators = Actuator(muscle='),
    'joint of a muscle': (Joint, ((Muscle(),),), 'actuators[0] = Muscle(a1='),
    'joint of a text': (Joint, ('ab',), "actuators = 'ab'"),
    'joint of a number': (Joint, (3.0,), 'actuators = 3.0'),
    'joint with a number as load': (Joint, ((STRAND,), 20.0), 'load = 20.0'),
    'joint with an unfinished transmission': (
        Joint,
        ((STRAND,), Mass(), Transmission()),
        'transmission.equations = None',
    ),
    'joint with a number as transmission': (
        Joint,
        ((STRAND,), Arm(), 0.04),
        'transmission = 0.04',
    ),
    'joint with effects by name': (
        Joint,
        ((STRAND,), Mass(), Pulley(), ['creep']),
        "effects[0] = 'creep'",
    ),
    'joint with effects in a table': (
        Joint,
        ((STRAND,), Mass(), Pulley(), {'viscous_friction': {'coefficient': 1.0}}),
        "effects = {'viscous_friction': {'coefficient': 1.0}}",
    ),
    'joint with an effect that is not made': (
        Joint,
        ((STRAND,), Mass(), Pulley(), [ViscousFriction]),
        "effects[0] = <class 'pam_ros.effects.viscous_friction.ViscousFriction'>",
    ),
    'joint with an effect as library': (
        lambda: Joint(library=EFFECTS[0]),
        (),
        "library = <class 'pam_ros.effects.dead_time.DeadTime'>",
    ),
    'actuator of a number': (Actuator, (0.4,), 'muscle = 0.4'),
    'actuator of effects': (Actuator, (LAG,), 'muscle = (PressureLag(fill=0.1),)'),
    'actuator with an effect that is not in a list': (
        Actuator,
        (Muscle(), LAG[0]),
        'effects = PressureLag(fill=0.1)',
    ),
    'one muscle of a mass': (
        single_muscle_joint,
        (Mass(mass=20.0),),
        'muscle = Mass(mass=20.0, mount=',
    ),
    'one muscle on a number': (single_muscle_joint, (None, 20.0), 'load = 20.0'),
    'one muscle of 0': (single_muscle_joint, (0,), 'muscle = 0 '),
    'one muscle with effects as a number': (
        single_muscle_joint,
        (None, None, 30.0),
        'effects = 30.0',
    ),
    'one muscle with an effect as a number': (
        single_muscle_joint,
        (None, None, [30.0]),
        'effects[0] = 30.0',
    ),
    'muscle of a text': (Muscle, ('4',), "a1 = '4'"),
    'rig of a joint': (Simulation, (ONE,), 'joints = Joint(actuators='),
    'rig of muscles': (Simulation, ([Muscle()],), 'joints[0] = Muscle('),
    'rig of nothing': (Simulation, ([],), 'joints is empty'),
    'change to a joint': (Simulation([ONE]).change, (ONE,), 'joints = Joint(actuators='),
    'simulate a muscle': (simulate, (Muscle(), T, T, COMMAND), 'joint = Muscle('),
    'simulate with hidden numbers': (
        lambda: simulate(
            single_muscle_joint(effects=LAG), T, COMMAND, hidden={'pressure_lag': 3e4}
        ),
        (),
        'hidden.pressure_lag = 30000.0',
    ),
    'simulate with a hidden number': (
        lambda: simulate(single_muscle_joint(effects=LAG), T, COMMAND, hidden=3e4),
        (),
        'hidden = 30000.0',
    ),
    'pressures of a muscle': (simulate_pressure, (Muscle(), T, COMMAND), 'joint = Muscle('),
    'hold a muscle': (simulate_held, (Muscle(), T, COMMAND, STILL), 'joint = Muscle('),
    'equilibrium of a muscle': (equilibrium, (Muscle(), 3e5), 'joint = Muscle('),
    'stiffness of a muscle': (joint_stiffness, (Muscle(), 3e5, 0.0), 'joint = Muscle('),
    'stiffness range of a list': (joint_stiffness_range, ([ELBOW], 0.0), 'joint = [Joint('),
    'pressures of None': (co_contraction_pressures, (None, 0.0, 60.0), 'joint = None'),
    'law of a muscle': (SlidingMode, (Muscle(),), 'joint = Muscle('),
    'law with the limits as gains': (SlidingMode, (ONE, Limits()), 'gains = Limits('),
    'law with the gains of another': (SlidingMode, (ONE, PidGains()), 'gains = PidGains('),
    'law with a number as limits': (SlidingMode, (ONE, None, 6e5), 'limits = 600000.0'),
    'law with a number as stiffness': (
        SlidingMode,
        (ELBOW, None, None, 60.0),
        'co_contraction = 60.0',
    ),
    'gains of a muscle': (Gains.for_joint, (Muscle(),), 'joint = Muscle('),
    'PID gains of a muscle': (PidGains.for_joint, (Muscle(),), 'joint = Muscle('),
    'identification of a muscle': (identify, (Muscle(), [recorded()]), 'model = Muscle('),
    'identification of files': (identify, (ONE, ['a.csv']), "recordings[0] = 'a.csv'"),
    'identification of nothing': (identify, (ONE, []), 'recordings is empty'),
    'recording of another kind': (recorded, (), "made: kind = 'fast'", {'kind': 'fast'}),
    'recording without stamps of commands': (
        recorded,
        (),
        'made: command_t = None',
        {'command_t': None},
    ),
    'recording without commands at stamps': (
        recorded,
        (),
        'made: command = None',
        {'command': None},
    ),
    'joint of file 3': (load_joint, (3,), 'name = 3'),
    'joint of a file with a text': (load_joint, ('dmsp_20_400n', 'mass=10'), "values = 'mass=10'"),
    'muscle of file 3': (load_muscle, (3,), 'name = 3'),
    'recording from a number': (read_recording, (3,), 'path = 3'),
    'recording of a name': (read_recording, ('a.csv', 'dmsp_10'), "joint = 'dmsp_10'"),
    'recording with rules': (
        partial(read_recording, mapping='a=t_s'),
        ('a.csv',),
        "mapping = 'a=t_s'",
    ),
    'mapping of a text': (read_mapping, ('a=t_s',), "rules = 'a=t_s'"),
    'mapping from a number': (read_mapping, ((), 3), 'file = 3'),
    'write a path': (write_csv, ('a.csv', recorded()), "recording = 'a.csv'"),
    'write to a number': (write_csv, (recorded(), 3), 'path = 3'),
}


@pytest.mark.parametrize('name', OBJECTS)
def test_an_object_of_a_wrong_kind_is_refused_with_a_sentence_that_names_it(name):
    call, arguments, begin, *named = OBJECTS[name]
    sentence = refusal(call, *arguments, **(named[0] if named else {}))
    assert sentence.startswith(begin)
    assert 'give' in sentence


def test_pid_refuses_objects_of_a_wrong_kind():
    assert refusal(Pid, Muscle()).startswith('joint = Muscle(')
    assert refusal(Pid, ONE, Gains()).startswith('gains = Gains(')
    assert refusal(Pid, ONE, None, 6e5).startswith('limits = 600000.0')
    assert refusal(Pid, ELBOW, None, None, 60.0).startswith('co_contraction = 60.0')


def test_lists_of_parts_are_taken_and_kept_as_tuples():
    joint = Joint([STRAND, STRAND], Arm(), Pulley(), library=list(EFFECTS))
    assert joint == ELBOW
    assert isinstance(joint.actuators, tuple)
    assert replace(joint) == ELBOW


def test_paths_may_be_texts(tmp_path):
    made = recorded(t=np.arange(3) * 1e-2)
    file = tmp_path / 'made.csv'
    write_csv(made, str(file))
    assert file.read_text(encoding='utf-8').startswith('t_s,pressure_command_Pa,')
    rules = tmp_path / 'rules.yaml'
    rules.write_text('columns: {a: t_s}\n', encoding='utf-8')
    assert 'a' in read_mapping(file=str(rules))
