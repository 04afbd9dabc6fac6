# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What an effect is: parameters, hidden states, and equations at the places where it acts.

An effect is one file that ends in one :class:`Effect`; ``effects/__init__.py`` lists it. The
equations are plain scalar functions, compiled into the stepping kernel when numba is there. An
effect acts either in a muscle (and its pressure path) or on the joint that the muscles move; in
which units a joint that turns has it, says :mod:`pam_ros.effects.turned`.

Places, in the order in which the kernel visits them, with the function each expects:

``delay(q, j) -> s``
    Time by which pressure commands act late.
``pressure(p, t, h, x, i, xn, q, j) -> Pa``
    Pressure path from command to chamber; p is what comes from upstream and is constant over
    the interval of length h that ends at t; returns what goes downstream at its end.
``contraction(kappa, q, j) -> fraction``
    What the muscle feels as its contraction.
``mass(m, q, j) -> kg``
    The moved mass. It acts on the joint.
``force(f, p, kappa, v, t, h, x, i, xn, q, j) -> N``
    The muscle's pull, after the force law and the effects listed before this one.
``damping(c, p, kappa, v, q, j) -> N s/m``
    The muscle's damping coefficient.
``outside(f, p, y, v, t, h, x, i, xn, q, j) -> N, or N m``
    Force on the joint from outside the muscles, along its coordinate y; p is the mean pressure
    of the muscles. It acts on the joint.
``drag(f, p, y, v, t, h, x, i, xn, q, j) -> N``
    The same of an effect that is friction between the two ends of the actuator, where a machine
    moves them along a prescribed position: it measures the friction with the force. No load swings
    there, so that nothing has to be kept stable.

Hidden states live in a row shared by all effects of a muscle, or of a joint: this effect's are
x[i], x[i + 1], ... as they were at the start of the step, and the function writes to xn[i],
xn[i + 1], ... what they have become after h seconds with the present arguments. The kernel calls
it at every stage of the step (with h from 0 to the step) and keeps xn of the last call. Written
so, an update can be exact or implicit, and a stiff law stays stable. Parameters are q[j],
q[j + 1], ... in SI; the muscle's or joint's own are at the indices of
:mod:`pam_ros.effects.rows`.
"""

from collections.abc import Callable, Mapping, MutableSequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import ParameterError
from pam_ros.parameters import Parameter

Array = NDArray[np.float64]
# A row of float64: numpy's array, or numba's; both are indexed like this.
Row = MutableSequence[float]
ON_JOINT = ('mass', 'outside', 'drag')
PLACES = ('delay', 'pressure', 'contraction', 'mass', 'force', 'damping', 'outside', 'drag')


class Compensation(Enum):
    """What a controller does about an effect that is declared to it.

    ``PATH``: it inverts the way of the pressure. ``MODEL``: the effect has no memory and is part
    of the model that the law inverts. ``FEED_FORWARD``: the effect's own equations run along the
    reference, and what they take is added to what is commanded. ``FEEDBACK``: nothing is done
    ahead; the feedback deals with it.
    """

    PATH = 'pressure path inverted'
    MODEL = 'part of the inverted model'
    FEED_FORWARD = 'fed forward along the reference'
    FEEDBACK = 'left to the feedback'


WITHOUT_MEMORY = (Compensation.PATH, Compensation.MODEL)  # what is inverted, but for a lag


@dataclass(frozen=True)
class EffectParameter:
    """One parameter of an effect, in SI.

    ``default`` is the value that it has when none is given; ``strength`` marks a parameter whose
    0 means that the effect is absent. ``scale`` is a typical size (fits are scaled by it), and
    ``sign`` the physical sign that a fitted strength must have (0: either).
    """

    name: str
    default: float
    text: str
    unit: str
    low: float
    high: float
    scale: float
    strength: bool = False
    sign: int = 0

    def described(self) -> Parameter:
        """Return the description that :mod:`pam_ros.parameters` checks values against."""
        return Parameter(self.text, self.unit, self.low, self.high)


# What every effect has in addition to its own parameters. No law reads it: simulations do.
ONSET = EffectParameter(
    'onset',
    0.0,
    'simulated time at which the effect begins to act; until then it is absent',
    's',
    0.0,
    1e9,
    scale=1.0,
)


@dataclass(frozen=True)
class HiddenState:
    """One hidden state of an effect, in SI.

    ``spread`` says how far it may be, when a recording or a run begins, from where it is after a
    long rest: a standard deviation. 0 means that it is always known, such as the last position.
    """

    name: str
    unit: str = ''
    spread: float = 0.0


@dataclass(frozen=True, eq=False)
class Effect:
    """A physical effect that the paper's model lacks.

    ``states`` are its hidden states, and ``start(q, j, p, kappa, y)`` gives them for a rig that
    has long been at rest there. ``compensation`` says what a controller does about it; where it
    inverts a lag of the pressure, ``lag(q, j)`` gives the time constants of filling and venting
    in s. ``example`` are values with which it is clearly present on a muscle of 20 mm and 400 mm
    with a load of some 10 kg, and lets that load come to rest; with ``moves_by_itself`` it never
    rests. ``fit_starts`` are sets of parameter values from which a fit begins; each
    makes the effect clearly present and names what a fit from there may change. What constants
    cannot foresee, a frequency or the place of a stop, comes from ``guess(t, p, kappa,
    residual)``: further starts from a recording, arrays (n,) in SI, the residual being measured
    less simulated position or force, kappa as measured and NaN where it is not known.
    ``signature`` says in words what the residual looks like, ``experiment`` what to record to
    distinguish it from its nearest ``rivals``. ``contains`` names those that it becomes as one of
    its parameters vanishes, with the parameters of theirs that others of its own then are.
    ``needs_muscle`` says that a load moved by some other force cannot have
    it: it has no braid, no bladder, no chamber.
    """

    name: str
    text: str
    source: str
    parameters: tuple[EffectParameter, ...]
    signature: str
    experiment: str
    fit_starts: tuple[dict[str, float], ...]
    example: dict[str, float]
    compensation: Compensation
    states: tuple[HiddenState, ...] = ()
    start: Callable[[Any, int, float, float, float], tuple[float, ...]] | None = None
    guess: Callable[[Array, Array, Array, Array], tuple[dict[str, float], ...]] | None = None
    delay: Callable[..., float] | None = None
    pressure: Callable[..., float] | None = None
    contraction: Callable[..., float] | None = None
    mass: Callable[..., float] | None = None
    force: Callable[..., float] | None = None
    damping: Callable[..., float] | None = None
    outside: Callable[..., float] | None = None
    drag: Callable[..., float] | None = None
    lag: Callable[[Any, int], tuple[float, float]] | None = None
    rivals: tuple[str, ...] = field(default=())
    contains: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    needs_muscle: bool = False
    moves_by_itself: bool = False

    def __post_init__(self) -> None:
        """Refuse what could never act or be absent, acts in two rows, or cannot be inverted."""
        acts = [place for place in PLACES if getattr(self, place)]
        if not acts:
            raise ParameterError(f'effect {self.name} acts nowhere: give it a function')
        if 0 < sum(place in ON_JOINT for place in acts) < len(acts):
            raise ParameterError(
                f'effect {self.name} acts in a muscle and on the joint ({", ".join(acts)}): '
                'make two effects of it'
            )
        if self.drag and not self.outside:
            raise ParameterError(
                f'effect {self.name} has drag without outside: friction brakes a free load as well'
            )
        if any(p.name == ONSET.name for p in self.parameters):
            raise ParameterError(
                f'effect {self.name} has a parameter onset: every effect has this one anyway'
            )
        if not any(p.strength for p in self.parameters):
            raise ParameterError(f'effect {self.name} has no strength parameter to be absent by')
        if self.states and self.lag is None and self.compensation in WITHOUT_MEMORY:
            raise ParameterError(
                f'effect {self.name} has hidden states, which {self.compensation} does not '
                'follow: give lag, or Compensation.FEED_FORWARD or FEEDBACK'
            )

    @cached_property
    def acts_on_joint(self) -> bool:
        """Whether it acts on the joint, and not in a muscle or its pressure path."""
        return any(getattr(self, place) for place in ON_JOINT)

    def values(self, given: Mapping[str, float]) -> list[float]:
        """Return the parameters in order, *given* over the defaults, checked.

        The onset, which *given* may have, too, is checked and is none of them. Raises
        ParameterError for an unknown name or a value out of range.
        """
        names = [p.name for p in (*self.parameters, ONSET)]
        for name in given:
            if name not in names:
                raise ParameterError(
                    f'effects.{self.name}.{name} is not known: give one of ' + ', '.join(names)
                )
        checked: list[float] = [
            p.described().check(
                f'effects.{self.name}.{p.name}', given.get(p.name, p.default), float
            )
            for p in (*self.parameters, ONSET)
        ]
        return checked[:-1]

    def is_present(self, given: Mapping[str, float]) -> bool:
        """Say whether any strength in *given* differs from zero."""
        return any(given.get(p.name, p.default) != 0.0 for p in self.parameters if p.strength)
