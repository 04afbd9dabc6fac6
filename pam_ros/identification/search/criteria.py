# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers that decide in a search, each with its reason, and those that limit computing."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Criteria:
    """What decides.

    ``margin``: of two models, how much lower the score of the better one must be. The score is
    -2 ln(evidence), and 10 is "very strong" (Kass and Raftery 1995).
    ``fit``, ``choose``: shares of each recording at which the part that fits see ends, and the
    part that choices see. The rest judges. Half of the data fix parameters, and a quarter each is
    long enough to show what a model carries on to by itself.
    ``worse``: factor by which a move may raise the product of the errors of the free run over
    *fit* and *choose*. The score weighs whitened residuals, in which a slow drift costs little; a
    free run shows it.
    ``gain``: share by which a first effect must lower the error, on *fit* and on *choose*.
    Jittered stamps, and constants two deviations of their priors away, are worth scores of 10 to
    20 to any effect, and 0.5 % of the error.
    ``strain``: or by how much it must lower the prior chi-square of the declared constants, which
    re-tuning has moved to make up for it, and what may be left of that. Of seven constants within
    their priors one specimen of 180 has more than 20.
    ``form``: share of what re-tuning leaves that a further effect must explain, or of what the
    others have lowered the score by. No law of the library has nature's form: those of another
    plant left 5 to 15 % of what the right effect explained, and that rest invites other effects.
    ``most``: or the share, of what the model before it leaves above the noise.
    ``complete``: errors in noise floors within which a model explains everything.
    ``left``: share of what re-tuning leaves above the noise that a claim may leave, if that is
    more than the noise: on *fit*, and on *fit* and *choose* by the geometric mean. Of some 80
    recordings the right effects left at most 0.30, most of them below 0.1. Of what the library
    does not have, wrong effects left 0.62 to 0.96 of a backlash and a second mode, 0.30 to 0.97 of
    a coupling, a saturation and a random walk, and 0.22 to 0.59 of a drift with the temperature,
    whose form is much like that of softening. The same share says since when a re-tuned model
    fails: before the moment it leaves no more than that of what it leaves after, and at most the
    noise over that share. Of 36 recordings in which something began it left 0.4 to 2.1 noise
    floors before and 2.5 to 1500 after; where it had lacked an effect all along, 6 and more
    before.
    ``duration``: s of recording at least, and ``range``: in noise floors, what the target must
    change by at least, for a verdict. They are what excites a rig's slowest mode (some 0.5 Hz) a
    few times, and what leaves an error of a tenth of the motion above the noise.
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
    """What limits computing.

    ``effects``: most effects of a model. ``rounds``: most steps from model to better model.
    ``looks``: iterations of a first fit from each start. ``fits``: starts of an effect from which
    a fit goes on. ``rivals``: candidates of a round that are fitted closer, by ``closer``
    iterations, as the last fits are from where long steps have led. ``iterations``: those of a fit
    to its end. ``finer``: steps of the last fit for one of the others. ``nearer``: iterations from
    the place of the best score towards the nearest free run. ``window``: length in s of the runs
    of a load without a spring. ``samples``: most thinned samples that a search fits; of what is
    longer, rests are shortened, and recordings left out but for one.
    """

    effects: int = 3
    rounds: int = 6
    looks: int = 4
    fits: int = 2
    rivals: int = 4
    closer: int = 15
    iterations: int = 60
    nearer: int = 25
    finer: int = 5
    window: float = 2.0
    samples: int = 30_000


CRITERIA, BUDGET = Criteria(), Budget()
