# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The compliance of controllers over the frequency of a force, for the page of a bench."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pam_ros.bench.forces import responses
from pam_ros.bench.trial import Trial
from pam_ros.report import style

HEIGHTS = (150, 120)  # px: compliance, and its ratio to that of the rig left alone
FEWEST = 3  # frequencies
MICRO = 1e6  # um in a m
COLOURS = (*style.COLOURS, style.NOISE, style.SINCE)


def force_plot(name: str, trials: Mapping[str, Trial]) -> str:
    """Return the plot of the *trials* of a scenario as SVG, by the names of the controllers.

    *name* begins the ids of the plot, and is a word. Returns '' if the scenario has forces of less
    than three frequencies.
    """
    curves = {controller: np.array(responses(trial)) for controller, trial in trials.items()}
    first = next(iter(curves.values()), np.empty((0, 3)))
    if len(np.unique(first[:, 0] if first.size else [])) < FEWEST:
        return ''
    unit = 'urad/N' if next(iter(trials.values())).is_revolute else 'um/N'
    with style.styled():
        figure, (above, below) = style.stacked(2 * style.NARROW, HEIGHTS)
        frequency, _, alone = first.T
        above.plot(frequency, MICRO * alone, color=style.MEASURED, linewidth=3.0, label='alone')
        below.axhline(0.0, color=style.MEASURED, linewidth=3.0)
        for k, (controller, curve) in enumerate(curves.items()):
            frequency, compliance, alone = curve.T
            look: dict[str, Any] = {'color': COLOURS[k % len(COLOURS)], 'marker': 'o'}
            above.plot(frequency, MICRO * compliance, label=controller, markersize=3.5, **look)
            below.plot(frequency, 20.0 * np.log10(compliance / alone), markersize=3.5, **look)
        above.set_yscale('log')
        style.log_axis(above.yaxis)
        for ax in (above, below):
            ax.set_xscale('log')
        style.log_axis(below.xaxis)
        above.set_title(f'compliance [{unit.replace("u", "µ")}]')
        below.set_title('relative to the rig left alone [dB]')
        below.set_xlabel('frequency of the force [Hz]')
        above.legend(frameon=False)
        return style.svg(figure, f'{name}-force', 'compliance of the controllers over frequency')
