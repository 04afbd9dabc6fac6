# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files: they name programs and files that exist, and load where launch is installed."""

import ast
import importlib.util
import runpy
from pathlib import Path
from types import SimpleNamespace

import pytest
import setuptools

from pam_ros.errors import ParameterError
from pam_ros.settings.control import settings_of
from pam_ros.settings.files import read
from pam_ros.settings.launch import ARGUMENTS, VIEW_TIME, refuse_unknown
from pam_ros.settings.scene import Scene
from support.assertions import no_error
from support.launch_stand_in import Loaded

ROOT = Path(__file__).parents[2]
LAUNCH_FILES = sorted((ROOT / 'launch').glob('*.launch.py'))
HAVE_LAUNCH = importlib.util.find_spec('launch_ros') is not None

each = pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)


def programs():
    arguments = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(setuptools, 'setup', arguments.update)
        patch.chdir(ROOT)
        runpy.run_path('setup.py')
    return {script.split()[0] for script in arguments['entry_points']['console_scripts']}


def parsed(path):
    return ast.parse(path.read_text(encoding='utf-8'), filename=str(path))


def calls(path, name):
    """Return the keyword arguments that are plain strings of each call of *name*."""
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.Call) and getattr(node.func, 'id', None) == name:
            yield {
                word.arg: word.value.value
                for word in node.keywords
                if isinstance(word.value, ast.Constant)
            }


def test_there_is_one_for_the_simulator():
    assert ROOT / 'launch' / 'sim.launch.py' in LAUNCH_FILES


@each
def test_has_the_function_that_launch_calls(path):
    functions = {node.name for node in parsed(path).body if isinstance(node, ast.FunctionDef)}
    assert 'generate_launch_description' in functions
    compile(path.read_text(encoding='utf-8'), path, 'exec')


@each
def test_starts_programs_that_exist(path):
    nodes = list(calls(path, 'Node'))
    assert nodes
    for node in nodes:
        if node.get('package') == 'pam_ros':
            assert node['executable'] in programs()


@each
def test_names_files_that_exist(path):
    constants = [node.value for node in ast.walk(parsed(path)) if isinstance(node, ast.Constant)]
    endings = ('.yaml', '.launch.py', '.urdf', '.rviz')
    texts = [text for text in constants if isinstance(text, str) and text.endswith(endings)]
    names = [Path(text).name for text in texts if Path(text).suffix]  # no ending by itself
    assert [name for name in names if not any(ROOT.rglob(name))] == []


@each
def test_arguments_are_those_of_the_one_table(path, monkeypatch):
    arguments = Loaded(monkeypatch, path).arguments
    assert arguments
    for name, argument in arguments.items():
        is_view = (path.name, name) == ('view.launch.py', 'use_sim_time')  # it has no controller
        about = VIEW_TIME if is_view else ARGUMENTS[name]
        assert argument.text == about.text
        assert argument.default == about.default
        assert tuple(argument.choices or ()) == about.choices


@pytest.fixture(params=['sim.launch.py', 'closed_loop.launch.py'])
def programs_of(request, monkeypatch):
    """Return a function that gives the parameters of each program that is started."""
    file = Loaded(monkeypatch, ROOT / 'launch' / request.param)
    return lambda *words: {name: node.parameters for name, node in file.nodes(*words).items()}


def test_what_is_given_reaches_every_program(programs_of):
    for parameters in programs_of().values():
        assert parameters == [{'muscle': 'dmsp_20_400n'}]
    words = ('muscle:=dmsp_10', 'mass:=10', 'joint:=load', 'time_mode:=lockstep')
    for name, (values,) in programs_of(*words).items():
        own = {'time_mode': 'lockstep'} if name == 'pam_sim' else {'use_sim_time': True}
        assert values == {'muscle': 'dmsp_10', 'joint': 'load', 'mass': 10.0, **own}
        assert type(values['mass']) is float
    for (values,) in programs_of('use_sim_time:=true').values():
        assert values['use_sim_time'] is True


def test_a_parameter_file_is_given_to_every_program_and_not_overruled(programs_of, tmp_path):
    one, other = tmp_path / 'one.yaml', tmp_path / 'other.yaml'
    one.touch()
    other.touch()
    for parameters in programs_of(f'params:={one}').values():
        assert parameters == [str(one)]
    for parameters in programs_of(f'params:={one},{other}', 'mass:=3.0').values():
        assert parameters == [str(one), str(other), {'mass': 3.0}]
    # The file may name a joint that needs no load.
    for parameters in programs_of(f'params:={one}', 'mass:=0').values():
        assert parameters == [str(one), {'mass': 0.0}]


@pytest.mark.parametrize(
    ('word', 'sentence'),
    [
        ('params:=nowhere.yaml', 'params = .nowhere.yaml. is not allowed: give the path'),
        ('muscle:=dmsp_99', 'dmsp_99 is neither .* dmsp_20_400n'),
        ('mass:=-1', 'mass = -1.0 is not allowed: give above 0'),
        ('mass:=0', 'mass = 0.0 is not allowed: give above 0'),
        ('mass:=heavy', 'mass = .heavy. is not allowed'),
        ('publish_rate:=0', 'publish_rate = 0.0 is not allowed'),
        ('mas:=10.0', r'mas is not an argument of .*launch.py: was mass meant\?'),
        (
            'zeta:=0.2',
            r'zeta is not an argument of .*launch.py: give one of muscle, .*, or a',
        ),
        ('sim_params:=a.yaml', 'sim_params is no'),
    ],
)
def test_what_is_not_allowed_is_one_sentence(programs_of, word, sentence):
    with pytest.raises(ParameterError, match=sentence):
        programs_of(word)


@pytest.mark.parametrize(('given', 'is_set'), [('true', True), ('True', True), ('False', False)])
def test_true_and_false_may_be_capitalised(programs_of, given, is_set):
    for (values,) in programs_of(f'use_sim_time:={given}').values():
        assert values['use_sim_time'] is is_set


@pytest.mark.parametrize(
    ('ends', 'exit_code', 'reasons'),
    [
        ([('pam_sim-1', 2), ('pam_control-2', 0)], 2, ['pam_sim-1 ended with exit code 2']),
        (
            [('pam_control-2', -9), ('pam_sim-1', 1)],
            137,
            ['pam_control-2 ended with exit code -9'],
        ),
        ([('pam_control-2', 0), ('pam_sim-1', 3)], 3, ['pam_sim-1 ended with exit code 3']),
        ([('pam_control-2', 0), ('pam_sim-1', 0)], None, []),
    ],
)
def test_a_program_that_dies_ends_the_closed_loop_with_its_exit_code(
    monkeypatch, ends, exit_code, reasons
):
    nodes = Loaded(monkeypatch, ROOT / 'launch' / 'closed_loop.launch.py').nodes()
    on_exit = nodes['pam_sim'].on_exit
    assert nodes['pam_control'].on_exit is on_exit
    shut_down = []
    found = None
    try:
        for name, code in ends:
            event = SimpleNamespace(process_name=name, returncode=code)
            context = SimpleNamespace(is_shutdown=bool(shut_down))
            shut_down += [action.reason for action in on_exit(event, context)]
    except SystemExit as end:
        found = end.code
    assert found == exit_code
    assert shut_down == (reasons if len(ends) > 1 and ends[0][1] else [])


def test_a_launch_file_that_includes_the_closed_loop_decides_when_it_ends(monkeypatch):
    file = Loaded(monkeypatch, ROOT / 'launch' / 'closed_loop.launch.py')
    nodes = file.nodes(started='mine.launch.py')
    assert [node.on_exit for node in nodes.values()] == [None, None]


@pytest.mark.parametrize('word', ['joint:=knee', 'time_mode:=fast', 'use_sim_time:=yes'])
def test_choices_are_configured(programs_of, word):
    with pytest.raises(RuntimeError, match='valid options are'):
        programs_of(word)


def test_arguments_of_a_file_that_includes_ours_are_its_own():
    with no_error():
        refuse_unknown('sim.launch.py', ['mass'], ['ros2', 'launch', 'mine.launch.py', 'mas:=1'])


def test_a_file_of_the_same_name_that_includes_ours_has_its_own_arguments(tmp_path, monkeypatch):
    ours, theirs = ROOT / 'launch' / 'sim.launch.py', tmp_path / 'sim.launch.py'
    theirs.touch()
    monkeypatch.chdir(tmp_path)
    linked = tmp_path / 'linked.launch.py'  # as colcon build --symlink-install does
    linked.symlink_to(ours)
    for words in (('my_robot', 'sim.launch.py'), ('sim.launch.py',), (str(theirs),)):
        with no_error():
            refuse_unknown(str(ours), ['mass'], ['ros2', 'launch', *words, 'world:=lab'])
    theirs.unlink()
    for words in (('pam_ros', 'sim.launch.py'), (str(ours),), (str(linked),)):
        with pytest.raises(ParameterError, match=r'world is not an argument of sim\.launch\.py'):
            refuse_unknown(str(ours), ['mass'], ['ros2', 'launch', *words, 'world:=lab'])


def test_the_settings_that_come_with_the_package_are_the_defaults():
    """So that launch files need not pass them on."""
    for file, program in (
        ('sim', 'pam_sim'),
        ('control', 'pam_control'),
        ('antagonistic', 'pam_sim'),
        ('antagonistic', 'pam_control'),
    ):
        values = read(ROOT / 'config' / f'{file}.yaml', program)
        given = {'joint': values['joint']}
        table = Scene(given).table() if program == 'pam_sim' else settings_of(given)[0]
        del values['joint']
        assert values == {name: table[name][1] for name in values}


@pytest.mark.skipif(not HAVE_LAUNCH, reason='launch_ros is not installed: no wheels have it')
@each
def test_loads(path):
    from launch import LaunchDescription

    description = runpy.run_path(str(path))['generate_launch_description']()
    assert isinstance(description, LaunchDescription)
    assert description.entities
