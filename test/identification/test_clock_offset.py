# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs that precede their input: the offset is named, and nothing else is."""

from dataclasses import replace

import pytest

from pam_ros.identification.identify import identify
from support import results
from support.marks import at_release

FRICTION = {'effects.coulomb_friction.level': 12.0}
DELAY = {'effects.dead_time.delay': 0.04}
RATE = 100.0


def early(recording, offset):
    """Return *recording* with outputs *offset* s before the input that causes them."""
    rows = round(offset / recording.period)
    names = ('position', 'velocity', 'force')
    changes = {
        name: getattr(recording, name)[rows:]
        for name in names
        if getattr(recording, name) is not None
    }
    count = recording.t.size - rows
    changes |= {
        name: getattr(recording, name)[:count]
        for name in ('t', 'command_t', 'command', 'pressure')
        if getattr(recording, name) is not None
    }
    return replace(recording, **changes)


def free(name='bench.csv', seed=0, seconds=20.0, **values):
    return results.free_recording(results.rig(**values), seconds, RATE, seed, name)


def offsets_of(found):
    """Return what the warnings on the clocks of a result say: name -> ms."""
    lines = [text for text in found.warnings if 'which no rig can do' in text]
    return {text.split(':')[0]: float(text.split(' by ')[1].split()[0]) for text in lines}


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('values', 'offset', 'effects', 'seen'),
    [
        ({}, 0.1, [], 100.0),
        at_release(FRICTION, 0.03, ['coulomb_friction'], 30.0),
        at_release(DELAY, 0.1, [], 60.0),  # a dead time hides as much of the offset
        at_release(DELAY, 0.0, ['dead_time'], None),  # motion after its command has a cause
        at_release(DELAY, 0.02, ['dead_time'], None),
    ],
)
def test_the_offset_is_named_with_its_size_and_the_effect_of_the_rig(
    values, offset, effects, seen
):
    found = identify(results.rig(), [early(free(**values), offset)])
    assert [effect.name for effect in found.effects] == effects
    assert found.verdict == ('effect_found' if effects else 'no_missing_effect')
    assert found.stages[2].held_error < 1.5 * results.NOISE
    expected = {} if seen is None else {'bench.csv': pytest.approx(seen, abs=0.5)}
    assert offsets_of(found) == expected


@pytest.mark.needs_numba
@pytest.mark.release
def test_each_recording_has_its_own_offset_and_so_have_tests():
    given = [early(free('a', 1), 0.03), free('b', 2)]
    found = identify(results.rig(), given, [early(free('c', 3), 0.07)])
    assert found.verdict == 'no_missing_effect'
    expected = {'a': pytest.approx(30.0, abs=0.5), 'c': pytest.approx(70.0, abs=0.5)}
    assert offsets_of(found) == expected


@pytest.mark.needs_numba
@pytest.mark.release
def test_a_force_that_precedes_the_measured_pressure():
    given = [early(results.held_recording(results.rig(), 0.05, 20.0, RATE), 0.04)]
    found = identify(results.rig(), given)
    assert found.verdict == 'no_missing_effect'
    assert offsets_of(found) == {'kappa_5.csv': pytest.approx(40.0, abs=0.5)}


@pytest.mark.needs_numba
def test_recordings_that_only_decide_between_models_are_corrected_too():
    """With five recordings, one of them is not fitted."""
    names = [f'{k}.csv' for k in range(5)]
    given = [
        early(free(name, seed=k, seconds=8.0), 0.05 if k else 0.0) for k, name in enumerate(names)
    ]
    found = identify(results.rig(), given)
    assert found.effects == ()
    assert offsets_of(found) == pytest.approx(dict.fromkeys(names[1:], 50.0), abs=0.5)
