# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A new effect is one file and one line: all that uses effects knows it then.

The example of docs/tutorials/add_an_effect.md is written into a copy of the sources, and looked
for there by a Python of its own.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PARTS = ('pam_ros', 'config', 'docs', 'tools')
NEW, LINE = Path('pam_ros/effects/choked_valve.py'), Path('pam_ros/effects/__init__.py')
ASKED = """
import json, sys
sys.modules['numba'] = None  # some steps as plain Python take less than to compile the kernel
import numpy as np
import pam_ros
from pam_ros.control.compensation import left_to_feedback
from pam_ros.effects import EFFECTS
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.unknowns import effect_unknowns
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.run import simulate
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, rig_table

given = {'effects.choked_valve.slowness': 2e-6}
scene = Scene(given)
(joint,) = scene.build(checked(scene.table(), given)).joints
t = np.array([0.0, 0.1, 0.2, 0.3])
run = simulate(joint, t, [2e5, 3e5], [0.0, 0.1])
other = simulate(
    joint, t, [2e5, 3e5], [0.0, 0.1], hidden={'choked_valve': {'pressure': -1e4}}
)
(new,) = (effect for effect in EFFECTS if effect.name == 'choked_valve')
place = places_of(joint)[new.name]
sys.path.insert(0, 'tools')
import effect_pages
from types import SimpleNamespace
text = effect_pages.with_tables(effect_pages.GUIDE.read_text())
page = effect_pages.page(new, SimpleNamespace(rms=1.0, largest=2.0))
print(json.dumps({
    'library': [effect.name for effect in EFFECTS],
    'public': pam_ros.ChokedValve.name,
    'arrangements': [
        'effects.choked_valve.slowness' in rig_table(kind) for kind in ARRANGEMENTS
    ],
    'pressure': list(run.pressure),
    'hidden': other.pressure[0],
    'candidates': [effect.name for effect in single_muscle_joint().library],
    'unknown': [u.name for u in effect_unknowns(joint, place, place.example)],
    'feedback': list(left_to_feedback(joint)),
    'rows': [line for line in text.splitlines() if line.startswith('| [`choked_valve')],
    'page': page.splitlines(),
}))
"""


def contents(folder):
    return {
        path.relative_to(folder): path.read_bytes()
        for part in PARTS
        for path in (folder / part).rglob('*')
        if path.is_file() and '__pycache__' not in path.parts
    }


@pytest.fixture(scope='module')
def found(tmp_path_factory):
    """Return what is known of the new effect, and which files were touched for that."""
    folder = tmp_path_factory.mktemp('sources')
    for part in PARTS:
        ignored = shutil.ignore_patterns('__pycache__')
        shutil.copytree(ROOT / part, folder / part, ignore=ignored)
    before = contents(folder)
    guide = (ROOT / 'docs' / 'tutorials' / 'add_an_effect.md').read_text(encoding='utf-8')
    example, _ = re.findall(r'^```python\n(.*?)^```', guide, re.MULTILINE | re.DOTALL)
    (folder / NEW).write_text(example, encoding='utf-8')
    (line,) = re.findall(r'^```text\n(from .*\n)```', guide, re.MULTILINE)
    library = (folder / LINE).read_text(encoding='utf-8')
    before_it = 'from pam_ros.effects.pressure_lag import PressureLag as PressureLag\n'
    assert before_it in library
    (folder / LINE).write_text(library.replace(before_it, before_it + line), encoding='utf-8')
    after = contents(folder)
    touched = {
        path: (before.get(path, b'').decode().splitlines(), text.decode().splitlines())
        for path, text in after.items()
        if before.get(path) != text
    }
    done = subprocess.run(
        [sys.executable, '-c', ASKED],
        cwd=folder,
        env={**os.environ, 'PYTHONPATH': str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return touched, json.loads(done.stdout)


@pytest.mark.slow
def test_one_file_is_new_and_one_has_one_more_line(found):
    touched, _ = found
    assert set(touched) == {NEW, LINE}
    assert touched[NEW][0] == []
    was, now = touched[LINE]
    new = [line for line in now if line not in was]
    assert new == ['from pam_ros.effects.choked_valve import ChokedValve as ChokedValve']
    assert [line for line in now if line not in new] == was


def test_it_acts_where_its_line_stands_and_every_joint_can_have_it(found):
    _, known = found
    library = known['library']
    assert library[library.index('pressure_lag') + 1] == 'choked_valve'
    assert known['candidates'] == library
    assert known['public'] == 'choked_valve'
    assert all(known['arrangements'])


def test_it_is_simulated_and_its_hidden_state_can_be_set(found):
    _, known = found
    # 1 Pa in 2 us is 50 kPa in 0.1 s.
    assert known['pressure'] == pytest.approx([2e5, 2e5, 2.5e5, 3e5])
    assert known['hidden'] == pytest.approx(1.9e5)


def test_it_is_in_identification_control_and_page(found):
    _, known = found
    assert known['unknown'] == ['effects.choked_valve.slowness']
    assert known['feedback'] == ['choked_valve']
    of_effect, of_experiment = known['rows']
    assert 'ramps of pressure after steps' in of_effect
    assert of_experiment.endswith('pressure measured: a lag takes as long for both |')
    page = known['page']
    assert page[0] == '# choked_valve'
    assert '- Source: ISO 6358, sonic flow.' in page
    assert 'dp/dt = sign(p_in - p) / slowness until p = p_in' in page
    assert "$ ros2 run pam_ros pam_excite --ros-args -p segments:='[steps]'" in page
    (parameter,) = (line for line in page if line.startswith('| **`effects.choked_valve.'))
    assert 'time for each Pa of change' in parameter
