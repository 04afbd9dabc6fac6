# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control``: move the load of a joint to a position or an angle.

Subscribes
    ``joint_states`` (sensor_msgs/JointState): contraction in m, of the joint joint_name
    ``position_reference`` (std_msgs/Float64): m; a step is approached smoothly
    ``joint_trajectory`` (trajectory_msgs/JointTrajectory): m, m/s, m/s^2
Publishes
    ``pressure_command`` (std_msgs/Float64): Pa gauge, at ``rate``
    ``~/state`` (sensor_msgs/JointState): the terms of the law by name, their values as positions
    ``/diagnostics`` (diagnostic_msgs/DiagnosticArray), once a second
Services
    ``~/enable`` (std_srvs/SetBool): control from the present position on, or send no commands
Actions, if control_msgs is installed
    ``~/follow_joint_trajectory`` (control_msgs/FollowJointTrajectory): with tolerances and result

The same law serves every kind of ``joint``: load (one muscle, the default), parallel,
antagonistic, lever and crank. The last three are revolute: rad instead of m. With any joint but
load it publishes ``pressure_commands`` (std_msgs/Float64MultiArray), or
``<muscle>/pressure_command`` for each muscle (muscle_topics). With antagonistic and lever it also
subscribes to ``co_contraction_reference`` (std_msgs/Float64): stiffness of the joint in N m/rad.

Contraction is positive: the load moves up. ``pam_control --parameters`` describes the parameters.
Control starts at the present position. A reference that is out of reach is refused, and the last
one remains. If no joint_states arrive for state_timeout seconds, the muscle vents within
vent_time, or its pressure is held (on_timeout).
"""

from pam_ros.cli.start import start_node


def main() -> None:
    """Run the controller until a signal requests its end."""
    start_node('pam_ros.nodes.control.node', 'PamControl', __doc__)


if __name__ == '__main__':
    main()
