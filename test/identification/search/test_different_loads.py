# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two recordings with two loads, of the truth plant, whose user states one load or both."""

from dataclasses import replace

import pytest

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.identification.identify import identify
from support import bench_truth
from truth import effect

LOADS = {'light.csv': 12.0, 'heavy.csv': 20.0}
pytestmark = pytest.mark.needs_numba


@pytest.fixture(
    scope='module',
    params=['nothing', pytest.param('friction', marks=pytest.mark.release)],
    ids=str,
)
def recordings(request):
    """Return a recording of each load, and the effects that the rig has."""
    names = ['coulomb_friction'] if request.param == 'friction' else []
    effects = [effect(name) for name in names]
    found = [
        bench_truth.free(*effects, mass=mass, seed=k, duration=20.0, name=name)
        for k, (name, mass) in enumerate(LOADS.items())
    ]
    return found, names


def test_no_effect_is_named_if_only_one_of_the_loads_is_stated(recordings):
    given, _ = recordings
    found = identify(bench_truth.nominal(), given)
    assert found.verdict == 'insufficient_data'
    assert found.effects == found.added == ()
    assert 'different loads' in found.sentence
    assert '--set mass=VALUE' in found.next_experiment
    with pytest.raises(ParameterError, match='different loads'):
        _ = found.joint


def test_stated_loads_are_those_of_the_simulations(recordings):
    given, effects = recordings
    stated = [replace(one, numbers={'mass': LOADS[one.name]}) for one in given]
    # The nominal mass is used by none of them.
    found = identify(bench_truth.nominal().with_load(mass=35.0), stated[:1], stated[1:])
    assert [one.name for one in found.effects] == effects
    assert found.verdict in ('effect_found', 'no_missing_effect')
    assert found.stages[2].held_error < 3.0 * found.noise.sigma
    run = found.simulate(stated[1])
    assert run.position == pytest.approx(found.stages[2].tested[0], abs=3.0 * found.noise.sigma)


def test_a_number_that_a_recording_states_is_not_uncertain(recordings):
    given, _ = recordings
    stated = replace(given[0], numbers={'mass': 12.0})
    with pytest.raises(RecordingError, match='states mass = 12, and mass is uncertain'):
        identify(bench_truth.nominal(), [stated], uncertain={'mass': '10%'})
    for numbers, words in (({'a1': 1.0}, 'a1 cannot differ'), ({'mass': -1.0}, 'mass = -1.0')):
        with pytest.raises(RecordingError, match=words):
            identify(bench_truth.nominal(), [replace(given[0], numbers=numbers)])
