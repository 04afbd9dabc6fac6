# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Verdicts at their limits, and the sentences of each."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.division import CHOOSE, FIT, JUDGE, Division
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.result import Estimate, Verdict
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Errors
from pam_ros.identification.verdict import (
    explains,
    next_experiment,
    of_absolute_pressures,
    of_unused,
    sentence,
    time_of,
    too_little,
    verdict,
)
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from support import bench_truth, results

DRIVE = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)


def with_errors(model, errors):
    """Return a model that takes *errors* for its own: it does not look for them again."""
    changed = replace(model)
    vars(changed)['errors'] = errors
    return changed


def ended(found, best, retuned, choose=None):
    """Return a search that ended with these errors in noise floors, of *choose* like of *fit*."""
    noise = found.setting.noise
    errors = noise * best, noise * (best if choose is None else choose), noise * best
    last = with_errors(found.best, Errors(*errors))
    first = with_errors(found.retuned, Errors(*3 * (retuned * noise,)))
    return Search(found.setting, first, last, found.evaluated)


@pytest.mark.parametrize(
    ('fit', 'choose', 'retuned', 'does'),
    [
        (9.8, 9.8, 33.0, True),  # above the noise 10.0 of 33 floors are 0.3 of them, 9.8 are less
        (10.1, 10.1, 33.0, False),
        (1.4, 1.4, 1.6, True),  # no more than the noise itself: nothing is to be seen
        (9.8, 1.0, 33.0, True),
        (10.1, 1.0, 33.0, False),
        # A load that sticks elsewhere leaves little of *fit*, a sine in a random walk does not.
        (1.4, 19.8, 33.0, True),
        (8.0, 19.8, 33.0, False),
        (5.08, 19.8, 33.0, False),  # the mean is at its limit: sqrt(0.151 * 0.6) = 0.301
        (5.0, 19.8, 33.0, True),
    ],
)
def test_a_claim_must_explain_most_of_what_retuning_left(found, fit, choose, retuned, does):
    """Of what is not fitted more may be left where the fit leaves less."""
    assert explains(ended(found, fit, retuned, choose)) is does


def test_without_an_effect_more_than_noise_is_structure_and_constants_may_be_wrong(found):
    bare, noise = ended(replace(found, best=found.retuned), 1.3, 1.3), found.setting.noise
    assert verdict(bare, 1.04 * noise, noise, noise) == 'no_missing_effect'
    assert verdict(bare, 1.06 * noise, noise, noise) == 'parameters_wrong'
    assert verdict(ended(bare, 1.5, 1.5), noise, noise, noise) == 'unexplained_structure'


def test_nothing_is_missing_only_if_the_held_out_data_show_it(found):
    """A drift may begin after the parts that the search sees."""
    bare, noise = ended(replace(found, best=found.retuned), 1.0, 1.0), found.setting.noise
    assert verdict(bare, *3 * (1.3 * noise,)) == 'no_missing_effect'
    assert verdict(bare, *3 * (1.5 * noise,)) == 'unexplained_structure'


def test_an_effect_that_explains_is_found_whatever_retuning_is_worth(found):
    noise = found.setting.noise
    errors = 40.0 * noise, 33.0 * noise, 1.0 * noise
    assert verdict(ended(found, 1.0, 33.0), *errors) == 'effect_found'


@pytest.mark.parametrize(
    ('retuned', 'augmented', 'is_found'),
    [
        (33.0, 23.0, True),  # 0.70 of the error above the noise is left
        (33.0, 23.2, False),
        (33.0, 33.0, False),
        (2.0, 2.5, True),  # the effect does not act there, and both explain nearly all
        (2.0, 2.6, False),
        (np.nan, np.nan, True),  # no data judge
    ],
)
def test_effects_that_the_judging_data_contradict_are_not_found(
    found, retuned, augmented, is_found
):
    noise = found.setting.noise
    name = verdict(ended(found, 1.0, 33.0), 40.0 * noise, retuned * noise, augmented * noise)
    assert name == ('effect_found' if is_found else 'unexplained_structure')


@pytest.mark.parametrize(('augmented', 'is_found'), [(9.8, True), (10.1, False)])
def test_blocks_in_turn_show_no_continuation_and_the_judging_data_must(found, augmented, is_found):
    """They explain as much as *choose* must elsewhere: 0.3 of the error may be left."""
    noise = found.setting.noise
    t = found.setting.parts[0].segment.t
    ends = t[0] + np.array([0.2, 0.4, 0.75]) * (t[-1] - t[0])
    division = Division(ends, np.array([FIT, CHOOSE, FIT, JUDGE]))
    in_turn = [replace(part, division=division) for part in found.setting.parts]
    slow = replace(found, setting=replace(found.setting, parts=in_turn))
    name = verdict(ended(slow, 1.0, 33.0), 40.0 * noise, 33.0 * noise, augmented * noise)
    assert name == ('effect_found' if is_found else 'unexplained_structure')


@pytest.mark.parametrize(('duration', 'is_enough'), [(4.9, False), (5.2, True)])
def test_a_recording_must_last(duration, is_enough):
    (segment,) = segments_of([bench_truth.free(duration=duration)])
    text = too_little([segment], 20e-6, CRITERIA)
    assert (text == '') == is_enough
    if text:
        assert text == 'the recordings last 4.9 s; at least 5 s are needed'


def test_what_is_measured_must_change_by_more_than_its_noise():
    (segment,) = segments_of([bench_truth.free(duration=8.0)])
    moved = float(np.ptp(segment.target))
    assert too_little([segment], 0.099 * moved, CRITERIA) == ''
    text = too_little([segment], 0.101 * moved, CRITERIA)
    assert text.startswith('the position changes by ')
    assert text.endswith(': excite the rig more')
    assert f'{1e3 * moved:.3g} mm, less than 10 times' in text


@pytest.mark.parametrize('name', Verdict)
def test_each_verdict_has_its_sentence_and_its_next_experiment(friction, name):
    answer = replace(friction, verdict=name)
    text = sentence(answer, 'the recordings last 1.0 s; at least 5 s are needed')
    assert text.endswith('.')
    errors = [f'{1e3 * stage.held_error:.3g} mm' for stage in answer.stages]
    there = {
        'effect_found': errors,
        'no_missing_effect': errors[:1],
        'parameters_wrong': errors[:2],
        'unexplained_structure': [errors[2], '% of the variance of the residual'],
        'insufficient_data': ['last 1.0 s'],
    }[name]
    assert all(part in text for part in there)
    if name == 'effect_found':
        assert all(effect.name in text for effect in answer.effects)
    model = answer.stages[0].model
    experiment, command = next_experiment(answer, model)
    assert 'ecord' in experiment
    if name == 'effect_found':
        by_name = {e.name: e.experiment for e in model.library}
        assert any(by_name[effect.name] in experiment for effect in answer.effects)
    is_known = name in ('effect_found', 'unexplained_structure', 'insufficient_data')
    assert command.startswith('pam_excite') == is_known


@pytest.mark.parametrize(
    ('since', 'text'),
    [
        (Estimate(17.0412, 17.0391, 17.0433, 's'), '17.041 s (17.039 to 17.043 s)'),
        (Estimate(17.0412, 16.9, 17.1, 's'), '17.04 s (16.90 to 17.10 s)'),
        (Estimate(17.0412, 15.0, 19.0, 's'), '17.0 s (15.0 to 19.0 s)'),
        (Estimate(17.0412, 2.0, 60.0, 's'), '17 s (2 to 60 s)'),
        (Estimate(17.0412, 17.0412, 17.0412, 's'), '17.041 s (17.041 to 17.041 s)'),
    ],
)
def test_a_moment_is_reported_as_precisely_as_it_is_known(since, text):
    assert time_of(since) == text


def test_an_effect_that_begins_in_the_middle_has_its_onset(friction):
    since = Estimate(12.5, 12.4, 12.6, 's')
    answer = replace(friction, since=since)
    found = sentence(replace(answer, verdict='effect_found'), '')
    assert 'lacks coulomb_friction (or hysteresis) from 12.50 s (12.40 to 12.60 s) on: ' in found
    slow = sentence(replace(answer, verdict='effect_found', development=3.812), '')
    assert ' from 12.50 s (12.40 to 12.60 s) on, developing within 3.8 s: ' in slow
    answer = replace(answer, verdict='unexplained_structure')
    until = 'explains the recording up to 12.50 s (12.40 to 12.60 s), but not after this time:'
    assert f'The re-tuned model {until}' in sentence(answer, '')
    two = 'creep', 'flexor.pressure_lag'
    assert f'The model with creep and pressure_lag of flexor {until}' in sentence(answer, '', two)


def test_an_effect_that_far_constants_could_replace_is_named_with_this_reservation(friction):
    answer = replace(friction, effects=(replace(friction.effects[0], or_constants=True),))
    text = sentence(answer, '')
    assert text.startswith('The model lacks coulomb_friction (or hysteresis): the error on held')
    assert 'Instead of coulomb_friction, constants far from the nominal ones explain' in text
    assert all(f'{1e3 * stage.held_error:.3g} mm' in text for stage in answer.stages)
    experiment = next_experiment(answer, answer.stages[0].model).text
    assert experiment.startswith('To distinguish between coulomb_friction and other constants, ')
    assert '--uncertain a2=10%' in experiment


@pytest.mark.parametrize(
    ('floors', 'remains'),
    [
        (2.9, ''),
        (3.2, ', and something remains that no effect explains (3.2 noise floors)'),
    ],
)
def test_the_first_sentence_says_that_something_remains(friction, floors, remains):
    last = replace(friction.stages[2], held_error=floors * friction.noise.sigma)
    text = sentence(replace(friction, stages=(*friction.stages[:2], last)), '')
    beginning = 'The model lacks coulomb_friction (or hysteresis)'
    assert text.startswith(f'{beginning}{remains}: with this effect the error on held-out data')


def test_an_error_that_no_effect_explains_is_that_of_a_model_which_is_named(friction):
    answer = replace(friction, effects=(), verdict='unexplained_structure')
    before, now = (f'{1e3 * stage.held_error:.3g} mm' for stage in answer.stages[1:])
    assert f'is {now} with coulomb_friction ({before} re-tuned), and' in sentence(answer, '')


def test_a_moment_is_since_the_first_sample_if_the_file_has_another_time_axis(friction):
    answer = replace(friction, since=Estimate(12.5, 12.4, 12.6, 's'))
    late = [replace(one, origin=31.5) for one in answer.recordings]
    assert ' from 12.50 s (12.40 to 12.60 s) on: ' in sentence(answer, '')
    text = sentence(replace(answer, recordings=tuple(late)), '')
    assert ' from 12.50 s (12.40 to 12.60 s) after the first sample on: ' in text


def test_no_experiment_is_proposed_for_an_effect_that_raises_the_score(friction):
    answer = replace(friction, effects=(), verdict='unexplained_structure')
    worse = [replace(c, gain=0.5, score_fall=-1.0) for c in answer.candidates]
    answer = replace(answer, candidates=tuple(worse))
    text = next_experiment(answer, answer.stages[0].model).text
    assert text.startswith('Record slow and fast motion over the whole range')


def test_rivals_are_distinguished_by_the_experiment_of_the_effect(friction):
    answer = replace(friction, verdict='effect_found')
    first = replace(answer.effects[0], alternatives=('slack', 'leak'))
    answer = replace(answer, effects=(first, *answer.effects[1:]))
    assert f'{first.name} (or slack or leak)' in sentence(answer, '')
    text = next_experiment(answer, answer.stages[0].model).text
    assert text.startswith(f'To distinguish between {first.name}, slack, leak, record: ')


def test_without_a_named_effect_the_nearest_one_decides_what_to_record(friction):
    answer = replace(friction, verdict='unexplained_structure')
    model = answer.stages[0].model
    best = max(answer.candidates, key=lambda c: c.gain)
    assert next_experiment(answer, model).text.startswith(f'{best.effect} lowers the error most')
    none = replace(answer, candidates=())
    assert next_experiment(none, model).text.startswith('Record slow and fast motion')


def test_an_experiment_that_no_segment_plays_has_no_command(friction):
    answer = replace(friction, verdict='effect_found')
    answer = replace(answer, effects=(replace(answer.effects[0], name='end_stop'),))
    text, command = next_experiment(answer, answer.stages[0].model)
    assert text.endswith('. pam_excite has no segment for it.')
    assert command == ''


def test_the_experiment_of_a_joint_needs_its_file(friction):
    answer = replace(friction, verdict='effect_found')
    command = next_experiment(answer, antagonistic_joint()).command
    assert command.startswith('pam_excite --ros-args --params-file FILE -p segments:=')
    answer = replace(answer, verdict='insufficient_data')
    command = next_experiment(answer, antagonistic_joint()).command
    assert command == 'pam_excite --ros-args --params-file FILE'


THREE = Joint((Actuator(), Actuator(), Actuator()))


@pytest.mark.parametrize('model', [THREE, single_muscle_joint(DRIVE, Mass(mount='horizontal'))])
def test_a_rig_that_is_not_excited_by_its_position_has_no_command(friction, model):
    answer = replace(friction, verdict='effect_found')
    text, command = next_experiment(answer, model)
    assert 'pam_excite' not in text
    assert command == ''


@pytest.mark.parametrize(
    ('offset', 'is_reported'), [(-101362.0, True), (-96e3, True), (-9e4, False), (101325.0, False)]
)
def test_an_offset_of_the_ambient_pressure_is_reported(offset, is_reported):
    name = 'up.effects.pressure_offset.offset'
    parameters = {name: results.estimate(offset, 0.01, 'Pa')}
    sentences = of_absolute_pressures(parameters, 'pressure', 'position')
    assert bool(sentences) is is_reported
    if sentences:
        assert "'NAME=pressure_Pa-101325'" in sentences[0]
        assert sentences[0].startswith(
            f'{name} = {offset:.6g} Pa is minus the pressure of the air'
        )


def test_signals_that_are_not_used_are_named():
    t = np.arange(3.0)
    free = Recording('free', t, t, 1e5 * t, t, pressure=1e5 * t, force=t)
    held = Recording('held', t, position=t, pressure=1e5 * t, force=t, kind='held')
    driven = Recording('driven', t, position=t, pressure=1e5 * t)
    names = ('pressure', 'force')
    assert of_unused([held, driven], names) == []
    (warning,) = of_unused([held, free], names)
    assert warning.startswith('the measured pressure and the measured force of a load that moves')
