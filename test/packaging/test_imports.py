# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Who imports whom in ``pam_ros``: no circles, floors from bottom to top, ROS in one room alone.

Found in the sources without running them, so that imports in functions, and those that are for
types alone, count as well.
"""

import sys
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from support.imports import imported, modules_of
from support.pages import code, rows, text_of

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / 'pam_ros'
FILES = sorted(path.relative_to(ROOT) for path in PACKAGE.rglob('*.py'))
# From bottom to top. A room is a folder or a module; it imports from itself and lower floors.
FLOORS = (
    (
        *('pam_ros.cached_property', 'pam_ros.code_cache', 'pam_ros.errors'),
        *('pam_ros.processes', 'pam_ros.timing'),
    ),
    ('pam_ros.compiled', 'pam_ros.parallel', 'pam_ros.similar_names'),
    ('pam_ros.arguments', 'pam_ros.constructors', 'pam_ros.plain_yaml'),
    ('pam_ros.recording', 'pam_ros.units', 'pam_ros.version'),
    ('pam_ros.parameters',),
    ('pam_ros.muscle',),
    ('pam_ros.effects', 'pam_ros.excitation'),
    ('pam_ros.rig',),
    ('pam_ros.sizes',),
    ('pam_ros.control', 'pam_ros.devices', 'pam_ros.identification'),
    ('pam_ros.settings',),
    ('pam_ros.presets', 'pam_ros.report', 'pam_ros.simulator'),
    (
        *('pam_ros.batch', 'pam_ros.bench', 'pam_ros.command', 'pam_ros.demo'),
        *('pam_ros.health', 'pam_ros.plot'),
    ),
    ('pam_ros.nodes.common',),
    (
        'pam_ros.nodes.command',
        'pam_ros.nodes.control',
        'pam_ros.nodes.demo',
        'pam_ros.nodes.excite',
        'pam_ros.nodes.plot',
        'pam_ros.nodes.record',
        'pam_ros.nodes.sim',
    ),
    ('pam_ros.nodes.bench',),
    ('pam_ros.cli',),
    ('pam_ros',),  # the public face names what users need of all rooms
)
MOST_MODULES = 25  # in one folder
ROS = {
    *('ament_index_python', 'builtin_interfaces', 'diagnostic_msgs', 'geometry_msgs'),
    *('rcl_interfaces', 'rclpy', 'rosgraph_msgs', 'sensor_msgs', 'std_msgs', 'std_srvs'),
    'trajectory_msgs',
}
# What the other rooms may import in addition to themselves and Python's own library.
ALLOWED = {
    *('bokeh', 'distributed', 'jinja2', 'matplotlib', 'mcap', 'numba', 'numpy', 'openpyxl'),
    *('rosbags', 'scipy'),
    *('tqdm', 'yaml'),
    'pam_ros',
}

ROOMS = [room for floor in FLOORS for room in floor]


def is_node(path):
    return path.parts[1] == 'nodes'


def name_of(path):
    parts = path.with_suffix('').parts
    return '.'.join(parts[:-1] if parts[-1] == '__init__' else parts)


NAMES = {name_of(path): path for path in FILES}
ARROWS = {
    (name, other)
    for name, path in NAMES.items()
    for other in modules_of(ROOT / path, NAMES)
    if other in NAMES
}


def room_of(name):
    """Return the innermost room that a module is in."""
    return max((room for room in ROOMS if f'{name}.'.startswith(f'{room}.')), key=len)


def floor_of(room):
    return next(number for number, floor in enumerate(FLOORS) if room in floor)


def upward(arrows):
    """Return the arrows that go up, or to another room on the same floor."""
    rooms = {arrow: tuple(map(room_of, arrow)) for arrow in arrows}
    return {
        arrow
        for arrow, (room, other) in rooms.items()
        if room != other and floor_of(room) <= floor_of(other)
    }


def circle(arrows):
    """Return the modules of a circle, one after the other; none where there is no circle."""
    imports = {}
    for name, other in arrows:
        imports.setdefault(name, set()).add(other)
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return error.args[1]
    return []


def test_every_module_is_in_a_room():
    assert {name for name in NAMES if room_of(name) == 'pam_ros'} == {'pam_ros', 'pam_ros.nodes'}


def test_every_room_is_there_and_on_one_floor():
    assert len(set(ROOMS)) == len(ROOMS)
    assert set(ROOMS) <= set(NAMES)


# A constructor of a class in another form: it imports what makes its objects when it is called.
CONSTRUCTORS = {('pam_ros.recording.recording', 'pam_ros.recording.read')}


def test_no_circle():
    assert CONSTRUCTORS <= ARROWS
    assert circle(ARROWS - CONSTRUCTORS) == []


def test_rooms_import_from_lower_floors():
    assert upward(ARROWS) == set()


def test_packages_other_than_nodes_do_not_import_ros():
    for path in FILES:
        if not is_node(path):
            assert imported(ROOT / path) - sys.stdlib_module_names <= ALLOWED, path


def test_modules_of_the_nodes_import_ros_themselves():
    for path in FILES:
        if is_node(path) and path.stem != '__init__':
            assert imported(ROOT / path) & ROS, path


def test_folders_can_be_overlooked():
    counts = Counter(path.parent for path in FILES if path.stem != '__init__')
    assert max(counts.values()) <= MOST_MODULES


def test_the_page_on_the_architecture_shows_these_floors():
    table = rows(text_of(ROOT / 'ARCHITECTURE.md'))[: len(FLOORS)]
    assert [number for number, _, _ in table] == [str(n + 1) for n in range(len(FLOORS))]
    shown = [
        {
            f'pam_ros.{name.replace("/", ".")}'.replace('pam_ros.pam_ros', 'pam_ros')
            for name in code(cell)
        }
        for _, cell, _ in table
    ]
    assert shown == [set(floor) for floor in FLOORS]
