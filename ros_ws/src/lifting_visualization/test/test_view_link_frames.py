# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The links of /tf, chained, lead to where the skeleton has its segments."""

import numpy as np
import pytest

from human_model.frames import matrix_from_quaternion
from human_model.urdf import WORLD
from lifting_visualization.core.exceptions import PictureError
from lifting_visualization.core.link_frames import LinkFrames


def chained(links, transforms):
    """Return the pose (4, 4) in the laboratory by frame."""
    poses = {WORLD: np.eye(4)}
    rows = [
        (parent, child, row[:3], row[3:])
        for parent, child, row in zip(links.parents, links.children, transforms, strict=True)
    ]
    rows += [(parent, child, place, (0, 0, 0, 1)) for parent, child, place in links.fixed]
    for parent, child, place, turn in rows:
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = matrix_from_quaternion(turn), place
        poses[child] = poses[parent] @ step
    return poses


def test_links_lead_to_the_segments(skeleton):
    rng = np.random.default_rng(20260601)
    links = LinkFrames(skeleton, 'cell_3/')
    for _ in range(10):
        q = rng.normal(size=40) * 2.0
        poses = chained(links, links.transforms(skeleton.coordinates, q))
        for segment, frame in zip(skeleton.segments, skeleton.forward(q), strict=True):
            np.testing.assert_allclose(poses[f'cell_3/{segment}'], frame, atol=1e-12)


def test_frames_are_named_once_and_begin_at_the_laboratory(skeleton):
    links = LinkFrames(skeleton, 'cell_3/')
    children = [*links.children, *(child for _, child, _ in links.fixed)]
    assert len(set(children)) == len(children) == 41
    assert links.parents[0] == WORLD
    assert all(name.startswith('cell_3/') for name in children)
    assert [child for _, child, _ in links.fixed] == ['cell_3/head']


def test_other_coordinates_are_refused(skeleton):
    links = LinkFrames(skeleton, '')
    with pytest.raises(PictureError, match=r'coordinate_names: 10 names, not the 40'):
        links.transforms(skeleton.coordinates[:10], np.zeros(10))
