# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All plots of a page, each as wide as a page, a third of it, or a telephone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.identification import Identification
from pam_ros.identification.wording import Scale, listed, scale_for
from pam_ros.report import residual_plots, style, time_plots
from pam_ros.report.diagnostics import Size
from pam_ros.report.numbers import Table
from pam_ros.report.runs import STAGES, Run, drive_of, pressure_runs_of
from pam_ros.report.time_plots import Curve
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Picture:
    """A plot with its texts; ``wide`` is empty if the narrow plot serves for every page."""

    name: str
    title: str
    caption: str
    narrow: str
    wide: str = ''


def pictures(
    result: Identification, runs: list[Run], content: Table, curves: list[Curve], scale: Scale
) -> dict[str, list[Picture]]:
    """Return the plots of each section of the page; *content* is that of ``report.json``."""
    with style.styled():
        return {
            'errors': _errors(result, content, curves, scale),
            'time': [*_over_time(result, runs, curves, scale), *_pressures(result, curves)],
            'correlation': _correlation(result, runs, _last_two(curves), scale),
            'against': _against(result, runs, _last_two(curves), scale),
        }


def _last_two(curves: list[Curve]) -> list[Curve]:
    """Return the chosen model and the one before it: their difference is due to the choice."""
    return curves[-2:]


def _wide(name: str, title: str, caption: str, draw: Callable[[int], Figure]) -> Picture:
    narrow, wide = (
        style.svg(draw(width), f'{name}-{width}', title) for width in (style.NARROW, style.WIDE)
    )
    return Picture(name, title, caption, narrow, wide)


def _narrow(name: str, title: str, caption: str, figure: Figure) -> Picture:
    return Picture(name, title, caption, style.svg(figure, name, title))


def _errors(
    result: Identification, content: Table, curves: list[Curve], scale: Scale
) -> list[Picture]:
    details = [content['error'][STAGES[curve.stage]]['details'] for curve in curves]
    measured = [
        (curve, Size(**each['fit']), Size(**each['held_out']))
        for curve, each in zip(curves, details, strict=True)
    ]
    return [
        _wide(
            'rmse',
            'RMSE of each model',
            'Open circles: fitted data. Filled circles: held-out data. Bars: 95 % intervals. A '
            'model that lacks nothing reaches the noise floor.',
            lambda width: time_plots.errors(measured, result.noise.sigma, scale, width),
        )
    ]


def _over_time(
    result: Identification, runs: list[Run], curves: list[Curve], scale: Scale
) -> list[Picture]:
    quantity, noise = result.quantity, result.noise.sigma
    everything = time_plots.whole(runs)
    before = curves[-2].stage if len(curves) > 1 else curves[-1].stage
    close = time_plots.close_up(runs, before, curves[-1].stage)
    several = f'{len(runs)} runs side by side. ' if len(runs) > 1 else ''
    tint = '' if result.test else 'Tinted background: held-out data. '
    band = 'Band: ± two standard deviations of the noise.'
    if result.since is not None:
        band += ' Red line: the time from which the missing effect acts.'
    return [
        _wide(
            'overview',
            'The whole recording' if len(runs) == 1 else 'All recordings',
            several + tint + band,
            lambda width: time_plots.measured_and_simulated(
                everything, curves, scale, quantity, noise, width
            ),
        ),
        _wide(
            'close-up',
            'Where the models differ most',
            f'{close.run.name}, from {close.run.t[close.start]:.4g} s. ' + tint + band,
            lambda width: time_plots.measured_and_simulated(
                [close], curves, scale, quantity, noise, width
            ),
        ),
    ]


def _pressures(result: Identification, curves: list[Curve]) -> list[Picture]:
    """Return the plot of the measured pressures of a load that moves, none without them."""
    runs = pressure_runs_of(result)
    if not runs:
        return []
    noise = noise_of([(run.t, run.target) for run in runs]).sigma
    ends = [curves[0], *curves[1:][-1:]]  # re-tuned constants have no influence, either
    names = listed([run.name for run in runs])
    return [
        _wide(
            'pressures',
            'Pressures in the chambers',
            f'From the commands, of {names}. Only effects of the pressure path have an influence '
            'on them. Band: ± two standard deviations of the noise.',
            lambda width: time_plots.measured_and_simulated(
                time_plots.whole(runs), ends, Scale(1e-3, 'kPa'), 'pressure', noise, width
            ),
        )
    ]


def _correlation(
    result: Identification, runs: list[Run], curves: list[Curve], scale: Scale
) -> list[Picture]:
    return [
        _narrow(
            'autocorrelation',
            'Autocorrelation of the residual',
            'At lags above 0, white noise stays within the band (95 %).',
            residual_plots.autocorrelation(runs, curves),
        ),
        _narrow(
            'cross-correlation',
            'Cross-correlation with the input',
            'A residual that is independent of the input stays within the band (Ljung, 99 %, '
            'drawn for the last model).',
            residual_plots.cross_correlation(runs, curves),
        ),
        _narrow(
            'spectrum',
            'Spectrum of the residual',
            'Pale line: the noise alone.',
            residual_plots.spectrum(runs, curves, scale, result.noise),
        ),
        _narrow(
            'coherence',
            'Coherence with the input',
            '95 % of the values of unrelated signals are within the band below the line.',
            residual_plots.coherence(runs, curves),
        ),
    ]


def _input(result: Identification) -> str:
    """Return the name of the one signal that drives the joint of *result*."""
    joint = result.stages[0].model
    if result.quantity == 'pressure':
        return 'command'
    if len(joint.muscles) == 1:
        return 'pressure'
    return 'pressure difference' if np.min(drive_of(joint)) < 0.0 else 'mean pressure'


def _axes(
    joint: Joint, pressure: Scale, name: str, input_label: str
) -> list[tuple[str, str, str, residual_plots.Pick]]:
    """Return (name, title, label, values) of what residuals are drawn against."""
    unit, speed = ('mrad', 'rad') if joint.is_revolute else ('mm', 'mm')
    fast = 1.0 if joint.is_revolute else 1e3
    place: tuple[str, str, str, residual_plots.Pick] = (
        *('position', 'Against position', f'position, {unit}'),
        lambda run: 1e3 * run.position,
    )
    if statics.is_direct(joint) and not joint.is_driven:
        l0 = joint.muscle.l0
        place = (
            *('contraction', 'Against contraction', 'contraction, %'),
            lambda run: 100.0 * run.position / l0,
        )
    axes: list[tuple[str, str, str, residual_plots.Pick]] = [
        ('velocity', 'Against velocity', f'velocity, {speed}/s', lambda run: fast * run.velocity),
        (
            'pressure',
            'Against the input' if joint.is_driven else f'Against {name}',
            input_label,
            lambda run: pressure.factor * run.drive,
        ),
        place,
        ('time', 'Against time', 'time, s', lambda run: run.t),
    ]
    if len(joint.muscles) > 1:
        level: tuple[str, str, str, residual_plots.Pick] = (
            *('level', 'Against mean pressure', f'mean pressure, {pressure.unit}'),
            lambda run: pressure.factor * run.pressures.mean(axis=1),
        )
        axes.insert(2, level)
    return axes


def _against(
    result: Identification, runs: list[Run], curves: list[Curve], scale: Scale
) -> list[Picture]:
    joint, name = result.stages[0].model, _input(result)
    pressures = np.concatenate([run.drive for run in runs])
    pressure = scale_for('Pa', float(np.max(np.abs(pressures))))
    input_label = f'{name}, {pressure.unit}'
    if joint.is_driven:
        pressure, input_label = Scale(1.0, ''), 'input'
    found = [
        _narrow(
            f'over-{axis}',
            title,
            '',
            residual_plots.against(runs, curves, scale, pick, label),
        )
        for axis, title, label, pick in _axes(joint, pressure, name, input_label)
        if np.ptp(np.concatenate([pick(run) for run in runs])) > 0.0
    ]
    found.append(
        _narrow(
            'directions',
            'Rising and falling input',
            'Triangles up: rising input. Triangles down: falling input. A distance between the '
            'two lines is a loop that the model lacks.',
            residual_plots.by_direction(runs, curves, scale, pressure, input_label),
        )
    )
    stretch = residual_plots.loop_stretch(runs)
    found.append(
        _narrow(
            'loop',
            'Loop',
            f'{result.quantity.capitalize()} over the input: {stretch.run.name}, from '
            f'{stretch.run.t[stretch.start]:.4g} s to {stretch.run.t[stretch.stop - 1]:.4g} s.',
            residual_plots.loop(stretch, curves, scale, pressure, result.quantity, input_label),
        )
    )
    return found
