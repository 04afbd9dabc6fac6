# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bind the kernel's templates to a set of effects, and compile the result.

The templates of :mod:`pam_ros.rig.kernel` call chains by name. Here each chain becomes a
function that passes the value through the effects in their order, and each template is made
anew with these chains as its globals. numba inlines the chains, and keeps the machine code of
the loops on disk under a name that holds a hash of all code that went in: numba itself notices
changes of one file only.
"""

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any

from pam_ros import compiled
from pam_ros.effects.base import Effect
from pam_ros.rig import joint_kernel
from pam_ros.rig import kernel as templates
from pam_ros.rig.joints import JOINTS
from pam_ros.rig.layout import Layout

Function = Callable[..., Any]
# Inner templates in the order in which they call each other, then the loops, which are cached.
_INNER = ('in_force', 'held_until', 'pull', 'coefficient', 'acceleration', 'step')
_LOOPS = ('advance', 'outputs', 'simulate', 'simulate_held', 'simulate_along')
_INNER_OF_JOINTS = ('share', 'joint_acceleration', 'joint_step')
_LOOPS_OF_JOINTS = ('advance_joints', 'outputs_of_joints')


@dataclass(frozen=True)
class Kernel:
    """The compiled functions for one set of effects; see the templates for their arguments."""

    advance: Function
    outputs: Function
    simulate: Function
    simulate_held: Function
    simulate_along: Function


@dataclass(frozen=True)
class JointKernel:
    """The compiled functions for joints of all kinds and one set of effects."""

    advance_joints: Function
    outputs_of_joints: Function


def _with_parameters(inner: Function, f: Function, j: int) -> Function:
    """Chain ``f(value, q, j)`` behind ``inner(value, q)``."""

    def chain(value, q):  # type: ignore[no-untyped-def]
        return f(inner(value, q), q, j)

    return chain


def _delays(inner: Function, f: Function, j: int) -> Function:
    def chain(q):  # type: ignore[no-untyped-def]
        return inner(q) + f(q, j)

    return chain


def _pressures(inner: Function, f: Function, i: int, j: int) -> Function:
    def chain(p, t, h, x, xn, q):  # type: ignore[no-untyped-def]
        return f(inner(p, t, h, x, xn, q), t, h, x, i, xn, q, j)

    return chain


def _forces(inner: Function, f: Function, i: int, j: int) -> Function:
    """Chain for muscle forces and for outside forces: both have the same arguments."""

    def chain(value, p, place, v, t, h, x, xn, q):  # type: ignore[no-untyped-def]
        return f(inner(value, p, place, v, t, h, x, xn, q), p, place, v, t, h, x, i, xn, q, j)

    return chain


def _dampings(inner: Function, f: Function, j: int) -> Function:
    def chain(c, p, kappa, v, q):  # type: ignore[no-untyped-def]
        return f(inner(c, p, kappa, v, q), p, kappa, v, q, j)

    return chain


def _or_present(inner: Function, strengths: tuple[int, ...]) -> Function:
    """Chain the question whether any of these parameters differs from 0."""
    if not strengths:
        return inner
    first, rest = strengths[0], strengths[1:]

    def chain(q):  # type: ignore[no-untyped-def]
        return inner(q) or q[first] != 0.0

    return _or_present(compiled.scalar(chain), rest)


def _chains(layout: Layout, active: tuple[Effect, ...]) -> dict[str, Function]:
    """Return the compiled chain of every place, by the name that the templates call."""
    chains = {
        f'{place}_chain': compiled.scalar(getattr(templates, f'{place}_chain'))
        for place in ('delay', 'pressure', 'contraction', 'mass', 'force', 'damping', 'outside')
    }
    for effect in active:
        i, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
        stateless = {
            'delay': _delays,
            'contraction': _with_parameters,
            'mass': _with_parameters,
            'damping': _dampings,
        }
        with_memory = {'pressure': _pressures, 'force': _forces, 'outside': _forces}
        for place, make in stateless.items():
            f = getattr(effect, place)
            if f is not None:
                inner = chains[f'{place}_chain']
                chains[f'{place}_chain'] = compiled.scalar(make(inner, compiled.scalar(f), j))
        for place, make_with_memory in with_memory.items():
            f = getattr(effect, place)
            if f is not None:
                inner = chains[f'{place}_chain']
                chains[f'{place}_chain'] = compiled.scalar(
                    make_with_memory(inner, compiled.scalar(f), i, j)
                )
    return chains


def fingerprint(function: Function) -> str:
    """Hash what the machine code of *function* depends on.

    That is the bytecode of all functions that it reaches, in whatever files they are, and the
    constants that they read, offsets in the rows among them.
    """
    digest = hashlib.sha256()
    seen: set[FunctionType] = set()
    for root in (function, compiled.scalar, compiled.cached):
        for part in _parts(root, seen):
            digest.update(repr(part).encode())
    return digest.hexdigest()[:16]


def _parts(value: Any, seen: set[FunctionType]) -> Iterator[Any]:
    plain = getattr(value, 'py_func', value)
    if isinstance(plain, FunctionType):
        code = plain.__code__
        yield code.co_name
        if plain not in seen:
            seen.add(plain)
            yield code.co_code, code.co_names, code.co_varnames, plain.__defaults__
            yield [c for c in code.co_consts if not isinstance(c, CodeType)]
            for cell in plain.__closure__ or ():
                yield from _parts(cell.cell_contents, seen)
            for name in code.co_names:
                yield from _parts(plain.__globals__.get(name), seen)
    elif isinstance(plain, (bool, int, float, str, tuple, dict)):
        yield plain


@lru_cache(maxsize=16)
def bind(layout: Layout, active: tuple[Effect, ...]) -> Kernel:
    """Return the kernel in which the effects *active*, a subset of the layout's, can act.

    Rows keep the layout's width whatever is active. Compilation happens at the first call of
    each loop, or comes from disk.
    """
    names = _inner(layout, active)
    return Kernel(**_loops(templates, _LOOPS, names))


@lru_cache(maxsize=16)
def bind_joints(layout: Layout, active: tuple[Effect, ...]) -> JointKernel:
    """Return the kernel of joints of any kind, mixed; otherwise as :func:`bind`."""
    names = {**vars(joint_kernel), **_inner(layout, active), **_choices()}
    for name in _INNER_OF_JOINTS:
        names[name] = compiled.scalar(_rebound(getattr(joint_kernel, name), names, name))
    return JointKernel(**_loops(joint_kernel, _LOOPS_OF_JOINTS, names))


def _inner(layout: Layout, active: tuple[Effect, ...]) -> dict[str, Any]:
    """Return the names of the templates, chains and inner functions bound and compiled."""
    memories = [e for e in active if e.states and e.pressure is None]
    strengths = tuple(
        layout.parameter_at[e.name] + k
        for e in memories
        for k, p in enumerate(e.parameters)
        if p.strength
    )
    names: dict[str, Any] = dict(vars(templates))
    names.update(_chains(layout, active))
    names['remembers'] = _or_present(compiled.scalar(templates.remembers), strengths)
    names['MEMORY_FROM'] = layout.memory_from if memories else layout.width
    for name in _INNER:
        names[name] = compiled.scalar(_rebound(getattr(templates, name), names, name))
    return names


def _loops(module: Any, loops: tuple[str, ...], names: dict[str, Any]) -> dict[str, Function]:
    """Return the *loops* of a module of templates, each cached under a name with its hash."""
    bound = {}
    for name in loops:
        loop = _rebound(getattr(module, name), names, name)
        loop.__qualname__ = f'{name}_{fingerprint(loop)}'
        bound[name] = compiled.cached(loop)
    return bound


def _choices() -> dict[str, Function]:
    """Return the functions by which a kernel calls the joint of a kind, an index in JOINTS."""
    choices = {}
    for name, make in (
        ('position', _of_muscle),
        ('arm', _of_muscle),
        ('inertia', _of_mass),
        ('fall', _of_coordinate),
    ):
        chosen = compiled.scalar(getattr(joint_kernel, f'{name}_of'))
        for kind, joint in enumerate(JOINTS):
            chosen = compiled.scalar(make(chosen, compiled.scalar(getattr(joint, name)), kind))
        choices[f'{name}_of'] = chosen
    return choices


def _of_muscle(others: Function, f: Function, own: int) -> Function:
    """Call f for its *own* kind, else the *others*."""

    def chosen(kind, s, i, g):  # type: ignore[no-untyped-def]
        if kind == own:
            return f(s, i, g)
        return others(kind, s, i, g)

    return chosen


def _of_mass(others: Function, f: Function, own: int) -> Function:
    def chosen(kind, m, g):  # type: ignore[no-untyped-def]
        if kind == own:
            return f(m, g)
        return others(kind, m, g)

    return chosen


def _of_coordinate(others: Function, f: Function, own: int) -> Function:
    def chosen(kind, s, m, j, g):  # type: ignore[no-untyped-def]
        if kind == own:
            return f(s, m, j, g)
        return others(kind, s, m, j, g)

    return chosen


def _rebound(template: Function, names: dict[str, Any], qualname: str) -> Function:
    function = FunctionType(template.__code__, names, template.__name__)
    function.__qualname__ = qualname
    function.__doc__ = template.__doc__
    return function
