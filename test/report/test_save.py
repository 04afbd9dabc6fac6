# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a program saves of an identification: the files of the command, and one sentence else."""

import json
import shlex
import sys
from dataclasses import dataclass, replace

import numpy as np
import pytest

from pam_ros import (
    Actuator,
    Arm,
    Joint,
    Mass,
    Muscle,
    PamError,
    Pulley,
    Straight,
    load_joint,
    save_parameters,
    save_report,
)
from pam_ros.effects import CoulombFriction, Slack
from pam_ros.report import write
from pam_ros.report.write import FILES
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from support.by_name import by_name
from support.pages import ROOT


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def of_joint(result, joint, muscles=()):
    """Return *result* as if it were that of another joint, whose muscles have these names."""
    stages = tuple(replace(stage, model=joint, parameters={}) for stage in result.stages)
    recordings = result.recordings
    if muscles:
        t = recordings[0].t
        command = np.full((t.size, len(muscles)), 3e5)
        recordings = (replace(recordings[0], command_t=t, command=command, muscles=muscles),)
    return replace(result, stages=stages, recordings=recordings)


def without_digests(result):
    """Return *result* as of recordings that were made from arrays."""
    return replace(result, recordings=tuple(replace(r, digest='') for r in result.recordings))


@pytest.mark.slow
def test_report_has_all_files_and_the_provenance_of_the_program(friction, tmp_path):
    result = without_digests(friction[0])
    save_report(result, str(tmp_path / 'new' / 'report'))
    folder = tmp_path / 'new' / 'report'
    assert names(folder) == sorted(FILES)
    report = json.loads((folder / 'report.json').read_text(encoding='utf-8'))
    source = report['provenance']
    assert source['command'] == shlex.join(sys.orig_argv)
    assert source['parameters'] == {'file': 'a Python program', 'sha256': None, 'overrides': []}
    assert source['recordings'] == [{'name': 'bench.csv', 'sha256': None}]
    assert source['configuration']['mass'] == 20.0
    html = (folder / 'report.html').read_text(encoding='utf-8')
    assert 'a Python program' in html
    assert 'SHA-256' not in html
    assert 'SHA-256' not in (folder / 'identified.yaml').read_text(encoding='utf-8')
    jsonschema = pytest.importorskip('jsonschema')
    schema = json.loads((ROOT / 'docs' / 'report.schema.json').read_text(encoding='utf-8'))
    jsonschema.Draft202012Validator(schema).validate(report)


def test_parameter_file_is_the_identified_joint(friction, tmp_path):
    save_parameters(friction[0], tmp_path / 'new' / 'bench.yaml')
    assert names(tmp_path / 'new') == ['bench.yaml']
    joint = load_joint(tmp_path / 'new' / 'bench.yaml')
    assert np.array_equal(joint.parameters(), friction[0].joint.parameters())
    assert by_name(friction[0].joint.all_effects).keys() == {'coulomb_friction'}


TWO = (Actuator(), Actuator())
CRANK = load_joint('dmsp_10', joint='crank', crank=0.03, mass=0.5)


@pytest.mark.parametrize(
    ('joint', 'muscles'),
    [
        (single_muscle_joint(Muscle(), Mass(mass=8), [Slack(share=1.0)]), ()),
        (antagonistic_joint(Muscle(), radius=0.03, load=Arm(0.5, 0.2)), ('biceps', 'triceps')),
        (Joint(TWO, Mass(30.0)), ('left', 'right')),
        (CRANK, ()),
    ],
)
def test_each_joint_of_a_parameter_file_is_read_again(friction, joint, muscles, tmp_path):
    save_parameters(of_joint(friction[0], joint, muscles), tmp_path / 'joint.yaml')
    again = load_joint(tmp_path / 'joint.yaml')
    assert np.array_equal(again.parameters(), joint.parameters())
    assert (again.load, again.transmission) == (joint.load, joint.transmission)


@pytest.mark.parametrize('joint', [CRANK, Joint(TWO, Mass(30.0)), single_muscle_joint()])
def test_a_joint_of_a_program_is_saved_without_an_identification(joint, tmp_path):
    changed = joint.with_effects(CoulombFriction(level=3.0))
    save_parameters(changed, tmp_path / 'mine.yaml')
    again = load_joint(tmp_path / 'mine.yaml')
    assert np.array_equal(again.parameters(), changed.parameters())
    assert by_name(again.all_effects).keys() == {'coulomb_friction'}
    head = (tmp_path / 'mine.yaml').read_text(encoding='utf-8').splitlines()[0]
    assert head == '# A joint made by a program.'


@pytest.mark.parametrize('what', [None, 'dmsp_10', Muscle()])
def test_what_is_neither_is_refused(what, tmp_path):
    with pytest.raises(PamError, match=r'what = .* give what identify\(\) returned, or a Joint'):
        save_parameters(what, tmp_path / 'mine.yaml')
    assert names(tmp_path) == []


@dataclass(frozen=True)
class Drum(Pulley):
    """A pulley of a user's own."""


DRUM = Joint((Actuator(contraction=0.1), Actuator(contraction=0.1)), Arm(), Drum())
OFFSET = Joint((Actuator(contraction=0.05),), Mass(20.0), Straight())


@pytest.mark.parametrize(
    ('joint', 'muscles', 'said'),
    [
        (DRUM, ('a', 'b'), r'this joint of 2 muscle\(s\), Drum and Arm: it can be one of load'),
        (OFFSET, (), r'this joint of 1 muscle\(s\), Straight and Mass'),
        (Joint(TWO, Mass(30.0)), ('left one', 'right'), "'left one' is not a valid name"),
        (Joint(TWO, Mass(30.0)), ('mass', 'right'), 'mass is the name of a parameter'),
    ],
)
def test_a_joint_of_no_parameter_file_is_refused(friction, joint, muscles, said, tmp_path):
    with pytest.raises(PamError, match=said):
        save_parameters(of_joint(friction[0], joint, muscles), tmp_path / 'joint.yaml')
    assert names(tmp_path) == []


def test_a_joint_of_a_program_that_no_file_can_describe_is_refused(tmp_path):
    with pytest.raises(PamError, match='Drum and Arm: it can be one of load'):
        save_parameters(DRUM, tmp_path / 'joint.yaml')
    assert names(tmp_path) == []


def test_a_custom_effect_is_refused(friction, tmp_path):
    last = friction[0].stages[-1].model
    felt = type('Felt', (CoulombFriction,), {'name': 'felt'})
    library = tuple(felt if effect is CoulombFriction else effect for effect in last.library)
    joint = replace(last, effects=[felt(level=8.0)], library=library)
    with pytest.raises(PamError, match='cannot describe the custom effect felt'):
        save_parameters(of_joint(friction[0], joint), tmp_path / 'joint.yaml')


@pytest.mark.slow
def test_the_report_of_such_a_joint_has_no_parameter_file(friction, tmp_path):
    save_report(of_joint(friction[0], OFFSET), tmp_path / 'report')
    assert names(tmp_path / 'report') == sorted({*FILES} - {'identified.yaml'})
    html = (tmp_path / 'report' / 'report.html').read_text(encoding='utf-8')
    assert 'There is no identified.yaml: a parameter file cannot describe this joint' in html
    save_report(friction[0], tmp_path / 'report')  # in its place
    assert names(tmp_path / 'report') == sorted(FILES)


def test_paths_that_cannot_be_written_are_one_sentence(friction, tmp_path):
    (tmp_path / 'file').write_text('', encoding='utf-8')
    for save, path, said in (
        (save_report, 'file', 'is not a folder: give one for the report'),
        (save_report, 'file/below', 'is not a folder'),
        (save_report, '.', 'holds file, which is not a report of pam_identify'),
        (save_parameters, '.', 'is a folder: give the path of a file'),
        (save_parameters, 'file/below', 'is not a folder that can be written to'),
    ):
        with pytest.raises(PamError, match=said):
            save(friction[0], tmp_path / path)
    assert names(tmp_path) == ['file']


def test_a_folder_without_permission_is_one_sentence(friction, tmp_path, monkeypatch):
    monkeypatch.setattr(write.os, 'access', lambda *_: False)
    for save in (save_report, save_parameters):
        with pytest.raises(PamError, match=f'{tmp_path} is not a folder that can be written to'):
            save(friction[0], tmp_path / 'new')


def test_a_full_disk_leaves_the_former_file(friction, tmp_path, monkeypatch):
    file = tmp_path / 'bench.yaml'
    file.write_text('former', encoding='utf-8')

    def full(*_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(type(file), 'replace', full)
    with pytest.raises(PamError, match='cannot be written: No space left'):
        save_parameters(friction[0], file)
    assert names(tmp_path) == ['bench.yaml']
    assert file.read_text(encoding='utf-8') == 'former'


def test_other_objects_are_refused(tmp_path):
    for save in (save_report, save_parameters):
        with pytest.raises(PamError, match='give what identify'):
            save('found', tmp_path / 'new')
