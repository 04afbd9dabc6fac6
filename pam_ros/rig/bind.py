# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bind the kernel's templates to a kind of joint and a set of effects, and compile the result.

The templates of :mod:`pam_ros.rig.kernel` call the chains of :mod:`pam_ros.rig.unbound` by name.
Here each chain becomes a function that passes the value through the effects in their order, the
geometry becomes that of the joint, and each template is copied with these as its globals. numba
inlines them and keeps the machine code of the loops on disk under a name that contains their
fingerprint, because numba itself only notices changes of one file.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from types import FunctionType
from typing import Any

from pam_ros import compiled
from pam_ros.effects.base import Effect
from pam_ros.rig import filling, run_kernel, unbound
from pam_ros.rig import kernel as templates
from pam_ros.rig.fingerprint import fingerprint
from pam_ros.rig.layout import Layout

Function = Callable[..., Any]
# Effects, each with the offsets of its states and its parameters.
Offsets = tuple[tuple[type[Effect], int, int], ...]
# Inner templates in the order in which they call each other, then the loops, which are cached.
_INNER = (
    'effective_contraction',
    'share',
    'pull',
    'coefficient',
    'net_force',
    'acceleration',
    'remembers',
    'keep_memories',
    'begin',
    'step',
)
_INNER_OF_FILLING = ('taken', 'balanced', 'supplied')
_INNER_OF_RUNS = ('in_force', 'held_until', 'first_command')
_LOOPS = ('advance', 'outputs')
_LOOPS_OF_RUNS = ('simulate', 'simulate_pressures', 'simulate_held')
_STATELESS = ('delay', 'contraction', 'mass', 'damping')
_WITH_MEMORY = ('reservoir', 'pressure', 'force', 'outside', 'drag')


@dataclass(frozen=True)
class Kernel:
    """The compiled functions for one kind of joint and set of effects; see the templates."""

    advance: Function
    outputs: Function
    simulate: Function
    simulate_pressures: Function
    simulate_held: Function


def _with_parameters(inner: Function, f: Function, j: int) -> Function:
    """Chain ``f(value, q, j)`` after ``inner(value, q)``."""

    def chain(value, q):  # type: ignore[no-untyped-def]
        return f(inner(value, q), q, j)

    return chain


def _delays(inner: Function, f: Function, j: int) -> Function:
    def chain(q):  # type: ignore[no-untyped-def]
        return inner(q) + f(q, j)

    return chain


def _reservoirs(inner: Function, f: Function, i: int, j: int) -> Function:
    def chain(taken, h, x, xn, q):  # type: ignore[no-untyped-def]
        return min(inner(taken, h, x, xn, q), f(taken, h, x, i, xn, q, j))

    return chain


def _pressures(inner: Function, f: Function, i: int, j: int) -> Function:
    def chain(p, t, h, x, xn, q):  # type: ignore[no-untyped-def]
        return f(inner(p, t, h, x, xn, q), t, h, x, i, xn, q, j)

    return chain


def _forces(inner: Function, f: Function, i: int, j: int) -> Function:
    """Chain for muscle forces, outside forces and drag, which have the same arguments."""

    def chain(value, p, place, v, t, h, x, xn, q):  # type: ignore[no-untyped-def]
        return f(inner(value, p, place, v, t, h, x, xn, q), p, place, v, t, h, x, i, xn, q, j)

    return chain


def _dampings(inner: Function, f: Function, j: int) -> Function:
    def chain(c, p, kappa, v, q):  # type: ignore[no-untyped-def]
        return f(inner(c, p, kappa, v, q), p, kappa, v, q, j)

    return chain


def _or_present(inner: Function, strengths: tuple[int, ...]) -> Function:
    """Chain the check whether any of these parameters differs from 0."""
    if not strengths:
        return inner
    first, rest = strengths[0], strengths[1:]

    def chain(q):  # type: ignore[no-untyped-def]
        return inner(q) or q[first] != 0.0

    return _or_present(compiled.inner(chain), rest)


_CHAINED: dict[str, Callable[..., Function]] = {
    'delay': _delays,
    'contraction': _with_parameters,
    'mass': _with_parameters,
    'damping': _dampings,
    'reservoir': _reservoirs,
    'pressure': _pressures,
    'force': _forces,
    'outside': _forces,
    'drag': _forces,
}


def is_dragged(layout: Layout) -> bool:
    """Return whether a machine that moves the one muscle measures the friction on the joint, too.

    This is so if muscle and load are in one line: the friction is then between the clamps of the
    machine. With a revolute joint or a second muscle the force cell is at the end of a muscle,
    and does not measure the friction on the joint.
    """
    return layout.muscles == 1 and not layout.transmission.revolute


@lru_cache(maxsize=32)
def _chains(offsets: Offsets) -> dict[str, Function]:
    """Return the compiled chain of every place, by the name that the templates call.

    The offsets are the same for joints of all kinds. Their kernels in one process share the
    chains, which are therefore compiled once.
    """
    chains = {
        f'{place}_chain': compiled.inner(getattr(unbound, f'{place}_chain'))
        for place in (*_STATELESS, *_WITH_MEMORY)
    }
    for effect, i, j in offsets:
        for place, make in _CHAINED.items():
            f = getattr(effect.equations, place)
            if f is not None:
                inner, own = chains[f'{place}_chain'], compiled.inner(f)
                at = (j,) if place in _STATELESS else (i, j)
                chains[f'{place}_chain'] = compiled.inner(make(inner, own, *at))
    return chains


@lru_cache(maxsize=32)
def _memories(offsets: Offsets) -> dict[str, Function]:
    """Return the functions that check a row for an effect with a memory that is not a pressure."""
    found = {}
    for name, on_joint in (('muscle_remembers', False), ('joint_remembers', True)):
        strengths = tuple(
            j + k
            for effect, _, j in offsets
            if effect.states
            and effect.equations.pressure is None
            and effect.acts_on_joint() is on_joint
            for k, p in enumerate(effect.parameters())
            if p.strength
        )
        found[name] = _or_present(compiled.inner(getattr(unbound, name)), strengths)
    return found


@lru_cache(maxsize=32)
def bind(layout: Layout, active: tuple[type[Effect], ...]) -> Kernel:
    """Return the kernel with the effects *active*, a subset of those of the layout.

    The width of the rows is that of the layout for every subset. Each loop is compiled at its
    first call, or loaded from disk.
    """
    transmission, load = layout.transmission, layout.load
    offsets = tuple((e, layout.state_at[e.name], layout.parameter_at[e.name]) for e in active)
    names: dict[str, Any] = {
        **vars(filling),
        **vars(templates),
        **_chains(offsets),
        **_memories(offsets),
        'MUSCLES': layout.muscles,
        'HAS_RESERVOIR': any(effect.equations.reservoir is not None for effect in active),
        'HAS_OUTSIDE': any(effect.equations.outside is not None for effect in active),
        'IS_DRAGGED': is_dragged(layout)
        and any(effect.equations.drag is not None for effect in active),
        'MEMORY_FROM': layout.memory_from,
        'WIDTH': layout.width,
        'LOAD': layout.load_at,
        'TRANSMISSION': layout.transmission_at,
        'travel_of': compiled.inner(transmission.travel),
        'arm_of': compiled.inner(transmission.arm),
        'arm_slope_of': compiled.inner(transmission.arm_slope),
        'inertia_of': compiled.inner(load.inertia),
        'fall_of': compiled.inner(load.fall),
    }
    _bind_inner(filling, _INNER_OF_FILLING, names)
    _bind_inner(templates, _INNER, names)
    loops = _bind_loops(templates, _LOOPS, names)
    # The runs use the names of the kernel as they are bound above.
    names = {**vars(run_kernel), **{k: v for k, v in names.items() if not k.startswith('__')}}
    _bind_inner(run_kernel, _INNER_OF_RUNS, names)
    return Kernel(**loops, **_bind_loops(run_kernel, _LOOPS_OF_RUNS, names))


def _bind_inner(module: Any, inner: tuple[str, ...], names: dict[str, Any]) -> None:
    """Bind the functions *inner* of a module of templates to *names*, and add them to *names*."""
    for name in inner:
        names[name] = compiled.inner(_rebound(getattr(module, name), names, name))


def _bind_loops(module: Any, loops: tuple[str, ...], names: dict[str, Any]) -> dict[str, Function]:
    """Return the *loops* of a module of templates, each cached under a name with its hash."""
    bound = {}
    for name in loops:
        loop = _rebound(getattr(module, name), names, name)
        loop.__qualname__ = f'{name}_{fingerprint(loop)}'
        bound[name] = compiled.cached(loop)
    return bound


def _rebound(template: Function, names: dict[str, Any], qualname: str) -> Function:
    function = FunctionType(template.__code__, names, template.__name__)
    function.__qualname__ = qualname
    function.__doc__ = template.__doc__
    return function
