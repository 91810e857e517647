# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the analyzer's results and inputs."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from human_model.motion import BodyMotion
from human_model.report import SolveStatus
from lifting_messages.conversions import (
    motion_from_msg,
    quality_from_msg,
    report_to_msg,
    subject_from_msg,
    vector,
)
from lifting_messages.message_types import Message, make, message_type
from lifting_messages.names import join
from lifting_messages.stamps import header
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.torque_limits import JointTorques

__all__ = [
    'analysis_to_msg',
    'disc_frame_id',
    'joint_reactions_to_msg',
    'mass_in_hands',
    'motion_from_msg',
    'quality_from_msg',
    'reactions_to_msg',
    'spine_load_to_msg',
    'subject_from_msg',
    'torques_to_msg',
]

#: Frame of the L5-S1 load: x anterior, y left, z along the disc normal towards the head.
DISC = 'l5_s1'

_SPINE_LOAD = message_type('SpineLoad')
_SOURCES = {
    'live': _SPINE_LOAD.LIVE,
    'measured': _SPINE_LOAD.MEASURED,
    'predicted': _SPINE_LOAD.PREDICTED,
}


def disc_frame_id(station: str) -> str:
    """Return the name of the disc's frame on /tf, which all stations share: station_1/l5_s1."""
    prefix = station.strip('/')
    return f'{prefix}/{DISC}' if prefix else DISC


def mass_in_hands(motion: BodyMotion, box_mass: float) -> float:
    """Return the mass in the hands [kg]: that of the box while it pushes a hand, else 0."""
    return box_mass if np.count_nonzero(motion.hand_force) else 0.0


def analysis_to_msg(analysis: MuscleAnalysis) -> Message:
    """Return the message of muscle forces and the quality of the analysis."""
    hands, feet = analysis.hand_distance, analysis.foot_distance
    return make(
        'MuscleAnalysis',
        **_block(analysis, analysis.status),
        muscle_names=join(analysis.muscle_names),
        activation=analysis.activation,
        force=analysis.force,
        coordinate_names=join(analysis.coordinate_names),
        torque=analysis.torque,
        reserve=analysis.reserve,
        pelvis_residual=analysis.pelvis_residual,
        transfer_position_error=np.maximum(hands, feet).max(axis=1),
        transfer_angle_error=np.maximum(analysis.trunk_angle, analysis.foot_angle.max(axis=1)),
        dual_residual=[report.dual_residual for report in analysis.reports],
        primal_residual=[report.primal_residual for report in analysis.reports],
        report=report_to_msg(analysis.report),
    )


def spine_load_to_msg(
    analysis: MuscleAnalysis, box_mass: float, frame_id: str = DISC, filter_delay: float = 0.0
) -> Message:
    """Return the message of the L5-S1 load, with its own statuses.

    Parameters
    ----------
    analysis
        Of a block.
    box_mass
        Mass in the hands [kg].
    frame_id
        Of the disc (`disc_frame_id`).
    filter_delay
        Of the motion that was analysed [s].
    """
    return make(
        'SpineLoad',
        **_block(analysis, analysis.spine_status, frame_id),
        subject=analysis.pseudonym,
        body_mass=analysis.body_mass,
        box_mass=box_mass,
        filter_delay=filter_delay,
        compression=analysis.compression,
        anterior_shear=analysis.anterior_shear,
        lateral_shear=analysis.lateral_shear,
        net_moment=analysis.net_moment_top_down,
        moment_difference=np.linalg.norm(analysis.net_moment_difference, axis=1),
        disc_frame=analysis.disc_frame,
        disc_position=analysis.disc_position,
        disc_orientation=analysis.disc_orientation,
        compression_per_degree=analysis.compression_per_degree,
        anterior_shear_per_degree=analysis.anterior_shear_per_degree,
        report=report_to_msg(analysis.spine_report),
    )


def joint_reactions_to_msg(analysis: MuscleAnalysis) -> Message:
    """Return the message of the loads of all joints."""
    return make(
        'JointReactions',
        **_block(analysis, analysis.status),
        subject=analysis.pseudonym,
        body_mass=analysis.body_mass,
        joint_names=join(analysis.joint_names),
        force=analysis.joint_force,
        moment=analysis.joint_moment,
        disc_frame=analysis.disc_frame,
        lumbar_status=analysis.spine_status,
        report=report_to_msg(analysis.report),
    )


def torques_to_msg(torques: JointTorques) -> Message:
    """Return the message of joint torques and strength."""
    return make(
        'JointTorques',
        **_block(torques, torques.status),
        joint_names=join(torques.joint_names),
        torque=torques.torque,
        torque_lower=torques.lower,
        torque_upper=torques.upper,
    )


def reactions_to_msg(analysis: MuscleAnalysis, frame_id: str = DISC) -> list[Message]:
    """Return force of S1 on L5 and moment about the joint centre of each good sample.

    Parameters
    ----------
    analysis
        Of a block.
    frame_id
        Of the disc (`disc_frame_id`).
    """
    return [
        make(
            'geometry_msgs/WrenchStamped',
            header=header(float(analysis.time[k]), frame_id),
            wrench=make(
                'geometry_msgs/Wrench',
                force=vector(analysis.l5_s1_force[k]),
                torque=vector(analysis.l5_s1_moment[k]),
            ),
        )
        for k in np.flatnonzero(analysis.spine_status == SolveStatus.OK).tolist()
    ]


def _block(
    block: MuscleAnalysis | JointTorques, status: npt.NDArray[np.int64], frame_id: str = ''
) -> dict[str, Any]:
    """Return stamp, lift, source, clock and statuses, which all blocks have."""
    return {
        'header': header(float(block.time[0]), frame_id),
        'lift_id': block.lift_id,
        'source': _SOURCES[block.source],
        'time_from_start': block.time - block.time[0],
        'status': status,
    }
