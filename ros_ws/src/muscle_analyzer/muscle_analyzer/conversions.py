# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the analyzer's results, and of what it reads."""

from __future__ import annotations

from array import array

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import Vector3, Wrench, WrenchStamped
from lifting_interfaces.msg import JointReactions as JointReactionsMsg
from lifting_interfaces.msg import JointTorques as JointTorquesMsg
from lifting_interfaces.msg import MuscleAnalysis as MuscleAnalysisMsg
from lifting_interfaces.msg import SpineLoad as SpineLoadMsg

from human_model.motion import BodyMotion
from lifting_node.conversions import (
    flat,
    motion_from_msg,
    quality_from_msg,
    report_to_msg,
    subject_from_msg,
)
from lifting_node.stamps import to_stamp
from muscle_analyzer.core.muscle_analysis import MuscleAnalysis
from muscle_analyzer.core.torque_limits import JointTorques

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

_SOURCES = {
    'live': SpineLoadMsg.LIVE,
    'measured': SpineLoadMsg.MEASURED,
    'predicted': SpineLoadMsg.PREDICTED,
}


def disc_frame_id(station: str) -> str:
    """Return the name of the disc's frame on /tf, which all stations share: station_1/l5_s1."""
    prefix = station.strip('/')
    return f'{prefix}/{DISC}' if prefix else DISC


def mass_in_hands(motion: BodyMotion, box_mass: float) -> float:
    """Return the mass in the hands [kg]: that of the box while it pushes a hand, else 0."""
    return box_mass if bool(np.any(motion.hand_force)) else 0.0


def analysis_to_msg(analysis: MuscleAnalysis) -> MuscleAnalysisMsg:
    """Return the message of muscle forces and the quality of the analysis."""
    ends = (analysis.hand_distance, analysis.foot_distance)
    angles = (analysis.trunk_angle[:, None], analysis.foot_angle)
    message = MuscleAnalysisMsg(
        muscle_names=list(analysis.muscle_names),
        activation=flat(analysis.activation),
        force=flat(analysis.force),
        coordinate_names=list(analysis.coordinate_names),
        torque=flat(analysis.torque),
        reserve=flat(analysis.reserve),
        pelvis_residual=flat(analysis.pelvis_residual),
        transfer_position_error=flat(np.concatenate(ends, axis=1).max(axis=1)),
        transfer_angle_error=flat(np.concatenate(angles, axis=1).max(axis=1)),
        dual_residual=flat([report.dual_residual for report in analysis.reports]),
        primal_residual=flat([report.primal_residual for report in analysis.reports]),
        report=report_to_msg(analysis.report),
    )
    _put_block(message, analysis, analysis.status)
    return message


def spine_load_to_msg(
    analysis: MuscleAnalysis, box_mass: float, frame_id: str = DISC
) -> SpineLoadMsg:
    """Return the message of the L5-S1 load, with its own statuses.

    Parameters
    ----------
    analysis
        Of a block.
    box_mass
        Mass in the hands [kg].
    frame_id
        Of the disc (`disc_frame_id`).
    """
    message = SpineLoadMsg(
        subject=analysis.pseudonym,
        body_mass=analysis.body_mass,
        box_mass=box_mass,
        compression=flat(analysis.compression),
        anterior_shear=flat(analysis.anterior_shear),
        lateral_shear=flat(analysis.lateral_shear),
        net_moment=flat(analysis.net_moment_top_down),
        moment_difference=flat(np.linalg.norm(analysis.net_moment_difference, axis=1)),
        disc_frame=analysis.disc_frame,
        disc_position=flat(analysis.disc_position),
        disc_orientation=flat(analysis.disc_orientation),
        compression_per_degree=flat(analysis.compression_per_degree),
        anterior_shear_per_degree=flat(analysis.anterior_shear_per_degree),
        report=report_to_msg(analysis.spine_report),
    )
    _put_block(message, analysis, analysis.spine_status)
    message.header.frame_id = frame_id
    return message


def joint_reactions_to_msg(analysis: MuscleAnalysis) -> JointReactionsMsg:
    """Return the message of the loads of all joints."""
    message = JointReactionsMsg(
        subject=analysis.pseudonym,
        body_mass=analysis.body_mass,
        joint_names=list(analysis.joint_names),
        force=flat(analysis.joint_force),
        moment=flat(analysis.joint_moment),
        disc_frame=analysis.disc_frame,
        report=report_to_msg(analysis.report),
    )
    _put_block(message, analysis, analysis.status)
    message.lumbar_status = _statuses(analysis.spine_status)
    return message


def torques_to_msg(torques: JointTorques) -> JointTorquesMsg:
    """Return the message of joint torques and strength."""
    message = JointTorquesMsg(
        joint_names=list(torques.joint_names),
        torque=flat(torques.torque),
        torque_lower=flat(torques.lower),
        torque_upper=flat(torques.upper),
    )
    _put_block(message, torques, torques.status)
    return message


def reactions_to_msg(analysis: MuscleAnalysis, frame_id: str = DISC) -> list[WrenchStamped]:
    """Return force of S1 on L5 and moment about the joint centre of each good sample.

    Parameters
    ----------
    analysis
        Of a block.
    frame_id
        Of the disc (`disc_frame_id`).
    """
    messages = []
    for k in np.flatnonzero(analysis.spine_status == 0):
        force, moment = (
            Vector3(x=float(x), y=float(y), z=float(z))
            for x, y, z in (analysis.l5_s1_force[k], analysis.l5_s1_moment[k])
        )
        message = WrenchStamped(wrench=Wrench(force=force, torque=moment))
        message.header.stamp = to_stamp(float(analysis.time[k]))
        message.header.frame_id = frame_id
        messages.append(message)
    return messages


def _put_block(
    message: MuscleAnalysisMsg | SpineLoadMsg | JointReactionsMsg | JointTorquesMsg,
    block: MuscleAnalysis | JointTorques,
    status: npt.NDArray[np.int64],
) -> None:
    """Write lift, source, clock and statuses, which all blocks have."""
    message.header.stamp = to_stamp(float(block.time[0]))
    message.lift_id = block.lift_id
    message.source = _SOURCES[block.source]
    message.time_from_start = flat(block.time - block.time[0])
    message.status = _statuses(status)


def _statuses(status: npt.NDArray[np.int64]) -> array[int]:
    return array('H', np.asarray(status, np.uint16).tobytes())
