# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The law on the rig itself: bounds, limits, starts, changes while it runs."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.limits import Limits
from pam_ros.control.pid import Pid
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import Payload, Slack
from pam_ros.errors import RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Pulley
from support import closed_loop, pair_loop
from support.bench import cart
from support.joint_loop import JOINTS
from support.joint_models import pair
from truth.effects import effect
from truth.pair import pair_plant

DT = 2e-3
DEGREE = math.radians(1.0)


@dataclass(frozen=True)
class Case:
    """A joint at a place; errors count in units of 1 mm or 1 degree, efforts are in N or N m."""

    joint: Joint
    begin: float
    pressures: tuple | None  # None: those at which it rests
    unit: float
    disturbance: float


ONE = closed_loop.nominal()
CASES = {
    'one muscle': Case(ONE, equilibrium(ONE, 300e3), (300e3,), 1e-3, 30.0),
    'pair': Case(pair(), 0.1, None, DEGREE, 1.0),
}
EACH = pytest.mark.parametrize('case', CASES.values(), ids=CASES)


def on_rig(law, case, way, seconds, effort=lambda t: 0.0):
    """Run *law* on the package's own rig; return t, e, s, and the commands of each muscle.

    The reference goes *way* (s -> m or rad) from the beginning, under an outside *effort*.
    """
    rig = Simulation([case.joint])
    law.start(case.begin, case.pressures)
    rig.reset(law.terms.pressures, [case.begin], [0.0])
    rows = []
    for n in range(round(seconds / DT)):
        t = n * DT
        goal, found = case.begin + way(t), float(rig.position[0])
        pressures = law.update(DT, Reference(goal), found)
        rows.append((t, goal - found, law.terms.surface, *pressures))
        # An outside effort is a change of pressures, against each other where there are two.
        gains = np.array(law.allocation.gains(found))
        rig.command(pressures + effort(t) * np.sign(gains) / np.sum(np.abs(gains)))
        rig.advance(2)
    t, e, s, *commands = np.array(rows).T
    return t, e, s, np.array(commands)


def still(t):
    return 0.0


@EACH
def test_surface_and_error_stay_within_the_bounds_of_the_boundary_layer(case):
    gains = Gains.for_joint(
        case.joint,
        learning=False,
        observer=False,
        rest_factor=1.0,
        velocity_bandwidth=500.0,
        disturbance_bound=2.0 * case.disturbance,
    )
    law = SlidingMode(case.joint, gains)
    model, pressures = law.model, case.pressures or law.terms.pressures
    stiffness = model.stiffness(pressures, case.begin) + model.gravity_stiffness(case.begin)
    frequency = math.sqrt(stiffness / model.inertia)
    # The worst there is: it changes sign with the surface's own frequency.
    worst = lambda t: math.copysign(case.disturbance, math.sin(frequency * t))  # noqa: E731
    _, e, s, _ = on_rig(law, case, still, 12.0, worst)
    width = case.disturbance / (model.inertia * gains.bandwidth)
    assert gains.boundary_width(model.inertia) == pytest.approx(2.0 * width)
    bound = gains.error_bound(case.disturbance, model.inertia, frequency)
    assert np.max(np.abs(s)) < 1.1 * width
    assert 0.1 * case.unit < np.max(np.abs(e))
    assert 0.1 * bound < np.max(np.abs(e)) < 1.1 * bound


@pytest.mark.parametrize('scale', [0.5, 1.5])
def test_coefficients_that_are_wrong_by_half_leave_no_error_at_rest(scale):
    # Lilly & Quesada 2004: the boundary layer holds under +-50 % of the model's coefficients.
    m = ONE.muscle
    wrong = Muscle(
        scale * m.a1, scale * m.a2, m.a3, scale * m.a4, scale * m.a5, scale * m.a6, zeta=0.15
    )
    law = SlidingMode(single_muscle_joint(wrong, Mass(mass=15.0)), Gains())
    _, e, _, (pressure,) = on_rig(law, CASES['one muscle'], lambda t: 0.005, 8.0)
    assert np.max(np.abs(e[-500:])) < 1e-6
    assert np.ptp(pressure[-500:]) < 100.0


@EACH
def test_integral_action_needs_no_observer(case):
    law = SlidingMode(case.joint, Gains.for_joint(case.joint, observer=False, learning=False))
    constant = 0.5 * case.disturbance
    _, e, *_ = on_rig(law, case, still, 8.0, lambda t: -constant if t > 0.5 else 0.0)
    assert np.max(np.abs(e)) > 0.1 * case.unit
    assert np.max(np.abs(e[-500:])) < 0.005 * case.unit


@EACH
@pytest.mark.parametrize('observer', [True, False])
def test_the_first_commands_are_the_pressures_that_are_there(case, observer):
    joint, begin = case.joint, 0.06
    law = SlidingMode(joint, Gains.for_joint(joint, observer=observer))
    one = len(joint.muscles) == 1
    for there in ((2e5, 1.5e5), (3e5, 3e5), (4.5e5, 2e5)):
        pressures = there[: len(joint.muscles)]
        law.start(begin, pressures)
        found = law.update(DT, Reference(begin), begin)
        # Two go on to the stiffness that is set.
        np.testing.assert_allclose(found, pressures, rtol=1e-9, atol=0.0 if one else 300.0)
    law.start(begin)
    found = law.update(DT, Reference(begin), begin)
    weight = float(statics.weight(joint, begin))
    assert law.model.effort(found, begin) == pytest.approx(weight, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize('hanging_at', [-0.8, 0.0, 0.6])
def test_an_arm_that_hangs_on_vented_muscles_stays_where_it_is(hanging_at):
    # Slack muscles hold nothing, where the bare law would let them push.
    slack = Actuator(effects=[Slack(share=1.0)], contraction=0.1)
    joint = Joint((slack, slack), Arm(hanging_at=hanging_at), Pulley())
    begin = equilibrium(joint, [0.0, 0.0])
    assert begin == pytest.approx(hanging_at, abs=0.01)
    law = SlidingMode(joint, Gains.revolute())
    case = Case(joint, begin, (0.0, 0.0), DEGREE, 0.0)
    _, e, *_ = on_rig(law, case, still, 2.0)
    assert np.max(np.abs(e)) < 0.1 * DEGREE
    assert law.terms.stiffness == pytest.approx(law.terms.co_contraction, rel=1e-3)


@pytest.mark.parametrize(
    'joint',
    [ONE, pair(), *(JOINTS[name] for name in ('parallel', 'lever', 'crank'))],
    ids=['one muscle', 'pair', 'parallel', 'lever', 'crank'],
)
def test_commands_stay_within_limits_of_pressure_and_rate(joint):
    law = SlidingMode(joint, Gains.for_joint(joint), Limits(100e3, 400e3, 1e6))
    (low, high), ends = law.allocation.reach, joint.position_range  # which is wider
    law.start(0.5 * (low + high))
    rng, last = np.random.default_rng(0), law.terms.pressures
    noise, seen = (1e-2 if joint.is_revolute else 1e-3), []
    for n in range(2000):
        goal = ends[0] if math.sin(0.01 * n) < 0.0 else ends[1]
        measured = 0.5 * (low + high) + noise * rng.standard_normal()
        pressures = law.update(DT, Reference(goal), measured)
        seen.append(np.abs(np.subtract(pressures, last)))
        assert all(100e3 <= now <= 400e3 for now in pressures)
        last = pressures
    assert np.max(seen) == pytest.approx(1e6 * DT, abs=1e-6)


@EACH
def test_it_does_not_wind_up_at_a_limit(case):
    law = SlidingMode(case.joint, Gains.for_joint(case.joint), Limits(pressure_high=350e3))
    far = law.allocation.reach[1] - case.begin + 0.5 * (0.03 if case.unit == 1e-3 else 1.0)
    t, e, _, pressures = on_rig(law, case, lambda t: far if 0.5 < t < 4.0 else 0.0, 6.0)
    first = pressures[0]
    assert np.all(first[(t > 2.0) & (t < 4.0)] == 350e3)
    assert law.terms.cut == 0.0
    # It leaves the limit at once: the error is that of a step, not of seconds of windup.
    assert first[np.searchsorted(t, 4.0) + 2] < 350e3
    assert np.min(e[t > 4.0]) > -0.65 * far
    assert np.max(np.abs(e[t > 5.5])) < 0.1 * case.unit


def test_a_load_without_a_spring_is_held_by_the_surface_alone():
    joint = cart(mass=10.0)
    law = SlidingMode(joint, Gains(learning=False, disturbance_bound=100.0))
    pulled_back = Case(joint, 0.0, (0.0,), 1e-3, 2.0)  # as nothing here can push
    _, e, *_ = on_rig(law, pulled_back, lambda t: 0.01 if t > 0.5 else 0.0, 12.0, lambda t: -2.0)
    assert e[-1] == pytest.approx(0.0, abs=1e-6)


@EACH
def test_measured_velocity_is_used_where_the_gains_say_so(case):
    for used, expected in ((True, 0.123), (False, 0.0)):
        law = SlidingMode(case.joint, Gains.for_joint(case.joint, use_measured_velocity=used))
        law.start(case.begin, case.pressures)
        law.update(DT, Reference(case.begin), case.begin, 0.123)
        assert law.terms.velocity == pytest.approx(expected, abs=1e-9)


@EACH
def test_gains_and_stiffness_can_change_in_flight_without_a_jump(case):
    joint, begin, goal = case.joint, case.begin, Reference(case.begin + 0.1 * case.unit)
    law = SlidingMode(joint, Gains.for_joint(joint, learning=False))
    law.start(begin, case.pressures)
    for _ in range(500):
        before = law.update(DT, goal, begin)
    gains = Gains.for_joint(joint, learning=False, bandwidth=30.0 if joint.is_revolute else 20.0)
    law.set_gains(gains)
    if len(joint.muscles) > 1:
        law.stiffen(1.3 * law.terms.co_contraction)
    after = law.update(DT, goal, begin)
    np.testing.assert_allclose(after, before, atol=1e3 * len(joint.muscles))


def test_a_stiffness_out_of_reach_is_refused_and_the_last_one_holds():
    law = SlidingMode(pair_loop.nominal(), Gains.revolute())
    law.start(0.2)
    law.stiffen(20.0)
    for bad in (500.0, 0.0, -3.0, math.nan, math.inf):
        with pytest.raises(RangeError, match='co-contraction'):
            law.stiffen(bad)
    for _ in range(500):
        law.update(DT, Reference(0.2), 0.2)
    assert law.terms.co_contraction == 20.0


def test_a_stiffness_that_the_angle_does_not_permit_is_reduced_and_restored():
    law = SlidingMode(pair_loop.nominal(), Gains.revolute())
    most = law.allocation.stiffness_range(0.0)[1]

    def there_and_back(t):
        return 0.0 if t < 2.0 else 0.3 - 0.3 * math.cos(math.pi * (t - 2.0))

    run = pair_loop.close_pair(law, pair_plant('nominal'), there_and_back, 4.0, lambda t: most)
    assert np.min(run.stiffness[1200:]) < 0.95 * most
    assert run.stiffness[-1] == pytest.approx(most, rel=0.01)
    assert np.max(np.abs(run.error)) < 0.2 * DEGREE


@pytest.mark.parametrize('law', [SlidingMode, Pid])
def test_an_effect_that_begins_later_is_not_known_to_the_law(law):
    """It holds the load that is there at the start; without the onset it would hold another."""
    weights = [Payload(mass=5.0)]
    late = [Payload(mass=5.0, onset=20.0)]
    laws = [law(single_muscle_joint(effects=effects)) for effects in ((), late, weights)]
    for each in laws:
        each.start(0.05, (3e5,))
    plain, later, loaded = (
        [each.update(DT, Reference(0.051), 0.05) for _ in range(50)] for each in laws
    )
    assert plain == later
    assert plain != loaded


@pytest.mark.parametrize('law', [SlidingMode, Pid])
@pytest.mark.parametrize('gap', [0.03, 0.01])
def test_the_load_leaves_a_stop_that_is_not_configured_when_the_reference_goes_back(law, gap):
    """The stop has some 1e6 N/m and loses no energy; the reference jumps without shaping."""
    rest = closed_loop.truth('nominal').y
    stop = (effect('end_stop', stop_m=rest + gap, stop_n_m15=3e7, stop_s_m=0.0),)
    plant = closed_loop.truth(stop, seed=1)
    law = law(closed_loop.nominal())
    law.start(plant.y, (plant.state.u,))
    measured, errors, reached = plant.measure(), [], 0.0
    for n in range(4000):
        goal = rest + (gap + 0.03 if 500 <= n < 2000 else 0.0)
        (pressure,) = law.update(DT, Reference(goal), measured)
        measured = plant.step(pressure, DT, 0.0)
        reached = max(reached, plant.y)
        errors.append(goal - plant.y)
    assert reached > rest + gap  # it was in the stop
    assert np.max(np.abs(errors[2750:])) < 2e-4  # 1.5 s later it has left the stop and rests
