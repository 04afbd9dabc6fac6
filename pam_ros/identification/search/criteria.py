# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers for the decisions of a search, each with its reason, and limits of computing."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Criteria:
    """The numbers for decisions.

    ``margin``: least difference between the scores of two models for a decision. The score is
    -2 ln(evidence), and 10 is "very strong" (Kass and Raftery 1995).
    ``fit``, ``choose``: shares of each recording at which the fitted part ends, and at which the
    part for choices ends. The rest is used to judge. Half of the data determine the
    parameters, and each of the other parts shows how well the free run of a model continues.
    ``worse``: factor by which a move may raise the product of the errors of the free run over
    *fit* and *choose*. The score weighs whitened residuals, in which a slow drift costs little; a
    free run shows it.
    ``gain``: share by which a first effect must lower the error, on *fit* and on *choose*. With
    jittered stamps, or with constants two standard deviations of their priors away, any effect can
    lower the score by 10 to 20 and the error by 0.5 %.
    ``strain``: alternatively, the least decrease of the prior chi-square of the nominal constants,
    which re-tuning has moved to compensate for the missing effect, and the largest value that may
    remain. With seven constants within their priors one specimen of 180 has more than 20.
    ``form``: share of the error after re-tuning that a further effect must explain, or share of
    the decrease of the score by the other effects. No law of the library has exactly the form of
    the real system: the laws of another plant left 5 to 15 % of what the right effect explained,
    and other effects can explain this rest.
    ``most``: alternatively, the share that it must explain of the error above the noise of the
    model before it.
    ``complete``: largest error, in noise floors, of a model that explains everything.
    ``left``: largest share of the error above the noise after re-tuning that may remain with the
    claimed effects, if it is more than the noise: on *fit*, and on *fit* and *choose* by the
    geometric mean. In some 80 recordings the right effects left at most 0.30, most of them below
    0.1. For phenomena that the library does not have, wrong effects left 0.62 to 0.96 of a
    backlash and a second mode, 0.30 to 0.97 of a coupling, a saturation and a random walk, and
    0.22 to 0.59 of a drift with the temperature, whose form is similar to that of softening. At
    least this share of the error over the judging data must be explained, too: over them the
    right effects of 27 recordings left at most 0.30, and effects that a later change of the rig
    contradicted left 0.85 to 1.00. The same share determines the time from which a model fails:
    before it, its error is at most this share of its later error, and at most the noise over this
    share. In 36 recordings in which something began, it was 0.4 to 2.1 noise floors before and
    2.5 to 1500 after; if an effect was missing from the start, it was 6 and more before.
    ``duration``: least s of recording, and ``range``: least change of the target, in noise floors,
    for a verdict. The duration excites a rig's slowest mode (some 0.5 Hz) a few times. With this
    range an error of a tenth of the motion is above the noise.
    """

    margin: float = 10.0
    fit: float = 0.55
    choose: float = 0.75
    worse: float = 1.05
    gain: float = 0.03
    strain: float = 20.0
    form: float = 0.15
    most: float = 0.60
    complete: float = 1.1
    left: float = 0.30
    duration: float = 5.0
    range: float = 10.0


@dataclass(frozen=True)
class Budget:
    """Limits of computing.

    ``effects``: most effects of a model. ``rounds``: most steps from model to better model.
    ``screening``: iterations of a first fit from each start, and of those from its result towards
    the nearest free run. ``fits``: starts of an effect from which a fit continues. ``rivals``:
    candidates of a round that are fitted further, by ``closer`` iterations; the last fits use as
    many, from the results with long steps. ``iterations``: those of a complete fit. ``finer``:
    number of steps of the confirming fit in one step of the others. ``nearer``: iterations from
    the result of a closer fit towards the nearest free run.
    ``window``: length in s of the runs of a load without a spring. ``samples``: thinned samples
    that a search needs; if there are more, they are thinned further, and if there are far more,
    rests are shortened before. ``most``: most samples that it fits; if there are still more,
    recordings are left out, but never all.
    """

    effects: int = 3
    rounds: int = 6
    screening: int = 4
    fits: int = 2
    rivals: int = 4
    closer: int = 15
    iterations: int = 60
    nearer: int = 25
    finer: int = 5
    window: float = 2.0
    samples: int = 3_000
    most: int = 30_000


CRITERIA, BUDGET = Criteria(), Budget()
