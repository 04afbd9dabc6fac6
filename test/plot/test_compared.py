# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Free runs of models over a recording: their errors, their plots and notes on them."""

import argparse
import json

import numpy as np
import pytest

from pam_ros import (
    Arm,
    CoulombFriction,
    Mass,
    Muscle,
    Recording,
    antagonistic_joint,
    save_parameters,
    simulate,
    simulate_held,
    simulate_pressure,
    single_muscle_joint,
    write_csv,
)
from pam_ros.effects import PressureLag
from pam_ros.errors import PamError, RecordingError
from pam_ros.plot.compared import compare
from pam_ros.plot.models import read_comparison
from pam_ros.plot.options import ModelOption, add_arguments, checked
from pam_ros.recording.mapping import ColumnMapping

NOMINAL = single_muscle_joint(Muscle(), Mass(mass=20.0))
TRUE = NOMINAL.with_effects(CoulombFriction(level=8.0))
T = np.arange(0.0, 12.0, 0.01)
COMMAND = 300e3 + 120e3 * np.sin(2.0 * np.pi * 0.2 * T)
NOISE = 20e-6  # m


def lifted(**changes):
    noise = np.random.default_rng(1).normal(0.0, NOISE, T.size)
    position = simulate(TRUE, T, COMMAND).position + noise
    return Recording('lifted', T, T, COMMAND, position=position, **changes)


def test_errors_are_those_of_free_runs():
    recording = lifted()
    found = compare(recording, [('nominal', NOMINAL), ('true', TRUE)])
    nominal, true = (run.sizes[0] for run in found.runs)
    expected = recording.position - simulate(NOMINAL, T, COMMAND).position
    assert nominal.rmse == pytest.approx(np.sqrt(np.mean(expected**2)), rel=0.01)
    assert true.rmse == pytest.approx(NOISE, rel=0.1)
    assert found.noises[0] == pytest.approx(NOISE, rel=0.1)
    heading, columns, first, last = found.table()
    assert heading.startswith('lifted: errors of free runs in mm, over 1200 samples with a noise')
    assert columns.split()[:2] == ['model', 'RMSE']
    assert float(first.split()[1]) == pytest.approx(1e3 * nominal.rmse, rel=0.01)
    assert first.startswith('nominal')
    assert float(last.split()[-1]) == pytest.approx(1.0, abs=0.15)  # noise floors


def test_plots_have_the_measurement_the_models_and_what_they_leave():
    recording = lifted()
    found = compare(recording, [('nominal', NOMINAL), ('true', TRUE)])
    position, residual, pressure = found.panels()
    assert position.title == 'position, m'
    assert residual.title == 'residual (measured − simulated), m'
    assert [line.name for line in position.lines] == ['measured', 'nominal', 'true']
    measured, *models = position.lines
    for model, left in zip(models, residual.lines, strict=True):
        assert (left.name, left.number) == (model.name, model.number)
        assert left.value == pytest.approx(measured.value - model.value)
    assert [line.name for line in pressure.lines] == ['commanded']
    assert found.end == T[-1]


def test_stretches_between_gaps_are_runs_of_their_own():
    kept = (T < 5.0) | (T > 6.0)
    whole = lifted()
    recording = Recording(
        'cut', T[kept], T, COMMAND, position=whole.position[kept], gaps=((4.99, 6.01),)
    )
    found = compare(recording, [('true', TRUE)])
    assert found.runs[0].sizes[0].rmse < 3.0 * NOISE
    residual = found.panels()[1].lines[0]
    assert np.isnan(residual.value).sum() == 1  # the line is interrupted
    assert found.noises[0] == pytest.approx(NOISE, rel=0.1)


def test_measured_pressures_of_a_moving_load_have_the_simulated_ones_beside_them():
    lagging = NOMINAL.with_effects(PressureLag(fill=0.1, vent=0.1))
    run = simulate(lagging, T, COMMAND)
    recording = Recording('path', T, T, COMMAND, position=run.position, pressure=run.pressure)
    found = compare(recording, [('quick', NOMINAL), ('lagging', lagging)])
    pressure = found.panels()[-1]
    assert [line.name for line in pressure.lines] == ['commanded', 'measured', 'quick', 'lagging']
    _, measured, quick, same = (line.value for line in pressure.lines)
    assert np.abs(same - measured).max() < 1e3
    assert np.abs(quick - measured)[T > 1.0].max() > 5e3


def test_a_prescribed_length_predicts_the_force():
    position = 0.05 + 0.01 * np.sin(T)
    force = simulate_held(NOMINAL, T, COMMAND, position, 0.01 * np.cos(T)).force
    recording = Recording(
        'held', T, position=position, force=force + 1.0, pressure=COMMAND, kind='held'
    )
    found = compare(recording, [('nominal', NOMINAL)])
    assert [one.title for one in found.panels()] == [
        'force, N',
        'residual (measured − simulated), N',
        'pressure (gauge), Pa',
    ]
    assert found.runs[0].sizes[0].rmse == pytest.approx(1.0, rel=0.05)


def test_pressures_alone_are_predicted_for_each_muscle():
    elbow = antagonistic_joint(Muscle(), radius=0.04, load=Arm(mass=2.0, arm=0.2), contraction=0.1)
    slow = elbow.with_effects(PressureLag(fill=0.2, vent=0.2))
    command = np.column_stack([COMMAND, 500e3 - COMMAND])
    pressure = simulate_pressure(slow, T, command)
    recording = Recording(
        'chambers', T, T, command, pressure=pressure, kind='pressure', muscles=('a', 'b')
    )
    found = compare(recording, [('slow', slow), ('quick', elbow)])
    assert [one.title for one in found.panels()] == [
        'pressure (gauge) of a, Pa',
        'residual (measured − simulated) of a, Pa',
        'pressure (gauge) of b, Pa',
        'residual (measured − simulated) of b, Pa',
    ]
    slow_sizes, quick_sizes = (run.sizes for run in found.runs)
    assert all(size.rmse < 100.0 for size in slow_sizes)
    assert all(size.rmse > 5e3 for size in quick_sizes)
    assert [line.split('  ')[0] for line in found.table()[2:]] == [
        'slow (a)', 'slow (b)', 'quick (a)', 'quick (b)',
    ]  # fmt: skip


def test_a_model_of_another_joint_is_named():
    elbow = antagonistic_joint(Muscle(), radius=0.04, load=Arm(mass=2.0, arm=0.2))
    with pytest.raises(RecordingError, match=r'^model elbow: lifted is a recording of 1 muscle'):
        compare(lifted(), [('elbow', elbow)])


# From files ----------------------------------------------------------------------------------


def options_of(*words):
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return checked(parser.parse_args(words))


def test_values_belong_to_the_model_before_them_or_to_all():
    given = options_of(
        *('--bag', 'x', '--set', 'mass=20', '--model', 'dmsp_20_400n', '--model', 'a.yaml'),
        *('--set', 'zeta=0.2', '--set', 'l0=0.3'),
    )
    assert given.models == (
        ModelOption('dmsp_20_400n', ('mass=20',)),
        ModelOption('a.yaml', ('mass=20', 'zeta=0.2', 'l0=0.3'), ('zeta=0.2', 'l0=0.3')),
    )
    assert [one.name for one in given.models] == ['dmsp_20_400n', 'a.yaml, zeta=0.2, l0=0.3']


@pytest.mark.parametrize(
    ('words', 'sentence'),
    [
        (
            ['--bag', 'x', '--set', 'mass=20'],
            '--set mass=20 is for --model, and no model is given',
        ),
        (['--model', 'a'], '--model is for --bag: a model is compared with a recording'),
        (['--bag', 'x', *['--model', 'a'] * 2], '--model a is given twice: give different models'),
        (
            ['--bag', 'x', *(word for k in range(7) for word in ('--model', f'{k}'))],
            '7 times --model is not allowed: give at most 6',
        ),
    ],
)
def test_models_that_cannot_be_compared(words, sentence):
    with pytest.raises(PamError) as caught:
        options_of(*words)
    assert str(caught.value) == sentence


def test_notes_say_what_may_mislead(tmp_path):
    recording = tmp_path / 'monday.csv'
    write_csv(lifted(), recording)
    identified = tmp_path / 'arm.yaml'
    save_parameters(NOMINAL.with_effects(CoulombFriction(level=8.0, onset=3.0)), identified)
    models = [ModelOption('dmsp_20_400n'), ModelOption(str(identified))]

    def notes():
        return read_comparison(recording, models, None, ColumnMapping()).notes

    example, onset = notes()
    assert example.startswith('dmsp_20_400n: the load is 20 kg, the example in the file')
    assert onset == f'{identified}: coulomb_friction begins at 3 s, as its file says'
    comparison = read_comparison(recording, models, None, ColumnMapping()).comparison
    digest = comparison.recording.digest
    rows = [{'role': 'fit', 'sha256': digest}]
    (tmp_path / 'report.json').write_text(json.dumps({'data': {'recordings': rows}}))
    assert (
        f'{identified} was fitted to this recording: its error on a new one is larger' in notes()
    )
    rows[0]['role'] = 'test'
    (tmp_path / 'report.json').write_text(json.dumps({'data': {'recordings': rows}}))
    assert len(notes()) == 2
