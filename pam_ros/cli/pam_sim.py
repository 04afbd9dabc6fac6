# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim``: simulate pneumatic artificial muscles with their loads.

One muscle subscribes
    ``pressure_command`` (std_msgs/Float64): Pa gauge
and publishes
    ``joint_states`` (sensor_msgs/JointState): contraction in m, velocity in m/s, force in N
    ``force``, ``stiffness``, ``damping`` (std_msgs/Float64): N, N/m, N s/m
    ``pressure`` (sensor_msgs/FluidPressure): absolute Pa in the chamber
Several muscles (parameters muscles, joint) subscribe
    ``pressure_commands`` (std_msgs/Float64MultiArray): Pa gauge, in the order of the muscles
and publish
    ``joint_states``: all joints in order; m, m/s, N, or rad, rad/s, N m
    ``forces``, ``stiffnesses``, ``dampings``, ``pressures`` (std_msgs/Float64MultiArray)
    and, with muscle_topics, the topics of one muscle below the name of each
All publish
    ``muscle_states`` (sensor_msgs/JointState): force, stiffness, damping and absolute pressure of
    all muscles with a stamp, named <muscle>/force and so on, the values as positions
    ``/diagnostics`` (diagnostic_msgs/DiagnosticArray), once a second
    ``/clock`` (rosgraph_msgs/Clock), in time_mode scaled and lockstep
Services
    ``~/reset`` (std_srvs/Trigger): back to the initial state
    ``~/pause`` (std_srvs/SetBool): stop simulated time; the state is still published
    ``~/step`` (std_srvs/Trigger): while paused, simulate step_periods periods

Contraction is positive: the load moves up. ``pam_sim --parameters`` describes the parameters.
Time is real, scaled or in lockstep (time_mode). A pressure command outside p_min..p_max is
clamped. One that is not finite is rejected, and the last valid one remains. If no command arrives
for command_timeout seconds, the muscle vents within vent_time (on_timeout).
"""

from pam_ros.cli.start import start_node


def main() -> None:
    """Run the simulator until a signal requests its end."""
    start_node('pam_ros.nodes.sim.node', 'PamSim', __doc__)


if __name__ == '__main__':
    main()
