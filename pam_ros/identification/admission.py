# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Admission: which candidates of a round count as effects that the model lacks, and the first."""

from collections.abc import Sequence
from dataclasses import dataclass

from pam_ros.effects.base import Effect
from pam_ros.identification import evidence
from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.noise import Noise

SURELY = 0.9  # share of the noise floor below which no model can come
AS_GOOD = 0.03  # share of the RMSE kept back by which two candidates may differ
ABOUT = 0.15  # and an effect from one that it is contained in
AS_MUCH = 0.03  # and of the fall that the better one brings
IMPLAUSIBLE = 12.0  # chi square of re-tuned parameters under their prior that asks for a reason


@dataclass(frozen=True, eq=False)
class Tried:
    """A candidate's fit in a round, and what speaks for it."""

    effect: Effect
    parents: tuple[str, ...]
    fit: Fit
    evidence: evidence.Evidence
    rank: float
    chosen: bool = False


def plainest(able: Sequence[Tried]) -> Tried:
    """Return the candidate with the fewest parameters that explains as much as the first.

    One that becomes another of them as its strength vanishes is not the plainest: a leak so
    small that only its refill shows is a lag. It is not even the better one by a little less of
    the samples kept back, where that other one fits better.
    """
    best = able[0]
    equal = [t for t in able if explains_as_much(t, best) or _is_contained(t, best)]
    names = {t.effect.name for t in equal}
    return min(equal, key=lambda t: (bool(names & set(t.effect.contains)), len(t.fit.solution.u)))


def explains_as_much(tried: Tried, best: Tried) -> bool:
    """Say whether a candidate leaves as little of the samples kept back as the *best*, in use.

    Statistics alone would tell apart what two models miss by the last bit of their numerics.
    """
    least = best.fit.held_error
    without = least / (1.0 - best.evidence.gain)
    tolerance = min(AS_GOOD * least, AS_MUCH * max(without - least, 0.0))
    return tried.fit.held_error <= least + tolerance


def _is_contained(tried: Tried, best: Tried) -> bool:
    return (
        tried.effect.name in best.effect.contains
        and tried.fit.score < best.fit.score
        and tried.fit.held_error < (1.0 + ABOUT) * best.fit.held_error
    )


def admitted(tried: Tried, parent: Fit, retuned: Fit, noise: Noise) -> bool:
    """Say whether a candidate counts as an effect that the model lacks."""
    e = tried.evidence
    if not e.interval_clear or e.p > evidence.SIGNIFICANCE:
        return False
    if is_odd(tried.effect, parent, tried.fit):
        return False
    if e.absorbed:
        return True
    if e.gain < evidence.GAIN:
        return False
    return not parent.effects or matters(parent, tried.fit, retuned, noise)


def matters(without: Fit, fit: Fit, retuned: Fit, noise: Noise) -> bool:
    """Say whether a further effect explains more than the form of those before it could miss.

    No effect of the library is quite the one of nature, and the rest that it leaves invites
    others: so a further one must explain a share of what re-tuning left, or much of the rest,
    and the more so the more are there.
    """
    return _is_much(without.held_error - fit.held_error, without, retuned, noise)


def could_matter(fit: Fit, retuned: Fit, noise: Noise) -> bool:
    """Say whether *fit* leaves so much unexplained that one more effect could matter.

    That is above the noise, or by parameters that are far from those declared.
    """
    return strain(fit) > IMPLAUSIBLE * leeway(fit, noise) or _is_much(
        fit.held_error - SURELY * noise.sigma, fit, retuned, noise
    )


def _is_much(fall: float, without: Fit, retuned: Fit, noise: Noise) -> bool:
    excess = max(retuned.held_error - noise.sigma, 0.0)
    there = max(len(without.effects), 1)
    gain = 1.0 - (1.0 - evidence.LATER_GAIN) ** there
    return fall >= there * evidence.LATER_SHARE * excess or fall >= gain * without.held_error


def absorbed(parent: Fit, fit: Fit, effect: Effect, noise: Noise) -> bool:
    """Say whether *effect* explains what re-tuning explains, too, but only by odd parameters."""
    relief = strain(parent) - strain(fit)
    return is_static(effect) and relief > IMPLAUSIBLE * leeway(parent, noise)


def is_odd(effect: Effect, without: Fit, fit: Fit) -> bool:
    """Say whether *effect* changes the mass, and explains only what odd parameters let it.

    Half the mass with half of every force moves as the whole does: where a model misses something
    else, a payload may win a little by constants that no specimen has.
    """
    return effect.mass is not None and strain(fit) - strain(without) > IMPLAUSIBLE


def p_of(parent: Fit, fit: Fit, noise: Noise) -> float:
    """Return the p value of a fit: of its residuals, or of its less strained parameters."""
    from scipy.stats import chi2

    count = len(fit.solution.u) - len(parent.solution.u)
    relief = max(strain(parent) - strain(fit), 0.0) / leeway(parent, noise)
    return min(evidence.f_test(parent, fit), float(chi2.sf(relief, count)))


def leeway(fit: Fit, noise: Noise) -> float:
    """Return by how much the parameters of *fit* may be odder than its declared ones.

    Behind other effects they make up for what these miss by their form, the more, the more is
    left above the noise.
    """
    return max(1.0, (fit.held_error / noise.sigma) ** 2) if fit.effects else 1.0


def strain(fit: Fit) -> float:
    """Return how far the declared parameters were moved, as a chi square."""
    problem = fit.solution.problem
    z = problem.priors(fit.solution.u)
    return float(sum(a * a for a, k in zip(z, problem.unknowns, strict=True) if k.is_parameter))


def is_static(effect: Effect) -> bool:
    """Say whether an effect only changes what the parameters of the model could change too."""
    where = (effect.mass, effect.contraction, effect.pressure)
    return not effect.states and any(f is not None for f in where)
