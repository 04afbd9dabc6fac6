# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page of ``pam_plot`` in a real browser: what the mouse and the buttons do."""

import re

import matplotlib.image
import numpy as np
import pytest

from pam_ros.plot.recorded import read
from pam_ros.plot.topics import Key
from pam_ros.plot.value_axis import value_axis
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.read import read_recording
from support.plotted import COMMAND, FORCE, PRESSURE, READY, Rig


def number(text):
    return float(text.replace('−', '-'))


@pytest.mark.parametrize('is_live', [True, False])
def test_a_drag_zooms_all_plots_and_reset_goes_back(show, is_live):
    rig = Rig(is_live)
    shown = show(rig)
    assert shown.axis() == (0.0, 20.0)
    shown.zoom(5.0, 8.0, plot=1)
    start, end = shown.axis()
    assert (start, end) == pytest.approx((5.0, 8.0), abs=0.1)
    # The axes are those of what is seen.
    shown.page.until('sections[0].y.end < 100', 'the axes of values')
    for plot, panel in zip(shown.plots(), rig.panels(), strict=True):
        factor = {'position': 1e3, 'pressure': 1e-3}.get(panel.quantity, 1.0)
        axis = value_axis(panel.lines, start, end)
        expected = factor * np.array([axis.low, axis.high])
        assert [plot.low, plot.high] == pytest.approx(expected, rel=0.02)
    rig.now = 30.0
    shown.page.ask('new Promise((done) => setTimeout(done, 700))')
    assert shown.axis() == (start, end)  # it does not jump
    if is_live:
        assert shown.page.ask('pause.textContent') == 'Continue'
    shown.page.click(*shown.place(6.0), count=2)
    ends = (10.0, 30.0) if is_live else (0.0, 20.0)
    shown.page.until(f'x.start === {ends[0]} && x.end === {ends[1]}', 'the whole time')
    assert shown.page.ask('mark') is None  # a double click sets no mark


def test_the_wheel_zooms_and_the_button_goes_back(show):
    rig = Rig()
    shown = show(rig)
    shown.page.mouse('mouseWheel', *shown.place(10.0), deltaX=0, deltaY=-300)
    shown.page.until('x.end - x.start < 19', 'the zoom')
    start, end = shown.axis()
    assert start < 10.0 < end
    shown.click_on('#move')
    shown.page.drag(shown.place(10.0), shown.place(11.0))
    shown.page.until(f'Math.abs(x.start - {start - 1.0}) < 0.1', 'the move')
    assert shown.axis()[1] - shown.axis()[0] == pytest.approx(end - start)
    shown.click_on('#reset')
    assert shown.axis() == (0.0, 20.0)


def test_a_vertical_drag_zooms_the_values_of_one_plot_alone(show):
    shown = show(Rig(is_live=False))
    before = shown.plots()
    shown.page.drag(shown.place(10.0, 2, 0.25), shown.place(10.05, 2, 0.75))
    shown.page.until(f'sections[2].y.end < {before[2].high}', 'the zoom')
    after = shown.plots()
    assert shown.axis() == (0.0, 20.0)
    assert (after[0].low, after[0].high) == (before[0].low, before[0].high)
    height = after[2].high - after[2].low
    assert height == pytest.approx(0.5 * (before[2].high - before[2].low), rel=0.1)
    shown.click_on('#reset')
    assert shown.plots()[2].high == before[2].high


def test_a_recording_has_all_of_its_samples_where_it_is_zoomed(show):
    shown = show(Rig(is_live=False))
    count = 'data.panels[0].lines[1].t.filter((t) => t >= 5 && t <= 6).length'
    assert shown.page.ask(count) < 101
    shown.zoom(5.0, 6.0)
    shown.page.until(f'{count} === 101', 'the samples')


def test_a_line_that_was_hidden_stays_hidden(show):
    rig = Rig()
    shown = show(rig)
    before = shown.plots()[0]
    assert before.high > 190.0
    shown.legend('position_reference')
    shown.legend('pam')
    visible = 'sections[0].lines.map(({ drawn }) => drawn.visible)'
    assert shown.page.ask(visible) == [False, False]
    shown.legend('position_reference')
    assert shown.page.ask(visible) == [True, False]
    # The axis is that of the line that is left.
    assert shown.plots()[0].high == pytest.approx(1.06 * 180.0, rel=0.01)
    rig.now = 24.0
    shown.page.until('data.now === 24', 'new data')
    assert shown.page.ask(visible) == [True, False]
    assert shown.plots()[0].high == pytest.approx(210.0 + 0.06 * 180.0, rel=0.02)
    shown.legend('pam')
    assert shown.page.ask(visible) == [True, True]
    assert shown.plots()[0].high > 240.0


def test_differences_to_a_mark(show):
    shown = show(Rig(is_live=False))
    shown.page.move(*shown.place(12.0))
    at = shown.page.until('pointer', 'the pointer')
    assert at == pytest.approx(12.0, abs=0.05)
    assert number(shown.values()['pam']) == pytest.approx(10.0 * at, rel=1e-3)
    shown.page.click(*shown.place(5.0))
    mark = shown.page.until('mark', 'the mark')
    assert mark == pytest.approx(5.0, abs=0.05)
    shown.page.move(*shown.place(14.0, plot=2))
    at = shown.page.until('pointer > 13 && pointer', 'the pointer')
    time = re.fullmatch(r't (\S+) s, Δt (\S+) s', shown.page.ask('time.textContent'))
    assert [number(one) for one in time.groups()] == pytest.approx([at, at - mark], abs=2e-3)
    differences = {
        name: re.fullmatch(r'(\S+) \(Δ (\S+)\)', text).groups()
        for name, text in shown.values().items()
    }
    step = np.floor(at / 3.0) * 3.0, np.floor(mark / 3.0) * 3.0
    expected = {
        'position_reference': (10.0 * step[0], 10.0 * (step[0] - step[1])),
        'pam': (10.0 * at, 10.0 * (at - mark)),
        'pressure_command': (10.0 * step[0], 10.0 * (step[0] - step[1])),
        'pressure': (5.0 * at, 5.0 * (at - mark)),
        'force': (100.0 + 10.0 * np.sin(at), 10.0 * (np.sin(at) - np.sin(mark))),
    }
    for name, pair in expected.items():
        found = [number(one) for one in differences[name]]
        assert found == pytest.approx(pair, rel=2e-3, abs=2e-3), name
    shown.page.click(*shown.place(9.0))
    shown.page.until('mark === null', 'the end of the mark')
    assert 'Δ' not in ''.join(shown.values().values())
    shown.page.click(*shown.place(9.0))
    shown.page.until('mark !== null', 'another mark')
    for kind in ('keyDown', 'keyUp'):
        shown.page.call('Input.dispatchKeyEvent', type=kind, key='Escape', code='Escape')
    shown.page.until('mark === null', 'the end of the mark')


def rows_of(path):
    header, *lines = path.read_text(encoding='utf-8').splitlines()
    cells = [line.split(',') for line in lines]
    values = np.array([[float(cell or 'nan') for cell in row] for row in cells])
    return dict(zip(header.split(','), values.T, strict=True))


@pytest.mark.parametrize('is_live', [True, False])
def test_a_csv_file_of_what_is_seen(show, is_live):
    shown = show(Rig(is_live))
    shown.zoom(5.0, 8.5)
    start, end = shown.axis()
    shown.legend('force')
    if is_live:
        shown.page.until('data.panels[0].lines[1].t.length > 1500', 'the finest samples')
    shown.click_on('#csv')
    table = rows_of(shown.page.downloaded('pam_plot.csv'))
    assert list(table) == [
        't_s',
        'position_reference_mm',
        'position_mm',
        'pressure_command_kPa',
        'pressure_kPa',
    ]
    t = table['t_s']
    assert np.all(np.diff(t) > 0.0)
    samples = np.arange(np.ceil(100.0 * start), np.floor(100.0 * end) + 1) / 100.0
    has = np.isfinite(table['position_mm'])
    assert t[has] == pytest.approx(samples)
    assert table['position_mm'][has] == pytest.approx(10.0 * samples)
    # A cell is empty where a line has no sample; a command that acts at the start is given there.
    has = np.isfinite(table['pressure_kPa'])
    even = np.round(100.0 * samples) % 2 == 0
    assert t[has] == pytest.approx(samples[even])
    has = np.isfinite(table['pressure_command_kPa'])
    assert t[has] == pytest.approx([start, 6.0], abs=1e-6)
    assert table['pressure_command_kPa'][has] == pytest.approx([30.0, 60.0])


def test_a_csv_file_is_read_as_a_recording(show):
    shown = show(Rig(is_live=False))
    shown.click_on('#csv')
    path = shown.page.downloaded('pam_plot.csv')
    samples = read(path, None, ColumnMapping()).curves.samples
    rig = Rig(is_live=False)
    position = Key('position', 'joint_states', 'position')
    for key, line in zip((position, COMMAND, PRESSURE, FORCE), lines_of(rig), strict=True):
        t, value = samples[key]
        assert t == pytest.approx(line.t, abs=1e-6)
        assert value == pytest.approx(line.value, rel=1e-6)
    recording = read_recording(path)
    assert recording.position[-1] == pytest.approx(0.2)
    assert recording.command.max() == pytest.approx(1.8e5)


def lines_of(rig):
    found = {line.column: line for panel in rig.panels() for line in panel.lines}
    return [found[name] for name in ('position', 'pressure_command', 'pressure', 'force')]


def test_units_are_chosen_and_remembered_by_pages_of_other_ports(show):
    rig = Rig()
    shown = show(rig)
    title = 'sections[1].title.textContent'
    assert shown.page.ask(title) == 'pressure (gauge), kPa'
    assert number(shown.values()['pressure']) == pytest.approx(100.0)
    choose = "units.value = 'SI'; units.dispatchEvent(new Event('change'))"
    shown.page.ask(choose)
    assert shown.page.ask(title) == 'pressure (gauge), Pa'
    assert number(shown.values()['pressure']) == pytest.approx(1e5)
    assert shown.plots()[1].high > 1.8e5
    shown.click_on('#csv')
    assert 'position_m' in rows_of(shown.page.downloaded('pam_plot.csv'))
    other = show(rig)
    assert other.page.ask('units.value') == 'SI'
    other.page.ask(choose.replace('SI', 'mm, kPa'))
    # A choice that does not exist for angles is not made.
    assert show(Rig(unit='rad')).page.ask('units.value') == 'deg, kPa'


def test_a_spike_is_marked_at_the_edge_and_can_be_included(show):
    rig = Rig()
    rig.spike = 7.77
    shown = show(rig)
    axis = value_axis(rig.panels()[0].lines, 0.0, 20.0)
    assert axis.above == 1
    plot = shown.plots()[0]
    assert [plot.low, plot.high] == pytest.approx([1e3 * axis.low, 1e3 * axis.high], rel=1e-6)
    marks = shown.page.ask('sections[0].outside.data')
    assert marks['t'] == [7.77]
    assert marks['marker'] == ['triangle']
    assert plot.high - 0.1 * (plot.high - plot.low) < marks['value'][0] < plot.high
    assert shown.page.ask('sections.map(({ far }) => far.hidden)') == [False, True, True]
    assert shown.page.ask('sections[0].far.textContent') == '1 sample outside'
    shown.click_on('.outside')
    assert shown.plots()[0].high > 60e3
    assert shown.page.ask('sections[0].outside.data.t.length') == 0
    shown.click_on('.outside')
    assert shown.plots()[0].high == plot.high


def test_a_picture_has_all_plots(show):
    shown = show(Rig())
    shown.legend('force')
    shown.click_on('#png')
    pixels = matplotlib.image.imread(shown.page.downloaded('pam_plot.png'))[..., :3]
    box = shown.page.ask("(({ width, height, top }) => [width, height, top])"
                         "(document.querySelector('main').getBoundingClientRect())")  # fmt: skip
    assert pixels.shape[:2] == (int(box[1]), int(box[0]))
    colours = [(0.0431, 0.3843, 0.6588)] * 2  # of the lines of position and pressure
    for plot, colour in zip(shown.plots(), [*colours, None], strict=True):
        top = int(plot.top - box[2])
        frame = pixels[top : top + int(plot.height)]
        is_colour = np.abs(frame - (colour or colours[0])).max(axis=2) < 0.05
        assert is_colour.any() == (colour is not None)
        head = pixels[top - 18 : top - 4]
        assert head.min() < 0.5  # the title and the legend


def test_pause_and_a_page_that_begins_empty(show):
    rig = Rig()
    shown = show(rig)
    shown.click_on('#pause')
    rig.now = 25.0
    shown.page.ask('new Promise((done) => setTimeout(done, 600))')
    assert shown.axis() == (0.0, 20.0)
    shown.zoom(5.0, 8.0)
    shown.click_on('#reset')  # it is still paused
    assert shown.axis() == (0.0, 20.0)
    shown.click_on('#pause')
    shown.page.until('x.end === 25', 'the live time')
    assert shown.page.ask('pause.textContent') == 'Pause'


def test_plots_that_appear_later_and_lines_that_stay_hidden(show):
    rig = Rig()
    shown = show(rig)
    shown.legend('pressure')
    every = rig.panels
    rig.panels = lambda: every()[:2]
    shown.page.until(f'sections.length === 2 && {READY}', 'two plots')
    rig.panels = every
    shown.page.until(f'sections.length === 3 && {READY}', 'three plots')
    assert shown.page.ask('sections[1].lines.map(({ drawn }) => drawn.visible)') == [True, False]
    pressed = shown.page.ask(
        '[...document.querySelectorAll(".line")].map((e) => e.ariaPressed === "true")'
    )
    assert pressed == [True, True, True, False, True]
