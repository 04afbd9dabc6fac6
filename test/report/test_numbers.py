# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""report.json: valid against its published schema, true to the result, and described."""

import json
import math
from dataclasses import asdict, replace

import numpy as np
import pytest

from pam_ros.identification.result import Estimate, Verdict
from pam_ros.report.numbers import SCHEMA_VERSION, numbers, to_json
from pam_ros.report.runs import runs_of
from support.pages import ROOT


@pytest.fixture(scope='module')
def schema():
    return json.loads((ROOT / 'docs' / 'report.schema.json').read_text(encoding='utf-8'))


@pytest.fixture(scope='module')
def validate(schema):
    """Return a function that lists what is wrong with a report."""
    jsonschema = pytest.importorskip('jsonschema')
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    return lambda report: [f'{e.json_path}: {e.message}' for e in validator.iter_errors(report)]


def report_of(parts):
    result, source, runs = parts
    return json.loads(to_json(numbers(result, runs, source)))


def test_report_is_valid(any_result, validate):
    assert validate(report_of(any_result)) == []


def test_schema_refuses_what_is_missing_or_new(friction, validate):
    report = report_of(friction)
    for key in report:
        assert validate({k: v for k, v in report.items() if k != key}), key
    assert validate({**report, 'more': 1})
    assert validate({**report, 'verdict': 'fine'})


def test_schema_knows_the_verdicts_and_the_version(schema):
    assert tuple(schema['properties']['verdict']['enum']) == tuple(map(str, Verdict))
    assert schema['properties']['schema_version']['const'] == SCHEMA_VERSION


def test_document_names_every_key_of_the_schema(schema):
    text = (ROOT / 'docs' / 'report.md').read_text(encoding='utf-8')

    def keys(part):
        for name, inner in part.get('properties', {}).items():
            yield name
            yield from keys(inner)
        if 'items' in part:
            yield from keys(part['items'])

    parts = [schema, *schema['$defs'].values()]
    assert {name for part in parts for name in keys(part) if name not in text} == set()
    assert f'`{SCHEMA_VERSION}`' in text


def test_numbers_are_those_of_the_result(friction):
    result, _, (run,) = friction
    report = report_of(friction)
    assert report['verdict'] == 'effect_found'
    (effect,) = report['effects']
    assert effect['name'] == 'coulomb_friction'
    assert effect['parameters']['level'] == asdict(Estimate(14.02, 13.9, 14.14, 'N'))
    assert effect['alternatives'] == ['hysteresis']
    error = report['error']
    assert (error['quantity'], error['unit'], error['noise_floor']) == ('position', 'm', 5e-5)
    for name, stage in zip(('declared', 'retuned', 'augmented'), result.stages, strict=True):
        e = stage.simulated[0] - run.target
        fit, held = e[result.segments[0].fit], e[~result.segments[0].fit]
        assert error[name]['fit'] == pytest.approx(np.sqrt(np.mean(fit**2)))
        assert error[name]['held_out'] == pytest.approx(np.sqrt(np.mean(held**2)))
        assert error[name]['details']['held_out']['maximum'] == np.max(np.abs(held))
    assert len(report['candidates']) == len(result.candidates)
    assert report['parameters']['retuned']['zeta']['at_bound'] is True
    assert 'effects.coulomb_friction.level' in report['parameters']['augmented']


def test_the_moment_is_there_where_something_begins(friction, validate):
    result, source, runs = friction
    assert report_of(friction)['since'] is None
    since = Estimate(12.5, 12.4, 12.6, 's')
    late = replace(result, since=since)
    report = json.loads(to_json(numbers(late, runs, source)))
    assert report['since'] == asdict(since)
    assert validate(report) == []


def test_a_transition_is_stated_and_is_in_no_error(friction, validate):
    result, source, _ = friction
    late = replace(result, transition=(1.0, 3.0), development=1.5)
    runs = runs_of(late)
    report = json.loads(to_json(numbers(late, runs, source)))
    assert report['transition'] == {'start': 1.0, 'end': 3.0, 'development': 1.5}
    assert validate(report) == []
    segment = result.segments[0]
    used = segment.fit & ((segment.t < 1.0) | (segment.t >= 3.0))
    assert np.count_nonzero(used) < np.count_nonzero(segment.fit)
    assert report['data']['fit_samples'] == np.count_nonzero(used)
    e = result.stages[2].simulated[0] - segment.target
    fit = report['error']['augmented']['details']['fit']
    assert fit['rmse'] == pytest.approx(np.sqrt(np.mean(e[used] ** 2)))
    assert report_of(friction)['transition'] is None


def test_data_are_described(tested):
    report = report_of(tested)
    first, second = report['data']['recordings']
    assert (first['role'], second['role']) == ('fit', 'test')
    assert first['rate'] == pytest.approx(200.0)
    assert first['jitter'] < 1e-9
    assert first['duration'] == pytest.approx(20.0 - 1 / 200.0)
    ((start, end),) = first['gaps']
    assert (start, end) == pytest.approx((8.0, 8.4), abs=0.011)
    low, high = first['ranges']['pressure_command']
    assert 2.0e5 < low < high < 5.0e5
    assert report['data']['segments'] == 3
    assert report['data']['held_out_samples'] == second['samples'] == 4000
    assert report['data']['fit_samples'] == first['samples']
    assert report['error']['held_out'] == 'test recordings'


def test_provenance_names_files_and_versions(tested):
    source = report_of(tested)['provenance']
    assert source['parameters']['file'] == 'dmsp_20_400n'
    assert source['parameters']['overrides'] == ['mass=20']
    assert source['uncertain'] == {'mass': '2%'}
    assert source['configuration']['mass'] == 20.0
    assert [r['name'] for r in source['recordings']] == ['bench.csv', 'other.csv']
    assert source['versions']['numpy'] == np.__version__


def test_what_is_not_finite_becomes_null(friction, validate):
    result, source, runs = friction
    nominal, *others = result.stages
    broken = replace(result, stages=(replace(nominal, held_error=math.nan), *others))
    text = to_json(numbers(broken, runs, source))
    assert 'NaN' not in text
    report = json.loads(text)
    assert report['error']['declared']['held_out'] is None
    assert validate(report) == []
