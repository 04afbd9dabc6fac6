# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification is given: a nominal joint, and recordings from files."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pam_ros.errors import PamError, shown
from pam_ros.identification.data.segment import require_joint
from pam_ros.identification.identification import Identification
from pam_ros.identification.identify import identify
from pam_ros.recording.inputs import refuse_copies, refuse_idle
from pam_ros.recording.mapping import column_names, read_mapping
from pam_ros.recording.recording import Recording
from pam_ros.settings.nominal import (
    NominalJoint,
    example_mass,
    nominal_joint,
    package_muscles,
    uncertain_values,
)
from pam_ros.settings.recording_list import READING, RecordingFile, recording_files

Values = Sequence[Mapping[str, str]]  # of --set, for each path of recordings


@dataclass(frozen=True, eq=False)
class Inputs:
    """A nominal joint with the recordings that are fitted, and those that judge.

    ``params`` is the parameter file or the muscle as it was named, and ``uncertain`` has the
    standard deviations of nominal values.
    """

    params: str
    nominal: NominalJoint
    uncertain: Mapping[str, str]
    recordings: Sequence[Recording]
    test: Sequence[Recording]
    given: Sequence[str] = ()  # values of --set

    @property
    def assumed(self) -> str:
        """A sentence on the mass if it is that of a muscle of this package; else empty."""
        names = {text.partition('=')[0].strip() for text in self.given}
        recordings = (*self.recordings, *self.test)
        names |= {name for one in recordings for name in one.numbers}
        is_moved = any(one.kind == 'free' for one in recordings)
        return example_mass(self.params, self.nominal.joint, names) if is_moved else ''

    @property
    def size(self) -> str:
        """What an identification has to compute: ``3 recordings, 12000 samples, 18 effects``."""
        recordings = [*self.recordings, *self.test]
        joint, kinds = self.nominal.joint, {one.kind for one in recordings}
        effects = [
            effect
            for effect in joint.library
            if effect not in joint.all_present
            and not (effect.needs_muscle and joint.is_driven)
            and (kinds != {'pressure'} or effect.acts_on_pressure())
        ]
        counts = {
            'recording': len(recordings),
            'sample': sum(one.t.size for one in recordings),
            'effect': len(effects),
        }
        return ', '.join(f'{n} {name}{"" if n == 1 else "s"}' for name, n in counts.items())

    def identify(
        self,
        progress: Callable[[float, str], None] | None = None,
        warn: Callable[[str], None] | None = None,
        time_left: Callable[[float, float], None] | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> Identification:
        """Return what :func:`pam_ros.identify` finds, with the muscles of this package in mind."""
        return identify(
            self.nominal.joint,
            self.recordings,
            self.test,
            progress,
            uncertain=self.uncertain,
            warn=warn,
            muscles=package_muscles(),
            time_left=time_left,
            stop=stop,
        )


def read_inputs(
    given: argparse.Namespace,
    paths: tuple[Sequence[str], Sequence[str]],
    own: tuple[Values, Values],
) -> Inputs:
    """Read the recordings at *paths* as the command line *given* says, and check them.

    *paths* are those of the recordings that are fitted, and of those that judge; *own* are the
    numbers of the rig in each of them. Raises PamError for what cannot be used.
    """
    lists = [
        [recording_files(Path(path), _numbers(values)) for path, values in zip(*one, strict=True)]
        for one in zip(paths, own, strict=True)
    ]
    params = _params(given.params, [params for one in lists for _, params in one])
    nominal = nominal_joint(params, given.set)
    uncertain = {**uncertain_values(params), **dict(map(_deviation, given.uncertain))}
    mapping = read_mapping(given.column, given.mapping)
    reading = {
        'muscles': nominal.recorded_muscles,
        'columns': () if given.columns is None else column_names(given.columns),
        **{name: getattr(given, name) for name in READING},
    }

    def read(files: Sequence[RecordingFile]) -> list[Recording]:
        return [file.read(nominal.joint, mapping, **reading) for file in files]

    recordings, test = (
        [recording for files, _ in one for recording in read(files)] for one in lists
    )
    require_joint([*recordings, *test], nominal.joint)
    refuse_idle(recordings)  # here already, so that no warning is printed before the error
    refuse_copies([*recordings, *test])
    return Inputs(params, nominal, uncertain, recordings, test, tuple(given.set))


def _params(given: str | None, of_lists: Sequence[str | None]) -> str:
    """Return the nominal model: that of the lists of recordings, or the one that is *given*."""
    named = {params if params is not None else given for params in of_lists}
    if len(named) > 1:
        texts = ' and '.join(sorted(text or 'none' for text in named))
        raise PamError(
            f'the recordings are of different rigs ({texts}): give --each to identify each of them'
        )
    (params,) = named
    if params is None:
        raise PamError(
            '--params is missing: give the nominal model, a parameter file of pam_sim or a muscle '
            'of this package'
        )
    return params


def _numbers(values: Mapping[str, str]) -> dict[str, float]:
    """Return the numbers that ``--set`` gives to some of the recordings."""
    found = {}
    for name, text in values.items():
        try:
            found[name] = float(text)
        except ValueError:
            raise PamError(
                f'--set {shown(name)}={shown(text)} between recordings is not allowed: give a '
                'number'
            ) from None
    return found


def _deviation(text: str) -> tuple[str, str]:
    """Return the name and the standard deviation of a text ``name=deviation``."""
    name, equals, given = (part.strip() for part in text.partition('='))
    if not (name and equals and given):
        raise PamError(
            f'--uncertain {shown(text)} is not allowed: give NAME=DEVIATION, such as inertia=50%'
        )
    return name, given
