# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A warning on identified constants that no specimen of the nominal muscle has."""

from pam_ros.identification.fit.solve import Solution
from pam_ros.identification.fit.unknowns import Constant
from pam_ros.identification.result import Conclusion, Verdict
from pam_ros.identification.wording import listed
from pam_ros.rig import layout as at

# Standard deviations of its prior beyond which a constant is not that of another specimen.
FAR = 6.0


def of_constants(solution: Solution, answer: Conclusion) -> list[str]:
    """Return a warning if constants in the last *solution* are far from the nominal ones.

    a1 is not considered, since it is a small correction to a5. Nothing is said if the data cannot
    support a verdict.
    """
    if answer.verdict == Verdict.INSUFFICIENT_DATA:
        return []
    far = [
        (unknown.name, unknown.value(u) / unknown.base)
        for unknown, u, z in zip(solution.problem.unknowns, solution.u, solution.z, strict=True)
        if isinstance(unknown.of, Constant) and at.A1 < unknown.of.which <= at.A6 and abs(z) > FAR
    ]
    if not far:
        return []
    names = listed([f'{name} {100.0 * share:.0f} %' for name, share in far])
    return [
        f'identified constants are far from the nominal ones ({names} of their nominal values), '
        'but those of a specimen are within some percent: is it another muscle, or is a unit, a '
        'sign or the load wrong?'
    ]
