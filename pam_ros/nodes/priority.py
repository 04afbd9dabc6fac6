# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Real-time scheduling for a node that keeps wall time, where the system permits it."""

import os
from pathlib import Path

PRIORITY = 10  # above all programs of normal scheduling, below the kernel's own threads
NORMAL = 'normal'


def prefer_real_time() -> str:
    """Schedule this process before every normal one; return how it is scheduled now.

    As the controller manager of ros2_control does: without it a busy machine delays ticks by
    several periods. All of its threads, since DDS's hold locks that the loop waits for. Where it
    is not permitted (``ulimit -r`` is 0), or no such thing exists, nothing changes.
    """
    try:
        for task in Path('/proc/self/task').iterdir():
            os.sched_setscheduler(int(task.name), os.SCHED_FIFO, os.sched_param(PRIORITY))
    except (AttributeError, OSError):
        return NORMAL
    return f'SCHED_FIFO {PRIORITY}'
