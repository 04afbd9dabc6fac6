# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_excite``: play a safe pressure programme that excites the effects of a muscle or joint.

Steps with holds, a slow triangle with minor loops, the same range four times as fast, a
multisine, chirps at three mean pressures, and the first steps once more; about 85 s. Some of
them are played with ``segments``. The plan is printed before it starts. One joint is excited:
a muscle that moves a mass, or the ``joint`` of the parameters, with all of its muscles.

Publishes
    ``pressure_command`` (std_msgs/Float64): Pa gauge; of another joint than ``load``
    ``pressure_commands`` (std_msgs/Float64MultiArray) in the order of its muscles, or
    ``<muscle>/pressure_command`` for each muscle (muscle_topics)
Subscribes
    ``joint_states`` (sensor_msgs/JointState): position in m or rad

Commands at ``rate``; with use_sim_time it answers each joint state with one command instead.
Stops and vents when a muscle leaves contraction_min..contraction_max or the joint
position_min..position_max, when no ``joint_states`` arrive for ``silence`` seconds, and on
Ctrl-C, SIGTERM, SIGHUP (the terminal is closed) and SIGQUIT. Limits, length, segments and seed
are parameters (``pam_excite --parameters``); the limits of the muscle (``-p
muscle:=dmsp_20_400n``, or a parameter file) apply as well. Exit code 0 at the end or after such
a signal, 1 if it stopped or could not start, 2 for invalid parameters.
"""

from pam_ros.cli.start import start_node


def main() -> None:
    """Play the programme to its end, or until a signal requests its end."""
    start_node('pam_ros.nodes.excite.node', 'PamExcite', __doc__)


if __name__ == '__main__':
    main()
