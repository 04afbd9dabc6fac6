# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The list of scenarios and scores, as text."""

from collections.abc import Sequence
from textwrap import fill

from pam_ros.bench.scenario import Scenario
from pam_ros.bench.scores import SCORES

WIDTH = 99


def text(scenarios: Sequence[Scenario]) -> str:
    """Return a paragraph for each of *scenarios*, then the definition of each score."""
    wide = max((len(one.name) for one in scenarios), default=0) + 2
    lines = [
        _paragraph(one.name, wide, f'{one.about} {one.duration:g} s, decided by {one.score}')
        for one in scenarios
    ]
    wide = max(len(score.name) for score in SCORES) + 2
    scores = [_paragraph(score.name, wide, f'[{score.unit}] {score.text}') for score in SCORES]
    return '\n'.join(['scenarios:', *lines, '', 'scores, lower is better:', *scores])


def _paragraph(name: str, wide: int, content: str) -> str:
    return fill(
        content,
        WIDTH,
        initial_indent=f'  {name:<{wide}}',
        subsequent_indent=' ' * (wide + 2),
    )
