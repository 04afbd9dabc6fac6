# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of a joint, without a joint that has it."""

from types import SimpleNamespace

from pam_ros.recording.bounds import Bounds


def known(*, muscles=1, p_max=None, **bounds):
    """Return what stands for a joint with these bounds; *p_max* in Pa is that of each muscle."""
    highest = () if p_max is None else (p_max,) * muscles
    return SimpleNamespace(bounds=Bounds(p_max=highest, **bounds))
