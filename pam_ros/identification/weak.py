# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The equation of motion in weak form, along the measured motion: no free run, no derivative.

    integral phi a dt = integral phi'' y dt

for every bump phi that vanishes with its slope at its ends (Shinbrot's modulating functions,
1957), a being the acceleration of equation (3) where the rig was measured to be. What a free
run makes of an error by and by, this says at once: a fit finds from afar where friction, stops
or a leak make the sum of squares of a free run rugged. Noise in the position, which enters the
forces, biases it a little, so it finds starts, not results.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from pam_ros.effects.base import Effect
from pam_ros.identification.candidate import EARNED, PROMISING, Fit, extended, fitted, freed
from pam_ros.identification.data.segment import FreeSegment, Segment
from pam_ros.identification.problem import Problem, finite
from pam_ros.identification.solve import Solution, amplified_cost, improved, solve
from pam_ros.rig.bind import bind
from pam_ros.rig.joint import Joint
from pam_ros.rig.run import acting_commands, delays_of
from pam_ros.rig.start import start_state

Array = NDArray[np.float64]
WIDTH = 0.15  # s of a bump, at least
SAMPLES = 14  # and that many
HOLE = 4.0  # periods between two samples of it, at most
SMOOTHED = 0.05  # s over which a quartic follows the motion
VISIBLE = 8.0  # noises by which a moving rig moves under a bump
MANY = 5  # bumps per unknown, at least
STEPS = 8  # iterations of a weak fit
LEADING = 0.1  # share of the best fall from which an effect is followed
TRIED = 2  # starts of an effect that are fitted
MOMENTS = 5  # the two integrals agree for polynomials of y up to this degree less one


@dataclass(frozen=True, eq=False)
class Motion:
    """A run as the weak form needs it.

    t, y, v (n,): s, m, m/s, the smoothed motion at the thinned stamps. rows (k, m): the
    intervals under each bump; weights (k, m, 2): what the integral of a over each, and its
    moment, count there; wanted (k,): what comes of it, in m, scaled so that each has the
    noise of the position. moving (k,) marks those under which the rig goes one way all the time.
    """

    segment: FreeSegment
    t: Array
    y: Array
    v: Array
    rows: NDArray[np.intp]
    weights: Array
    wanted: Array
    moving: NDArray[np.bool_]


def motion_of(full: FreeSegment, thin: FreeSegment, sigma: float) -> Motion:
    """Return the motion of a free run, its measurement from *full*, its stamps from *thin*.

    sigma is the noise of the position in m. Bumps are as wide as SAMPLES of a slow recording, and
    lie wholly in what may be fitted and is sampled densely enough; a short run has none.
    """
    y, v = _smoothed(full.t, full.target, SMOOTHED)
    period = float(np.median(np.diff(full.t)))
    half = 0.5 * max(WIDTH, SAMPLES * period)
    centres = np.arange(full.t[0] + half, full.t[-1] - half, half)
    middles = 0.5 * (thin.t[1:] + thin.t[:-1])
    rows = _under(thin.t, centres, half, thin.t.size - 1)
    many = _under(full.t, centres, half, full.t.size)
    z = (full.t[many] - centres[:, None]) / half
    dense = np.count_nonzero(np.abs(z) < 1.0, axis=1) > SAMPLES // 2
    dense &= np.diff(full.t[many], axis=1).max(axis=1, initial=0.0) < HOLE * period
    inside = full.fit[many].all(axis=1) & dense
    rows, many, centres, z = rows[inside], many[inside], centres[inside], z[inside]
    s = (middles[rows] - centres[:, None]) / half
    weights = np.stack([_bump(s), _bump_slope(s) / half], axis=2)
    slopes = _bump_curvature(z) * np.gradient(full.t)[many] / half**2
    slopes = _matched(slopes, _bump(z), z, _bump(s) * np.diff(thin.t)[rows], s, half)
    size = np.linalg.norm(slopes, axis=1)
    centred = full.target[many] - full.target[many].mean(axis=1, keepdims=True)
    return Motion(
        thin,
        thin.t,
        np.interp(thin.t, full.t, y),
        np.interp(thin.t, full.t, v),
        rows,
        weights / size[:, None, None],
        np.sum(slopes * centred, axis=1) / size,
        _moving(full, many, sigma),
    )


def _moving(full: Segment, many: NDArray[np.intp], sigma: float) -> NDArray[np.bool_]:
    y, v = _smoothed(full.t, full.target, WIDTH)
    one_way = np.abs(np.sign(v[many]).sum(axis=1)) == many.shape[1]
    return np.asarray(one_way & (np.abs(y[many[:, -1]] - y[many[:, 0]]) > VISIBLE * sigma))


def _under(t: Array, centres: Array, half: float, end: int) -> NDArray[np.intp]:
    """Return the indices below *end*, of samples or intervals, under a bump at each centre."""
    count = min(int(np.ceil(2.0 * half / float(np.median(np.diff(t))))) + 1, end)
    first = np.searchsorted(t, centres - half, side='right') - 1
    return np.asarray(np.clip(first, 0, end - count)[:, None] + np.arange(count))


def _bump(s: Array) -> Array:
    return np.where(np.abs(s) < 1.0, (1.0 - s * s) ** 3, 0.0)


def _bump_slope(s: Array) -> Array:
    return np.where(np.abs(s) < 1.0, -6.0 * s * (1.0 - s * s) ** 2, 0.0)


def _bump_curvature(s: Array) -> Array:
    return np.where(np.abs(s) < 1.0, -6.0 * (1.0 - s * s) * (1.0 - 5.0 * s * s), 0.0)


def _matched(slopes: Array, bump: Array, z: Array, weights: Array, s: Array, half: float) -> Array:
    """Return *slopes* corrected so that sampled integrals agree as the true ones do.

    For y = s^j: the sum of slopes times z^j must be that of weights times (s^j)''.
    """
    powers = z[:, :, None] ** np.arange(MOMENTS)
    asked = np.zeros((z.shape[0], MOMENTS))
    for j in range(2, MOMENTS):
        asked[:, j] = np.sum(weights * j * (j - 1) * s ** (j - 2), axis=1) / half**2
    missing = asked - np.einsum('kn,knj->kj', slopes, powers)
    spread = bump[:, :, None] * powers
    c = np.linalg.solve(np.einsum('kni,knj->kij', powers, spread), missing[:, :, None])
    return np.asarray(slopes + np.einsum('knj,kj->kn', spread, c[:, :, 0]))


def _smoothed(t: Array, y: Array, span: float) -> tuple[Array, Array]:
    """Return position and velocity of the quartic that follows the motion over *span* s."""
    period = float(np.median(np.diff(t)))
    even = np.arange(t[0], t[-1] + 0.5 * period, period)
    n = max(7, int(span / period)) | 1
    values = np.interp(even, t, y)
    if n > even.size:
        return y, np.gradient(y, t)
    curve = savgol_filter(values, n, 4)
    slope = savgol_filter(values, n, 4, deriv=1, delta=period)
    return np.interp(t, even, curve), np.interp(t, even, slope)


@dataclass(frozen=True, eq=False)
class WeakProblem(Problem):
    """A problem whose residuals are those of the equation of motion, in units of the position."""

    motions: tuple[Motion, ...] = ()
    moving: bool = False

    def residuals(self, u: Array) -> Array:
        """Return simulated - measured integrals over every bump, in m."""
        q = self.matrix_at(u)
        kernel, scratch = bind(self.layout, self.active), self.layout.scratch()
        delays = delays_of(self.layout, q)
        parts = []
        for m in self.motions:
            s = m.segment
            x = start_state(self.layout, q, (s.first_pressure,), s.y0, s.v0)
            a = np.empty((m.t.size - 1, 2))
            act_t, acting = acting_commands(s.drive_t, s.drive[:, None], delays)
            kernel.simulate_along(x, scratch, q, m.t, m.y, m.v, act_t, acting, a)
            e = np.einsum('knj,knj->k', a[m.rows], m.weights) - m.wanted
            parts.append(e[m.moving] if self.moving else e)
        return finite(np.concatenate(parts))


def weak_fits(parent: Fit, motions: Sequence[Motion], pool: Executor) -> list[Solution]:
    """Return the weak fits of the parameters of *parent*: to all bumps, and to moving ones.

    At rest friction may have any value, and so may the force of a hard stop: what such an effect
    is when it acts shows where the rig moves.
    """
    problem = parent.solution.problem
    kept = [k for k, x in enumerate(problem.unknowns) if x.is_parameter]
    unknowns = tuple(problem.unknowns[k] for k in kept)
    weak = []
    for moving in (False, True):
        count = sum(np.count_nonzero(m.moving) if moving else m.wanted.size for m in motions)
        if count > MANY * (len(kept) + 1):
            weak.append(WeakProblem(
                problem.segments, problem.layout, problem.active, problem.row, unknowns,
                float(count), problem.step, motions=tuple(motions), moving=moving,
            ))  # fmt: skip
    return list(pool.map(lambda one: solve(one, parent.solution.u[kept], STEPS), weak))


def at_weak(parent: Fit, weak: Solution) -> Fit:
    """Return *parent* fitted anew from where its *weak* fit has ended, if it comes down there."""
    free = parent.solution
    u = free.u.copy()
    u[[k for k, x in enumerate(free.problem.unknowns) if x.is_parameter]] = weak.u
    start = Solution(free.problem, u, free.problem.residuals(u), free.jacobian, 0)
    return fitted(parent.effects, improved(start, goal=free.cost))


def weak_starts(
    parent: Fit,
    model: Joint,
    effects: Sequence[Effect],
    read: Mapping[str, Sequence[dict[str, float]]],
    known: Sequence[Solution],
    pool: Executor,
) -> dict[str, list[tuple[Problem, Array]]]:
    """Return where the free run of *parent* may start with each of *effects*.

    Each is fitted on top of the weak fits *known* from its most promising starts, those that were
    *read* from the recording among them; what brings next to nothing there leads nowhere.
    """
    found: dict[str, list[tuple[Problem, Array]]] = {effect.name: [] for effect in effects}
    for base in known:
        jobs = [(base, model, e, read[e.name]) for e in effects]
        fits = list(pool.map(fitted_to, *zip(*jobs, strict=True)))
        falls = np.array([base.cost - fit.cost for fit in fits])
        worth = [k for k in np.argsort(-falls) if falls[k] > max(EARNED, LEADING * falls.max())]
        finest = pool.map(lambda k, f=fits: finer(f[k], model, effects[k]), worth)
        for k, best in zip(worth, finest, strict=True):
            found[effects[k].name].append(as_free(parent.solution, base, best))
    return found


def finer(fit: Solution, model: Joint, effect: Effect) -> Solution:
    """Return a weak fit with finer parameters of *effect* freed where they earn their cost."""
    wide = freed(fit, model, effect, STEPS)
    price = (wide.u.size - fit.u.size) * np.log(fit.problem.independent)
    return wide if wide.cost + price < fit.cost - EARNED else fit


def as_free(free: Solution, base: Solution, fit: Solution) -> tuple[Problem, Array]:
    """Return where the free run starts with what a weak *fit* has beyond its *base*.

    *base* has the unknowns of the fit *free* but for those of single runs.
    """
    kept = [k for k, x in enumerate(free.problem.unknowns) if x.is_parameter]
    unknowns = (*free.problem.unknowns, *fit.problem.unknowns[base.u.size :])
    u = np.concatenate([free.u, fit.u[base.u.size :]])
    u[kept] = fit.u[: base.u.size]
    row, active = fit.problem.row, fit.problem.active
    return replace(free.problem, row=row, active=active, unknowns=unknowns), u


def fitted_to(
    base: Solution, model: Joint, effect: Effect, read: Sequence[dict[str, float]] = ()
) -> Solution:
    """Return the best of the weak fits of *effect* on top of the weak fit *base*.

    From its known starts, and from those that were *read* from the recording.
    """
    guesses = []
    for values in (*effect.fit_starts, *read):
        problem, added = extended(base.problem, model, effect, values)
        u = np.concatenate([base.u, added])
        r = problem.residuals(u)
        guesses.append((amplified_cost(base, r), Solution(problem, u, r, r, 0)))
    guesses.sort(key=lambda guess: guess[0])
    promising = [begun for cost, begun in guesses[:TRIED] if cost < base.cost - PROMISING]
    fits = []
    for begun in promising or [guesses[0][1]]:
        columns = np.empty((begun.r.size, begun.u.size - base.u.size))
        start = replace(begun, jacobian=np.hstack([base.jacobian, columns]))
        # Of what promises nothing, a step says whether that is so.
        fits.append(improved(start, STEPS if promising else 1, frozen=base.u.size))
    return min(fits, key=lambda fit: fit.cost)
