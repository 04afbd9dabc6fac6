# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One score for any two models of the same recordings: their evidence, after Laplace.

The evidence of a model is the probability of the data under it, whatever its unknowns are:

    p(y) = integral p(y | z) p(z) dz

with the residual y, white after the map W of :mod:`pam_ros.identification.fit.discrepancy`, and
unknowns u = P z, where P holds the standard deviations of their priors and z ~ N(0, 1). Laplace's
method takes the posterior as normal around its maximum (MacKay, Information Theory, Inference and
Learning Algorithms, 2003, chapter 27). With the Jacobian J of W y there,

    -2 ln p(y) = |W y|^2 / sigma^2 + n ln(2 pi sigma^2) + ln det C
                 + z'z + ln det(1 + P J'J P / sigma^2)

which is exact where y is linear in u. The last term is what the unknowns cost: it grows with how
much more the data say of them than was known before, so that no count of parameters is needed
beside it. At the most likely sigma^2 = |W y|^2 / n the first two terms are n ln sigma^2 and
n (1 + ln 2 pi), which is the same for all models and is left out.

A difference of 10 between two models is very strong evidence (Kass and Raftery 1995).
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def score(whitened: Array, jacobian: Array, z: Array, prior: Array, log_det: float) -> float:
    """Return -2 ln(evidence) but for a constant of the data: the lower, the better the model.

    *whitened* (n,) is the residual W y at the most probable unknowns, of all runs one after the
    other, *jacobian* (n, k) its derivatives to the unknowns u, *z* (k,) the unknowns in standard
    deviations of their priors *prior* (k,), all finite, and *log_det* the sum of ln det C of the
    runs.
    """
    n = whitened.size
    variance = float(whitened @ whitened) / n
    scaled = jacobian * prior
    _, price = np.linalg.slogdet(np.eye(prior.size) + scaled.T @ scaled / variance)
    return float(n * np.log(variance) + log_det + z @ z + price)
