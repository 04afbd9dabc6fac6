# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Real-time scheduling for a loop that keeps wall time, if the system permits it."""

import os

PRIORITY = 10  # above all programs of normal scheduling, below the kernel's own threads
NORMAL = 'normal'


def prefer_real_time() -> str:
    """Schedule the calling thread before all normal threads; return its present scheduling.

    The controller manager of ros2_control does the same: without it a busy machine delays ticks by
    several periods. The threads of DDS are unchanged: if they were woken for every message before
    the loop, they would delay it. If real-time scheduling is not permitted (``ulimit -r`` is 0) or
    does not exist, nothing changes.
    """
    try:
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(0, policy, os.sched_param(PRIORITY))
    except (AttributeError, OSError):
        return NORMAL
    return f'SCHED_FIFO {PRIORITY}'
