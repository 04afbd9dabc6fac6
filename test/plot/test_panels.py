# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Curves as plots with titles, names and gaps, and their figure."""

import matplotlib.image
import numpy as np
import pytest

from pam_ros.errors import PamError
from pam_ros.plot.colours import COLOURS, colour
from pam_ros.plot.figure import figure, save
from pam_ros.plot.panels import Curves, name_of, panels, with_gaps
from pam_ros.plot.topics import Key
from pam_ros.plot.value_axis import judged

T = np.arange(200) / 100.0


def curve(factor=1.0):
    return T, factor * np.sin(T)


ONE = {
    Key('position', 'joint_states', 'pam'): curve(0.01),
    Key('effort', 'joint_states', 'pam'): curve(200.0),
    Key('position', 'pam_control/state'): curve(0.011),
    Key('position', 'position_reference'): (np.array([0.5]), np.array([0.06])),
    Key('pressure', 'pressure'): curve(1e5),
    Key('pressure', 'pressure_command'): curve(1.1e5),
    Key('force', 'force'): curve(200.0),
    Key('stiffness', 'stiffness'): curve(1e4),
    Key('damping', 'damping'): curve(300.0),
}
PAIR = {
    Key('position', 'joint_states', 'elbow'): curve(),
    Key('effort', 'joint_states', 'elbow'): curve(),
    **{Key('pressure', 'pressures', str(i)): curve(i + 1.0) for i in range(2)},
    **{Key('pressure', 'pressure_commands', str(i)): curve(i + 1.0) for i in range(2)},
}


def test_one_muscle():
    made = panels(Curves(ONE), '', 2.0)
    assert [(one.title, [line.name for line in one.lines]) for one in made] == [
        ('position, m or rad', ['position_reference', 'reference', 'pam']),
        ('pressure (gauge), Pa', ['pressure_command', 'pressure']),
        ('force, N', ['force']),
        ('stiffness, N/m', ['stiffness']),
        ('damping, N·s/m', ['damping']),
    ]
    reference = made[0].lines[0]
    assert reference.t.tolist() == [0.5, 2.0]  # it holds until now
    assert reference.value.tolist() == [0.06, 0.06]
    assert [line.is_set_point for line in made[0].lines] == [True, True, False]
    assert [line.is_held for line in made[0].lines] == [True, False, False]


def test_a_joint_of_two_muscles():
    made = panels(Curves(PAIR, ('flexor', 'extensor')), 'rad', 2.0)
    assert [one.title for one in made] == [
        'position, rad',
        'pressure (gauge), Pa',
        'effort of the joint, N·m',
    ]
    lines = made[1].lines
    assert [(line.name, line.number) for line in lines] == [
        ('flexor, commanded', 0),
        ('extensor, commanded', 1),
        ('flexor', 0),
        ('extensor', 1),
    ]
    assert name_of(Key('pressure', 'pressures', '1'), ()) == 'muscle 2'


def test_joints_have_colours_of_their_own():
    keys = [Key('position', 'joint_states', name) for name in ('hip', 'knee', 'ankle')]
    (made,) = panels(Curves(dict.fromkeys(keys, curve())), 'rad', 2.0)
    assert [(line.name, line.number) for line in made.lines] == [
        ('hip', 0),
        ('knee', 1),
        ('ankle', 2),
    ]
    assert len({colour(line.number) for line in made.lines}) == 3
    assert colour(len(COLOURS)) == COLOURS[0]


def test_a_pause_and_a_time_that_goes_back_are_gaps():
    t = np.concatenate([T, T + 10.0, T + 5.0])
    found_t, found = with_gaps(t, np.ones(t.size))
    assert found.size == t.size + 2
    assert np.isnan(found[[T.size, 2 * T.size + 1]]).all()
    assert np.isfinite(found).sum() == t.size
    assert found_t[T.size] == 10.0
    slow = np.arange(20.0)  # a period of 1 s is no pause
    assert np.isfinite(with_gaps(slow, slow)[1]).all()


def test_the_figure_has_all_lines_on_one_axis_of_time():
    made = panels(Curves(ONE), 'm', 2.0)
    drawn = figure(made, 0.0, 2.0)
    assert [ax.get_title(loc='left') for ax in drawn.axes] == [
        'position, mm',
        'pressure (gauge), kPa',
        'force, N',
        'stiffness, N/m',
        'damping, N·s/m',
    ]
    factors = {'position': 1e3, 'pressure': 1e-3}
    for ax, panel in zip(drawn.axes, made, strict=True):
        assert ax.get_xlim() == (0.0, 2.0)
        names = [text.get_text() for text in ax.get_legend().get_texts()]
        assert names == [line.name for line in panel.lines]
        for line, own in zip(ax.get_lines(), panel.lines, strict=True):
            factor = factors.get(panel.quantity, 1.0)
            assert np.array_equal(line.get_ydata(), factor * own.value)
            assert line.get_color() == colour(own.number)
    assert drawn.axes[-1].get_xlabel() == 'time, s'


def test_the_figure_counts_what_is_outside():
    value = 0.05 + 0.001 * np.sin(T)
    value[77] = 60.0
    key = Key('position', 'joint_states', 'pam')
    (panel,) = panels(judged(Curves({key: (T, value)})), 'm', 2.0)
    (ax,) = figure([panel], 0.0, 2.0).axes
    assert 48.0 < ax.get_ylim()[0] < ax.get_ylim()[1] < 52.0
    assert [text.get_text() for text in ax.texts] == ['▲ 1 sample is outside']
    marks = [line for line in ax.get_lines() if line.get_marker() == '^']
    assert [line.get_xdata().tolist() for line in marks] == [[T[77]]]


def test_a_file_is_written_completely_or_not_at_all(tmp_path):
    drawn = figure(panels(Curves(ONE), 'm', 2.0), 0.0, 2.0)
    save(drawn, tmp_path / 'rig.png')
    pixels = matplotlib.image.imread(tmp_path / 'rig.png')
    assert pixels.shape[1] == 2160
    assert pixels[..., :3].min() < 0.5  # lines on white
    assert list(tmp_path.iterdir()) == [tmp_path / 'rig.png']
    (tmp_path / 'taken.png').mkdir()
    with pytest.raises(PamError, match=r'taken\.png cannot be written'):
        save(drawn, tmp_path / 'taken.png')
    with pytest.raises(PamError, match='cannot be written'):
        save(drawn, tmp_path / 'nowhere' / 'rig.png')
    assert sorted(path.name for path in tmp_path.iterdir()) == ['rig.png', 'taken.png']
