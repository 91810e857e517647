# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A person, a motion and a visualizer that the tests of the package share."""

import numpy as np
import pytest

from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from lifting_visualization.core.drawing import SpineScale
from lifting_visualization.core.visualizer import Options, Visualizer

SCALE = SpineScale(3400.0, 6400.0, 1e-4)


@pytest.fixture(scope='session')
def woman():
    """Return a person."""
    return Subject('S04', 'female', 62.6, 1.68, 31.0)


@pytest.fixture(scope='session')
def skeleton(woman):
    """Return her skeleton."""
    return Skeleton3D.of(woman)


@pytest.fixture
def motion_at(skeleton):
    """Return a function: one sample of standing on the right foot at a stamp [s]."""

    def make(stamp, **forces):
        q = skeleton.standing()
        loaded = {
            'ground_force': [[[0.0, 0.0, 600.0], [0.0, 0.0, 0.0]]],
            'centre_of_pressure': [[[0.05, -0.1, 0.0], [np.nan] * 3]],
        }
        return skeleton.body_motion(stamp, q, 0.0 * q, 0.0 * q, **(loaded | forces))

    return make


@pytest.fixture
def visualizer(woman):
    """Return a visualizer at 50 Hz that knows the person."""
    made = Visualizer(
        Options(
            rate=50.0, force_length=1e-3, compression=SCALE, fresh=0.2, pause=0.5, prefix='cell_3/'
        )
    )
    assert made.set_subject(woman)
    return made
