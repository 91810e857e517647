# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Loads of all joints in anatomical frames: lumbar discs, hips, knees, abdominal body.

One convention for all: the force of the *lower* segment on the *upper* one at the joint's centre,
in a frame with x anterior, y left, z towards the head.  At L5-S1 that is the force of S1 on L5, at
the knee that of the tibia on the femur.  Compression is +F_z, anterior shear (the upper segment
pushed forward on the lower one) is -F_x, lateral shear is +F_y.

Lumbar levels have the frames of their discs (`disc_frame`).  `bruno2015` gives every level its
share of the lordosis; `chaffin` knows L5-S1 only, and the levels above it have those of
`bruno2015`; `vertebral` is not turned.  Hips and knees have the axes of femur and tibia.
The mass-less abdominal body carries muscles alone; its joint is at L5-S1.

In models without lumbar vertebrae (most gait models) the joint that carries the torso stands for
L5-S1, with the torso in place of the vertebra, and there are no other levels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import kernel
from human_model.tables import read_table
from human_model.typing import Array, IntArray
from muscle_analyzer.core.loads.disc_frame import (
    FORWARD_LEFT_UP,
    DiscOption,
    disc_parameters,
    leant_forward,
)
from muscle_analyzer.core.multibody.kinematics import cross3
from muscle_analyzer.core.multibody.model import MultibodyModel

#: The joint whose frame depends on the posture with `chaffin`.
LUMBOSACRAL = 'l5_s1'
#: The mass-less body that some models have, and its joint: the last of the table.
ABDOMEN, ABDOMINAL = 'Abdomen', 'abdomen'
#: The body above it, and what stands for that in models without vertebrae.
L5, TORSO = 'lumbar5', 'torso'


@dataclass(frozen=True)
class LoadedJoint:
    """A row of `data/loaded_joints.csv`.

    Attributes
    ----------
    name
        Of the joint.
    body
        Body of the model that the joint carries (its child).
    upper
        Whether that body is the upper one of the two.
    disc
        Whether the frame is that of a disc.
    """

    name: str
    body: str
    upper: bool
    disc: bool


class JointLoad(NamedTuple):
    """Forces [N] and moments about the joints' centres [N m], each (n_j, 3); see the header."""

    force: Array
    moment: Array


def read_loaded_joints() -> tuple[LoadedJoint, ...]:
    """Read the table of joints."""
    upper, disc = {'upper': True, 'lower': False}, {'disc': True, 'body': False}
    return tuple(
        LoadedJoint(
            row['joint'], row['body'], row.choice('side', upper), row.choice('frame', disc)
        )
        for row in read_table('muscle_analyzer', 'loaded_joints.csv', 'joint body side frame')
    )


def lumbosacral_body(model: MultibodyModel) -> str:
    """Return the name of the body above L5-S1: the fifth vertebra, or the torso without one."""
    return L5 if L5 in model.body_names else TORSO


def loaded_joints(model: MultibodyModel) -> tuple[LoadedJoint, ...]:
    """Return the rows of the table for a model, those of vertebrae and abdomen if it has them."""
    joints = tuple(
        joint
        for joint in read_loaded_joints()
        if joint.body != ABDOMEN or ABDOMEN in model.body_names
    )
    body = lumbosacral_body(model)
    if body == L5:
        return joints
    return tuple(
        replace(joint, body=body) if joint.name == LUMBOSACRAL else joint
        for joint in joints
        if joint.name == LUMBOSACRAL or not joint.disc
    )


class JointFrames(NamedTuple):
    """The loaded joints of a model, for the compiled functions.

    Attributes
    ----------
    body : (n_j,) int
        Bodies that the joints carry.
    sign : (n_j,)
        1 where that is the upper segment, else -1.
    frame : (n_j, 3, 3)
        Body <- anatomical frame.
    lumbosacral : int
        Number of L5-S1, whose frame comes from elsewhere.
    """

    body: IntArray
    sign: Array
    frame: Array
    lumbosacral: int


@kernel
def joint_loads(
    joints: JointFrames,
    reactions: Array,
    centres: Array,
    rotations: Array,
    lumbosacral: Array,
    force: Array,
    moment: Array,
) -> None:
    """Put forces and moments of all joints into the last two (n_j, 3).

    The others are those of `JointLoadFrames.loads`.
    """
    for j in range(joints.body.size):
        b, sign = joints.body[j], joints.sign[j]
        fx, fy, fz = sign * reactions[b, 3], sign * reactions[b, 4], sign * reactions[b, 5]
        mx, my, mz = cross3(centres[b, 0], centres[b, 1], centres[b, 2], fx, fy, fz)
        mx = sign * reactions[b, 0] - mx
        my = sign * reactions[b, 1] - my
        mz = sign * reactions[b, 2] - mz
        for k in range(3):
            # Axis k of the joint's frame.
            x, y, z = lumbosacral[0, k], lumbosacral[1, k], lumbosacral[2, k]
            if j != joints.lumbosacral:
                x, y, z = 0.0, 0.0, 0.0
                for m in range(3):
                    x += rotations[b, 0, m] * joints.frame[j, m, k]
                    y += rotations[b, 1, m] * joints.frame[j, m, k]
                    z += rotations[b, 2, m] * joints.frame[j, m, k]
            force[j, k] = x * fx + y * fy + z * fz
            moment[j, k] = x * mx + y * my + z * mz


class JointLoadFrames:
    """Turns the reactions of a model's joints into their anatomical frames.

    Parameters
    ----------
    model
        The subject's model.
    option
        Source of the discs' orientation.

    Raises
    ------
    UnknownNameError
        If the model lacks a body of the table.
    """

    def __init__(self, model: MultibodyModel, option: DiscOption) -> None:
        joints = loaded_joints(model)
        self.names = tuple(joint.name for joint in joints)
        self.joints = JointFrames(
            np.array([model.body_index(joint.body) for joint in joints], np.int64),
            np.array([1.0 if joint.upper else -1.0 for joint in joints]),
            np.array([_frame(joint, option) for joint in joints]),
            self.names.index(LUMBOSACRAL),
        )

    def loads(
        self, reactions: Array, centres: Array, rotations: Array, lumbosacral: Array
    ) -> JointLoad:
        """Return the loads in one state.

        Parameters
        ----------
        reactions : (n_b, 6)
            Of `joint_reaction.joint_reactions`, about the ground's origin.
        centres : (n_b, 3)
            Where the joints that carry the bodies are [m].
        rotations : (n_b, 3, 3)
            Ground <- body.
        lumbosacral : (3, 3)
            Ground <- L5-S1 disc.
        """
        force, moment = np.empty((2, len(self.names), 3))
        disc = np.ascontiguousarray(lumbosacral)
        joint_loads(self.joints, reactions, centres, rotations, disc, force, moment)
        return JointLoad(force, moment)


def _frame(joint: LoadedJoint, option: DiscOption) -> Array:
    """Return the rotation (3, 3) body <- anatomical frame."""
    if not joint.disc or option is DiscOption.VERTEBRAL:
        return FORWARD_LEFT_UP
    parameters = disc_parameters(DiscOption.BRUNO2015)
    own = '' if joint.name == LUMBOSACRAL else f'_{joint.name}'
    frame: Array = leant_forward(FORWARD_LEFT_UP, math.radians(parameters[f'forward_tilt{own}']))
    return frame
