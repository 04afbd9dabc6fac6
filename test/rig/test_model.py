# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What makes a rig, where it rests, and how short its steps must be."""

import numpy as np
import pytest

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.layout import EFFECTS_FROM, HIDDEN, layout_of
from pam_ros.rig.model import GRAVITY, Load, RigModel, start_effects, start_row
from support import paper

LAG = {'pressure_lag': {'fill': 0.1, 'vent': 0.2}}
SOURCE = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)


def test_it_rests_where_the_muscle_holds_the_load():
    model = RigModel()
    y = model.rest(6e5)
    assert paper.force(6.0, 100.0 * y / paper.L0) == pytest.approx(20.0 * GRAVITY, abs=1e-9)
    free = RigModel(load=Load(mount='horizontal'))
    assert paper.force(6.0, 100.0 * free.rest(6e5) / paper.L0) == pytest.approx(0.0, abs=1e-9)
    assert RigModel(SOURCE, Load(mount='horizontal')).rest(100.0) == 0.0


def test_an_undeclared_payload_moves_and_weighs():
    model = RigModel(effects={'payload': {'mass': 4.0}})
    assert model.moved_mass == 24.0
    assert model.weight == pytest.approx(24.0 * GRAVITY)
    assert model.rest(6e5) < RigModel().rest(6e5)


REFUSED = [
    (
        {'load': Load(mass=5000.0)},
        'mass = 5000 kg and this muscle make no rig: no equilibrium: at 0',
    ),
    ({'effects': {'magic': {}}}, 'effects.magic is not known: give one of dead_time, '),
    (
        {'effects': {'dead_time': {'time': 0.1}}},
        'effects.dead_time.time is not known: give one of delay',
    ),
    (
        {'effects': {'dead_time': {'delay': -0.1}}},
        'effects.dead_time.delay = -0.1 is not allowed: give 0 to 1 s',
    ),
    (
        {'muscle': Muscle(contraction_unit='fraction')},
        'mass = 20 kg and this muscle make no rig: no equilibrium: at 0 kPa the muscle pulls',
    ),
]


@pytest.mark.parametrize(('parts', 'sentence'), REFUSED)
def test_what_makes_no_rig_is_refused_with_a_sentence(parts, sentence):
    with pytest.raises(ParameterError) as error:
        RigModel(**parts)
    assert str(error.value).startswith(sentence)


@pytest.mark.parametrize(
    ('fields', 'sentence'),
    [
        ({'mass': 0.0}, 'mass = 0.0 is not allowed: give above 0 and at most 10000 kg'),
        ({'mount': 'tilted'}, "mount = 'tilted' is not allowed: give one of vertical, horizontal"),
    ],
)
def test_what_makes_no_load_is_refused_with_a_sentence(fields, sentence):
    with pytest.raises(ParameterError) as error:
        Load(**fields)
    assert str(error.value) == sentence


def test_the_longest_step_is_a_radian_of_the_stiffest_place_of_a_fall():
    """Let go at 25 % without pressure, by the paper's force and energy alone."""
    weight = 20.0 * paper.G
    y, v, h = 0.1, 0.0, 1e-4
    while v <= 0.0:  # an undamped fall until the muscle has stopped it
        v += h * (paper.force(0.0, 100.0 * y / paper.L0) - weight) / 20.0
        y += h * v
    stiffest = max(paper.stiffness(p, 100.0 * y / paper.L0) for p in (0.0, 6.0))
    expected = np.sqrt(20.0 / stiffest)
    assert RigModel().longest_step == pytest.approx(expected, rel=0.03)
    # A strongly damped rig creeps, but its fast root is 2 zeta times as fast: 9.9 at zeta 5.
    damped = RigModel(Muscle(zeta=5.0)).longest_step
    assert damped == pytest.approx(RigModel().longest_step / (5.0 + np.sqrt(24.0)))
    assert RigModel(SOURCE).longest_step == np.inf


def test_effects_are_active_together_as_soon_as_one_is_present():
    none = RigModel(effects={'dead_time': {'delay': 0.0}})
    assert (none.present, none.active) == ((), ())
    one = RigModel(effects={'dead_time': {'delay': 0.1}} | LAG)
    assert [effect.name for effect in one.present] == ['dead_time', 'pressure_lag']
    assert one.active == one.library
    assert (none.delay, one.delay) == (0.0, 0.1)


def test_rows_hold_everything_in_si():
    model = RigModel(effects=LAG)
    q = model.row()
    np.testing.assert_array_equal(q[:6], model.muscle.si)
    np.testing.assert_array_equal(q[6:EFFECTS_FROM], [0.15, 0.4, 20.0, GRAVITY])
    j = model.layout.parameter_at['pressure_lag']
    np.testing.assert_array_equal(q[j : j + 2], [0.1, 0.2])
    assert q.shape == (model.layout.parameters,)
    assert RigModel(load=Load(mount='horizontal')).row()[9] == 0.0


def test_every_effect_has_its_own_places_in_the_rows():
    layout = layout_of(RigModel().library)
    states, parameters = [], []
    for effect in layout.effects:
        i, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
        states += range(i, i + len(effect.states))
        parameters += range(j, j + len(effect.parameters))
        if effect.states:
            assert (i < layout.memory_from) == (effect.pressure is not None)
    assert sorted(states) == list(range(HIDDEN, layout.width))
    assert sorted(parameters) == list(range(EFFECTS_FROM, layout.parameters))


def test_a_start_is_a_long_rest():
    """A lagging chamber is full, and what is downstream of an offset has got it."""
    effects = LAG | {'pressure_offset': {'offset': 5e3}}
    model = RigModel(effects=effects)
    x = start_row(model.layout, model.row(), 2e5, 0.03, 0.1)
    assert list(x[:3]) == [0.03, 0.1, 2.05e5]
    assert x[model.layout.state_at['pressure_lag']] == 2.05e5


def test_one_effect_can_be_started_alone():
    model = RigModel(effects=LAG)
    x = start_row(model.layout, model.row(), 2e5, 0.03, 0.1)
    before = x.copy()
    lag = next(e for e in model.library if e.name == 'pressure_lag')
    assert start_effects((lag,), model.layout, model.row(), x, 4e5) == 4e5
    i = model.layout.state_at['pressure_lag']
    assert x[i] == 4e5
    x[i] = before[i]
    np.testing.assert_array_equal(x, before)
