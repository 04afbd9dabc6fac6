# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Close the loop: ``ros2 launch pam_ros closed_loop.launch.py mass:=10.0``.

With ``joint:=antagonistic`` two muscles turn a pulley against each other.
"""

from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

CONFIG = Path(__file__).resolve().parents[1] / 'config'
ARGUMENTS = (
    DeclareLaunchArgument(
        'muscle',
        default_value='dmsp_20_400n',
        description='muscle of config/muscles, or a parameter file of one, for both programs',
    ),
    DeclareLaunchArgument(
        'joint',
        default_value='load',
        description='load, parallel, antagonistic, lever or crank, for both programs',
    ),
    DeclareLaunchArgument(
        'joint_params',
        default_value='',
        description='ROS parameter file of both programs; none: antagonistic.yaml for that joint',
    ),
    DeclareLaunchArgument(
        'mass', default_value='', description="kg of the load, for both; none: the muscle's"
    ),
    DeclareLaunchArgument(
        'sim_params',
        default_value=str(CONFIG / 'sim.yaml'),
        description='ROS parameter file of the simulator',
    ),
    DeclareLaunchArgument(
        'control_params',
        default_value=str(CONFIG / 'control.yaml'),
        description='ROS parameter file of the controller',
    ),
    DeclareLaunchArgument(
        'publish_rate', default_value='', description='Hz of the simulated joint states'
    ),
    DeclareLaunchArgument('rate', default_value='', description="Hz of the controller's commands"),
    DeclareLaunchArgument(
        'time_mode',
        default_value='',
        description='real_time, scaled or lockstep; the controller follows /clock in the latter',
    ),
    DeclareLaunchArgument('namespace', default_value='', description='namespace of both nodes'),
)


def start(context: LaunchContext) -> list[Node]:
    """Return both nodes; what the command line gives comes after the files."""
    given = {
        argument.name: LaunchConfiguration(argument.name).perform(context)
        for argument in ARGUMENTS
    }
    both: dict[str, object] = {'muscle': given['muscle'], 'joint': given['joint']}
    # What the joint is comes after each program's own file.
    joint = [given['joint_params']] if given['joint_params'] else []
    if given['joint'] == 'antagonistic' and not joint:
        joint = [str(CONFIG / 'antagonistic.yaml')]
    if given['mass']:
        both['mass'] = float(given['mass'])
    sim, control = dict(both), dict(both)
    if given['publish_rate']:
        sim['publish_rate'] = float(given['publish_rate'])
    if given['rate']:
        control['rate'] = float(given['rate'])
    if given['time_mode']:
        sim['time_mode'] = given['time_mode']
        control['use_sim_time'] = given['time_mode'] != 'real_time'
    return [
        Node(
            package='pam_ros',
            executable='pam_sim',
            namespace=given['namespace'],
            parameters=[given['sim_params'], *joint, sim],
            output='screen',
            emulate_tty=True,
        ),
        Node(
            package='pam_ros',
            executable='pam_control',
            namespace=given['namespace'],
            parameters=[given['control_params'], *joint, control],
            output='screen',
            emulate_tty=True,
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the arguments and the nodes."""
    return LaunchDescription([*ARGUMENTS, OpaqueFunction(function=start)])
