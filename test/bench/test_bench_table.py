# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The lines and the table of a bench, as a reader sees them."""

from dataclasses import replace

import pytest

from pam_ros.bench.outcome import ScenarioAbout, Status
from pam_ros.bench.table import WIDTH, line, table
from support.outcomes import SCORES, results_of

LONG = 'a_controller_' + 30 * 'x'


def test_a_run_is_one_line():
    results = results_of({'step': {'a': [1.2e-5], 'b': [Status.DIED]}}, others={'rms_error': 4e-4})
    assert line(results.outcomes[0], SCORES, 'error_at_rest') == (
        'step              a             seed 0  error at rest 0.0120 mm  rms error 0.400 mm  '
        '12x real time'
    )
    assert line(results.outcomes[1], SCORES, 'error_at_rest') == (
        'step              b             seed 0  died: its process ended with exit code 1'
    )
    late = replace(results.outcomes[0], is_real_time=True, is_revolute=True)
    assert line(late, SCORES, 'rms_error') == (  # there is no space for a second score
        'step              a             seed 0  rms error 0.400 mrad  in real time'
    )


def test_the_table_shows_each_controller_and_marks_the_best():
    died = Status.DIED
    text = table(
        results_of(
            {
                'step': {'a': [1e-5, 2e-5, 1e-5], 'b': [4e-4, 5e-4, 4e-4], 'c': 3 * [died]},
                'turn': {'a': [1e-3, died, died], 'b': [0.0, 0.0, 0.0], 'c': [1e-4, 1e-4, None]},
            },
            revolute={'turn'},
            real_time={'b'},
            others={'limit_violations': 0.0, 'computing_time': 0.25},
        )
    )
    assert [text_line.rstrip() for text_line in text.splitlines()] == [
        'step: A step of 20 mm',
        '                        error at  its worst,  computing',
        '  controller            rest, mm          mm   time, ms',
        '  a                      0.0100*     0.0200      0.250',
        '  b                       0.400       0.500      0.250',
        '  c                     died with 3 of 3 seeds: its process ended with exit code 1',
        '',
        'turn: A step of 20 mm',
        '                          error at  its worst,  computing',
        '  controller            rest, mrad        mrad   time, ms',
        '  a                          1.00        1.00      0.250',
        '    died with 2 of 3 seeds: its process ended with exit code 1',
        '  b                             0           0      0.250',
        '  c                         0.100       0.100      0.250',
        '',
        '2 scenarios, by their main scores',
        '  controller            best  not worse  failed',
        '  a                        1          1       1',
        '  b                        0          1       0',
        '  c                        0          0       1',
        '',
        'Values are medians of 3 seeds; lower is better.',
        '* best: lower than each other controller by at least 1 % and by more than the spread '
        'over the seeds',
        '      (paired t test, p < 0.05).',
        'not worse: no other controller is lower by so much.',
        'A controller that failed with a seed counts as worse than one that completed all.',
        'Without simulated time, thus in real time: b.',
    ]


@pytest.mark.parametrize('value', [1.234e-12, 1.234e11, 0.0, None, Status.NOT_FINITE])
def test_lines_have_at_most_the_width(value):
    others = {'rms_error': value, 'settling_time': value, 'computing_time': value}
    results = results_of(
        {LONG: {LONG: [value], 'b\x1b[2J': [Status.SILENT]}},
        others={} if isinstance(value, Status) else others,
    )
    results = replace(results, about={LONG: ScenarioAbout(40 * 'words and ', 'rms_error')})
    texts = [table(results), *(line(run, SCORES, 'rms_error') for run in results.outcomes)]
    lines = '\n'.join(texts).split('\n')
    assert max(map(len, lines)) <= WIDTH
    assert all(one.isprintable() for one in lines)
    assert 'a single seed has no spread' in texts[0]
