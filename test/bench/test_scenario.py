# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scenarios are read from YAML, the rig changes when they say, and what is wrong is named."""

import numpy as np
import pytest
import yaml

from pam_ros.bench.faults import NO_FAULTS, CommandFaults, MessageFaults, StateFaults
from pam_ros.bench.scenario import RATE, chosen, read_scenario, scenarios_of_package
from pam_ros.errors import ParameterError

GOOD = {
    'about': 'A step with a payload.',
    'duration': 4.0,
    'declared': {'muscle': 'dmsp_20_400n', 'effects': {'coulomb_friction': {'level': 5.0}}},
    'undeclared': {'initial': {'pressure': 3e5}, 'effects.payload.mass': 2.0},
    'reference': {'kind': 'step', 'size': 0.02},
    'changes': [{'time': 2.0, 'effects.payload.mass': 5.0}],
}
FREEZE = {'kind': 'freeze', 'time': 1.0, 'duration': 0.5}


def written(folder, **changes):
    """Return the path of a scenario, with other values; a value None removes its key."""
    content = {key: value for key, value in {**GOOD, **changes}.items() if value is not None}
    path = folder / 'mine.yaml'
    path.write_text(yaml.safe_dump(content), encoding='utf-8')
    return path


def effects_of(setup):
    (joint,) = setup.joints
    return {type(one).name: one for one in (*joint.effects, *joint.actuators[0].effects)}


def test_the_simulator_has_both_and_changes_in_time(tmp_path):
    scenario = read_scenario(written(tmp_path))
    assert scenario.name == 'mine'
    assert scenario.declared['effects.coulomb_friction.level'] == 5.0
    assert not any('payload' in name for name in scenario.declared)
    (start, first), (later, second) = scenario.setups(7, 'lockstep')
    assert (start, later) == (0.0, 2.0)
    assert [effects_of(one)['payload'].mass for one in (first, second)] == [2.0, 5.0]
    assert {effects_of(one)['coulomb_friction'].level for one in (first, second)} == {5.0}
    assert first.pressures == (3e5,)
    assert (first.sensors.seed, first.settings.time_mode) == (7, 'lockstep')
    assert first.settings.publish_rate == RATE
    assert scenario.reference.at(np.array([0.0, 3.9])).tolist() == [0.0, 0.02]


def test_faults_of_messages_and_outages(tmp_path):
    messages = {'states': {'loss': 0.1, 'dropout': 0.05}, 'commands': {'delay': 0.008}}
    outages = [
        FREEZE,
        {'kind': 'restart', 'time': 2, 'duration': 1},
        {'kind': 'stop', 'time': 3.5},
    ]
    scenario = read_scenario(written(tmp_path, messages=messages, outages=outages))
    assert scenario.messages == MessageFaults(StateFaults(0.1, 0.05), CommandFaults(delay=0.008))
    found = [(one.kind, one.time, one.end) for one in scenario.outages]
    assert found == [('freeze', 1.0, 1.5), ('restart', 2.0, 3.0), ('stop', 3.5, np.inf)]
    plain = read_scenario(written(tmp_path))
    assert (plain.messages, plain.outages) == (NO_FAULTS, ())


def test_a_parameter_file_beside_the_scenario_is_found(tmp_path, monkeypatch):
    rig = {'/**': {'ros__parameters': {'a2': 290.0, 'mass': 12.0}}}
    (tmp_path / 'identified.yaml').write_text(yaml.safe_dump(rig), encoding='utf-8')
    path = written(tmp_path, declared={'muscle': 'identified.yaml'})
    monkeypatch.chdir('/')
    (_, setup), _ = read_scenario(path).setups(0, 'lockstep')
    assert setup.joints[0].load.mass == 12.0


@pytest.mark.parametrize(
    ('changes', 'sentence'),
    [
        ({'about': None}, 'about is missing'),
        ({'durration': 1.0}, 'durration is not a key of a scenario: was duration meant?'),
        ({'duration': 0.5}, 'duration = 0.5 is not allowed: give 1 to 600 s'),
        ({'score': 'speed'}, "score = 'speed' is not allowed: give one of error_at_rest"),
        ({'quick': 'yes please'}, "quick = 'yes please' is not allowed: give true or false"),
        ({'declared': [1]}, 'declared = [1] is not allowed: give parameters of pam_sim'),
        ({'declared': {'muscle': 'dmsp_21'}}, 'dmsp_21 is neither a parameter file nor'),
        ({'declared': {'mas': 2.0}}, 'mas is not a parameter of pam_sim: was mass meant?'),
        ({'declared': {'mass': -2.0}}, 'mass = -2.0 is not allowed'),
        ({'declared': {'mass': [1.0]}}, 'declared: mass = [1.0] is not a single value'),
        ({'declared': {'muscles': ['a', 'b']}}, 'declared has 2 joints: a scenario has one'),
        ({'undeclared': {'sensor.seed': 1}}, 'sensor.seed is set by the bench'),
        ({'undeclared': {'effects.payloads.mass': 1.0}}, 'payloads'),
        ({'reference': 'step'}, "reference = 'step' is not allowed: give a mapping with kind"),
        ({'reference': {'kind': 'jump'}}, "reference: kind = 'jump' is not allowed"),
        ({'changes': {'time': 1.0}}, 'changes is not a list'),
        ({'changes': [{'mass': 1.0}]}, 'changes[0].time is missing'),
        ({'changes': [{'time': 5.0}]}, 'changes[0].time = 5.0 is not allowed: give 0 to 4 s'),
        ({'changes': [{'time': 2.0}, {'time': 2.0}]}, 'changes[1].time = 2 s is not after'),
        ({'changes': [{'time': 2.0, 'mass': 'x'}]}, "mass = 'x' is not allowed"),
        ({'changes': [{'time': 2.0, 'muscle': 'dmsp_10'}]}, 'changes: muscle cannot change'),
        ({'changes': [{'time': 2.0, 'publish_rate': 100.0}]}, 'changes: publish_rate cannot'),
        (
            {'changes': [{'time': 2.0, 'initial.pressure': 1e5}]},
            'changes: initial.pressure cannot',
        ),
        ({'messages': 0.1}, 'messages = 0.1 is not allowed: give a mapping with states, commands'),
        ({'messages': {'state': {}}}, 'messages.state is not known: was states meant?'),
        ({'messages': {'states': None}}, 'messages.states = None is not allowed: give a mapping'),
        ({'messages': {'states': {'lost': 0.1}}}, 'messages.states.lost is not known: give loss'),
        (
            {'messages': {'states': {'delay': 0.1}}},
            'messages.states.delay is not known: give loss',
        ),
        (
            {'messages': {'states': {'loss': 1.5}}},
            'messages.states.loss = 1.5 is not allowed: give 0 to 0.9',
        ),
        ({'messages': {'commands': {'loss': -0.1}}}, 'messages.commands.loss = -0.1 is not'),
        ({'messages': {'commands': {'jitter': '5 ms'}}}, "messages.commands.jitter = '5 ms' is"),
        (
            {'messages': {'commands': {'delay': -0.1}}},
            'delay = -0.1 is not allowed: give 0 to 1 s',
        ),
        ({'messages': {'states': {'dropout': 0.1}}}, 'messages.states.dropout = 0.1 s has no'),
        ({'outages': FREEZE}, 'outages is not a list of mappings'),
        ({'outages': ['stop']}, "outages[0] = 'stop' is not allowed: give a mapping with kind"),
        ({'outages': [{**FREEZE, 'lenght': 1.0}]}, 'outages[0].lenght is not known'),
        ({'outages': [{**FREEZE, 'kind': 'hang'}]}, "outages[0].kind = 'hang' is not allowed"),
        ({'outages': [{'kind': ['stop'], 'time': 1.0}]}, "outages[0].kind = ['stop'] is not"),
        ({'outages': [{'kind': 'freeze', 'time': 1.0}]}, 'outages[0].duration is missing'),
        ({'outages': [{'kind': 'stop'}]}, 'outages[0].time is missing'),
        ({'outages': [{**FREEZE, 'kind': 'stop'}]}, 'outages[0].duration is not allowed for the'),
        ({'outages': [{**FREEZE, 'time': -1.0}]}, 'outages[0].time = -1.0 is not allowed: give'),
        ({'outages': [{**FREEZE, 'duration': 0}]}, 'outages[0].duration = 0 is not allowed'),
        ({'outages': [{**FREEZE, 'time': 3.8}]}, 'outages[0] ends at 4.3 s, after the scenario'),
        ({'outages': [FREEZE, {**FREEZE, 'time': 1.5}]}, 'outages[1].time = 1.5 s is not after'),
        ({'outages': [{'kind': 'stop', 'time': 1.0}, FREEZE]}, 'outages[1] comes after the kind'),
    ],
)
def test_what_is_wrong_is_named_with_the_file(tmp_path, changes, sentence):
    path = written(tmp_path, **changes)
    with pytest.raises(ParameterError) as caught:
        read_scenario(path)
    assert str(caught.value).startswith(f'{path}: ')
    assert sentence in str(caught.value)


def test_a_file_that_is_no_mapping(tmp_path):
    path = tmp_path / 'mine.yaml'
    path.write_text('- 1\n', encoding='utf-8')
    with pytest.raises(ParameterError, match='is not a scenario: give a mapping with about'):
        read_scenario(path)


def test_the_scenarios_of_the_package():
    """Each is valid, tells its score, and a rest to judge comes after 4 s without a motion."""
    every = scenarios_of_package()
    assert len({one.name for one in every}) == len(every) >= 54
    for one in every:
        first, *_ = one.setups(0, 'lockstep')
        assert first[1].joints[0].is_revolute is (
            one.suite == 'joint' and 'parallel' not in one.name
        )
        for outage in one.outages:  # it can be judged before it, or after it
            assert outage.time > 2.0
            assert outage.kind == 'stop' or outage.end < one.duration - 4.0
        if one.score == 'error_at_rest':
            end = one.reference.at(np.linspace(one.duration - 4.0, one.duration, 99))
            assert np.ptp(end) == 0.0
    quick = [one.name for one in chosen([], None, is_quick=True)]
    assert 5 <= len(quick) <= 9
    assert {one.suite for one in chosen([], 'joint', is_quick=False)} == {'joint'}


def test_scenarios_are_chosen_by_name_or_path(tmp_path):
    path = written(tmp_path)
    assert [one.name for one in chosen(['sine', str(path)], None, is_quick=False)] == [
        'sine',
        'mine',
    ]
    with pytest.raises(ParameterError, match='scenario mine is given twice'):
        chosen([str(path), str(path)], None, is_quick=False)
    with pytest.raises(ParameterError, match='scenario sin does not exist: give the path'):
        chosen(['sin'], None, is_quick=False)
