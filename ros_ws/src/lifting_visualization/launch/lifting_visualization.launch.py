# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Starts the pictures of one station; configure and activate it with `ros2 lifecycle`."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode

from launch import LaunchDescription


def generate_launch_description() -> LaunchDescription:
    """Return the launch description."""
    parameters = Path(get_package_share_directory('lifting_visualization')) / 'config'
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'station', default_value='station_1', description='Namespace of the station'
            ),
            LifecycleNode(
                package='lifting_visualization',
                executable='lifting_visualization_node',
                name='lifting_visualization',
                namespace=LaunchConfiguration('station'),
                parameters=[str(parameters / 'lifting_visualization.yaml')],
                output='screen',
            ),
        ]
    )
