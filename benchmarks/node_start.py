# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How long ``pam_sim`` needs from its start to its first message.

Claim: at most 2 s, once the package is set up.
"""

import os
from statistics import median
from time import monotonic

from sensor_msgs.msg import JointState

from pam_ros.nodes.demo.client import Client
from pam_ros.processes.children import Program
from pam_ros.rig.warm import warm

TIMES = 5


def main() -> None:
    """Start the simulator several times and print how long its first message took."""
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    namespace = f'/node_start_{os.getpid()}'
    warm()
    took = []
    for _ in range(TIMES):
        with Client(namespace) as client:
            states = client.collect(JointState, 'joint_states')
            begin = monotonic()
            with Program('pam_sim', '-r', f'__ns:={namespace}'):
                client.more(states)
                took.append(monotonic() - begin)
    print(f'load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores')
    print(
        f'pam_sim, start to first message: median {median(took):.2f} s, longest {max(took):.2f} s'
    )
    print('(claim: at most 2 s)')


if __name__ == '__main__':
    main()
