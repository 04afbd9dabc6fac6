# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""See a simulated muscle move: ``ros2 launch pam_ros view.launch.py model:=antagonistic_pair``."""

from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

# Where this file is installed the others are beside it, as they are in the sources.
SHARE = Path(__file__).parents[1]
ARGUMENTS = (
    DeclareLaunchArgument(
        'model',
        default_value='rig',
        description='rig, antagonistic_pair, or the path of a URDF with the joint of joint_states',
    ),
    DeclareLaunchArgument(
        'rviz', default_value='true', description='false: publish the description and tf alone'
    ),
    DeclareLaunchArgument(
        'namespace', default_value='', description='namespace of the simulator that is looked at'
    ),
    DeclareLaunchArgument(
        'use_sim_time', default_value='false', description='follow /clock instead of the system'
    ),
)


def start(context: LaunchContext) -> list[Node]:
    """Return the publisher of the description, and RViz."""
    model = LaunchConfiguration('model').perform(context)
    known = SHARE / 'urdf' / f'{model}.urdf'
    text = (known if known.is_file() else Path(model)).read_text(encoding='utf-8')
    use_sim_time = {
        'use_sim_time': ParameterValue(LaunchConfiguration('use_sim_time'), value_type=bool)
    }
    namespace = LaunchConfiguration('namespace')
    return [
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            namespace=namespace,
            parameters=[
                use_sim_time,
                {'robot_description': ParameterValue(text, value_type=str)},
            ],
            output='screen',
        ),
        Node(
            package='rviz2',
            executable='rviz2',
            namespace=namespace,
            arguments=['-d', str(SHARE / 'config' / 'rviz' / 'pam.rviz')],
            parameters=[use_sim_time],
            condition=IfCondition(LaunchConfiguration('rviz')),
            output='screen',
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the arguments and the nodes."""
    return LaunchDescription([*ARGUMENTS, OpaqueFunction(function=start)])
