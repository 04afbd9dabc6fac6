# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a program does with the result of an identification: simulate, plot, compare."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from pam_ros.effects import Leak
from pam_ros.errors import ParameterError, RecordingError
from pam_ros.identification.result import Verdict
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint
from pam_ros.rig.step_limit import longest_step
from support import results


def test_a_verdict_is_its_text():
    assert Verdict.EFFECT_FOUND == 'effect_found'
    assert (
        f'{Verdict.EFFECT_FOUND} {Verdict("parameters_wrong")}' == 'effect_found parameters_wrong'
    )
    assert Verdict.NO_MISSING_EFFECT.heading == 'Nothing missing'
    with pytest.raises(ValueError, match='nonsense'):
        Verdict('nonsense')


def test_the_identified_joint_has_only_effects_that_are_present(friction):
    last = friction.stages[-1]
    idle = last.model.with_effects(Leak())
    found = replace(friction, stages=(*friction.stages[:2], replace(last, model=idle)))
    assert [effect.name for effect in found.joint.all_effects] == ['coulomb_friction']


def test_it_simulates_another_recording_from_where_that_begins(friction):
    other = results.free_recording(friction.joint, seed=7, name='other.csv', gap=True)
    run = friction.simulate(other)
    np.testing.assert_array_equal(run.t, other.t)
    assert np.sqrt(np.mean((run.position - other.position) ** 2)) < 3.0 * results.NOISE


def test_a_light_load_is_simulated_with_the_steps_that_it_needs(friction):
    light = replace(friction.stages[-1], model=friction.joint.with_load(mass=0.1))
    found = replace(friction, stages=(*friction.stages[:2], light))
    assert longest_step(light.model) < 1e-3
    assert np.all(np.isfinite(found.simulate(friction.recordings[0]).position))


def test_effects_that_began_in_a_fitted_recording_act_in_others_from_the_start(friction):
    recording, last = friction.recordings[0], friction.stages[-1]
    late = last.model.with_effects(Leak(rate=2.0, onset=8.0))
    found = replace(friction, stages=(*friction.stages[:2], replace(last, model=late)))
    own, other = found.simulate(recording), found.simulate(replace(recording, name='other'))
    before = own.t < 7.9
    start = {'position': own.position[0], 'velocity': own.velocity[0]}
    without = simulate(friction.joint, recording.t, recording.command, **start)
    np.testing.assert_allclose(own.position[before], without.position[before], atol=1e-9)
    assert np.max(np.abs(other.position - without.position)[before]) > 1e-3


def test_it_simulates_a_prescribed_length(held):
    recording = held.recordings[0]
    run = held.simulate(recording)
    assert np.sqrt(np.mean((run.force - recording.force) ** 2)) < 0.1 * np.ptp(recording.force)


def test_what_cannot_be_simulated_is_refused(friction):
    with pytest.raises(ParameterError, match=r'recording = .* give a Recording'):
        friction.simulate('monday.csv')
    turning = antagonistic_joint()
    last = replace(friction.stages[-1], model=turning)
    of_two = replace(friction, stages=(*friction.stages[:2], last))
    with pytest.raises(RecordingError, match='recording of 1 muscle'):
        of_two.simulate(friction.recordings[0])


def test_the_picture_has_the_measurement_both_models_and_their_residuals(friction):
    axes = Figure().subplots(2, 1)
    assert friction.plot(axes) is axes
    upper, lower = axes
    labels = [line.get_label() for line in upper.lines]
    assert [label for label in labels if not label.startswith('_')] == [
        *('measured', 'nominal', 'identified'),
    ]
    segment, last = friction.segments[0], friction.stages[-1]
    np.testing.assert_array_equal(upper.lines[0].get_ydata(), segment.target)
    np.testing.assert_array_equal(upper.lines[2].get_ydata(), last.simulated[0])
    left = 1e3 * (segment.target - last.simulated[0])
    np.testing.assert_allclose(lower.lines[1].get_ydata(), left)
    assert (upper.get_ylabel(), lower.get_ylabel()) == ('position [m]', 'residual [mm]')
