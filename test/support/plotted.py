# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A rig whose every value is known, and its page in a browser."""

from types import SimpleNamespace

import numpy as np

from pam_ros.plot.panels import Curves, panels
from pam_ros.plot.server import content
from pam_ros.plot.topics import Key
from pam_ros.plot.value_axis import judged

POSITION = Key('position', 'joint_states', 'pam')
REFERENCE = Key('position', 'position_reference')
COMMAND, PRESSURE = Key('pressure', 'pressure_command'), Key('pressure', 'pressure')
FORCE = Key('force', 'force')
SPAN = 20.0  # s
READY = 'sections.length && sections.every(({ view }) => view)'


class Rig:
    """Signals of which every value is known, at a time that a test sets."""

    def __init__(self, is_live=True, unit='m'):
        self.now, self.is_live, self.unit, self.spike = 20.0, is_live, unit, None

    def panels(self):
        t = np.arange(round(100.0 * self.now) + 1) / 100.0
        position = 0.01 * t
        if self.spike is not None:
            position[round(100.0 * self.spike)] = 60.0
        steps = np.arange(0.0, self.now, 3.0)
        curves = {
            POSITION: (t, position),
            REFERENCE: (steps, 0.01 * steps),
            COMMAND: (steps, 1e4 * steps),
            PRESSURE: (t[::2], 5e3 * t[::2]),
            FORCE: (t, 100.0 + 10.0 * np.sin(t)),
        }
        return panels(judged(Curves(curves)), self.unit, self.now)

    def look(self, window):
        start = max(self.now - SPAN, 0.0) if self.is_live else 0.0
        end = start + SPAN if self.is_live else self.now
        return content(
            self.panels(),
            start,
            end,
            self.now,
            is_live=self.is_live,
            window=window,
        )


class Shown:
    """The page, with the places of its plots."""

    def __init__(self, page):
        self.page = page

    def plots(self):
        """Return the frames of the plots in px, and their ranges."""
        return [
            SimpleNamespace(**one)
            for one in self.page.ask("""sections.map(({ plot, view, y }) => {
              const box = plot.getBoundingClientRect(), frame = view.frame.bbox;
              return { left: box.left + frame.left, top: box.top + frame.top, width: frame.width,
                height: frame.height, start: view.frame.x_range.start, end: view.frame.x_range.end,
                low: y.start, high: y.end };
            })""")
        ]

    def place(self, t, plot=0, share=0.5):
        """Return the place in px of a time in a plot, at a share of its height from above."""
        one = self.plots()[plot]
        across = (t - one.start) / (one.end - one.start)
        return one.left + across * one.width, one.top + share * one.height

    def axis(self):
        """Return the times at the ends of all plots, which are the same."""
        found = {(one.start, one.end) for one in self.plots()}
        assert len(found) == 1
        return found.pop()

    def zoom(self, start, end, plot=0):
        before = self.axis()
        self.page.drag(self.place(start, plot), self.place(end, plot))
        self.page.until(f'x.start !== {before[0]} || x.end !== {before[1]}', 'the zoom')

    def values(self):
        """Return the texts in the legends by the names of the lines."""
        texts = self.page.ask('[...document.querySelectorAll(".line")].map((e) => e.textContent)')
        return dict(text.split(' ', 1) for text in texts)

    def click_on(self, selector):
        self.page.ask(f'document.querySelector({selector!r}).click()')

    def legend(self, name):
        """Click the entry of a line in its legend."""
        box = self.page.ask(f"""(() => {{
          const found = [...document.querySelectorAll('.line')]
            .find((e) => e.textContent.startsWith('{name} ')).getBoundingClientRect();
          return [found.left + found.width / 2, found.top + found.height / 2];
        }})()""")
        self.page.click(*box)
