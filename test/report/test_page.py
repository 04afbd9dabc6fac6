# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""report.html as text: complete, in order, self-contained, and true to the numbers."""

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.result import Verdict
from pam_ros.identification.wording import Scale
from pam_ros.report.numbers import numbers, to_json
from pam_ros.report.page import curves_of, inputs_of, not_excluded, page, warnings_of
from pam_ros.report.runs import runs_of
from pam_ros.rig.standard_joints import single_muscle_joint

SECTIONS = ['error', 'simulated', 'residual', 'shape', 'candidates', 'parameters', 'data', 'next']
SECTIONS.append('provenance')
FILE = Path('/reports/monday/identified.yaml')
VOID = {'meta', 'br', 'img', 'link', 'input', 'hr'}


class Outline(HTMLParser):
    """Checks that elements are nested, and collects ids, tags, links and text."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.tags, self.text = [], [], [], []
        self.links = []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.tags.append(tag)
        if 'id' in given:
            self.ids.append(given['id'])
        self.links += [given[k] for k in ('src', 'href', 'xlink:href', 'srcset') if k in given]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if not {'style', 'script'} & set(self.open):
            self.text.append(data)


def outline(html):
    found = Outline()
    found.feed(html)
    assert found.open == []
    return found


def rendered(parts):
    result, source, runs = parts
    return page(result, runs, source, numbers(result, runs, source), FILE)


@pytest.fixture(scope='module')
def friction_page(reports, friction):
    return (reports(friction) / 'report.html').read_text(encoding='utf-8')


@pytest.mark.slow
def test_page_is_whole_and_needs_nothing_else(html):
    found = outline(html)
    assert not {'iframe', 'link', 'object'} & set(found.tags)
    assert found.tags.count('script') == 1  # it has no source: see the links
    assert all(link.startswith('#') for link in found.links)
    assert not re.search(r'@import|url\((?!#)', html)
    assert len(found.ids) == len(set(found.ids))
    assert len(html) < 2.5e6


def test_sections_come_in_the_order_in_which_they_are_read(html):
    ids = outline(html).ids
    assert [i for i in ids if i in SECTIONS] == list(SECTIONS)
    first = [ids.index(name) for name in ('verdict', 'remainder', 'not-excluded', 'use', 'error')]
    assert first == sorted(first)


def test_no_cell_shows_the_inside_of_the_program(html):
    text = ' '.join(outline(html).text)
    for bad in ('built-in', 'object at 0x', 'nan', 'None', 'Undefined', '{{', 'Estimate('):
        assert not re.search(rf'(?<![A-Za-z]){re.escape(bad)}(?![a-z])', text), bad


def test_page_has_the_numbers_of_the_result(friction, friction_page):
    result, _, _ = friction
    text = ' '.join(' '.join(outline(friction_page).text).split())
    assert 'Effect found : coulomb friction' in text.replace('found:', 'found :')
    assert 'Instead of coulomb friction it could be hysteresis' in text
    for stage in result.stages:
        assert f'{1e3 * stage.held_error:.3g}' in text
    assert '14.02 N' in text
    assert 'at its bound' in text
    for candidate in result.candidates:
        assert candidate.effect.replace('_', ' ') in text
    assert 64 * 'a' in text


@pytest.mark.parametrize('verdict', Verdict)
def test_every_verdict_states_what_is_open(clean, verdict):
    sentences = not_excluded(replace(clean[0], verdict=verdict), Scale(1e3, 'mm'))
    assert len(sentences) == (0 if verdict == 'effect_found' else 1)


def test_the_verdict_that_nothing_is_missing_lists_what_would_not_be_found(reports, clean):
    html = (reports(clean) / 'report.html').read_text(encoding='utf-8')
    assert '<h1 id="verdict">Nothing missing</h1>' in html
    assert 'stay below the noise floor of 0.0500 mm' in html


@pytest.mark.slow
def test_user_text_cannot_become_markup(friction):
    result, source, runs = friction
    html = rendered((replace(result, sentence='1 < 2 & <b>3</b>'), source, runs))
    assert '1 &lt; 2 &amp; &lt;b&gt;3&lt;/b&gt;' in html


def test_models_that_do_not_differ_are_drawn_once(clean, friction):
    assert [c.label for c in curves_of(clean[0], clean[2])] == ['nominal', 're-tuned']
    labels = [c.label for c in curves_of(friction[0], friction[2])]
    assert labels == ['nominal', 're-tuned', 're-tuned + coulomb friction']


def test_an_effect_that_did_not_suffice_is_named_all_the_same(friction):
    result, _, runs = friction
    partial = replace(result, verdict='unexplained_structure', effects=())
    assert curves_of(partial, runs)[-1].label == 're-tuned + coulomb friction'


@pytest.mark.slow
def test_later_rounds_stand_below_the_first(friction):
    result, source, runs = friction
    later = tuple(replace(c, parents=('coulomb_friction',)) for c in result.candidates[:3])
    html = rendered((replace(result, candidates=(*result.candidates, *later)), source, runs))
    assert html.index('In addition to re-tuning') < html.index('In addition to coulomb friction')


@pytest.mark.slow
def test_what_the_data_cannot_show_is_listed_with_the_experiment_to_record(held):
    result, *_ = held
    assert result.untestable == ('payload', 'end_stop')
    assert not {*result.untestable} & {*result.tested}
    assert len(result.tested) == len(EFFECTS) - 2
    sentences = not_excluded(result, Scale(1.0, 'N'))
    assert sentences[-1].startswith('These data cannot show payload and end stop: ')
    html = rendered(held)
    assert '<b class="tag untestable">untestable</b>' in html
    assert 'these data cannot show it; record: touch it slowly' in html


def test_constants_that_could_replace_an_effect_are_not_excluded(friction):
    result = friction[0]
    finding = replace(result.effects[0], or_constants=True)
    sentences = not_excluded(replace(result, effects=(finding,)), Scale(1e3, 'mm'))
    assert any('constants a1 to a6 far from the nominal ones' in one for one in sentences)
    assert not any('a1 to a6' in one for one in not_excluded(result, Scale(1e3, 'mm')))


@pytest.mark.slow
def test_page_without_candidates_states_it(clean):
    result, source, runs = clean
    html = rendered((replace(result, candidates=(), next_experiment=''), source, runs))
    assert 'None was tried.' in html
    assert 'None is needed for this verdict.' in html


def test_load_without_a_muscle_has_an_input_and_a_position(friction, friction_page):
    result, source, runs = friction
    assert 'Against pressure' in friction_page
    model = result.stages[0].model
    muscle = replace(
        model.muscle,
        a1=0.0, a2=0.0, a3=0.0, a4=0.0, a6=0.0, a5=35.15, pressure_unit='Pa', zeta=0.0,
        p_min=-10.0, p_max=10.0, force_max=351.5,
    )  # fmt: skip
    nominal = replace(result.stages[0], model=single_muscle_joint(muscle, model.load))
    html = rendered((replace(result, stages=(nominal, *result.stages[1:])), source, runs))
    assert 'Against the input' in html
    assert 'Against position' in html
    assert 'contraction, %' not in html


def test_the_input_of_a_free_run_is_named(tested):
    result, source = tested[:2]
    assert inputs_of(result, source) == 'command'
    (*others, last) = source.recordings
    measured = replace(last, command=None, command_t=None)
    assert inputs_of(result, replace(source, recordings=(measured,))) == 'measured pressure'
    both = replace(source, recordings=(*others, last, measured))
    assert inputs_of(result, both) == 'command or measured pressure'
    assert inputs_of(replace(result, quantity='force'), both) == 'pressure and length'


def test_each_warning_is_shown_once_with_its_recording(tested):
    result, source, _ = tested
    all_warnings = (*result.warnings, *(w for r in source.recordings for w in r.warnings))
    found = warnings_of(replace(result, warnings=all_warnings), source)
    assert found == [('', 'the position covers 11 % of the stroke'), ('bench.csv', '1 gap(s)')]


@pytest.mark.slow
@pytest.mark.parametrize('value', [np.nan, np.inf, -1e300])
def test_a_model_that_diverges_is_drawn_and_its_numbers_stay_finite(clean, value):
    result, source, _ = clean
    nominal = result.stages[0]
    simulated = nominal.simulated[0].copy()
    simulated[1500:] = value
    broken = replace(nominal, simulated=(simulated,), fit_error=value, held_error=value)
    changed = replace(result, stages=(broken, *result.stages[1:]))
    runs = runs_of(changed)
    content = numbers(changed, runs, source)
    assert json.loads(to_json(content))['error']['declared']['details']['fit']['maximum'] > 1e5
    assert outline(page(changed, runs, source, content, FILE)).ids


def test_lines_that_use_the_result_are_there_unless_there_is_no_file(friction, friction_page):
    text = ' '.join(outline(friction_page).text)
    assert text.count('/identified.yaml') == 3
    result, source, runs = friction
    content = numbers(result, runs, source)
    html = page(result, runs, source, content, FILE, 'the sign of a5 is wrong')
    assert str(FILE) not in html
    assert 'There is no identified.yaml: the sign of a5 is wrong.' in html


def test_an_error_that_is_not_explained_has_another_colour(friction, friction_page):
    result, source, runs = friction
    assert 'class="remainder" id="remainder"' in friction_page
    noise = replace(result.noise, sigma=result.stages[-1].held_error / 8.2)
    html = rendered((replace(result, noise=noise), source, runs))
    assert 'class="remainder warn" id="remainder"' in html
    assert '<li class="stage2 warn">' in html
    assert '(8.2 noise floors)' in html


def test_contents_lead_to_every_section(friction_page):
    found = outline(friction_page)
    names = ['use', *SECTIONS]
    assert {*names} <= {*found.ids}
    assert found.links[: len(names)] == [f'#{name}' for name in names]


def test_an_effect_has_its_trace_and_leads_to_the_plots_that_show_it(friction_page):
    trace = next(effect.signature for effect in EFFECTS if effect.name == 'coulomb_friction')
    assert f'Its trace: {trace}; see <a href="#shape">' in friction_page


def test_a_search_that_was_stopped_is_marked_at_the_top_and_claims_no_more(friction):
    result, source, runs = friction
    stopped = replace(result, is_complete=False)
    html = rendered((stopped, source, runs))
    text = ' '.join(' '.join(outline(html).text).split())
    assert '<title>Incomplete: Effect found' in html
    mark = html.index('<p class="remainder warn" id="incomplete">The search was stopped')
    assert html.index('id="verdict"') < mark < html.index('id="remainder"')
    open_ = text[text.index('What could not be excluded.') :]
    assert open_.split('. ')[2].startswith('The search was stopped before it ended: effects that')
    assert 'identify again before you rely on this model' in text
    whole = rendered(friction)
    assert 'id="incomplete"' not in whole
    assert 'Incomplete' not in whole
