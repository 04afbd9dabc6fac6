# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From numbers made by hand to each verdict, its sentence and what to record next."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification import evidence, verdict
from pam_ros.identification.admission import Tried
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.evidence import Evidence
from pam_ros.identification.result import VERDICTS, Candidate, Finding, Stage, Trace
from pam_ros.identification.selection import Search
from pam_ros.identification.structure import Structure
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import one_muscle
from support.equations import coloured, missing

FLOOR = 1e-5  # m
KNOWN = {effect.name: effect for effect in EFFECTS}


def stage(name, held_error):
    return Stage(name, one_muscle(), {}, held_error, held_error, (), ())


def answer(declared, retuned, augmented, ceiling=0.0, share=0.0, effects=(), candidates=()):
    """Return a trace with these errors of the samples kept back, in noise floors."""
    errors = zip(('declared', 'retuned', 'augmented'), (declared, retuned, augmented), strict=True)
    return Trace(
        '', '', 'position', 'm', Noise(FLOOR, 0.0),
        tuple(stage(name, error * FLOOR) for name, error in errors),
        tuple(effects), tuple(candidates), Structure(ceiling, 0.0, share), (), (), (), '',
    )  # fmt: skip


def finding(name, *alternatives):
    return Finding(name, {}, alternatives, 'because')


def judge(made, lacking=''):
    found = verdict.judged(made, lacking, EFFECTS)
    assert found.verdict in VERDICTS
    assert found.sentence.endswith('.')
    assert found.next_experiment.endswith('.')
    # The errors stay what they were.
    assert found.stages is made.stages
    return found


def test_an_effect_that_takes_the_residual_to_the_noise():
    found = judge(answer(300, 100, 1.1, 0.1, 0.2, [finding('creep')]))
    assert found.verdict == 'effect_found'
    for part in ('creep', '3 mm as declared', '1 mm re-tuned', 'to 0.011 mm', 'is 0.01 mm'):
        assert part in found.sentence
    assert KNOWN['creep'].experiment in found.next_experiment
    assert [e.name for e in found.effects] == ['creep']


def test_several_effects_and_what_could_stand_in_their_place():
    found = judge(
        answer(300, 100, 1.1, effects=[finding('creep'), finding('dead_time', 'pressure_lag')])
    )
    assert 'creep, dead_time (or pressure_lag)' in found.sentence
    # What is open is settled first.
    assert found.next_experiment.startswith('To tell dead_time, pressure_lag apart')
    assert KNOWN['dead_time'].experiment in found.next_experiment


def test_an_effect_whose_form_is_not_quite_natures():
    # Structure is left, but little beside what was found.
    found = judge(answer(300, 100, 10, 0.8, 0.9, [finding('hysteresis')]))
    assert found.verdict == 'effect_found'


def test_an_effect_that_leaves_most_of_it_is_not_the_answer():
    candidates = [candidate('creep', 0.1), candidate('hysteresis', 0.2), candidate('slack', -0.3)]
    found = judge(answer(300, 100, 80, 0.8, 0.9, [finding('hysteresis')], candidates))
    assert found.verdict == 'unexplained_structure'
    assert found.effects == ()
    assert '0.8 mm' in found.sentence
    assert '80 %' in found.sentence
    assert found.next_experiment.startswith('hysteresis comes nearest')
    assert KNOWN['hysteresis'].experiment in found.next_experiment


def candidate(name, gain):
    return Candidate(name, (), 1e-3, 1e-3, 0.5, gain, False, {}, 'rejected', 'too little')


def test_structure_that_no_effect_explains():
    found = judge(answer(300, 100, 100, 0.8, 0.9))
    assert found.verdict == 'unexplained_structure'
    assert 'force and pressure' in found.next_experiment


def test_a_residual_far_above_the_noise_is_no_noise_even_if_nothing_predicts_it():
    assert judge(answer(300, 100, 100)).verdict == 'unexplained_structure'


def test_structure_below_the_noise_is_none():
    assert judge(answer(1.0, 1.0, 1.0, 0.8, 0.05)).verdict == 'no_missing_effect'


def test_what_retuning_cures_are_wrong_parameters():
    found = judge(answer(50, 1.02, 1.02))
    assert found.verdict == 'parameters_wrong'
    assert 'from 0.5 mm to 0.0102 mm' in found.sentence


def test_a_model_that_is_right():
    found = judge(answer(1.02, 1.01, 1.01))
    assert found.verdict == 'no_missing_effect'
    assert '0.0102 mm' in found.sentence


def test_retuning_that_only_fits_noise_is_no_cure():
    assert judge(answer(1.0, 1.1, 1.1)).verdict == 'no_missing_effect'


def test_an_effect_that_retuning_would_absorb():
    found = judge(answer(300, 1.0, 1.0, effects=[finding('payload', 'pressure_offset')]))
    assert found.verdict == 'effect_found'
    assert 'payload (or pressure_offset)' in found.sentence


def test_too_little_overrules_whatever_was_found():
    found = judge(answer(300, 100, 1.0, effects=[finding('creep')]), 'the recordings last 2 s')
    assert found.verdict == 'insufficient_data'
    assert 'the recordings last 2 s' in found.sentence
    assert found.effects == ()
    assert 'pam_excite' in found.next_experiment


def test_errors_of_a_force_are_in_newtons():
    made = replace(answer(1.0, 1.0, 1.0), quantity='force', unit='N', noise=Noise(2.7, 0.0))
    made = replace(made, stages=tuple(stage('x', e) for e in (310.0, 3.0, 3.0)))
    found = judge(made)
    assert 'from 310 N to 3 N' in found.sentence
    assert '2.7 N' in found.sentence


def segment(seconds, stroke):
    t = np.arange(round(100 * seconds)) / 100.0
    y = 0.5 * stroke * (1.0 - np.cos(2 * np.pi * t))
    recording = Recording('r', t, t, t, y, None, None, None, 'free')
    return segments_of([recording], keep_back=True)[0]


def test_too_little_time_or_motion():
    noise = Noise(1e-4, 0.0)
    assert verdict.too_little([segment(60.0, 0.01)], noise) == ''
    assert '3.0 s; at least 5 s' in verdict.too_little([segment(3.01, 0.01)], noise)
    # Several runs count together.
    assert verdict.too_little([segment(3.01, 0.01)] * 2, noise) == ''
    sentence = verdict.too_little([segment(60.0, 5e-4)], noise)
    assert 'position moves by 0.0005' in sentence
    assert '0.0001' in sentence


CLEAR = Evidence(p=1e-9, gain=0.5, interval_clear=True, absorbed=False)


def tried(name, size, known=CLEAR, seed=1):
    """Return a candidate that leaves noise of this size on the samples kept back."""
    miss = coloured(np.random.default_rng(seed), 4000, 0.0)
    return Tried(KNOWN[name], (), missing(miss, size, (name,)), known, 0.0)


def search_of(*candidates):
    some = missing(np.ones(100), 1.0)
    return Search(some, some, some, (tuple(candidates),))


def test_who_explains_what_was_kept_back_as_well_is_a_rival():
    winner = tried('creep', 1.0)
    rivals = [
        tried('leak', 1.0, seed=2),  # as good on average
        tried('slack', 0.99),
        tried('dead_time', 1.3),
        tried('payload', 1.0, replace(CLEAR, interval_clear=False), seed=3),
        tried('softening', 1.0, replace(CLEAR, p=2.0 * evidence.SIGNIFICANCE), seed=4),
        tried('pressure_offset', 1.0, replace(CLEAR, absorbed=True), seed=5),
    ]
    found = verdict.alternatives(search_of(winner, *rivals), winner)
    assert found == ('leak', 'slack')


def test_rivals_are_sought_in_the_round_that_was_won():
    winner, other = tried('creep', 1.0), tried('leak', 1.0, seed=2)
    found = search_of(winner)
    assert verdict.alternatives(replace(found, rounds=((winner,), (other,))), winner) == ()
    assert verdict.alternatives(replace(found, rounds=((other,), (winner,))), winner) == ()


@pytest.mark.parametrize(
    ('changes', 'winner', 'words'),
    [
        ({'interval_clear': False, 'p': 0.5}, None, 'includes 0'),
        ({'p': 0.5, 'gain': 0.0}, None, 'p = 0.5 after correction'),
        ({'gain': 0.5 * evidence.GAIN}, None, '-1.5 %, less than the 3 %'),
        ({'gain': -0.2}, None, '+20.0 %'),
        ({}, 'creep', 'creep explains more'),
        ({}, None, 'too little'),
        ({'gain': 0.0, 'absorbed': True}, 'creep', 'creep explains more'),
    ],
)
def test_why_a_candidate_was_not_chosen(changes, winner, words):
    loser = tried('leak', 1.0, replace(CLEAR, **changes))
    best = None if winner is None else tried(winner, 0.5)
    assert words in verdict.why_not(loser, best)
