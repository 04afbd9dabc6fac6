# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""bench.json: read back without loss, valid against its schema, never half-written."""

import errno
import json
import os
import re

import pytest

from pam_ros.bench.compare import compared
from pam_ros.bench.outcome import Status
from pam_ros.bench.read import read_results
from pam_ros.bench.save import SCHEMA_VERSION, provenance, save_results
from pam_ros.errors import PamError
from pam_ros.settings import files
from support.outcomes import results_of
from support.pages import ROOT

OLD = '{"an": "older file"}'


@pytest.fixture
def results():
    """Return results with each kind of value: failed, without meaning, zero, not UTF-8."""
    return results_of(
        {
            'step': {'a': [1e-5, 2e-5, None], 'b\udcff': [0.0, Status.FLOODED, float('inf')]},
            'turn': {'a': [1e-5], 'b\udcff': [Status.NOT_FINITE]},
        },
        revolute={'turn'},
        real_time={'a'},
        others={'computing_time': float('nan'), 'limit_violations': 0.0},
    )


@pytest.fixture
def saved(results, tmp_path):
    path = tmp_path / 'new' / 'bench.json'
    save_results(path, results)
    return path


@pytest.fixture(scope='module')
def validate():
    """Return a function that lists what is wrong with a content of bench.json."""
    jsonschema = pytest.importorskip('jsonschema')
    schema = json.loads((ROOT / 'docs' / 'bench.schema.json').read_text(encoding='utf-8'))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    return lambda content: [f'{e.json_path}: {e.message}' for e in validator.iter_errors(content)]


def loaded(path):
    def refuse(text):
        raise AssertionError(text)

    return json.loads(path.read_text(encoding='utf-8'), parse_constant=refuse)


def changed(content, place, value):
    """Return *content* with *value* at *place*, a list of keys; ... removes the key."""
    content = json.loads(json.dumps(content))
    *inner, last = place
    part = content
    for key in inner:
        part = part[key]
    if value is ...:
        del part[last]
    else:
        part[last] = value
    return content


def test_results_are_read_back(results, saved):
    assert read_results(saved) == results
    assert [path.name for path in saved.parent.iterdir()] == ['bench.json']


def test_content_is_valid_and_has_what_follows_from_the_outcomes(results, saved, validate):
    content = loaded(saved)
    assert validate(content) == []
    for key in content:
        assert validate(changed(content, [key], ...)), key
    assert validate(changed(content, ['outcomes', 0, 'scores', 'rms_error'], -1.0))
    assert validate(changed(content, ['schema_version'], '2.0'))
    first = next(one for one in content['comparison'] if one['score'] == 'error_at_rest')
    (expected, _) = compared(results, 'step', 'error_at_rest')
    assert (first['median'], first['unit'], first['failed']) == (expected.median, 'm', 0)
    assert first['interval'] == {'low': 1e-5, 'high': 2e-5, 'confidence': 0.5}
    assert content['comparison'][-1]['scenario'] == 'turn'
    assert {one['unit'] for one in content['comparison'] if one['scenario'] == 'turn'} >= {'rad'}


def test_schema_knows_the_statuses_and_the_version():
    schema = loaded(ROOT / 'docs' / 'bench.schema.json')['properties']
    assert schema['schema_version']['const'] == SCHEMA_VERSION
    status = schema['outcomes']['items']['properties']['status']
    assert status['enum'] == list(map(str, Status))


def test_provenance_has_the_digests_of_the_scenarios(tmp_path):
    (tmp_path / 'step.yaml').write_bytes(b'abc')
    found = provenance('pam_bench step', {'step': tmp_path / 'step.yaml'})
    assert found.files['step'].startswith('ba7816bf')  # FIPS 180-4, "abc"
    assert {'pam_ros', 'python', 'numpy'} <= set(found.versions)
    with pytest.raises(PamError, match=r'absent\.yaml cannot be read: No such file'):
        provenance('pam_bench', {'absent': tmp_path / 'absent.yaml'})


def test_a_full_disk_leaves_the_former_file(results, tmp_path, monkeypatch):
    path = tmp_path / 'bench.json'
    path.write_text(OLD, encoding='utf-8')
    whole = files.tempfile.NamedTemporaryFile

    def small(*args, **options):
        """Return a file on a disk that has space for some bytes only."""
        file = whole(*args, **options)

        def write(text):
            file.file.write(text[:100])
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        file.write = write
        return file

    monkeypatch.setattr(files.tempfile, 'NamedTemporaryFile', small)
    with pytest.raises(PamError) as refused:
        save_results(path, results)
    assert str(refused.value) == f'{path} cannot be written: No space left on device'
    assert path.read_text(encoding='utf-8') == OLD
    assert [path.name for path in tmp_path.iterdir()] == ['bench.json']


@pytest.mark.parametrize(
    ('place', 'sentence'),
    [
        ('.', 'is a folder: give the path of a file for the results'),
        ('pipe', 'is not a file: give the path of a file for the results'),
        ('file/bench.json', 'cannot be written: {}/file is not a folder'),
        ('/proc/bench.json', 'cannot be written: No such file or directory'),
    ],
)
def test_a_place_that_cannot_be_written_is_one_sentence(results, tmp_path, place, sentence):
    (tmp_path / 'file').write_text('', encoding='utf-8')
    os.mkfifo(tmp_path / 'pipe')
    with pytest.raises(PamError) as refused:
        save_results(tmp_path / place, results)
    assert str(refused.value) == f'{tmp_path / place} {sentence.format(tmp_path)}'


@pytest.mark.parametrize(
    ('data', 'sentence'),
    [
        (b'', 'is damaged: Expecting value'),
        (b'{"program": "pam_bench", "schema_version"', 'is damaged: Expecting'),
        (b'\xff\xfe', "is damaged: 'utf-8' codec"),
        pytest.param(100000 * b'[', 'is damaged: ', id='nested without end'),
        (b'{"program": "pam_bench", "program": 1}', 'is damaged: program is in a table twice'),
        (b'[]', 'has no results of pam_bench'),
        (b'{"schema_version": "2.11", "verdict": ""}', 'has no results of pam_bench'),
        (
            b'{"program": "pam_bench", "schema_version": "2.0"}',
            'has the schema version 2.0, which is not known: it must be 1.x',
        ),
    ],
)
def test_a_file_that_is_something_else_is_one_sentence(tmp_path, data, sentence):
    path = tmp_path / 'bench.json'
    path.write_bytes(data)
    with pytest.raises(PamError, match=re.escape(f'{path} {sentence}')):
        read_results(path)


def test_a_file_that_is_not_there_is_one_sentence(tmp_path):
    os.mkfifo(tmp_path / 'pipe')
    for name, sentence in (('none', 'No such file or directory'), ('pipe', 'it is not a file')):
        with pytest.raises(PamError) as refused:
            read_results(tmp_path / name)
        assert str(refused.value) == f'{tmp_path / name} cannot be read: {sentence}'


@pytest.mark.parametrize(
    ('place', 'value', 'sentence'),
    [
        (['outcomes'], ..., 'there is no outcomes'),
        (['outcomes', 1, 'seed'], ..., 'there is no seed in outcomes[1]'),
        (['outcomes', 1, 'seed'], 0, 'the outcome step of a with seed 0 is there twice'),
        (['outcomes', 1, 'seed'], True, 'outcomes[1].seed must be a whole number that is not'),
        (['outcomes', 1, 'status'], 'fine', 'outcomes[1].status must be one of completed, died'),
        (['outcomes', 1, 'scores'], [], 'outcomes[1].scores must be a table, not []'),
        (['outcomes', 1, 'seconds'], float('nan'), 'outcomes[1].seconds must be a finite number'),
        pytest.param(
            ['outcomes', 1, 'seconds'],
            10**400,
            'outcomes[1].seconds must be a finite number',
            id='huge',
        ),
        (['outcomes', 1, 'is_revolute'], 0, 'outcomes[1].is_revolute must be true or false'),
        (['outcomes', 1, 'scenario'], 'x', 'the scenario x is used, but not described'),
        (['outcomes', 1, 'scores', 'x'], 1, 'the score x is used, but not described'),
        (['scenarios', 0, 'main_score'], 'x', 'the score x is used, but not described'),
        (['scenarios'], {}, 'scenarios must be a list'),
        (['controllers', 0], 1, 'controllers[0] must be a text, not 1'),
        (['provenance', 'files', 'step'], None, 'provenance.files.step must be a text'),
    ],
)
def test_a_damaged_file_is_one_sentence(saved, place, value, sentence):
    saved.write_text(json.dumps(changed(loaded(saved), place, value)), encoding='utf-8')
    with pytest.raises(PamError, match=re.escape(f'{saved} is damaged: {sentence}')):
        read_results(saved)


def test_keys_of_a_later_version_are_ignored(results, saved):
    content = {**loaded(saved), 'schema_version': '1.7', 'more': 1}
    saved.write_text(json.dumps(content), encoding='utf-8')
    assert read_results(saved) == results
