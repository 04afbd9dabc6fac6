# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Flat parameter names: both ways without loss, and nothing gets in that is not allowed."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.devices.sensors import Sensors
from pam_ros.effects import EFFECTS
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.arrangements import ARRANGEMENTS, LOAD
from pam_ros.rig.loads import Mass
from pam_ros.settings.nominal import NominalJoint
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.tables import (
    build,
    checked,
    effects_table,
    override,
    refuse_mistyped,
    refuse_unknown_effects,
    rig_table,
    table_of,
    with_defaults,
)

TABLE = rig_table()
FLOATS = sorted(name for name, (kind, _, _) in TABLE.items() if kind is float)


def inside(about):
    """Return a strategy for the values that a description allows."""
    low = -1e6 if about.low is None else about.low
    high = 1e6 if about.high is None else about.high
    return st.floats(low, high, exclude_min=about.above_low, allow_subnormal=False)


def test_the_table_has_every_effect_parameter_and_no_name_twice():
    # Each effect has an onset in addition to its own parameters.
    assert len(effects_table()) == sum(len(effect.parameters()) + 1 for effect in EFFECTS)
    assert len(TABLE) == len(table_of(Muscle)) + len(table_of(Mass)) + len(effects_table())
    some = {'a1', 'zeta', 'mass', 'mount', 'effects.payload.mass', 'effects.payload.onset'}
    assert some <= set(TABLE)


def test_no_name_is_so_like_another_that_it_would_be_taken_for_mistyped():
    for name in TABLE:
        assert refuse_mistyped([name], TABLE) == []


@pytest.mark.parametrize('kind', ARRANGEMENTS, ids=lambda kind: kind.name)
def test_each_arrangement_is_made_of_its_table(kind):
    """Its defaults make its joint, with the units of its coordinate and a contraction a muscle."""
    table = rig_table(kind)
    values = checked(table, {})
    (joint,) = RigParameters({'joint': kind.name}).build_joints(values)
    assert len(joint.actuators) == kind.muscles
    assert [one.contraction for one in joint.actuators] == [kind.contraction] * kind.muscles
    assert (joint.transmission, joint.load) == (kind.transmission(), kind.load())
    mountings = [name for name in table if name.startswith('contraction_') and name[-1].isdigit()]
    expected = [f'contraction_{i + 1}' for i in range(kind.muscles)] if kind.has_mounting else []
    assert mountings == expected
    friction = table['effects.viscous_friction.coefficient'][2].unit
    assert friction == ('N m s/rad' if joint.is_revolute else 'N s/m')
    assert not any(joint.present)


@given(st.sampled_from(FLOATS).flatmap(lambda n: st.tuples(st.just(n), inside(TABLE[n][2]))))
def test_what_is_allowed_is_taken_unchanged(item):
    name, value = item
    assert checked(TABLE, {name: value})[name] == value


@given(
    st.sampled_from(FLOATS),
    st.one_of(
        st.sampled_from([math.nan, math.inf, -math.inf, True, '1', None, (1.0,)]),
        st.floats(allow_nan=False),
    ),
)
def test_what_is_not_allowed_is_refused_by_name_and_value(name, value):
    about = TABLE[name][2]
    is_number = isinstance(value, float) and math.isfinite(value)
    fits = (
        is_number
        and (
            about.low is None or value > about.low or (value == about.low and not about.above_low)
        )
        and (about.high is None or value <= about.high)
    )
    if fits:
        assert checked(TABLE, {name: value})[name] == value
    else:
        with pytest.raises(ParameterError) as caught:
            checked(TABLE, {name: value})
        assert str(caught.value).startswith(f'{name} = {value!r} is not allowed: give ')


@given(st.integers(1, 60), st.floats(0.0, 1.0), st.sampled_from(['vertical', 'horizontal']))
def test_a_rig_goes_flat_and_comes_back(mass, zeta, mount):
    values = {'mass': mass, 'zeta': zeta, 'mount': mount, 'effects.payload.mass': 0.5}
    (model,) = RigParameters({}).build_joints(checked(TABLE, values))
    flat = NominalJoint(model, LOAD, ('muscle',), 'muscle').flat()
    (again,) = RigParameters({}).build_joints(flat)
    assert again.muscle == model.muscle
    assert again.load == model.load
    assert (again.parameters() == model.parameters()).all()
    assert type(again.load.mass) is float


def test_a_prefix_leads_the_names():
    assert set(table_of(Sensors, 'sensor.')) == {f'sensor.{n}' for n in table_of(Sensors)}
    sensors = build(Sensors, {'sensor.latency': 0.02, 'latency': 0.5}, 'sensor.')
    assert sensors.latency == 0.02


def test_other_defaults_are_checked_too():
    assert with_defaults(TABLE, {'mass': 7, 'stranger': 1})['mass'][1] == 7.0
    with pytest.raises(ParameterError, match='mass = -7'):
        with_defaults(TABLE, {'mass': -7})


def test_unknown_effects_and_their_parameters_are_named():
    with pytest.raises(ParameterError, match=r'effects\.creeep is not known'):
        refuse_unknown_effects({'effects.creeep.gain': 1.0})
    with pytest.raises(ParameterError, match=r'effects\.payload\.weight is not known'):
        refuse_unknown_effects({'effects.payload.weight': 1.0})
    refuse_unknown_effects({'effects.payload.mass': 1.0, 'robot': 'arm', 'arm.payload.weight': 1})


@pytest.mark.parametrize(
    ('text', 'name', 'value'),
    [
        ('mass=20', 'mass', 20.0),
        (' mass = 2e1 ', 'mass', 20.0),
        ('mount=horizontal', 'mount', 'horizontal'),
        ('source=a = b', 'source', 'a = b'),
        ('effects.payload.mass=-0.5', 'effects.payload.mass', -0.5),
    ],
)
def test_overrides_of_the_command_line(text, name, value):
    assert override(text, TABLE) == (name, value)


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('mass', 'give name=value'),
        ('mass=', 'give name=value'),
        ('=3', 'is not a parameter'),
        ('mas=20', 'was mass meant'),
        ('colour=20', 'colour is not a parameter'),
        ('mass=heavy', "mass = 'heavy' is not allowed"),
        ('mass=nan', 'mass = nan is not allowed'),
        ('mount=up', 'vertical, horizontal'),
    ],
)
def test_bad_overrides_are_refused_with_a_sentence(text, sentence):
    with pytest.raises(ParameterError, match=sentence):
        override(text, TABLE)


def test_strangers_are_returned_and_slips_refused():
    assert refuse_mistyped(['robot_name', 'mass'], TABLE) == ['robot_name']
    with pytest.raises(ParameterError, match='was zeta meant'):
        refuse_mistyped(['zetta'], TABLE)
