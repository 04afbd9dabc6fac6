# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""README.md and all pages: commands, options, files and links exist; pictures are small."""

import argparse
import json
import re
import shlex
import subprocess
import sys
from functools import cache
from itertools import pairwise, takewhile
from pathlib import Path

import pytest
import yaml

from benchmarks.__main__ import names as benchmarks
from pam_ros.cli import pam_identify
from pam_ros.command import options
from pam_ros.errors import ParameterError
from pam_ros.settings import excite
from pam_ros.settings.control import settings_of
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, override
from support.assertions import no_error
from support.domain import claimed
from support.launch_stand_in import Loaded
from support.pages import (
    DOCS,
    PAGES,
    README,
    ROOT,
    anchors,
    blocks,
    commands,
    links,
    names,
    rows,
    text_of,
)

# How commands of other programs begin: whether they are right is for their manuals.
OF_OTHERS = (
    'colcon build',
    'dask scheduler',
    'dask worker tcp://',
    'pip install --user --break-system-packages bokeh mcap rosbags',
    'python3 examples/own_controller.py',
    'ros2 bag',
    'ros2 run plotjuggler plotjuggler',
    'ros2 param load',
    'ros2 run topic_tools transform',
    'ros2 security generate_artifacts',
    'ros2 topic echo',
    'rosdep install',
    'source install/setup.bash',
)
OF_SECURITY = '(ENABLE|STRATEGY|KEYSTORE|ENCLAVE_OVERRIDE)'
SETTING = re.compile(rf'(ROS_DOMAIN_ID|ROS_SECURITY_{OF_SECURITY})=.')
PROGRAMS = sorted(path.stem for path in (ROOT / 'pam_ros' / 'cli').glob('pam_*.py'))
FILE = re.compile(r'[\w./*<>-]+\.(css|csv|html|json|md|png|py|rst|toml|txt|xml|yaml)')
# What the tutorials have their readers write.
OF_AN_EXAMPLE = {
    'my_crank.yaml',
    'my_elbow.yaml',
    'my_lever.yaml',
    'my_muscle.yaml',
    'pam_ros/effects/choked_valve.py',
    'test/effects/test_choked_valve.py',
}
LARGEST = 300_000  # bytes of a picture
LONGEST = 120  # lines of the README

each_page = pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)


@cache
def help_of(module):
    with claimed():  # programs of ROS ask for a domain before anything else
        done = subprocess.run(
            [sys.executable, '-m', module, '--help'],
            capture_output=True,
            text=True,
            check=True,
            timeout=60,
        )
    return done.stdout


def has_option(module, option):
    """Return whether the help of a program names this option."""
    return re.search(rf'(^|[\s,\[]){option}(?![\w-])', help_of(module))


def check_make(words):
    target, *rest = words
    makefile = text_of(ROOT / 'Makefile')
    assert re.search(rf'^{target}:', makefile, re.MULTILINE), f'make {target}'
    for word in rest:
        name, _, value = word.partition('=')
        assert name in ('ARGS', 'DISTRO'), word
        if name == 'DISTRO':
            assert (ROOT / 'requirements' / f'ros-{value}.txt').is_file()
        elif target == 'bench':
            check_benchmarks(value.split())
        else:
            # Options of pytest stand next to the paths.
            paths = [word for word in value.split() if not word.startswith('-')]
            assert all((ROOT / path).exists() for path in paths), value


def check_benchmarks(words):
    """Check that there are these benchmarks, and that the one that is given options has them."""
    names = list(takewhile(lambda word: not word.startswith('-'), words))
    assert set(names) <= set(benchmarks())
    for option in (word for word in words if word.startswith('-')):
        (name,) = names
        assert has_option(f'benchmarks.{name}', option), option


# What makes of the parameters that a program is started with the table of all that it has.
TABLES = {
    'pam_sim': lambda given: Scene(given).table(),
    'pam_control': lambda given: settings_of(given)[0],
    'pam_excite': lambda given: excite.settings_of(given)[0],
}
BUILDERS = {
    'pam_sim': lambda given, values: Scene(given).build(values),
    'pam_control': lambda given, values: settings_of(given)[1](values),
    'pam_excite': lambda given, values: excite.settings_of(given)[1](values),
}


def check_parameters(name, words):
    """Check that a program starts with the parameters of a command."""
    parts = [word.partition(':=') for flag, word in pairwise(words) if flag == '-p']
    given = {parameter: yaml.safe_load(value) for parameter, _, value in parts}
    table = TABLES[name](given)
    for parameter, _, value in parts:
        if not isinstance(given[parameter], list):
            given.update([override(f'{parameter}={value}', table)])
    assert given.keys() <= table.keys()
    BUILDERS[name](given, checked(table, given))


def check_program(name, words):
    """Check that a program understands its options, and its parameters."""
    assert name in PROGRAMS
    own, ros = words, []
    if '--ros-args' in words:
        own, ros = words[: words.index('--ros-args')], words[words.index('--ros-args') :]
    if '-p' in ros:
        check_parameters(name, ros)
    if name == 'pam_identify':
        given = pam_identify.parser().parse_intermixed_args(own)
        # A list of recordings may name the nominal model itself.
        if given.params and not given.params.startswith(('MUSCLE', 'FILE')):
            nominal_joint(
                str(ROOT / given.params) if '/' in given.params else given.params, given.set
            )
        return
    if name == 'pam_command' and len(own) > 1:
        check_command(own)
        return
    for word in own:
        if word.startswith('-'):
            assert has_option(f'pam_ros.cli.{name}', word), f'{name} {word}'


def check_command(words):
    """Check that ``pam_command`` understands *words*, and that parameters exist."""
    parser = argparse.ArgumentParser()
    options.add_arguments(parser)
    given = options.checked(parser.parse_args(words))
    known = {**TABLES['pam_sim']({}), **TABLES['pam_control']({})}
    for parameter in [parameter for parameter, _ in given.pairs] or given.names:
        assert given.action == 'call' or any(parameter in one for one in known), parameter


def check_launch(words):
    file, *arguments = words
    with pytest.MonkeyPatch.context() as monkeypatch:
        known = Loaded(monkeypatch, ROOT / 'launch' / file).arguments
    for word in arguments:
        assert word.partition(':=')[0] in known, f'{file} {word}'


def check(words):
    """Check a command of the documentation, given as words."""
    first = Path(words[0]).name
    if first == 'make':
        check_make(words[1:])
    elif first in PROGRAMS:
        check_program(first, words[1:])
    elif words[:3] == ['ros2', 'run', 'pam_ros']:
        check_program(words[3], words[4:])
    elif words[:3] == ['ros2', 'launch', 'pam_ros']:
        check_launch(words[3:])
    elif words[:3] in (['ros2', 'param', 'describe'], ['ros2', 'param', 'get']):
        assert words[3].lstrip('/') in PROGRAMS
    elif words[:3] == ['ros2', 'param', 'set']:
        assert words[3] == '/pam_sim'
        assert words[4] in Scene({}).table()
    elif words[:3] == ['ros2', 'service', 'call']:
        services = {'pause': 'SetBool', 'step': 'Trigger', 'reset': 'Trigger'}
        assert words[4] == f'std_srvs/srv/{services[words[3].removeprefix("/pam_sim/")]}'
    elif words[:3] == ['ros2', 'action', 'send_goal']:
        name, kind, goal = words[4:]
        assert words[3] == '--feedback'
        assert name == '/pam_control/follow_joint_trajectory'
        assert kind == 'control_msgs/action/FollowJointTrajectory'
        fields = (ROOT / 'test/interfaces' / f'{kind}.action').read_text(encoding='utf-8')
        for field in yaml.safe_load(goal):
            assert re.search(rf' {field}$', fields.partition('---')[0], re.MULTILINE)
    elif words[:3] == ['ros2', 'topic', 'pub']:
        topics = dict.fromkeys(
            ('/pressure_command', '/position_reference', '/co_contraction_reference'), 'Float64'
        )
        topics['/pressure_commands'] = 'Float64MultiArray'
        (topic,) = set(words) & set(topics)
        assert f'std_msgs/msg/{topics[topic]}' in words
    else:
        assert ' '.join(words).startswith(OF_OTHERS), words


@each_page
def test_commands_exist(page):
    with no_error():  # a page may have none
        for words in commands(page):
            if words[0] == 'export':
                assert all(SETTING.match(word) for word in words[1:])
            else:
                check(words[1:] if SETTING.match(words[0]) else words)


def test_a_block_that_starts_one_program_by_ros2_starts_all_so():
    """In a workspace they are not on the path."""
    shown = [b for page in PAGES for kind in ('bash', 'console') for b in blocks(page, kind)]
    by_ros2 = [block for block in shown if 'ros2 run pam_ros' in block]
    assert by_ros2
    for block in by_ros2:
        first = {line.removeprefix('$ ').partition(' ')[0] for line in block.splitlines()}
        assert first.isdisjoint(PROGRAMS), block


def test_a_transform_waits_for_its_topic():
    """It ends at once where nobody publishes yet."""
    transform = ['ros2', 'run', 'topic_tools', 'transform']
    shown = [words for page in PAGES for words in commands(page) if words[:4] == transform]
    assert shown
    for words in shown:
        assert '--wait-for-start' in words


def test_the_readme_shows_how_to_begin():
    shown = {' '.join(words) for words in commands(README)}
    assert {'make demo', 'make test', 'colcon build'} <= shown


def test_the_readme_is_short():
    assert len(text_of(README).splitlines()) <= LONGEST


def test_all_pages_are_checked():
    written = set(ROOT.glob('*.md')) | set(DOCS.rglob('*.md'))
    assert set(PAGES) == written | set(DOCS.rglob('*.ipynb'))
    assert {ROOT / 'ARCHITECTURE.md', DOCS / 'tutorials' / 'your_own_rig.md'} <= written


def test_the_readme_names_every_command_of_its_own():
    text = text_of(README)
    for name in PROGRAMS:
        assert name in text


def test_a_wrong_command_would_be_found():
    for command in (
        'make dmeo',
        'make bench ARGS=plant_stop',
        "make bench ARGS='tracing --fist'",
        'ros2 run pam_ros pam_sum',
        'ros2 run pam_ros pam_excite --dry --ros-args',
        'ros2 launch pam_ros sim.launch.py muscel:=dmsp_10',
    ):
        with pytest.raises(AssertionError):
            check(shlex.split(command))
    for command in (
        'ros2 run pam_ros pam_sim --ros-args -p mas:=3.0',
        'ros2 run pam_ros pam_control --ros-args -p joint:=knee',
        'ros2 run pam_ros pam_excite --ros-args -p muscle:=dmsp_99',
    ):
        with pytest.raises(ParameterError):
            check(command.split())
    with pytest.raises(SystemExit):
        check(['pam_identify', 'monday', '--parms', 'dmsp_10', '--out', 'report'])
    with pytest.raises(SystemExit):
        check(['pam_command', 'presure', '3bar'])
    with pytest.raises(AssertionError):
        check(['pam_command', 'get', 'mas_'])


@each_page
def test_links_lead_somewhere(page):
    def is_good(target):
        file, _, anchor = target.partition('#')
        path = (page.parent / file).resolve() if file else page
        is_there = path.exists() and ROOT in path.parents
        return is_there and (not anchor or anchor in anchors(path))

    assert [target for target in links(page) if not is_good(target)] == []


def test_every_page_is_in_the_index():
    """The pages of the effects are in the index of the effects."""
    index, of_effects = DOCS / 'README.md', DOCS / 'effects.md'
    listed = {(DOCS / target.partition('#')[0]).resolve() for target in links(index)}
    listed |= {(DOCS / target).resolve() for target in links(of_effects) if '#' not in target}
    assert set(PAGES) - {index} <= listed


@cache
def sources():
    files = (path for f in ('pam_ros', 'benchmarks') for path in (ROOT / f).rglob('*'))
    texts = (path for path in files if path.suffix in ('.py', '.j2'))
    return '\n'.join(path.read_text(encoding='utf-8') for path in texts)


@each_page
def test_files_that_a_page_names_exist_or_are_written(page):
    def is_known(name):
        here = list(ROOT.glob(name)) or list(ROOT.glob(f'[!.]*/**/{name}'))
        # What is not in the repository is left by a program of it, which then names it.
        texts = (f"'{name}'", f"'{Path(name).name}'")
        return here or any(one in sources() for one in texts)

    files = {name for name in names(page) if FILE.fullmatch(name)} - OF_AN_EXAMPLE
    assert [name for name in files if not is_known(name)] == []


PICTURES = sorted(path for path in (DOCS / 'images').rglob('*') if path.is_file())


@pytest.mark.parametrize('picture', PICTURES, ids=lambda path: path.name)
def test_pictures_are_small_and_shown(picture):
    assert picture.suffix == '.png'
    assert picture.stat().st_size < LARGEST
    shown = {(page.parent / target).resolve() for page in PAGES for target in links(page)}
    assert picture in shown


def test_verdicts_are_those_of_the_report():
    schema = json.loads(text_of(ROOT / 'docs' / 'report.schema.json'))
    verdicts = schema['properties']['verdict']['enum']
    page = text_of(DOCS / 'report.md')
    shown = [row[0].strip('`') for row in rows(page) if row[0].strip('`') in verdicts]
    assert sorted(shown) == sorted(verdicts)
