# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of ``pam_sim`` over DDS: descriptions, refusals, atomicity, live change."""

import pytest
from rcl_interfaces.srv import ListParameters
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from pam_ros.settings.scene import Scene
from support.distribution import IS_JAZZY
from support.harness import Peer, Program

pytestmark = pytest.mark.at_any_pace

NODE = '/pam_sim'


@pytest.fixture(scope='module')
def sim(module_domain):
    """Return a peer of one simulator that all tests here share; each leaves it as it was."""
    with Peer() as peer, Program('pam_sim'):
        yield peer


def test_every_parameter_is_declared_described_and_has_its_default(sim):
    response = sim.call(ListParameters, f'{NODE}/list_parameters')
    names = [n for n in response.result.names if not n.startswith('qos_overrides.')]
    own = [n for n in names if n not in ('use_sim_time', 'start_type_description_service')]
    assert set(own) == set(Scene({}).table())
    for name, description in zip(own, sim.describe(NODE, *own), strict=True):
        kind, default, about = Scene({}).table()[name]
        assert about.text in description.description
        assert about.unit in description.description
        assert description.read_only is not about.live
        assert description.dynamic_typing is False
        if kind is float and None not in (about.low, about.high):
            (span,) = description.floating_point_range
            assert (span.from_value, span.to_value) == (about.low, about.high)
        (value,) = sim.get(NODE, name)
        assert type(value) is (list if kind is tuple else kind)
        assert kind(value) == default


def test_mass_is_described_with_unit_and_bounds(sim):
    (mass,) = sim.describe(NODE, 'mass')
    assert mass.description == 'mass of the load [kg]'
    assert mass.additional_constraints == 'above 0 and at most 10000 kg'


@pytest.mark.parametrize(
    ('values', 'named'),
    [
        ({'mass': -1.0}, ['mass', '-1']),
        ({'mass': 0.0}, ['mass', '0', 'above 0']),
        ({'mass': float('nan')}, ['mass', 'nan']),
        ({'mass': 1e4}, ['mass', '10000', 'load']),
        ({'mass': 'heavy'}, ['type', *(('DOUBLE', 'STRING') if IS_JAZZY else ("'3'", "'4'"))]),
        ({'mount': 'sideways'}, ['mount', 'sideways', 'vertical', 'horizontal']),
        ({'a3': 0.32866}, ['stiffness']),
        ({'on_timeout': 'explode'}, ['on_timeout', 'vent', 'hold']),
        ({'publish_rate': 2000.0}, ['publish_rate', '2000', 'physics_rate', '1000']),
        ({'mass': 1e-6}, ['mass', 'ms']),
        ({'initial__pressure': 700e3}, ['initial.pressure', '700000', 'p_max']),
        ({'effects__creep__nonsense': 1.0}, ['undeclared']),
    ],
)
def test_what_makes_no_model_is_refused_with_the_reason(sim, values, named):
    before = sim.get(NODE, *Scene({}).table())
    result = sim.set_together(NODE, **values)
    assert not result.successful
    for word in named:
        assert word in result.reason
    assert sim.get(NODE, *Scene({}).table()) == before


@pytest.mark.parametrize('name', ['physics_rate', 'pressure_unit', 'joint_name', 'muscle'])
def test_what_cannot_change_while_running_is_read_only(sim, name):
    (value,) = sim.get(NODE, name)
    result = sim.set_one(NODE, **{name: value})
    assert not result.successful
    assert 'read-only' in result.reason


def test_several_are_taken_together_or_not_at_all(sim):
    before = sim.get(NODE, 'mass', 'zeta')
    assert not sim.set_together(NODE, mass=10.0, zeta=-0.5).successful
    assert sim.get(NODE, 'mass', 'zeta') == before
    # The start is bound by the limit, so that only together they can go up.
    assert not sim.set_one(NODE, initial__pressure=650e3).successful
    assert sim.set_together(NODE, initial__pressure=650e3, p_max=700e3).successful
    assert not sim.set_one(NODE, p_max=600e3).successful
    assert sim.set_together(NODE, initial__pressure=0.0, p_max=600e3).successful


def test_a_whole_number_is_taken_for_a_float(sim):
    assert sim.set_one(NODE, mass=10).successful
    (value,) = sim.get(NODE, 'mass')
    assert type(value) is float
    assert value == 10.0
    assert sim.set_one(NODE, mass=20.0).successful


def test_a_change_acts_on_the_running_model(sim):
    force = sim.collect(Float64, 'force')

    def settles_at(newton):
        sim.until(
            lambda: len(force) > 50 and all(abs(m.data - newton) < 0.05 for m in force[-50:]),
            f'a force of {newton} N',
        )

    settles_at(20.0 * 9.80665)
    assert sim.set_one(NODE, mass=12.5).successful
    settles_at(12.5 * 9.80665)
    assert sim.set_together(NODE, mass=20.0, effects__payload__mass=5.0).successful
    settles_at(25.0 * 9.80665)
    assert sim.set_one(NODE, effects__payload__mass=0.0).successful
    settles_at(20.0 * 9.80665)


def test_the_publish_rate_can_change(sim):
    states = sim.collect(JointState, 'joint_states')

    def spacing_is(period):
        a, b = (m.header.stamp for m in states[-2:])
        return abs((b.sec - a.sec) * 10**9 + b.nanosec - a.nanosec - period) <= 1

    for rate, period in ((100.0, 10_000_000), (500.0, 2_000_000)):
        assert sim.set_one(NODE, publish_rate=rate).successful
        sim.more(states, 20)
        sim.until(lambda p=period: spacing_is(p), f'a sample every {period} ns')


def test_values_from_a_file_and_the_command_line(peer, tmp_path):
    file = tmp_path / 'rig.yaml'
    file.write_text(
        '/**:\n  ros__parameters:\n    mass: 7\n    effects: {payload: {mass: 2}}\n'
        'pam_control:\n  ros__parameters:\n    mass: 9.0\n'
    )
    arguments = ('-r', '__node:=filed', '--params-file', str(file))
    with Program('pam_sim', *arguments, parameters={'zeta': 0.25}):
        assert peer.get('/filed', 'mass', 'zeta', 'effects.payload.mass') == [7.0, 0.25, 2.0]


def test_a_named_muscle_gives_what_is_not_given(peer, tmp_path):
    file = tmp_path / 'mine.yaml'
    file.write_text('/**: {ros__parameters: {a2: 270.0, zeta: 0.3, l0: 0.5}}\n')
    given = {'muscle': str(file), 'zeta': 0.25}
    with Program('pam_sim', '-r', '__node:=named', parameters=given):
        assert peer.get('/named', 'a2', 'zeta', 'l0', 'mass') == [270.0, 0.25, 0.5, 20.0]
