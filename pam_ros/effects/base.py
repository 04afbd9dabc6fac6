# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What an effect is: parameters, hidden states, and equations at the places where it acts.

An effect is one file with one dataclass, an :class:`Effect`; ``effects/__init__.py`` lists it. Its
fields are its parameters. Its equations are plain scalar functions, compiled into the stepping
kernel when numba is there. An effect acts either in a muscle (and its pressure path) or on the
joint that the muscles move; in which units a joint that turns has it, says
:mod:`pam_ros.effects.parameter`.

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
q[j + 1], ... in SI, in the order of the fields, for which each file has names; the muscle's or
joint's own are at the indices of :mod:`pam_ros.effects.rows`.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping, MutableSequence
from dataclasses import dataclass, fields, replace
from enum import Enum
from functools import cache
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.names import EffectName
from pam_ros.effects.parameter import EffectParameter
from pam_ros.errors import ParameterError
from pam_ros.parameters import described, field_about

Array = NDArray[np.float64]
Starts = tuple[dict[str, float], ...]
Bounds = tuple[float, float]
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


ONSET = EffectParameter(
    text='simulated time at which the effect begins to act; until then it is absent',
    unit='s',
    name='onset',
    low=0.0,
    high=1e9,
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
class EffectEquations:
    """The functions of an effect, one for each place where it acts; None where it does not.

    ``start(q, j, p, kappa, y)`` gives its hidden states for a rig that has long been at rest
    there. Where a controller inverts a lag of the pressure, ``lag(q, j)`` gives the time constants
    of filling and venting in s.

    What constants cannot foresee, a frequency or the place of a stop, comes from ``guess(t, p,
    kappa, residual)``: sets of values, from a recording, from which a fit begins as well. Its
    arguments are arrays (n,) in SI, the contraction kappa as measured and NaN where it is not
    known, the residual being measured less simulated position or force.
    """

    delay: Callable[..., float] | None = None
    pressure: Callable[..., float] | None = None
    contraction: Callable[..., float] | None = None
    mass: Callable[..., float] | None = None
    force: Callable[..., float] | None = None
    damping: Callable[..., float] | None = None
    outside: Callable[..., float] | None = None
    drag: Callable[..., float] | None = None
    start: Callable[[Any, int, float, float, float], tuple[float, ...]] | None = None
    lag: Callable[[Any, int], tuple[float, float]] | None = None
    guess: Callable[[Array, Array, Array, Array], Starts] | None = None

    def __post_init__(self) -> None:
        """Refuse what is no function, such as a parameter of the same name."""
        for item in fields(self):
            given = getattr(self, item.name)
            if given is not None and not callable(given):
                raise ParameterError(
                    f'{item.name} = {given!r} is not a function: where a parameter of the effect '
                    'has its name, give the function another one'
                )

    @property
    def places(self) -> tuple[str, ...]:
        """The places at which it acts."""
        return tuple(place for place in PLACES if getattr(self, place))

    # What a controller asks of an effect without memory. Its parameters are q[j], q[j + 1], ...

    def resting_pressure(self, p: float, q: Any, j: int) -> float:
        """Return the pressure in Pa that goes downstream for ever if *p* Pa comes in."""
        if self.pressure is None:
            return p
        return float(self.pressure(p, 0.0, 0.0, (), 0, (), q, j))

    def resting_force(self, f: float, p: float, kappa: float, q: Any, j: int) -> float:
        """Return the pull in N of a muscle at rest, which has *f* N without the effect."""
        if self.force is None:
            return f
        return float(self.force(f, p, kappa, 0.0, 0.0, 0.0, (), 0, (), q, j))

    def viscous_drag(self, q: Any, j: int) -> float:
        """Return the damping in N s/m or N m s/rad of the joint: its slope over -1 to 1."""
        if self.outside is None:
            return 0.0
        up, down = (self.outside(0.0, 0.0, 0.0, v, 0.0, 0.0, (), 0, (), q, j) for v in (1.0, -1.0))
        return 0.5 * float(down - up)


@dataclass(frozen=True)
class Effect(ABC):
    """A physical effect that the paper's model lacks, with the values of its parameters.

    As with loads, an effect is a dataclass of its parameters and equations that are compiled into
    the stepping kernel. ``q[j]``, ``q[j + 1]``, ... are its own parameters in the order of its
    fields. ``states`` are its hidden states. ``compensation`` says what a controller does about
    it. With ``moves_by_itself`` its example never lets a load rest. ``signature`` says in words
    what the residual looks like, ``experiment`` what to record to distinguish it from its nearest
    ``rivals``. ``contains`` names those that it becomes as one of its parameters vanishes, with
    the parameters of theirs that others of its own then are. ``needs_muscle`` says that a load
    moved by some other force cannot have it: it has no braid, no bladder, no chamber.

    Raises ParameterError for a value out of range.
    """

    name: ClassVar[str]
    text: ClassVar[str]
    source: ClassVar[str]
    signature: ClassVar[str]
    experiment: ClassVar[str]
    compensation: ClassVar[Compensation]
    equations: ClassVar[EffectEquations]
    states: ClassVar[tuple[HiddenState, ...]] = ()
    rivals: ClassVar[tuple[str, ...]] = ()
    contains: ClassVar[Mapping[str, Mapping[str, str]]] = {}
    needs_muscle: ClassVar[bool] = False
    moves_by_itself: ClassVar[bool] = False

    # No law reads it: simulations do.
    onset: float = field_about(0.0, ONSET, kw_only=True)

    @classmethod
    @abstractmethod
    def fit_starts(cls) -> Starts:
        """Return sets of parameter values from which a fit begins.

        Each makes the effect clearly present and names what a fit from there may change.
        """

    @classmethod
    @abstractmethod
    def example(cls) -> 'Effect':
        """Return it clearly present, on a muscle of 20 mm and 400 mm with a load of some 10 kg.

        That load comes to rest.
        """

    def __init_subclass__(cls) -> None:
        """Refuse equations that act nowhere or in two rows, or that cannot be inverted."""
        cls.__repr__ = Effect.__repr__  # type: ignore[method-assign]  # the dataclass keeps it
        acts = cls.equations.places
        if not acts:
            raise ParameterError(f'effect {cls.name} acts nowhere: give it a function')
        if 0 < sum(place in ON_JOINT for place in acts) < len(acts):
            raise ParameterError(
                f'effect {cls.name} acts in a muscle and on the joint ({", ".join(acts)}): '
                'make two effects of it'
            )
        if cls.equations.drag and not cls.equations.outside:
            raise ParameterError(
                f'effect {cls.name} has drag without outside: friction brakes a free load as well'
            )
        if cls.states and cls.equations.lag is None and cls.compensation in WITHOUT_MEMORY:
            raise ParameterError(
                f'effect {cls.name} has hidden states, which {cls.compensation} does not '
                'follow: give lag, or Compensation.FEED_FORWARD or FEEDBACK'
            )

    def __repr__(self) -> str:
        """Return the call that makes it, without what has its default."""
        given = ', '.join(f'{name}={value!r}' for name, value in self.given.items())
        return f'{type(self).__name__}({given})'

    def __post_init__(self) -> None:
        """Check every value; the joint checks those that have another range there."""
        for p in (*self.parameters(), ONSET):
            about = p.on_any_joint() if self.acts_on_joint() else p
            flat = EffectName(self.name, p.name).flat
            object.__setattr__(self, p.name, about.check(flat, getattr(self, p.name), float))

    @classmethod
    @cache
    def parameters(cls, *, turning: bool = False) -> tuple[EffectParameter, ...]:
        """Return its own parameters in order, without the onset that every effect has.

        With *turning* they have the units and ranges of a joint that turns; raises ParameterError
        for a unit of which is not known what it is there.
        """
        found = tuple(
            replace(about, name=name, default=default)
            for name, (_, default, about) in described(cls).items()
            if isinstance(about, EffectParameter) and about is not ONSET
        )
        if not any(p.strength for p in found):
            raise ParameterError(f'effect {cls.name} has no strength parameter to be absent by')
        if not turning:
            return found
        return tuple(p.turned(EffectName(cls.name, p.name).flat) for p in found)

    @classmethod
    def acts_on_joint(cls) -> bool:
        """Say whether it acts on the joint, and not in a muscle or its pressure path."""
        return any(place in ON_JOINT for place in cls.equations.places)

    def check(self, *, mass: float, turning: bool) -> None:
        """Raise ParameterError for a value that is out of range on a joint.

        *mass* in kg is what it moves without effects, and *turning* says that it is revolute.
        """
        for p in self.parameters(turning=turning):
            p.check(EffectName(self.name, p.name).flat, getattr(self, p.name), float)

    @classmethod
    def fit_bounds(
        cls, near: Mapping[str, float], fitted: Collection[str], mass: float
    ) -> dict[str, Bounds]:
        """Return the bounds of its parameters in a fit, where they are narrower than their ranges.

        *near* are the values of all its parameters from which the fit begins, *fitted* the names
        of those that it changes, and *mass* in kg is what the joint moves without effects. A fit
        within them ends with a joint that may be declared.
        """
        return {}

    @property
    def row(self) -> tuple[float, ...]:
        """Its own parameters in order, as q has them."""
        return tuple(getattr(self, p.name) for p in self.parameters())

    @property
    def is_present(self) -> bool:
        """Whether any of its strengths differs from zero."""
        return any(getattr(self, p.name) != 0.0 for p in self.parameters() if p.strength)

    @property
    def values(self) -> dict[str, float]:
        """Its own parameters by name, and the onset where it has one."""
        own = {p.name: float(getattr(self, p.name)) for p in self.parameters()}
        return own if self.onset == 0.0 else {**own, ONSET.name: self.onset}

    @property
    def given(self) -> dict[str, float]:
        """Those of its values that differ from their defaults, by name."""
        default = {p.name: p.default for p in (*self.parameters(), ONSET)}
        return {name: value for name, value in self.values.items() if value != default[name]}
