# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_record``: write the topics of a rig to a rosbag2, for machines without ``ros2 bag``.

Records ``joint_states``, ``pressure_command``, ``force``, ``stiffness``, ``damping`` and
``pressure``, of joints ``pressure_commands``, ``forces``, ``stiffnesses``, ``dampings`` and
``pressures``, and the topics that are named, each as soon as it is published. Messages are stored
unchanged, with the time at which the middleware received them. The bag (MCAP, with metadata.yaml)
can be read at any time: if the recorder is killed, at most the last second is lost. Ctrl-C ends
it, and so do SIGTERM, SIGHUP (the terminal is closed) and SIGQUIT. On a full disk it ends with
exit code 2; the bag contains the messages written before.
"""

from pam_ros.cli.start import start_node


def main() -> None:
    """Record until a signal requests the end."""
    start_node('pam_ros.nodes.record.node', 'PamRecord', __doc__)


if __name__ == '__main__':
    main()
