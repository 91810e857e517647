# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The 3D skeleton against Pinocchio, built here from an own statement of joints and segments.

The list of joints below is written from the anatomy and the lengths' meanings, not from the
package's chain table, so an error there shows.
"""

import numpy as np
import pytest

from human_model.constants import GRAVITY
from human_model.skeleton import ExternalForce

pin = pytest.importorskip('pinocchio', reason='Pinocchio (package pin) is not installed')

FORWARD, LEFT, UP = np.eye(3)
RIGHT = -LEFT


def joint_list(length):
    """Return (coordinate, parent, axis, place in the parent, segment moved) of every joint."""
    here = np.zeros(3)

    def at(forward=0.0, left=0.0, up=0.0):
        return np.array([forward, left, up])

    joints = [
        ('pelvis_tx', '', FORWARD, here, ''),
        ('pelvis_ty', 'pelvis_tx', UP, here, ''),
        ('pelvis_tz', 'pelvis_ty', RIGHT, here, ''),
        ('pelvis_tilt', 'pelvis_tz', RIGHT, here, ''),
        ('pelvis_list', 'pelvis_tilt', FORWARD, here, ''),
        ('pelvis_rotation', 'pelvis_list', UP, here, 'pelvis'),
        (
            'lumbar_extension',
            'pelvis_rotation',
            RIGHT,
            at(length['l5s1_forward'], 0, length['l5s1_height']),
            '',
        ),
        ('lumbar_bending', 'lumbar_extension', FORWARD, here, ''),
        ('lumbar_rotation', 'lumbar_bending', UP, here, 'lumbar'),
        (
            'thorax_extension',
            'lumbar_rotation',
            RIGHT,
            at(length['t12l1_forward'], 0, length['t12l1_height']),
            '',
        ),
        ('thorax_bending', 'thorax_extension', FORWARD, here, ''),
        ('thorax_rotation', 'thorax_bending', UP, here, 'thorax'),
    ]
    for side, out in (('r', -1.0), ('l', 1.0)):
        forward, up = -out * FORWARD, -out * UP  # mirrored on the left
        names = [
            f'{name}_{side}'
            for name in (
                'arm_flex',
                'arm_add',
                'arm_rot',
                'elbow_flex',
                'pro_sup',
                'wrist_flex',
                'wrist_dev',
            )
        ]
        places = [
            at(
                length['shoulder_forward'],
                out * length['shoulder_half_width'],
                length['shoulder_height'],
            ),
            here,
            here,
            at(up=-length['upper_arm']),
            here,
            at(up=-length['forearm']),
            here,
        ]
        axes = [RIGHT, forward, up, RIGHT, up, forward, LEFT]
        moved = ['', '', 'upper_arm', '', 'forearm', '', 'hand']
        for i, name in enumerate(names):
            joints.append(
                (
                    name,
                    names[i - 1] if i else 'thorax_rotation',
                    axes[i],
                    places[i],
                    moved[i] and f'{moved[i]}_{side}',
                )
            )
    for side, out in (('r', -1.0), ('l', 1.0)):
        forward, up = -out * FORWARD, -out * UP
        names = [
            f'{name}_{side}'
            for name in (
                'hip_flexion',
                'hip_adduction',
                'hip_rotation',
                'knee_angle',
                'ankle_angle',
                'subtalar_angle',
                'mtp_angle',
            )
        ]
        places = [
            at(left=out * length['hip_half_width']),
            here,
            here,
            at(up=-length['thigh']),
            at(up=-length['shank']),
            here,
            at(forward=length['ankle_mtp'], up=-length['mtp_drop']),
        ]
        axes = [RIGHT, forward, up, LEFT, RIGHT, forward, LEFT]
        moved = ['', '', 'thigh', 'shank', '', 'foot', 'toes']
        for i, name in enumerate(names):
            joints.append(
                (
                    name,
                    names[i - 1] if i else 'pelvis_rotation',
                    axes[i],
                    places[i],
                    moved[i] and f'{moved[i]}_{side}',
                )
            )
    return joints


class Reference:
    """Pinocchio model of the same person."""

    def __init__(self, parameters):
        self.model = pin.Model()
        self.model.gravity.linear = np.array([0, 0, -GRAVITY])
        self.ids, self.carrier = {'': 0}, {}
        for name, parent, axis, place, segment in joint_list(parameters.lengths):
            kind = (
                pin.JointModelPrismaticUnaligned
                if name[:8] == 'pelvis_t' and name[8] in 'xyz'
                else pin.JointModelRevoluteUnaligned
            )
            self.ids[name] = self.model.addJoint(
                self.ids[parent], kind(*axis), pin.SE3(np.eye(3), place), name
            )
            if segment:
                self.attach(parameters, segment, name, np.zeros(3))
        lengths = parameters.lengths
        self.attach(
            parameters,
            'head',
            'thorax_rotation',
            np.array([lengths['c7_forward'], 0, lengths['c7_height']]),
        )
        self.data = self.model.createData()

    def attach(self, parameters, segment, joint, place):
        """Fix a segment's inertia to a joint's frame, at a place in it."""
        i = parameters.index(segment)
        inertia = pin.Inertia(
            float(parameters.mass[i]), np.array(parameters.com[i]), np.array(parameters.inertia[i])
        )
        self.model.appendBodyToJoint(self.ids[joint], inertia, pin.SE3(np.eye(3), place))
        self.carrier[segment] = (self.ids[joint], place)

    def order(self, coordinates):
        """Index of each coordinate in Pinocchio's vectors."""
        return np.array([self.model.joints[self.ids[name]].idx_q for name in coordinates])


@pytest.fixture(scope='module')
def reference(body):
    return Reference(body.parameters)


def test_forward_kinematics(body, reference, rng):
    order = reference.order(body.coordinates)
    for _ in range(5):
        q = rng.normal(size=40)
        theirs = np.empty(40)
        theirs[order] = q
        pin.forwardKinematics(reference.model, reference.data, theirs)
        frames = body.forward(q)
        for i, segment in enumerate(body.segments):
            joint, place = reference.carrier[segment]
            placement = reference.data.oMi[joint]
            assert frames[i, :3, :3] == pytest.approx(placement.rotation, abs=1e-12)
            assert frames[i, :3, 3] == pytest.approx(placement.act(place), abs=1e-12)
        assert body.centre_of_mass(q) == pytest.approx(
            pin.centerOfMass(reference.model, reference.data, theirs), abs=1e-12
        )


def test_jacobian(body, reference, rng):
    order = reference.order(body.coordinates)
    q = rng.normal(size=40)
    theirs = np.empty(40)
    theirs[order] = q
    pin.computeJointJacobians(reference.model, reference.data, theirs)
    for segment in ('hand_l', 'toes_r', 'head'):
        joint, place = reference.carrier[segment]
        local = np.array([0.02, -0.03, 0.05])
        jacobian = pin.getJointJacobian(
            reference.model, reference.data, joint, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        arm = reference.data.oMi[joint].rotation @ (place + local)
        expected = jacobian[:3] - pin.skew(arm) @ jacobian[3:]
        assert body.point_jacobian(q, segment, local)[0] == pytest.approx(
            expected[:, order], abs=1e-12
        )


def test_inverse_dynamics_with_external_forces(body, reference, rng):
    order = reference.order(body.coordinates)
    for _ in range(5):
        q, qd, qdd = rng.normal(size=(3, 40)) * [[0.8], [2.0], [10.0]]
        loads = [
            ExternalForce(segment, *rng.normal(size=(3, 3)) * [[300], [1.0], [20]])
            for segment in ('foot_r', 'foot_l', 'hand_r', 'hand_l', 'thorax', 'head')
        ]
        vectors = np.empty((3, 40))
        vectors[:, order] = q, qd, qdd
        pin.forwardKinematics(reference.model, reference.data, vectors[0])
        forces = [pin.Force.Zero() for _ in range(reference.model.njoints)]
        for load in loads:
            joint, _ = reference.carrier[load.segment]
            world = pin.Force(
                np.asarray(load.force), np.cross(load.point, load.force) + load.moment
            )
            forces[joint] += reference.data.oMi[joint].actInv(world)
        expected = pin.rnea(reference.model, reference.data, *vectors, forces)
        ours = body.inverse_dynamics(q, qd, qdd, loads)
        assert ours == pytest.approx(np.asarray(expected)[order], rel=1e-10, abs=1e-9)
