# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Start ``pam_sim``: ``ros2 launch pam_ros sim.launch.py muscle:=dmsp_20_400n``."""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = (
    DeclareLaunchArgument(
        'muscle',
        default_value='',
        description='muscle of config/muscles, such as dmsp_20_400n, or a parameter file of one',
    ),
    DeclareLaunchArgument(
        'params',
        default_value='',
        description='ROS parameter file, such as one that pam_identify wrote',
    ),
    DeclareLaunchArgument('namespace', default_value='', description='namespace of the node'),
    DeclareLaunchArgument(
        'use_sim_time', default_value='false', description='follow /clock instead of the system'
    ),
)


def start(context: LaunchContext) -> list[Node]:
    """Return the node with what the command line gives: the parameter file may set the rest."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ('muscle', 'params')}
    parameters: list[object] = [
        {'use_sim_time': ParameterValue(LaunchConfiguration('use_sim_time'), value_type=bool)}
    ]
    if given['params']:
        parameters.append(given['params'])
    if given['muscle']:
        parameters.append({'muscle': given['muscle']})
    return [
        Node(
            package='pam_ros',
            executable='pam_sim',
            namespace=LaunchConfiguration('namespace'),
            parameters=parameters,
            output='screen',
            emulate_tty=True,
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the arguments and the node."""
    return LaunchDescription([*ARGUMENTS, OpaqueFunction(function=start)])
