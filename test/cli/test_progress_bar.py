# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The progress of ``pam_identify`` on standard error."""

import io
import sys

from pam_ros.cli.progress_bar import ProgressBar

SIZE = '2 cores (1 recording, 6000 samples, 18 effects)'


class Terminal(io.StringIO):
    def isatty(self):
        return True


def show(bar):
    """Show the steps of an identification."""
    bar(0.0, 're-tuning the parameters')
    bar.time_left(70.0, 200.0)
    bar(0.1, 'trying effects, round 1')
    bar.time_left(10.0, 150.0)
    bar(0.3, 'trying effects, round 1')
    bar.time_left(10.0, 50.0)
    bar(0.5, 'confirming')
    bar(1.0, 'done')
    bar.close()


def test_without_a_terminal_there_is_a_line_for_each_step(monkeypatch):
    monkeypatch.setattr(sys, 'stderr', io.StringIO())
    show(ProgressBar(SIZE, lambda: False))
    assert sys.stderr.getvalue().splitlines() == [
        '  0 %  re-tuning the parameters',
        f'1 to 4 min on {SIZE}',
        ' 10 %  trying effects, round 1, 1 to 4 min left',
        ' 50 %  confirming, less than a minute left',
        '100 %  done',
    ]


def test_on_a_terminal_the_bar_has_the_time_that_is_left_now(monkeypatch):
    monkeypatch.setattr(sys, 'stderr', Terminal())
    show(ProgressBar(SIZE, lambda: False))
    shown = [line.strip() for line in sys.stderr.getvalue().replace('\n', '\r').split('\r')]
    assert f'1 to 4 min on {SIZE}' in shown
    steps = [line.split('| ')[-1] for line in shown if '|' in line]
    assert 'trying effects, round 1, 1 to 4 min left' in steps
    assert 'trying effects, round 1, 10 s to 3 min left' in steps


def test_after_an_interrupt_a_line_states_once_what_follows(monkeypatch):
    monkeypatch.setattr(sys, 'stderr', io.StringIO())
    signals = []
    bar = ProgressBar(SIZE, lambda: bool(signals))
    for text in ('first', 'second', 'third', 'fourth'):
        bar(0.5, text)
        signals += ['SIGINT'] * (text == 'second')
    note = 'interrupted: the report of the best model so far follows, a second Ctrl-C ends at once'
    steps = [f' 50 %  {text}' for text in ('first', 'second', 'third', 'fourth')]
    assert sys.stderr.getvalue().splitlines() == [*steps[:2], note, *steps[2:]]
