# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subjects and skeletons the human model's tests share."""

import hypothesis
import numpy as np
import pytest

from human_model.skeleton import Skeleton
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.subject import Subject

# The machine that runs the suite may be busy: examples are fixed and have no deadline.
hypothesis.settings.register_profile('human_model', deadline=None, derandomize=True)
hypothesis.settings.load_profile('human_model')


@pytest.fixture(scope='session')
def man() -> Subject:
    """Return the thesis' subject of chapter IV."""
    return Subject('man', 'male', 63.5, 1.69, 31.0)


@pytest.fixture(scope='session')
def woman() -> Subject:
    """Return a woman near the median of ANSUR II."""
    return Subject('woman', 'female', 66.8, 1.626, 24.0)


@pytest.fixture(scope='session', params=['3d_40dof', '2d_10dof'])
def skeleton(request: pytest.FixtureRequest, man: Subject) -> Skeleton:
    """Return each skeleton of the man in turn."""
    return Skeleton3D.of(man) if request.param == '3d_40dof' else Skeleton2D.of(man)


@pytest.fixture(scope='session')
def body(man: Subject) -> Skeleton3D:
    """Return the man's 3D skeleton."""
    return Skeleton3D.of(man)


@pytest.fixture
def rng() -> np.random.Generator:
    """Return a generator with a fixed seed."""
    return np.random.default_rng(20260101)
