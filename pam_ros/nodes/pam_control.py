# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control``: moves the load of a pneumatic muscle to where it shall be.

Subscribes
    ``joint_states`` (sensor_msgs/JointState): contraction in m, and velocity where it is wanted
    ``position_reference`` (std_msgs/Float64): m; a step is shaped, a stream is followed
    ``joint_trajectory`` (trajectory_msgs/JointTrajectory): m, m/s, m/s^2; empty: stop
    ``pressure`` (sensor_msgs/FluidPressure): absolute Pa, for a start without a bump; optional
Publishes
    ``pressure_command`` (std_msgs/Float64): Pa gauge
    ``~/state`` (sensor_msgs/JointState): the terms of the law, by name
    ``/diagnostics`` (diagnostic_msgs/DiagnosticArray), once a second
Services
    ``~/enable`` (std_srvs/SetBool): begin where the load is, or command nothing

Contraction is positive: the load moves up. It starts where the load is and holds it there until
a reference comes. A reference out of reach is refused, and the last one counts. When joint states
stay away for state_timeout seconds the pressure is held or vented (on_timeout). The rig is
declared as to pam_sim: parameters say what they are, ``ros2 param describe /pam_control <name>``.
"""

from pam_ros.nodes.program import start_node


def main() -> None:
    """Run the controller until Ctrl-C or SIGTERM."""
    start_node('pam_ros.nodes.control_node', 'PamControl', __doc__)


if __name__ == '__main__':
    main()
