# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Kinematics in NumPy against the compiled ones, and what the sagittal skeleton loads."""

import subprocess
import sys

import numpy as np
import pytest

from human_model import compiled, tree_kinematics
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.subject import Subject

SUBJECT = Subject('test', 'male', 75.0, 1.75, 30.0)


@pytest.mark.parametrize('kind', [Skeleton2D, Skeleton3D])
def test_same_frames_and_points_as_compiled(kind):
    skeleton = kind.of(SUBJECT)
    q = np.random.default_rng(4).uniform(-1.5, 1.5, (7, len(skeleton.coordinates)))
    rotation, origin = tree_kinematics.segment_frames(skeleton.tree, q)
    points = tree_kinematics.point_positions(
        skeleton.tree, q, skeleton.point_segment, skeleton.point_local
    )
    for i, row in enumerate(q):
        turned, place = compiled.segment_frames(skeleton.tree, row)
        np.testing.assert_allclose(rotation[i], turned, atol=1e-13)
        np.testing.assert_allclose(origin[i], place, atol=1e-13)
        expected = compiled.point_positions(
            skeleton.tree, row, skeleton.point_segment, skeleton.point_local
        )
        np.testing.assert_allclose(points[i], expected, atol=1e-13)


def test_sagittal_skeleton_does_not_load_numba():
    code = (
        'import sys, numpy as np\n'
        'from human_model.skeletons import Skeleton2D\n'
        'from human_model.subject import Subject\n'
        "skeleton = Skeleton2D.of(Subject('test', 'male', 75.0, 1.75, 30.0))\n"
        'q = np.zeros((4, 10))\n'
        'skeleton.body_motion(np.arange(4.0), q, q, q)\n'
        "print('numba' in sys.modules, 'scipy' in sys.modules)\n"
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.split() == ['False', 'False']
