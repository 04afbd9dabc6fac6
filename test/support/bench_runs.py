# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run of a bench without ROS, for what a real one does only by accident: it cannot be made."""

import numpy as np

from pam_ros.bench.outcome import Outcome, Status
from pam_ros.bench.runs import Finished
from pam_ros.bench.trial import Trial

FULL = 'full'  # a file beside the scenario: while it exists, a run with seed 1 has no disk


def run(scenario, controller, seed, domain):
    """Return a run that follows from its seed, and note it beside the scenario."""
    folder = scenario.file.parent
    with (folder / 'performed.txt').open('a', encoding='ascii') as file:
        file.write(f'{controller.name}{seed}\n')
    if seed == 1 and (folder / FULL).exists():
        raise OSError(28, 'No space left on device')
    random = np.random.default_rng(seed)
    outcome = Outcome(
        scenario.name,
        controller.name,
        seed,
        Status.COMPLETED,
        '',
        {'error_at_rest': float(random.uniform())},
        False,
        False,
        1.0,
        2.0,
    )
    n = 1000
    trial = Trial(
        np.arange(n) / 500.0,
        random.normal(size=n),
        np.zeros(n),
        random.uniform(0.0, 600e3, (n, 1)),
        np.array([[0.0], [600e3]]),
        np.zeros(n),
        np.zeros(0),
    )
    return Finished(outcome, trial)
