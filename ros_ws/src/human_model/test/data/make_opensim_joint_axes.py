# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write ``opensim_joint_axes.csv``: what OpenSim does when one coordinate of a model grows.

Usage: ``python make_opensim_joint_axes.py MODEL.osim`` with the official OpenSim wheel (4.6 was
used, on the lifting full-body model of the pose2sim wheel). For each coordinate: the world axis
(REP-103) about which, or along which, a body further out moves, hanging arms, all other
coordinates at their defaults. Not a test; the tests read its result.
"""

import csv
import sys
from pathlib import Path

import numpy as np
import opensim

SOURCE = 'OpenSim 4.6 on the lifting full-body model of the pose2sim wheel'
PROBES = {
    'pelvis_tx': 'pelvis',
    'pelvis_ty': 'pelvis',
    'pelvis_tz': 'pelvis',
    'pelvis_tilt': 'pelvis',
    'pelvis_list': 'pelvis',
    'pelvis_rotation': 'pelvis',
    'L5_S1_Flex_Ext': 'torso',
    'L5_S1_Lat_Bending': 'torso',
    'L5_S1_axial_rotation': 'torso',
}
for _side in 'rl':
    PROBES |= {
        f'{name}_{_side}': f'hand_{_side}'
        for name in (
            'arm_flex',
            'arm_add',
            'arm_rot',
            'elbow_flex',
            'pro_sup',
            'wrist_flex',
            'wrist_dev',
        )
    }
    PROBES |= {
        f'{name}_{_side}': f'toes_{_side}'
        for name in (
            'hip_flexion',
            'hip_adduction',
            'hip_rotation',
            'knee_angle',
            'ankle_angle',
            'subtalar_angle',
            'mtp_angle',
        )
    }
STEP = 1e-3
ROS = np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])


def main() -> None:
    """Move each coordinate by a small step and write the axes."""
    model = opensim.Model(sys.argv[1])
    state = model.initSystem()
    coordinates = model.getCoordinateSet()
    for side in 'rl':
        coordinates.get(f'arm_add_{side}').setValue(state, 0.0)

    def pose(body: str) -> tuple[np.ndarray, np.ndarray]:
        model.realizePosition(state)
        frame = model.getBodySet().get(body).getTransformInGround(state)
        return (
            np.array([frame.p().get(i) for i in range(3)]),
            np.array([[frame.R().get(i, j) for j in range(3)] for i in range(3)]),
        )

    lines = []
    for name, body in PROBES.items():
        coordinate = coordinates.get(name)
        value = coordinate.getValue(state)
        place, turn = pose(body)
        coordinate.setValue(state, value + STEP)
        place_after, turn_after = pose(body)
        coordinate.setValue(state, value)
        turned = turn_after @ turn.T
        axis = (
            np.array(
                [
                    turned[2, 1] - turned[1, 2],
                    turned[0, 2] - turned[2, 0],
                    turned[1, 0] - turned[0, 1],
                ]
            )
            / 2
        )
        kind = 'rotation' if np.linalg.norm(axis) > STEP / 100 else 'translation'
        vector = ROS @ (axis if kind == 'rotation' else place_after - place)
        vector /= np.linalg.norm(vector)
        lines.append([name, kind, *(f'{component:.6f}' for component in vector)])
    with (Path(__file__).parent / 'opensim_joint_axes.csv').open('w', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['coordinate', 'kind', 'x', 'y', 'z', 'source'])
        writer.writerows([*line, SOURCE] for line in lines)


if __name__ == '__main__':
    main()
