# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Check recordings with what is known about the joint that they are recordings of."""

from dataclasses import replace

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.identification.fit.of_rig import joint_with
from pam_ros.recording.direction import with_contraction_positive
from pam_ros.recording.quality import check
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint


def checked(recording: Recording, joint: Joint) -> Recording:
    """Return *recording* with warnings about its data, which are checked with those of *joint*.

    Recordings that :func:`pam_ros.read_recording` returns have passed these checks, recordings
    that are made of arrays have not. Raises RecordingError for a recording that cannot be used.
    """
    try:
        own = joint_with(joint, recording.numbers)
    except ParameterError as error:
        raise RecordingError(f'{recording.name}: {error}') from error
    recording = with_contraction_positive(recording)
    found = check(recording, own.bounds)
    return replace(recording, warnings=tuple(dict.fromkeys((*recording.warnings, *found))))
