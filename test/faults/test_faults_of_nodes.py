# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node is killed, stopped or ended while the others run, and comes again.

Where nothing controls the load, the valve lets it down after its time-out. At all times it moves
within the configured limits.
"""

import signal

import pytest

from support.control_watch import stamp
from support.station import AWAY, FASTEST, JUMP, RATE, Station, fastest

STOPPED = 1.5 * AWAY  # s
SECOND = 10**9

pytestmark = pytest.mark.usefixtures('turn')


@pytest.fixture(scope='module')
def running(module_peer, tmp_path_factory):
    with Station(module_peer, tmp_path_factory.mktemp('bags')) as station:
        yield station


@pytest.fixture
def station(running):
    """Return the three programs, the load at rest where it was moved to."""
    for name, program in running.programs.items():
        if not program.is_running:  # a test before has failed
            since = running.mark()
            running.start(name)
            if name != 'pam_record':
                running.controls_again(since)
    if not running.is_held():
        running.move()
    return running


def check_begin(station, since):
    """Check that control began without a jump, and that the load can be moved as before."""
    jump = station.controls_again(since)
    print(f'jump {1e3 * jump:.4f} mm')
    assert jump < JUMP
    station.move()


def test_a_simulator_that_ends(station, kind, code):
    assert station.end('pam_sim', kind) == code
    station.vents()
    since = station.mark()
    station.start('pam_sim')  # with pressure, at rest: a command to vent would drop the load
    check_begin(station, since)
    assert fastest(station.states[since[0] :]) < FASTEST


def test_a_simulator_that_is_stopped(station):
    with station.stopped('pam_sim'):
        station.peer.work(STOPPED)
        since = station.mark()
    check_begin(station, since)
    assert fastest(station.states[since[0] :]) < FASTEST


def test_a_controller_that_ends(station, kind, code):
    first = len(station.states)
    assert station.end('pam_control', kind) == code
    station.is_let_down()
    since = station.mark()
    station.start('pam_control')
    check_begin(station, since)
    assert fastest(station.states[first:]) < FASTEST


def test_a_controller_that_is_stopped(station):
    first = len(station.states)
    with station.stopped('pam_control'):
        station.peer.work(STOPPED)
        station.is_let_down()
        since = station.mark()
    check_begin(station, since)
    assert fastest(station.states[first:]) < FASTEST


def test_a_recorder_that_ends(station, kind, code):
    station.is_recording()
    first = len(station.states)
    bag, last = station.bag, station.states[-1]
    assert station.end('pam_record', kind) == code
    station.start('pam_record')
    station.is_recording()
    check_undisturbed(station, first)
    found = station.recorded(bag)
    # One that ends by itself loses nothing, but messages come some ms apart.
    lost = SECOND if kind == signal.SIGKILL else SECOND // 10
    for topic, messages in found.items():
        assert messages[-1][0] >= round(stamp(last) * SECOND) - lost, topic


def test_a_recorder_that_is_stopped(station):
    station.is_recording()
    first, bag = len(station.states), station.bag
    with station.stopped('pam_record'):
        station.peer.work(STOPPED)
        counts = station.counts()
    woke = station.states[-1]
    # More than had come in the moment before the stop: the middleware reconnects them.
    station.peer.until(
        lambda: all(n > counts[topic] + RATE / 5 for topic, n in station.counts().items()),
        'more messages in the bag',
    )
    assert station.end('pam_record', signal.SIGINT) == 0
    station.start('pam_record')
    station.is_recording()
    check_undisturbed(station, first)
    found = station.recorded(bag)
    for topic, messages in found.items():
        assert messages[-1][0] >= round(stamp(woke) * SECOND), topic


def check_undisturbed(station, first):
    """Check that the load was held all the time since state number *first*, and can be moved."""
    positions = [one.position[0] for one in station.states[first:]]
    jump = max(positions) - min(positions)
    print(f'jump {1e3 * jump:.4f} mm')
    assert jump < JUMP
    station.move()
