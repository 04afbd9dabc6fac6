# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The policy for ROS security: it permits what the programs use, no more and no less."""

import shutil
import subprocess
from collections import defaultdict
from contextlib import ExitStack, suppress
from fnmatch import fnmatchcase
from pathlib import Path
from xml.etree import ElementTree

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from pam_ros.errors import PamError
from pam_ros.nodes.control.topics import watched_topics as watched_by_controller
from pam_ros.nodes.sim.topics import watched_topics as watched_by_simulator
from pam_ros.settings.control import settings_of
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from support.bags import contents
from support.harness import FreshProgram
from support.interfaces import built

POLICY = Path(__file__).parents[2] / 'config' / 'security' / 'pam_ros.policy.xml'
PAIR = {'joint': 'antagonistic'}
SEPARATE = {'muscles': ['left', 'right'], 'muscle_topics': True, 'time_mode': 'scaled'}
FOLLOWS = {'use_sim_time': True}
# Rigs in namespaces of their own, with the programs and parameters by which they use everything.
RIGS = {
    'one': {'pam_sim': {}, 'pam_control': {}, 'pam_record': {}},
    'pair': {'pam_sim': PAIR, 'pam_control': {**PAIR, **FOLLOWS}, 'pam_record': FOLLOWS},
    'separate': {'pam_sim': SEPARATE, 'pam_control': {**PAIR, 'muscle_topics': True}},
    'followed': {'pam_sim': FOLLOWS},
    'excited': {'pam_excite': FOLLOWS},
    'excited_pair': {'pam_excite': {**PAIR, **FOLLOWS}},
    'excited_separately': {'pam_excite': {**PAIR, 'muscle_topics': True}},
    'drawn': {'pam_plot': FOLLOWS},
}
PROGRAMS = sorted({program for rig in RIGS.values() for program in rig})
NODES = {
    'pam_command': '_pam_command',
    'pam_plot': '_pam_plot',
}  # the names of nodes, where they are not those of the programs
NO_KEYS = (
    'the command ros2 security, which makes keys, is not installed: that a stranger is not heard '
    'was not tried'
)
NO_PLUGINS = (
    'the middleware was built without its security plugins: that a stranger is not heard was not '
    'tried'
)


def permitted(path):
    """Return the rules of an enclave: (kind, verb) -> expressions of absolute names.

    Names are resolved as by the template from which ``ros2 security`` makes permissions.
    """
    found = defaultdict(set)
    (profile,) = ElementTree.parse(POLICY).findall(f'.//enclave[@path="{path}"]/profiles/profile')
    for rules in profile:
        ((verb, value),) = rules.attrib.items()
        assert value == 'ALLOW'
        for rule in rules:
            name = rule.text.replace('~', f'/{profile.get("node")}')
            found[rules.tag, verb].add(name if name.startswith('/') else f'/{name}')
    return found


def used(peer, program, namespace):
    """Return what a running program publishes, subscribes and answers, without its namespace.

    That of its hidden node, which samples topics with several publishers, is included.
    """
    node = peer.node
    getters = {
        ('topics', 'publish'): node.get_publisher_names_and_types_by_node,
        ('topics', 'subscribe'): node.get_subscriber_names_and_types_by_node,
        ('services', 'reply'): node.get_service_names_and_types_by_node,
    }
    found = defaultdict(set)
    for one in nodes_of(program) & names_in(peer, namespace):
        for rule, get in getters.items():
            with suppress(RuntimeError):  # the hidden node has ended meanwhile
                found[rule] |= {
                    of.removeprefix(f'/{namespace}') for of, _ in get(one, f'/{namespace}')
                }
    return found


def nodes_of(program):
    """Return the names of the node of a program, and of the hidden one that samples topics."""
    name = NODES.get(program, program)
    return {name, f'_{name}_sampler'}


def names_in(peer, namespace):
    """Return the names of the nodes in a namespace."""
    return {
        name for name, of in peer.node.get_node_names_and_namespaces() if of == f'/{namespace}'
    }


def watched(program, parameters):
    """Return the topics that a program samples where there is more than one publisher."""
    if program == 'pam_sim':
        scene = Scene(parameters)
        return watched_by_simulator(scene.build(checked(scene.table(), parameters)))
    if program == 'pam_control':
        table, build = settings_of(parameters)
        return watched_by_controller(build(checked(table, parameters)))
    return []


@pytest.mark.at_any_pace
def test_programs_use_what_the_policy_permits_and_all_of_it(peer, tmp_path):
    unused = {program: permitted(f'/{program}') for program in PROGRAMS}
    del unused['pam_control']['actions', 'execute']  # the next test
    denied, sampled = set(), set()

    def note(program, rule, name):
        through = {one for one in permitted(f'/{program}')[rule] if fnmatchcase(name, one)}
        unused[program][rule] -= through
        # The action exists where its messages are installed.
        if not through and '/_action/' not in name:
            denied.add((program, *rule, name))

    def look():
        for namespace, programs in RIGS.items():
            for program in programs:
                for rule, names in used(peer, program, namespace).items():
                    for name in names:
                        note(program, rule, name)
                if f'_{program}_sampler' in names_in(peer, namespace):
                    sampled.add(program)
        has_all = not any(rules for of in unused.values() for rules in of.values())
        return has_all and sampled == {'pam_sim', 'pam_control'}

    with ExitStack() as running:
        for namespace, programs in RIGS.items():
            for program, parameters in programs.items():
                for kind, topic, *_ in watched(program, parameters):
                    name = topic if topic.startswith('/') else f'/{topic}'
                    note(program, ('topics', 'subscribe'), name)
                    if name == f'/{topic}':  # not /clock, which all programs share
                        peer.node.create_publisher(kind, f'/{namespace}{name}', 1)
                bag = ('--', '-o', str(tmp_path / namespace)) if program == 'pam_record' else ()
                words = (*bag, '--ros-args', '-r', f'__ns:=/{namespace}')
                running.enter_context(FreshProgram(program, *words, parameters=parameters))
        # If the time is over, the assertion shows what nobody uses.
        with suppress(PamError):
            peer.until(look, 'the use of all that is permitted')
        look()
        others = {
            name: names_in(peer, name) - {part for one in programs for part in nodes_of(one)}
            for name, programs in RIGS.items()
        }
    left = {
        (program, *rule, name)
        for program, rules in unused.items()
        for rule, names in rules.items()
        for name in names
    }
    assert (denied, left, sampled) == (set(), set(), {'pam_sim', 'pam_control'})
    assert not any(others.values()), others


@pytest.mark.at_any_pace
def test_the_action_of_the_controller_is_permitted(peer, tmp_path_factory, monkeypatch):
    for name, value in built('control_msgs', tmp_path_factory).items():
        monkeypatch.setenv(name, value)
    (action,) = permitted('/pam_control')['actions', 'execute']
    parts = {
        ('services', 'reply'): {f'{action}/_action/{one}_goal' for one in ('send', 'cancel')}
        | {f'{action}/_action/get_result'},
        ('topics', 'publish'): {f'{action}/_action/{one}' for one in ('feedback', 'status')},
    }
    with FreshProgram('pam_control', '-r', '__ns:=/one'):

        def is_complete():
            now = used(peer, 'pam_control', 'one')
            return now and all(now[rule] >= names for rule, names in parts.items())

        peer.until(is_complete, 'the action')
        for rule, names in used(peer, 'pam_control', 'one').items():
            able = permitted('/pam_control')[rule]
            others = {name for name in names if not any(fnmatchcase(name, one) for one in able)}
            assert others == parts.get(rule, set())


def test_the_operator_may_call_what_the_programs_answer():
    rules = permitted('/operator')
    for program in ('pam_sim', 'pam_control', 'pam_excite'):
        answered = permitted(f'/{program}')['services', 'reply']
        assert answered
        for name in answered:
            assert any(fnmatchcase(name, one) for one in rules['services', 'request']), name
    # What each command ros2 offers itself, and pam_command.
    own = rules['services', 'reply']
    offered = ('/_ros2cli_12345/get_type_description', '/_pam_command/get_type_description')
    assert [any(fnmatchcase(one, rule) for rule in own) for one in offered] == [True, True]
    assert len(own) == len(offered)
    assert rules['actions', 'call'] == permitted('/pam_control')['actions', 'execute']
    # A person gives references to the controller, and no pressures past it.
    assert not any(name.endswith('command') for name in rules['topics', 'publish'])


@pytest.mark.at_any_pace
def test_the_operator_may_do_what_pam_command_does_with_a_reference(peer):
    rules = permitted('/operator')
    own = {}

    def is_there():
        own.update(used(peer, 'pam_command', 'one'))
        return own.get(('topics', 'publish'), set()) >= {'/position_reference', '/rosout'}

    peer.node.create_subscription(Float64, 'one/position_reference', lambda _: None, 10)
    with FreshProgram(
        'pam_command', '-r', '__ns:=/one', '--', 'position', '60mm', '--wait', '60'
    ) as program:
        peer.until(lambda: is_there() or not program.is_running, 'the topic')
    assert own['topics', 'publish'] >= {'/position_reference'}
    for rule, names in own.items():
        for name in names:
            assert any(fnmatchcase(name, one) for one in rules[rule]), (rule, name)


def secured(monkeypatch, keys):
    monkeypatch.setenv('ROS_SECURITY_ENABLE', 'true')
    monkeypatch.setenv('ROS_SECURITY_STRATEGY', 'Enforce')
    if keys is None:
        monkeypatch.delenv('ROS_SECURITY_KEYSTORE', raising=False)
    else:
        monkeypatch.setenv('ROS_SECURITY_KEYSTORE', str(keys))


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
@pytest.mark.parametrize('name', PROGRAMS)
def test_a_program_without_keys_ends_with_one_sentence(name, tmp_path, monkeypatch):
    secured(monkeypatch, tmp_path)
    with FreshProgram(name, '--enclave', f'/{name}') as program:
        assert program.wait() == 2
        (line,) = program.output.splitlines()
    assert line.startswith(f'{name}: ')
    assert str(tmp_path) in line
    assert [*tmp_path.iterdir()] == []


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
def test_security_without_a_keystore_names_the_variable(monkeypatch):
    secured(monkeypatch, None)
    with FreshProgram('pam_sim', '--enclave', '/pam_sim') as program:
        assert program.wait() == 2
        assert program.output == (
            'pam_sim: ROS_SECURITY_KEYSTORE is not set: give the folder of the keys, or no '
            'security\n'
        )


def test_a_stranger_is_not_heard_and_sees_nothing(peer, tmp_path, monkeypatch):
    if shutil.which('ros2') is None:
        pytest.skip(NO_KEYS)
    keys, bag = tmp_path / 'keys', tmp_path / 'bag'
    make = ('ros2', 'security', 'generate_artifacts', '-k', str(keys), '-p', str(POLICY))
    made = subprocess.run(make, capture_output=True, text=True, timeout=120.0, check=False)
    if 'invalid choice' in made.stderr:
        pytest.skip(NO_KEYS)
    assert made.returncode == 0, made.stderr
    states = peer.collect(JointState, 'joint_states')
    commands = peer.node.create_publisher(Float64, 'pressure_command', 10)
    secured(monkeypatch, keys)
    with (
        FreshProgram('pam_sim', '--enclave', '/pam_sim') as rig,
        FreshProgram('pam_record', '--enclave', '/pam_record', '--', '-o', str(bag)) as recorder,
    ):
        for _ in range(50):
            commands.publish(Float64(data=300e3))
            peer.work(0.1)
        if 'have the security libraries' in rig.output:
            pytest.skip(NO_PLUGINS)
        assert (rig.stop(), recorder.stop()) == (0, 0), rig.output + recorder.output
    seen = contents(bag)
    assert '/pressure_command' not in seen
    positions = [message.position[0] for _, message in seen['/joint_states']]
    assert len(positions) > 500
    assert max(positions) - min(positions) < 1e-6
    assert states == []
