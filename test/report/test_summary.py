# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The last line of the command."""

from dataclasses import replace

from pam_ros.identification.result import Estimate
from pam_ros.report.summary import last_line


def test_line_has_verdict_and_errors(friction):
    result, _, _ = friction
    line = last_line(result)
    assert line.startswith('effect_found (coulomb_friction): held-out error ')
    assert f'{1e3 * result.stages[0].held_error:.3g} mm nominal' in line
    assert f'{1e3 * result.stages[2].held_error:.3g}' in line
    assert line.endswith('noise 0.0500 mm')
    assert '\n' not in line


def test_line_has_the_onset(friction):
    since = Estimate(12.5, 12.4, 12.6, 's')
    line = last_line(replace(friction[0], since=since))
    assert line.startswith('effect_found (coulomb_friction from 12.50 s (12.40 to 12.60 s) on): ')
    unknown = replace(friction[0], since=since, effects=(), verdict='unexplained_structure')
    assert last_line(unknown).startswith('unexplained_structure (from 12.50 s (12.40 to ')


def test_without_an_effect_two_errors(clean):
    line = last_line(clean[0])
    assert 'with' not in line
    assert 're-tuned; noise' in line


def test_force_is_in_newtons(held):
    assert ' N nominal' in last_line(held[0])


def test_added_effects_are_those_that_were_not_configured(friction):
    result, _, _ = friction
    assert result.added == ('coulomb_friction',)
    assert replace(result, stages=3 * result.stages[:1]).added == ()


def test_an_effect_in_all_muscles_is_one_though_each_has_its_own_start(friction):
    result = friction[0]
    *before, last = result.stages
    estimate = Estimate(0.1, 0.0, 0.2, '')
    names = ['effects.hysteresis.slip', 'agonist.effects.leak.rate']
    starts = [f'{muscle}.effects.hysteresis.initial' for muscle in ('agonist', 'antagonist')]
    stage = replace(last, parameters=dict.fromkeys([*names, *starts], estimate))
    assert replace(result, stages=(*before, stage)).added == ('hysteresis', 'agonist.leak')
