# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The whole result of an identification, as a Python program and a notebook use it."""

from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from pam_ros.arguments import instance
from pam_ros.identification.free_run import from_start, simulate_recording
from pam_ros.identification.result import Conclusion
from pam_ros.identification.summary import last_line, summary
from pam_ros.identification.wording import scale_for
from pam_ros.recording.recording import Recording
from pam_ros.rig.run import Trajectory


@dataclass(frozen=True, eq=False, repr=False)
class Identification(Conclusion):
    """The whole result of an identification: what :func:`pam_ros.identify` returns.

    ``verdict`` is a member of an enumeration that equals its text, such as ``'effect_found'``, and
    ``sentence`` states it with the numbers. ``joint`` is the identified joint, and ``effects`` are
    the effects that the nominal model lacks, with their parameters. ``next_experiment`` says what
    to record next, and ``next_command`` is the command that plays it, '' if there is none.
    ``warnings`` are sentences about the data and the result.

    ``stages`` are the nominal, the re-tuned and the augmented model, in this order, with their
    errors in ``unit`` (m, rad, N or Pa), as ``noise`` is. ``quantity`` is what was predicted,
    ``position``, ``force`` or ``pressure``. ``candidates`` are all effects that were tried, and
    ``structure`` is what remains in the residual. ``recordings`` were fitted,
    ``test_recordings`` were not; ``segments`` and ``test`` are their gapless stretches. ``since``
    is the time in s at which the effects begin to act, None if they act from the start.
    ``uncertain`` are the given standard deviations of nominal values, by parameter.
    ``is_complete`` is false if the search was stopped, and the result is that of its best model.
    :func:`pam_ros.save_report` and :func:`pam_ros.save_parameters` write the result to files.
    """

    sentence: str
    next_experiment: str
    next_command: str
    warnings: tuple[str, ...]

    @property
    def own_warnings(self) -> tuple[str, ...]:
        """The warnings that do not come from the recordings."""
        recordings = (*self.recordings, *self.test_recordings)
        before = {warning for recording in recordings for warning in recording.warnings}
        return tuple(warning for warning in self.warnings if warning not in before)

    def summary(self) -> str:
        """Return a text of several lines: verdict, parameters with 95 % intervals, errors."""
        return summary(self, self.sentence, self.own_warnings, self.next_experiment)

    def __repr__(self) -> str:
        """Return the verdict and the errors on one line."""
        return f'<Identification: {last_line(self)}>'

    def _repr_html_(self) -> str:
        """Return the summary, as a notebook shows it."""
        return f'<pre>{escape(self.summary())}</pre>'

    def simulate(self, recording: Recording) -> Trajectory:
        """Simulate the identified joint under the inputs of *recording*, from its first sample.

        Each stretch between gaps begins where it was measured. Effects that begin in the middle of
        a fitted recording act in all others from the start. The result has the stamps of the
        samples. If only pressures were recorded, position, velocity and force are not simulated:
        they are NaN. Raises RecordingError for a recording of another joint or one that cannot be
        used.
        """
        instance('recording', recording, Recording, 'a Recording')
        is_fitted = any(_are_same(recording, one) for one in self.recordings)
        joint = self.joint if is_fitted else from_start(self.joint)
        return simulate_recording(joint, recording)

    def plot(self, axes: Any = None) -> Any:
        """Draw the measurement, the nominal and the identified model, and what they leave.

        *axes* are two of matplotlib, for the signals and the residuals; if None, a new figure of
        pyplot is made. Returns the two axes.
        """
        if axes is None:
            from matplotlib import pyplot as plt

            axes = plt.subplots(2, 1, sharex=True, layout='constrained')[1]
        upper, lower = axes
        scale = scale_for(self.unit, self.stages[-1].fit_error)
        stages = (self.stages[0], self.stages[-1])
        for k, segment in enumerate(self.segments):
            # Labels appear once in the legend; matplotlib leaves out those with an underscore.
            hidden = '' if k == 0 else '_'
            upper.plot(segment.t, segment.target, color='0.6', label=f'{hidden}measured')
            for stage, colour, name in zip(
                stages, ('C1', 'C0'), ('nominal', 'identified'), strict=True
            ):
                run = stage.simulated[k]
                upper.plot(segment.t, run, color=colour, linewidth=0.8, label=hidden + name)
                left = scale.factor * (segment.target - run)
                lower.plot(segment.t, left, color=colour, linewidth=0.8)
        upper.set_ylabel(f'{self.quantity} [{self.unit}]')
        upper.legend(frameon=False)
        lower.set_ylabel(f'residual [{scale.unit}]')
        lower.set_xlabel('time [s]')
        return axes


def _are_same(recording: Recording, other: Recording) -> bool:
    return recording.name == other.name and np.array_equal(recording.t, other.t)
