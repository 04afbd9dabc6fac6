# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Any values for the parameters of both nodes: refused with a sentence, or within their range.

What is accepted works: the law gives pressures that the muscles permit, the rig has a start.
"""

import math
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pam_ros.control.signals import Reference
from pam_ros.errors import PamError
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.settings.control import settings_of
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, override, rig_table
from pam_ros.simulator.initial import initial_state
from support.bad_values import ANY, TEXTS, YAML_TRAPS, fits, values

KINDS = [kind.name for kind in ARRANGEMENTS]
MOST = 3  # parameters that are given at once
ROOMY = settings(suppress_health_check=list(HealthCheck))


def scene_of(given):
    """Return table and builder of a simulator, as ``settings_of`` does of a controller."""
    scene = Scene(given)
    return scene.table(), scene.build


TABLES = {(of, kind): of({'joint': kind})[0] for of in (settings_of, scene_of) for kind in KINDS}


@st.composite
def parameters(draw, of):
    """Draw a kind of joint and some parameters of it, as a node is started with them."""
    kind = draw(st.sampled_from(KINDS))
    table = TABLES[of, kind]
    names = draw(st.lists(st.sampled_from(sorted(table)), min_size=1, max_size=MOST, unique=True))
    given = {'joint': kind, **{name: draw(values(*picked(table, name))) for name in names}}
    if draw(st.integers(0, 9)) == 0:  # a name that is nearly one, or one of something else
        near = names[0] + draw(st.sampled_from(('s', '_', '.', '.x', '')))
        given[
            draw(st.sampled_from((near, 'effects.', 'effects.creep', 'a.b', '', 'initial.x')))
        ] = draw(ANY)
    return given


def picked(table, name):
    kind, _, about = table[name]
    return kind, about


def accepted(of, given):
    """Return table, values and what they make, or None for a set that is refused."""
    try:
        table, build = of(given)
        found = checked(table, given)
        return table, found, build(found)
    except PamError as error:
        check_sentence(error)
        return None


def check_sentence(error):
    """Check that an error can be shown in one line."""
    assert str(error)
    assert str(error).isprintable()


def check_range(table, found):
    for name, (kind, _, about) in table.items():
        assert fits(found[name], kind, about), (name, found[name])


@ROOMY
@given(parameters(settings_of))
def test_a_controller(given):
    made = accepted(settings_of, given)
    if made is None:
        return
    table, found, setup = made
    check_range(table, found)
    middle = 0.5 * (setup.law.reach[0] + setup.law.reach[1])
    assert math.isfinite(middle)
    law = setup.law.make_law()
    law.start(middle)
    period = 1.0 / setup.settings.rate
    for _ in range(3):
        pressures = law.update(period, Reference(middle), middle)
    for pressure, muscle in zip(pressures, setup.law.joint.muscles, strict=True):
        assert muscle.p_min <= pressure <= muscle.p_max


@ROOMY
@given(parameters(scene_of))
def test_a_simulator(given):
    made = accepted(scene_of, given)
    if made is None:
        return
    table, found, simulation = made
    check_range(table, found)
    with suppress(PamError):  # a load that rests nowhere
        assert all(np.all(np.isfinite(each)) for each in initial_state(simulation))


@ROOMY
@given(st.sampled_from(sorted(TABLES[scene_of, 'load'])), st.sampled_from(TEXTS))
def test_an_override_of_a_command_line(name, text):
    table = TABLES[scene_of, 'load']
    try:
        found, value = override(f'{name}={text}', table)
    except PamError as error:
        check_sentence(error)
    else:
        assert found == name
        assert fits(value, *picked(table, name))


@pytest.fixture(scope='module')
def file(tmp_path_factory):
    return tmp_path_factory.mktemp('bad') / 'rig.yaml'


@ROOMY
@given(st.sampled_from(sorted(TABLES[scene_of, 'load'])), st.sampled_from(YAML_TRAPS))
def test_a_parameter_file(file, name, text):
    file.write_text(f'/**:\n  ros__parameters:\n    {name}: {text}\n')
    try:
        nominal = nominal_joint(file)
    except PamError as error:
        check_sentence(error)
    else:
        known = rig_table(nominal.kind)
        for flat, value in nominal.flat().items():
            assert fits(value, *picked(known, flat)), flat
