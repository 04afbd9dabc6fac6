# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Drawn scenarios are valid, possible, various, the same for the same seed, and described."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import yaml

from pam_ros.bench.draw.capability import Capability
from pam_ros.bench.draw.draw import drawn_scenarios
from pam_ros.bench.references import REFERENCES
from pam_ros.bench.scenario import Scenario, read_scenario
from pam_ros.control.allocation import allocation_of
from pam_ros.control.limits import Limits
from pam_ros.control.model import ControlModel
from pam_ros.effects import EFFECTS, PressureLag
from pam_ros.errors import PamError, ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.arrangements import ARRANGEMENTS, arrangement_of
from pam_ros.rig.equilibrium import held
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import GRAVITY, Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.nominal import package_muscles
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.initial import initial_state

COUNT, SEED = 150, 11
SPARE = 0.04  # share of the range of pressure with which no end of the reference is held


class Case(NamedTuple):
    """A drawn scenario, the joint that is declared, the real ones, and the demanded positions."""

    scenario: Scenario
    nominal: Joint
    setups: list
    positions: np.ndarray


def case_of(scenario):
    scene = Scene(scenario.declared)
    nominal = scene.build(checked(scene.table(), scenario.declared)).joints[0]
    setups = [setup for _, setup in scenario.setups(0, 'lockstep')]
    start = float(initial_state(setups[0])[1][0])
    t = np.arange(0.0, scenario.duration, 0.01)
    return Case(scenario, nominal, setups, start + scenario.reference.at(t))


@pytest.fixture(scope='module')
def cases(tmp_path_factory):
    folder = tmp_path_factory.mktemp('drawn') / 'scenarios'
    return [case_of(scenario) for scenario in drawn_scenarios(folder, COUNT, SEED)]


@pytest.fixture(scope='module')
def drawn(cases):
    return [case.scenario for case in cases]


def effect_names(scenario):
    """Return the effects that are declared, and those that the controller does not know."""
    values = [scenario.declared, scenario.undeclared, *(one.values for one in scenario.changes)]
    names = [
        {name.split('effects.')[1].split('.')[0] for name in given if 'effects.' in name}
        for given in values
    ]
    return names[0], set().union(*names[1:])


def test_the_real_rig_can_hold_each_end_of_the_reference(cases):
    """With nearly the highest pressure each load moves up from there, with the lowest down.

    At the start all muscles pull: the force law alone could hold a load by pushing.
    """
    for scenario, _, setups, s in cases:
        for setup in setups:
            (joint,) = setup.joints
            low, high = setup.limits
            spare = SPARE * (high - low)
            is_up = np.array([statics.arm(joint, i, 0.0) > 0.0 for i in range(len(low))])
            most = np.where(is_up, high - spare, low + spare)
            least = np.where(is_up, low + spare, high - spare)
            assert held(joint, most)(float(s.max())) > 0.0, scenario.about
            assert held(joint, least)(float(s.min())) < 0.0, scenario.about
            first, last = statics.span(joint)
            assert first < s.min() <= s.max() < last, scenario.about
        for i, (muscle, p) in enumerate(zip(setups[0].muscles, setups[0].pressures, strict=True)):
            kappa = statics.contraction(setups[0].joints[0], i, s[0])
            assert float(muscle.force(p, kappa)) > 0.0, scenario.about


def test_no_reference_is_out_of_the_reach_of_the_declared_rig(cases):
    """A controller that knows what is declared need not refuse it."""
    for scenario, nominal, _, s in cases:
        low, high = allocation_of(ControlModel(nominal), Limits()).reach
        assert low < s.min() <= s.max() < high, scenario.about


def test_each_specimen_is_a_muscle_and_not_the_declared_one(cases):
    share = np.linspace(0.0, 1.0, 8)
    for _, joint, setups, _ in cases:
        nominal = joint.muscles[0]
        p = nominal.p_min + share[:, None] * (nominal.p_max - nominal.p_min)
        kappa = nominal.kappa_min + share * (nominal.kappa_max - nominal.kappa_min)
        for muscle in setups[0].joints[0].muscles:
            force = muscle.force(p, kappa)
            assert np.all(np.diff(force, axis=0) > 0.0)
            assert np.all(np.diff(force, axis=1) < 0.0)
            differs = np.abs(force - nominal.force(p, kappa)).max()
            assert 0.0 < differs < 0.13 * nominal.force(nominal.p_max, 0.0)


def test_everything_is_drawn(cases):
    drawn = [case.scenario for case in cases]
    assert {arrangement_of(case.nominal) for case in cases} == set(ARRANGEMENTS)
    muscles = {case.nominal.muscles[0] for case in cases}
    assert muscles == set(package_muscles().values())
    assert {type(one.reference) for one in drawn} == set(REFERENCES.values())
    declared, hidden = (set().union(*each) for each in zip(*map(effect_names, drawn), strict=True))
    assert hidden == {effect.name for effect in EFFECTS}
    assert len(declared) > 5
    assert {len(effect_names(one)[1]) for one in drawn} >= {0, 1, 2, 3}
    assert {one.score for one in drawn} == {'error_at_rest', 'rms_error'}
    assert {one.undeclared['publish_rate'] for one in drawn} == {200.0, 250.0, 500.0, 1000.0}
    assert {'sensor.latency' in one.undeclared for one in drawn} == {True, False}
    assert 20 < sum(bool(one.changes) for one in drawn) < COUNT - 20


def test_what_is_drawn_is_described(drawn):
    for scenario in drawn:
        about = scenario.about.lower()
        declared, hidden = effect_names(scenario)
        by_change = ' '.join(name for change in scenario.changes for name in change.values)
        for name in {*declared, *hidden}:
            assert name.replace('_', ' ') in about or f'{name}.' in by_change, about
        assert ((' is declared' in about) or (' are declared' in about)) is bool(declared)
        assert about.startswith(f'drawn with seed {SEED}: ')
        assert str(Path(scenario.declared['muscle']).stem) in about
        for change in scenario.changes[:1]:
            assert f'at {change.time:g} s' in about


def test_a_score_at_rest_has_its_rest(drawn):
    for scenario in drawn:
        if scenario.score == 'error_at_rest':
            t = np.linspace(scenario.duration - 4.1, scenario.duration, 99)
            assert np.ptp(scenario.reference.at(t)) == 0.0
            assert all(change.time < scenario.duration - 4.1 for change in scenario.changes)


def test_a_scenario_depends_on_seed_and_number_only(drawn, tmp_path):
    by_name = {one.name: one.file.read_bytes() for one in drawn}
    assert list(by_name)[:2] == ['draw_11_001', 'draw_11_002']
    few = drawn_scenarios(tmp_path, 3, SEED)
    joints = drawn_scenarios(tmp_path, 3, SEED, 'joint')
    assert {one.suite for one in joints} == {'joint'}
    for one in (*few, *joints):
        assert one.file.read_bytes() == by_name[one.name]
    other = drawn_scenarios(tmp_path, 3, SEED + 1)
    assert len({str(one.declared) for one in (*few, *other)}) == 6


def test_a_file_is_readable_and_what_was_changed_by_hand_is_kept(tmp_path):
    (scenario,) = drawn_scenarios(tmp_path, 1, 5)
    content = yaml.safe_load(scenario.file.read_text(encoding='utf-8'))
    values = [*scenario.declared.values(), *scenario.undeclared.values()]
    numbers = [value for value in values if isinstance(value, float)]
    assert len(numbers) > 8
    assert all(float(f'{value:.4g}') == value for value in numbers)
    scenario.file.write_text(yaml.safe_dump({**content, 'duration': 33.0}), encoding='utf-8')
    with pytest.raises(ParameterError, match=r'draw_5_001\.yaml has another content than what is'):
        drawn_scenarios(tmp_path, 1, 5)
    assert read_scenario(scenario.file).duration == 33.0


def test_a_folder_that_cannot_be_made_is_a_sentence(tmp_path):
    (tmp_path / 'found').write_text('', encoding='utf-8')
    with pytest.raises(PamError, match='found'):
        drawn_scenarios(tmp_path / 'found' / 'scenarios', 1, 5)


def test_a_motion_is_followed_if_gravity_and_the_valve_allow_it():
    """A load hangs on a muscle: it cannot fall faster than free, nor than its chamber empties."""
    joint = single_muscle_joint(Muscle(zeta=0.0), Mass(mass=20.0))
    t = np.arange(0.0, 4.0, 1e-3)

    def follows(one, acceleration, frequency=6.0):
        w = 2.0 * np.pi * frequency
        s = 0.06 + acceleration / w**2 * np.sin(w * t)
        return Capability(one, 0.0).follows(s, 1e-3, [3e5])

    slow = joint.with_effects(PressureLag(fill=0.05, vent=0.05))
    assert follows(joint, 0.9 * GRAVITY)
    assert not follows(joint, 1.1 * GRAVITY)
    assert not follows(slow, 0.9 * GRAVITY)
    assert follows(slow, 0.05 * GRAVITY)
