# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The interface of an effect: parameters, hidden states, and equations where it acts.

An effect is one file with one dataclass, an :class:`Effect`; ``effects/__init__.py`` lists it. Its
fields are its parameters. Its equations are plain scalar functions, compiled into the stepping
kernel if numba is installed. An effect acts either in a muscle (and its pressure path) or on the
joint that the muscles move. :mod:`pam_ros.effects.parameter` defines its units on a revolute
joint.

Places, in the order in which the kernel visits them, with the function that each expects:

``delay(q, j) -> s``
    Time by which pressure commands act late.
``reservoir(taken, h, x, i, xn, q, j) -> Pa``
    Pressure after h seconds of the reservoir from which all muscles of the joint fill; no command
    is met beyond it. *taken* in Pa is the sum over the chambers of the rises of pressure that it
    has fed meanwhile: the more, the lower the result. It acts on the joint.
``pressure(p, t, h, x, i, xn, q, j) -> Pa``
    Pressure path from command to chamber. p is the upstream pressure and constant over the
    interval of length h that ends at t. Returns the downstream pressure at its end.
``contraction(kappa, q, j) -> fraction``
    Effective contraction of the muscle.
``mass(m, q, j) -> kg``
    The moved mass. It acts on the joint.
``force(f, p, kappa, v, t, h, x, i, xn, q, j) -> N``
    The muscle's force, after the force law and the effects listed before this one.
``damping(c, p, kappa, v, q, j) -> N s/m``
    The muscle's damping coefficient.
``outside(f, p, y, v, t, h, x, i, xn, q, j) -> N, or N m``
    Force on the joint from outside the muscles, along its coordinate y; p is the mean pressure
    of the muscles. It acts on the joint.
``drag(f, p, y, v, t, h, x, i, xn, q, j) -> N``
    The same for an effect that is friction between the two ends of the actuator, when a machine
    moves them along a prescribed position: the measured force includes the friction. No load
    oscillates there, so that the function need not ensure stability.

Hidden states are in a row that all effects of a muscle, or of a joint, share. Those of this effect
are x[i], x[i + 1], ... with their values at the start of the step. The function writes to xn[i],
xn[i + 1], ... their values after h seconds with the present arguments. The kernel calls it at
every stage of the step (with h from 0 to the step) and keeps xn of the last call. In this form an
update can be exact or implicit, and a stiff law stays stable. Parameters are q[j], q[j + 1], ...
in SI, in the order of the fields; each file has names for these indices. The parameters of the
muscle or joint itself are at the indices of :mod:`pam_ros.effects.rows`.
"""

from abc import abstractmethod
from collections.abc import Callable, Collection, Mapping, MutableSequence
from dataclasses import dataclass, fields, replace
from enum import Enum
from functools import cache
from math import inf
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.cached_property import cached_property
from pam_ros.constructors import RefusesUnknownNames
from pam_ros.effects.names import EffectName
from pam_ros.effects.parameter import EffectParameter
from pam_ros.errors import ParameterError
from pam_ros.parameters import described, field_about

Array = NDArray[np.float64]
Starts = tuple[dict[str, float], ...]
Interval = tuple[float, float]
# A row of float64: an array of numpy or of numba, with the same indexing.
Row = MutableSequence[float]
ON_PRESSURE = ('delay', 'reservoir', 'pressure')
ON_JOINT = ('reservoir', 'mass', 'outside', 'drag')
PLACES = (
    *('delay', 'reservoir', 'pressure', 'contraction', 'mass', 'force', 'damping'),
    *('outside', 'drag'),
)
ENOUGH = inf  # Pa, the pressure of a reservoir that is absent


class Compensation(Enum):
    """How a controller compensates an effect that is configured in it.

    ``PATH``: it inverts the pressure path. ``MODEL``: the effect has no memory and is part of the
    model that the law inverts. ``FEED_FORWARD``: the effect's own equations are evaluated along
    the reference, and the result is added to the command. ``FEEDBACK``: there is no feed-forward;
    the feedback compensates the effect.
    """

    PATH = 'pressure path inverted'
    MODEL = 'part of the inverted model'
    FEED_FORWARD = 'fed forward along the reference'
    FEEDBACK = 'left to the feedback'


WITHOUT_MEMORY = (Compensation.PATH, Compensation.MODEL)  # inverted; only a lag has a state


ONSET = EffectParameter(
    text='simulated time at which the effect begins to act; until then it is absent',
    unit='s',
    name='onset',
    low=0.0,
    high=1e9,
    fit_low=0.0,
    fit_high=1e9,
    scale=1.0,
)


@dataclass(frozen=True)
class HiddenState:
    """One hidden state of an effect, in SI.

    ``spread`` is the standard deviation of its value at the beginning of a recording or run from
    the value after a long rest. 0 means that it is always known, such as the last position.
    """

    name: str
    unit: str = ''
    spread: float = 0.0


@dataclass(frozen=True, eq=False)
class EffectEquations:
    """The functions of an effect, one for each place where it acts; None for all other places.

    ``start(q, j, p, kappa, y)`` returns its hidden states after a long rest at these values. If a
    controller inverts a lag of the pressure, ``chamber(q, j)`` returns the time constants of
    filling and venting in s, and the dead zone of the valve in Pa.

    ``guess(t, p, kappa, residual)`` returns additional sets of starting values for a fit, for
    parameters whose starting values depend on the recording, such as a frequency or the position
    of a stop. The arguments are arrays (n,) in SI: p is the highest of the pressures of the
    muscles, kappa the measured contraction, NaN if it is not known, and the residual is the
    measured minus the simulated position or force.
    """

    delay: Callable[..., float] | None = None
    reservoir: Callable[..., float] | None = None
    pressure: Callable[..., float] | None = None
    contraction: Callable[..., float] | None = None
    mass: Callable[..., float] | None = None
    force: Callable[..., float] | None = None
    damping: Callable[..., float] | None = None
    outside: Callable[..., float] | None = None
    drag: Callable[..., float] | None = None
    start: Callable[[Any, int, float, float, float], tuple[float, ...]] | None = None
    chamber: Callable[[Any, int], tuple[float, float, float]] | None = None
    guess: Callable[[Array, Array, Array, Array], Starts] | None = None

    def __post_init__(self) -> None:
        """Raise ParameterError for a non-function, such as a parameter of the same name."""
        for item in fields(self):
            given = getattr(self, item.name)
            if given is not None and not callable(given):
                raise ParameterError(
                    f'{item.name} = {given!r} is not a function: if a parameter of the effect has '
                    'this name, rename the function'
                )

    @cached_property
    def places(self) -> tuple[str, ...]:
        """The places where it acts; cached, since each start of a simulation reads them."""
        return tuple(place for place in PLACES if getattr(self, place))

    # For controllers, of effects without memory. The parameters are q[j], q[j + 1], ...

    def resting_pressure(self, p: float, q: Any, j: int) -> float:
        """Return the steady downstream pressure in Pa for a constant upstream pressure *p*."""
        if self.pressure is None:
            return p
        return float(self.pressure(p, 0.0, 0.0, (), 0, (), q, j))

    def resting_force(self, f: float, p: float, kappa: float, q: Any, j: int) -> float:
        """Return the force in N of a muscle at rest, which has *f* N without the effect."""
        if self.force is None:
            return f
        return float(self.force(f, p, kappa, 0.0, 0.0, 0.0, (), 0, (), q, j))

    def viscous_drag(self, q: Any, j: int) -> float:
        """Return the damping in N s/m or N m s/rad of the joint, from forces at v = -1 and 1."""
        if self.outside is None:
            return 0.0
        up, down = (self.outside(0.0, 0.0, 0.0, v, 0.0, 0.0, (), 0, (), q, j) for v in (1.0, -1.0))
        return 0.5 * float(down - up)


@dataclass(frozen=True)
class Effect(metaclass=RefusesUnknownNames):
    """A physical effect that the paper's model lacks, with the values of its parameters.

    As for loads, an effect is a dataclass of its parameters and equations that are compiled into
    the stepping kernel. ``q[j]``, ``q[j + 1]``, ... are its own parameters in the order of its
    fields. ``equation`` is what its page shows of the equations, with the parameters by their
    names; the index ``in`` marks a value without the effect. ``states`` are its hidden states.
    ``compensation`` is how a controller compensates it. With ``moves_by_itself`` a load never
    comes to rest in its example. ``signature`` describes its trace in the residual, ``experiment``
    what to record to distinguish it from the effects with which it is confused most easily, its
    ``rivals``. ``excitation`` has the parameters with which ``pam_excite`` plays this experiment;
    it is None if no segment of ``pam_excite`` does. ``contains`` names the effects that are
    special cases of it. For each of them it maps the parameters of that effect to those of its
    own with the same values. ``needs_muscle`` means that a load moved by another force cannot have
    it, since there is no braid, no bladder and no chamber.

    Raises ParameterError for a value out of range.
    """

    name: ClassVar[str]
    text: ClassVar[str]
    source: ClassVar[str]
    equation: ClassVar[str]
    signature: ClassVar[str]
    experiment: ClassVar[str]
    excitation: ClassVar[Mapping[str, Any] | None] = None
    compensation: ClassVar[Compensation]
    equations: ClassVar[EffectEquations]
    states: ClassVar[tuple[HiddenState, ...]] = ()
    rivals: ClassVar[tuple[str, ...]] = ()
    contains: ClassVar[Mapping[str, Mapping[str, str]]] = {}
    needs_muscle: ClassVar[bool] = False
    moves_by_itself: ClassVar[bool] = False

    # Simulations use it, the equations do not.
    onset: float = field_about(0.0, ONSET, kw_only=True)

    @classmethod
    @abstractmethod
    def fit_starts(cls) -> Starts:
        """Return sets of parameter values from which a fit begins.

        With each set the effect is clearly present. A fit from it may change the named parameters.
        """

    @classmethod
    @abstractmethod
    def example(cls) -> 'Effect':
        """Return it clearly present, for a muscle of 20 mm x 400 mm and a load of some 10 kg.

        This load comes to rest, except with ``moves_by_itself``.
        """

    def __init_subclass__(cls) -> None:
        """Raise ParameterError for equations without a place, in two rows, or not invertible."""
        # The dataclass of the subclass does not replace it then.
        cls.__repr__ = Effect.__repr__  # type: ignore[method-assign]
        acts = cls.equations.places
        if not acts:
            raise ParameterError(f'effect {cls.name} has no function: give it at least one')
        if 0 < sum(place in ON_JOINT for place in acts) < len(acts):
            raise ParameterError(
                f'effect {cls.name} acts in a muscle and on the joint ({", ".join(acts)}): '
                'make two effects of it'
            )
        if cls.equations.drag and not cls.equations.outside:
            raise ParameterError(
                f'effect {cls.name} has drag without outside: friction brakes a free load as well'
            )
        if cls.states and cls.equations.chamber is None and cls.compensation in WITHOUT_MEMORY:
            raise ParameterError(
                f'effect {cls.name} has hidden states, which {cls.compensation} does not '
                'compute: give chamber, or Compensation.FEED_FORWARD or FEEDBACK'
            )

    def __repr__(self) -> str:
        """Return the constructor call, without parameters that have their default."""
        given = ', '.join(f'{name}={value!r}' for name, value in self.given.items())
        return f'{type(self).__name__}({given})'

    def __post_init__(self) -> None:
        """Check every value; the joint checks ranges that depend on the kind of joint."""
        for p in (*self.parameters(), ONSET):
            about = p.on_any_joint() if self.acts_on_joint() else p
            flat = EffectName(self.name, p.name).flat
            object.__setattr__(self, p.name, about.check(flat, getattr(self, p.name), float))

    @classmethod
    @cache
    def parameters(cls, *, revolute: bool = False) -> tuple[EffectParameter, ...]:
        """Return its own parameters in order, without the onset that every effect has.

        With *revolute* they have the units and ranges of a revolute joint; raises ParameterError
        for a unit that has no counterpart there.
        """
        found = tuple(
            replace(about, name=name, default=default)
            for name, (_, default, about) in described(cls).items()
            if isinstance(about, EffectParameter) and about is not ONSET
        )
        if not any(p.strength for p in found):
            raise ParameterError(
                f'effect {cls.name} has no strength parameter, whose 0 means that it is absent'
            )
        if not revolute:
            return found
        return tuple(p.for_revolute(EffectName(cls.name, p.name).flat) for p in found)

    @classmethod
    def acts_on_pressure(cls) -> bool:
        """Return whether it acts in the pressure path, from the command to the chamber."""
        return any(place in ON_PRESSURE for place in cls.equations.places)

    @classmethod
    def is_of_path(cls) -> bool:
        """Return whether it acts in the pressure path alone."""
        return all(place in ON_PRESSURE for place in cls.equations.places)

    @classmethod
    def acts_on_joint(cls) -> bool:
        """Return whether it acts on the joint, and not in a muscle or its pressure path."""
        return any(place in ON_JOINT for place in cls.equations.places)

    def check(self, *, mass: float, revolute: bool) -> None:
        """Raise ParameterError for a value that is out of range on a joint.

        *mass* in kg is the moved mass without effects, *revolute* is true for a revolute joint.
        """
        for p in self.parameters(revolute=revolute):
            p.check(EffectName(self.name, p.name).flat, getattr(self, p.name), float)

    @classmethod
    def fit_bounds(
        cls, near: Mapping[str, float], fitted: Collection[str], mass: float, duration: float
    ) -> dict[str, Interval]:
        """Return those bounds of its parameters in a fit that are narrower than their ranges.

        *near* are the values of all its parameters from which the fit begins, *fitted* the names
        of those that it changes, *mass* in kg is what the joint moves without effects, and
        *duration* in s that of the longest recording. A fit within these bounds ends with a valid
        joint.
        """
        return {}

    def fed_forward(self) -> 'Effect':
        """Return it as a controller feeds it forward: as it is, unless a part must be left out."""
        return self

    @property
    def row(self) -> tuple[float, ...]:
        """Its own parameters, without the onset, in the order of its fields and in their units."""
        return tuple(getattr(self, p.name) for p in self.parameters())

    @property
    def is_present(self) -> bool:
        """Whether any of its strengths differs from zero."""
        return any(getattr(self, p.name) != 0.0 for p in self.parameters() if p.strength)

    @property
    def values(self) -> dict[str, float]:
        """Its own parameters by name in the units of its fields, and the onset in s if not 0."""
        own = {p.name: float(getattr(self, p.name)) for p in self.parameters()}
        return own if self.onset == 0.0 else {**own, ONSET.name: self.onset}

    @property
    def given(self) -> dict[str, float]:
        """Its values that differ from their defaults, by name."""
        default = {p.name: p.default for p in (*self.parameters(), ONSET)}
        return {name: value for name, value in self.values.items() if value != default[name]}
