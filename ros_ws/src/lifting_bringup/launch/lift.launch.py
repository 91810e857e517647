# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Start the graph of one station: `ros2 launch lifting_bringup lift.launch.py station:=cell_3`."""

from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessStart
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition

from launch import LaunchDescription

#: Time [s] before a node that ended is started again.
RESPAWN_DELAY = 1.0

NODES = ('muscle_analyzer', 'lift_predictor', 'motion_tracker')


def managed_node(name: str, condition: IfCondition | None = None, *parameters: dict) -> list:
    """Return a lifecycle node and the handlers that configure and activate it."""
    node = LifecycleNode(
        package=name,
        executable=f'{name}_node',
        name=name,
        namespace=LaunchConfiguration('station'),
        parameters=[
            PathJoinSubstitution([FindPackageShare(name), 'config', f'{name}.yaml']),
            {'use_sim_time': LaunchConfiguration('use_sim_time')},
            *parameters,
        ],
        output='screen',
        # A node that ends is started again, and the handlers below bring it up.
        respawn=True,
        respawn_delay=RESPAWN_DELAY,
        condition=condition,
    )

    def change(transition: int) -> EmitEvent:
        return EmitEvent(
            event=ChangeState(
                lifecycle_node_matcher=matches_action(node), transition_id=transition
            )
        )

    configure = RegisterEventHandler(
        OnProcessStart(target_action=node, on_start=[change(Transition.TRANSITION_CONFIGURE)])
    )
    activate = RegisterEventHandler(
        OnStateTransition(
            target_lifecycle_node=node,
            start_state='configuring',
            goal_state='inactive',
            entities=[change(Transition.TRANSITION_ACTIVATE)],
        )
    )
    return [configure, activate, node]


def generate_launch_description() -> LaunchDescription:
    """Describe the graph of one station."""
    arguments = [
        DeclareLaunchArgument(
            'station', default_value='station_1', description='Namespace of the station'
        ),
        DeclareLaunchArgument(
            'use_sim_time',
            default_value='false',
            description='Follow /clock (true when a bag is played)',
        ),
        DeclareLaunchArgument(
            'journal',
            default_value='',
            description='File of the alarm journal: alarms go on from their state after a restart',
        ),
        DeclareLaunchArgument(
            'visualization',
            default_value='true',
            description='Also publish markers, /tf and the URDF of the person',
        ),
    ]
    entities = [entity for name in NODES for entity in managed_node(name)]
    entities += managed_node('injury_monitor', None, {'journal': LaunchConfiguration('journal')})
    shown = IfCondition(LaunchConfiguration('visualization'))
    entities += managed_node('lifting_visualization', shown)
    return LaunchDescription([*arguments, *entities])
