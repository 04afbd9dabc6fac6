# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Comparisons of models: by score, by the errors of free runs, and by what an effect explains."""

from collections.abc import Iterable

import numpy as np

from pam_ros.identification.search.setting import Model, Setting


def is_accepted(model: Model, other: Model, setting: Setting) -> bool:
    """Return whether a larger model's score is lower by the margin and its free run no worse."""
    return model.score < other.score - setting.criteria.margin and is_no_worse(
        model, other, setting
    )


def is_sufficient(less: Model, other: Model, setting: Setting) -> bool:
    """Return whether a smaller model is as good: score in the margin, free run no worse."""
    return is_within_margin(less, other, setting) and is_no_worse(less, other, setting)


def is_within_margin(less: Model, other: Model, setting: Setting) -> bool:
    """Return whether the score of a smaller model is higher by at most the margin."""
    return less.score <= other.score + setting.criteria.margin


def is_no_worse(model: Model, other: Model, setting: Setting) -> bool:
    """Return whether a model's free run over *choose* loses no more than it gains over *fit*.

    The product of both errors may grow by the factor ``worse``: constants that are fitted to half
    of the data increase the error in the other half by some percent.
    """
    a, b = other.errors, model.errors
    return b.free_run * b.fit <= setting.criteria.worse * a.free_run * a.fit


def within_tolerance(model: Model, other: Model, setting: Setting) -> bool:
    """Return whether the error of a simpler model is hardly larger, on *fit* and on *choose*."""
    room, a, b = 1.0 + setting.criteria.gain, other.errors, model.errors
    return b.fit <= room * a.fit and b.choose <= room * a.choose


def is_complete(model: Model, setting: Setting) -> bool:
    """Return whether a model with effects leaves only noise, with constants as expected."""
    if not model.effects or model.strain > setting.criteria.strain:
        return False
    most = setting.criteria.complete * setting.noise
    return max(model.errors.fit, model.errors.choose) <= most


def is_significant(model: Model, before: Model, retuned: Model, setting: Setting) -> bool:
    """Return whether a new effect explains more than an error in the form of the others could.

    It does not if the error of the free run over *choose* is larger than that of the re-tuned
    model by more than the factor ``worse``.
    """
    criteria = setting.criteria
    if model.errors.free_run > criteria.worse * retuned.errors.free_run:
        return False
    if before.strain - model.strain >= criteria.strain >= model.strain:
        return True
    pairs = [
        (model.errors.fit, before.errors.fit, retuned.errors.fit),
        (model.errors.choose, before.errors.choose, retuned.errors.choose),
    ]
    if not before.effects:
        return all(b <= (1.0 - criteria.gain) * a for b, a, _ in pairs)
    if before.score - model.score >= criteria.form * (retuned.score - before.score):
        return True

    def does(b: float, a: float, whole: float) -> bool:
        explained = float(np.sqrt(max(a * a - b * b, 0.0)))
        return explained >= criteria.form * setting.above(whole) or setting.above(b) <= (
            1.0 - criteria.most
        ) * setting.above(a)

    return all(does(*pair) for pair in pairs)


def with_errors(models: Iterable[Model], setting: Setting) -> None:
    """Compute the errors of *models* in parallel; they are stored."""
    list(setting.pool.map(lambda model: model.errors, models))
