# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Show a muscle in RViz: ``ros2 launch pam_ros view.launch.py model:=antagonistic_pair``."""

import sys
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from pam_ros.errors import PamError
from pam_ros.settings.launch import ARGUMENTS, TRUE, VIEW_TIME, refuse_unknown

# When this file is installed, the others are next to it, as they are in the sources.
SHARE = Path(__file__).parents[1]
NAMES = ('model', 'rviz', 'use_sim_time', 'namespace')


def refuse_missing(package: str, hint: str = '') -> None:
    """Raise PamError if *package* is not installed."""
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        raise PamError(
            f'{package} is not installed: sudo apt install ros-$ROS_DISTRO-'
            f'{package.replace("_", "-")}{hint}'
        ) from None


def start(context: LaunchContext) -> list[Node]:
    """Return the publisher of the description, and RViz."""
    refuse_unknown(__file__, NAMES, sys.argv)
    given = {name: LaunchConfiguration(name).perform(context) for name in NAMES}
    model = given['model']
    known = SHARE / 'urdf' / f'{model}.urdf'
    path = known if known.is_file() else Path(model)
    if not path.is_file():
        models = ', '.join(sorted(file.stem for file in known.parent.glob('*.urdf')))
        raise PamError(f'model = {model} is not allowed: give {models}, or the path of a URDF')
    description = ParameterValue(path.read_text(encoding='utf-8'), value_type=str)
    use_sim_time = {'use_sim_time': given['use_sim_time'] in TRUE}
    refuse_missing('robot_state_publisher')
    nodes = [
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            namespace=given['namespace'],
            parameters=[use_sim_time, {'robot_description': description}],
            output='screen',
        )
    ]
    if given['rviz'] in TRUE:
        refuse_missing('rviz2', ', or rviz:=false')
        nodes.append(
            Node(
                package='rviz2',
                executable='rviz2',
                namespace=given['namespace'],
                arguments=['-d', str(SHARE / 'config' / 'rviz' / 'pam.rviz')],
                parameters=[use_sim_time],
                output='screen',
            )
        )
    return nodes


def generate_launch_description() -> LaunchDescription:
    """Return the arguments and the nodes."""
    table = {**ARGUMENTS, 'use_sim_time': VIEW_TIME}
    arguments = [DeclareLaunchArgument(name, **table[name].declared) for name in NAMES]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
