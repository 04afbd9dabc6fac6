# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An identification as text: in one line, and in tables."""

import re
from dataclasses import replace

import pytest

from pam_ros.identification.result import Estimate
from pam_ros.identification.summary import details, last_line


def test_line_has_verdict_and_errors(friction):
    line = last_line(friction)
    assert line.startswith('effect_found (coulomb_friction): held-out error ')
    assert f'{1e3 * friction.stages[0].held_error:.3g} mm nominal' in line
    assert f'{1e3 * friction.stages[2].held_error:.3g}' in line
    assert line.endswith('noise 0.0500 mm')
    assert '\n' not in line


def test_line_has_the_onset(friction):
    since = Estimate(12.5, 12.4, 12.6, 's')
    line = last_line(replace(friction, since=since))
    assert line.startswith('effect_found (coulomb_friction from 12.50 s (12.40 to 12.60 s) on): ')
    unknown = replace(friction, since=since, effects=(), verdict='unexplained_structure')
    assert last_line(unknown).startswith('unexplained_structure (from 12.50 s (12.40 to ')


def test_without_an_effect_two_errors(clean):
    line = last_line(clean)
    assert 'with' not in line
    assert 're-tuned; noise' in line


def test_force_is_in_newtons(held):
    assert ' N nominal' in last_line(held)


def test_added_effects_are_those_that_were_not_configured(friction):
    assert friction.added == ('coulomb_friction',)
    assert replace(friction, stages=3 * friction.stages[:1]).added == ()


def test_an_effect_in_all_muscles_is_one_though_each_has_its_own_start(friction):
    *before, last = friction.stages
    estimate = Estimate(0.1, 0.0, 0.2, '')
    names = ['effects.hysteresis.slip', 'agonist.effects.leak.rate']
    starts = [f'{muscle}.effects.hysteresis.initial' for muscle in ('agonist', 'antagonist')]
    stage = replace(last, parameters=dict.fromkeys([*names, *starts], estimate))
    assert replace(friction, stages=(*before, stage)).added == ('hysteresis', 'agonist.leak')


# The summary -------------------------------------------------------------------------------------


def row(text, name):
    """Return the cells of the one line that begins with *name*."""
    (line,) = (one for one in text.splitlines() if one.strip().startswith(f'{name} '))
    return line.split()


def test_the_summary_begins_with_the_sentence_and_has_all_parameters(friction):
    text = friction.summary()
    assert text.startswith(friction.sentence)
    for name, found in friction.stages[-1].parameters.items():
        value = row(text, name)[2].replace('−', '-').replace('·10', 'e')
        value = value.translate(str.maketrans('⁻⁰¹²³⁴⁵⁶⁷⁸⁹', '-0123456789'))
        assert float(value) == pytest.approx(found.value, rel=5e-3)
    assert row(text, 'a1')[1] == '−4.36'
    assert row(text, 'a1')[-1] == 'N/bar'
    assert 'at its bound' in next(line for line in text.splitlines() if 'zeta' in line)
    assert row(text, 'effects.coulomb_friction.level')[1] == '–'  # the nominal model has none


def test_the_summary_has_the_error_of_each_model_and_what_follows(friction, clean):
    text = friction.summary()
    for name, stage in zip(
        ('nominal', 're-tuned', 'with coulomb_friction'), friction.stages, strict=True
    ):
        cells = row(text[text.index('Errors') :], name)
        assert cells[-3:-1] == [f'{1e3 * e:.3g}' for e in (stage.fit_error, stage.held_error)]
    assert '- the position covers 11 % of the stroke' in text
    assert text.endswith(friction.next_experiment)
    assert max(map(len, text.splitlines())) < 100
    assert '  with ' not in clean.summary()
    for shown in (text, clean.summary()):  # the headings stand above short and long names
        assert re.search(r'^Errors \(RMSE\) +fitted  +held out$', shown, re.MULTILINE)
        assert re.search(
            r'^Parameters +nominal  +identified  +95 % interval$', shown, re.MULTILINE
        )


def test_a_notebook_shows_the_summary_and_a_console_one_line(friction):
    marked = replace(friction, sentence='1 < 2 & 3')
    html = marked._repr_html_()
    assert html.startswith('<pre>1 &lt; 2 &amp; 3')
    assert repr(friction) == f'<Identification: {last_line(friction)}>'


def test_the_details_have_the_end_of_each_fit_and_every_effect_that_was_tried(friction, clean):
    text = details(friction)
    for name in ('nominal', 're-tuned', 'with coulomb_friction'):
        assert row(text, name)[-3:] == ['converged', '12', '140']
    for one in friction.candidates:
        assert f'{one.decision}: {one.reason}' in text
    assert row(text, 'coulomb_friction')[1] == '450'
    assert 'with' not in details(clean).partition('Effects')[0]
