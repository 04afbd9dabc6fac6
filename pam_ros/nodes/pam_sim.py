# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim``: a pneumatic artificial muscle with its load, simulated in real time.

Subscribes
    ``pressure_command`` (std_msgs/Float64): Pa gauge
Publishes
    ``joint_states`` (sensor_msgs/JointState): contraction in m, velocity in m/s, force in N
    ``force``, ``stiffness``, ``damping`` (std_msgs/Float64): N, N/m, N s/m
    ``pressure`` (sensor_msgs/FluidPressure): absolute Pa in the chamber
    ``/diagnostics`` (diagnostic_msgs/DiagnosticArray), once a second
Services
    ``~/reset`` (std_srvs/Trigger): back to the initial state
    ``~/pause`` (std_srvs/SetBool): let simulated time stand still; messages go on

Contraction is positive: the load moves up. Parameters say what they are:
``ros2 param describe /pam_sim <name>``. A pressure command outside p_min..p_max is clamped, one
that is no number is refused and the last good one holds; when none comes for command_timeout
seconds the muscle vents (on_timeout).
"""

from pam_ros.nodes.program import start_node


def main() -> None:
    """Run the simulator until Ctrl-C or SIGTERM."""
    start_node('pam_ros.nodes.sim_node', 'PamSim', __doc__)


if __name__ == '__main__':
    main()
