# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""identified.yaml: loaded again it is the same rig, and simulates the same to the bit."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from pam_ros.effects import CoulombFriction, Creep
from pam_ros.report.parameters import identified, write_identified
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.nominal import nominal_joint


def reloaded(parts, tmp_path):
    result, source, _ = parts
    write_identified(tmp_path / 'identified.yaml', result, source)
    return nominal_joint(tmp_path / 'identified.yaml').joint


def test_loaded_again_it_is_the_same_rig(any_result, tmp_path):
    result, source, _ = any_result
    model = reloaded(any_result, tmp_path)
    last = result.stages[-1].model
    assert (model.load, model.present) == (last.load, last.present)
    assert model.muscle.source == identified(result, source).muscle.source
    assert replace(model.muscle, source=last.muscle.source) == last.muscle
    assert np.array_equal(model.parameters(), last.parameters())


def test_it_simulates_as_the_last_stage_did_to_the_bit(any_result, tmp_path):
    result, _, _ = any_result
    model = reloaded(any_result, tmp_path)
    for s, simulated in zip(result.segments, result.stages[-1].simulated, strict=True):
        if s.kind == 'free':
            again = simulate(model, s.t, s.drive, s.drive_t, position=s.y0, velocity=s.v0).position
        else:
            again = simulate_held(model, s.t, s.pressure, s.position, s.velocity).force
        assert np.array_equal(again, simulated)


def test_awkward_numbers_survive(friction, tmp_path):
    result, source, _ = friction
    model = result.stages[-1].model
    odd = single_muscle_joint(
        replace(model.muscle, a1=-4.1e-7, a5=302.00000000000006, a2=1e2 / 3.0),
        model.load,
        [CoulombFriction(level=np.float64(1.0) / 3.0, presliding=1e-5), Creep()],
    )
    other = replace(result, stages=(*result.stages[:2], replace(result.stages[2], model=odd)))
    again = reloaded((other, source, None), tmp_path)
    assert np.array_equal(again.parameters(), odd.parameters())
    assert 'creep' not in (tmp_path / 'identified.yaml').read_text(encoding='utf-8')


@pytest.mark.parametrize('name', ['C: a.csv', 'a #1: b', 'a:', '\x07\n#b\u2028 :c', ' : # '])
def test_its_source_is_a_text_also_where_it_is_read_twice(friction, tmp_path, name):
    result, source, _ = friction
    recordings = tuple(replace(one, name=name) for one in source.recordings)
    other = replace(source, recordings=recordings, parameters=name)
    write_identified(tmp_path / 'identified.yaml', result, other)
    written = yaml.safe_load((tmp_path / 'identified.yaml').read_text(encoding='utf-8'))
    text = written['/**']['ros__parameters']['source']
    assert yaml.safe_load(text) == text


def test_constants_stay_in_the_units_of_their_source(friction, tmp_path):
    model = reloaded(friction, tmp_path)
    assert (model.muscle.pressure_unit, model.muscle.contraction_unit) == ('bar', 'percent')
    assert model.muscle.a5 == pytest.approx(303.5, abs=0.1)
    assert 're-tuned on bench.csv' in model.muscle.source


def test_comment_names_the_source_of_the_value(tested, tmp_path):
    reloaded(tested, tmp_path)
    lines = (tmp_path / 'identified.yaml').read_text(encoding='utf-8').splitlines()
    comment = [line for line in lines if line.startswith('#')]
    assert max(map(len, comment)) <= 99
    text = '\n'.join(comment)
    for part in ('effect_found', 'bench.csv', 'other.csv', 64 * 'a', 'mass=20', 'dmsp_20_400n'):
        assert part in text
