# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Results of a bench that was not run: scores are stated by the test."""

from pam_ros.bench.outcome import Outcome, Provenance, Results, ScenarioAbout, ScoreAbout, Status
from pam_ros.report.provenance import versions

SCORES = (
    ScoreAbout('error_at_rest', 'position', 'Largest error at the end.', 'A standard', False),
    ScoreAbout('rms_error', 'position', 'Root mean square error.', '', False),
    ScoreAbout('settling_time', 's', 'Time until the error stays small.', '', False),
    ScoreAbout('limit_violations', 'percent', 'Share of commands beyond a limit.', '', False),
    ScoreAbout('computing_time', 'ms', 'Median time of an answer.', '', True),
)
SOURCE = Provenance('pam_bench a', '2026-12-01T00:00:00+00:00', versions(), {'step': 64 * 'a'})


def results_of(table, *, revolute=(), real_time=(), others=None):
    """Return results with seeds 0, 1 ... from {scenario: {controller: [value or Status]}}.

    The values are the error_at_rest, the main score; *others* are the other scores of each run.
    """
    outcomes = [
        Outcome(
            scenario,
            controller,
            seed,
            value if isinstance(value, Status) else Status.COMPLETED,
            'its process ended with exit code 1' if isinstance(value, Status) else '',
            {} if isinstance(value, Status) else {'error_at_rest': value, **(others or {})},
            scenario in revolute,
            controller in real_time,
            2.0,
            24.0,
        )
        for scenario, row in table.items()
        for controller, values in row.items()
        for seed, value in enumerate(values)
    ]
    about = {name: ScenarioAbout('A step of 20 mm', 'error_at_rest') for name in table}
    names = tuple(dict.fromkeys(outcome.controller for outcome in outcomes))
    return Results(about, names, SCORES, tuple(outcomes), SOURCE)
