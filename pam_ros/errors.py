# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The errors that a user sees: one family, each carrying the whole sentence."""


class PamError(Exception):
    """A mistake in what the user gave; the text is the sentence to show, exit code 2."""


class ParameterError(PamError):
    """A parameter or a set of parameters that makes no model."""


class RangeError(PamError):
    """A wanted force, position or pressure that the model cannot reach."""


class RecordingError(PamError):
    """A recording that cannot be used as it is."""
