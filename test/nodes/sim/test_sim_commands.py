# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` does with bad commands and with none, and what it says of them."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from support.harness import Program

AMBIENT = 101325.0


class Watch:
    """Gauge pressure and diagnostics of one simulator."""

    def __init__(self, peer):
        self.peer = peer
        self.pressures = peer.collect(FluidPressure, 'pressure')
        self.states = peer.collect(JointState, 'joint_states')
        self.arrays = peer.collect(DiagnosticArray, '/diagnostics')
        self.seen = 0  # of the pressures

    def command(self, value):
        self.peer.publish(Float64(data=value), 'pressure_command')

    def pressure_becomes(self, gauge):
        """Wait for a pressure among those that came since the last one that was waited for."""

        def find():
            for i in range(self.seen, len(self.pressures)):
                if abs(self.pressures[i].fluid_pressure - AMBIENT - gauge) < 1:
                    self.seen = i
                    return True
            return False

        self.peer.until(find, f'{gauge} Pa')

    def status(self, part, condition):
        """Wait for a status of a part that fulfils *condition*; return it and its values."""

        def find():
            for array in reversed(self.arrays):
                for status in array.status:
                    values = {v.key: v.value for v in status.values}
                    if status.name == f'pam_sim: {part}' and condition(status, values):
                        return status, values
            return None

        return self.peer.until(find, f'diagnostics of {part}')


@pytest.fixture
def watch(peer):
    return Watch(peer)


@pytest.mark.at_any_pace
def test_bad_commands_are_clamped_or_refused_counted_and_named(watch):
    with Program('pam_sim', parameters={'command_timeout': 0.0}) as sim:
        watch.status('commands', lambda s, v: s.message == 'no command yet')
        watch.command(300e3)
        watch.pressure_becomes(300e3)
        for bad in (math.nan, math.inf, -math.inf):
            watch.command(bad)
        _, values = watch.status('commands', lambda s, v: v['refused'] == '3')
        assert 'inf' in values['last reason']
        assert values['accepted'] == '1'
        watch.pressure_becomes(300e3)  # the last valid one stays in force
        watch.command(-5.0)
        watch.pressure_becomes(0.0)
        watch.command(601e3)
        watch.pressure_becomes(600e3)
        status, values = watch.status('commands', lambda s, v: v['clamped'] == '2')
        assert status.level == DiagnosticStatus.OK
        assert '601000' in values['last reason']
        assert values['last command (Pa)'] == '601000'
        said = sim.output
        assert 'nan is not finite' in said
        assert said.count('is not finite') < 3  # throttled
        assert '-5' in said
        # The last command is above a new limit.
        assert watch.peer.set_one('pam_sim', p_max=4.5e5).successful
        watch.pressure_becomes(4.5e5)
    for message in watch.states:
        assert math.isfinite(message.position[0] + message.velocity[0] + message.effort[0])


@pytest.mark.at_any_pace
def test_commands_in_kpa_are_mentioned(watch):
    with Program('pam_sim', parameters={'command_timeout': 0.0}) as sim:
        watch.status('commands', lambda s, v: s.message == 'no command yet')
        watch.command(300.0)
        status, _ = watch.status('commands', lambda s, v: 'Pa only' in s.message)
        assert status.level == DiagnosticStatus.WARN
        assert status.message.startswith('commands reach 300 Pa only')
        watch.peer.until(lambda: 'are these in kPa or bar' in sim.output, 'the line of the log')
        watch.command(300e3)
        watch.status('commands', lambda s, v: s.message == 'commanded')


@pytest.mark.at_any_pace
def test_silence_vents_and_a_new_command_is_obeyed(watch):
    with Program('pam_sim', parameters={'command_timeout': 0.3}):
        watch.command(4e5)
        watch.pressure_becomes(4e5)
        status, values = watch.status('commands', lambda s, v: s.level == DiagnosticStatus.WARN)
        assert status.message.endswith('vented')
        assert float(values['command age (s)']) > 0.3
        watch.pressure_becomes(0.0)
        watch.command(2e5)
        watch.pressure_becomes(2e5)


@pytest.mark.at_any_pace
def test_a_lost_load_is_reported_and_never_published(watch):
    given = {'initial.at_rest': False, 'initial.velocity': -100.0}  # no muscle holds that
    with Program('pam_sim', parameters=given) as sim:
        status, values = watch.status('timing', lambda s, v: s.level == DiagnosticStatus.ERROR)
        assert 'the state is invalid' in status.message
        assert values['paused'] == 'True'
        assert status.message in sim.output
        # Set right, it goes on.
        assert watch.peer.set_one('pam_sim', initial__velocity=0.0).successful
        assert watch.peer.call(Trigger, 'pam_sim/reset').success
        assert watch.peer.call(SetBool, 'pam_sim/pause', data=False).success
        watch.status('timing', lambda s, v: s.level == DiagnosticStatus.OK)
    assert all(abs(m.position[0]) < 0.4 for m in watch.states)


def test_diagnostics_tell_rate_and_lateness_once_a_second_and_sensors_have_their_faults(watch):
    given = {
        'initial.pressure': 250e3,
        'sensor.position_offset': 0.01,
        'sensor.position_noise': 20e-6,
        'sensor.pressure_noise': 500.0,
    }
    with Program('pam_sim', parameters=given):
        watch.peer.until(lambda: len(watch.arrays) >= 4, 'diagnostics')
        rest = watch.peer.get('pam_sim', 'l0')[0]
    statuses = {s.name: s for array in watch.arrays for s in array.status}
    parts = ('timing', 'commands', 'contraction', 'topics')
    assert set(statuses) == {f'pam_sim: {part}' for part in parts}
    values = {v.key: v.value for v in statuses['pam_sim: timing'].values}
    assert float(values['wanted publish rate (Hz)']) == 500.0
    assert float(values['publish rate (Hz)']) > 0.0
    assert int(values['overruns']) >= 0
    assert float(values['worst lateness (s)']) >= 0.0
    assert values['paused'] == 'False'
    stamps = [a.header.stamp.sec + a.header.stamp.nanosec * 1e-9 for a in watch.arrays]
    assert (stamps[-1] - stamps[0]) / (len(stamps) - 1) == pytest.approx(1.0, abs=0.4)
    # test/simulator/test_plant.py judges the noise.
    positions = [m.position[0] for m in watch.states]
    assert 0.0 < min(positions) - 0.01 < max(positions) - 0.01 < 0.3 * rest
    assert {m.variance for m in watch.pressures} == {250e3}
    assert len({m.fluid_pressure for m in watch.pressures}) > 0.9 * len(watch.pressures)
