# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of axes and rotation forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from human_model import compiled_blocks, frames
from human_model.exceptions import HumanModelError

components = st.floats(-1e3, 1e3)
vectors = st.tuples(components, components, components).map(np.array)
quaternions = (
    st.tuples(*[st.floats(-1, 1)] * 4).map(np.array).filter(lambda q: np.linalg.norm(q) > 0.1)
)


def test_axes_of_opensim_in_rep_103():
    assert frames.from_opensim([1, 0, 0]) == pytest.approx([1, 0, 0])  # forward
    assert frames.from_opensim([0, 1, 0]) == pytest.approx([0, 0, 1])  # up
    assert frames.from_opensim([0, 0, 1]) == pytest.approx([0, -1, 0])  # right


@given(vectors)
def test_vectors_there_and_back(vector):
    assert frames.to_opensim(frames.from_opensim(vector)) == pytest.approx(vector)


@given(quaternions)
def test_quaternion_there_and_back(quaternion):
    unit = quaternion / np.linalg.norm(quaternion)
    matrix = frames.matrix_from_quaternion(quaternion)
    assert matrix @ matrix.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(matrix) == pytest.approx(1.0)
    back = frames.quaternion_from_matrix(matrix)
    assert back[3] >= 0
    assert abs(back @ unit) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize('axis', range(3))
def test_half_turns_lose_no_digits(axis):
    quaternion = np.zeros(4)
    quaternion[axis] = 1.0
    back = frames.quaternion_from_matrix(frames.matrix_from_quaternion(quaternion))
    assert np.abs(back) == pytest.approx(np.abs(quaternion), abs=1e-15)


def test_quarter_turn_about_up_takes_forward_to_left():
    matrix = frames.matrix_from_quaternion([0, 0, np.sqrt(0.5), np.sqrt(0.5)])
    assert matrix @ [1, 0, 0] == pytest.approx([0, 1, 0])


def test_stacks_keep_their_shape(rng):
    quaternion = rng.normal(size=(4, 5, 4))
    matrix = frames.matrix_from_quaternion(quaternion)
    assert matrix.shape == (4, 5, 3, 3)
    assert frames.quaternion_from_matrix(matrix).shape == (4, 5, 4)


@pytest.mark.parametrize(
    ('function', 'value'),
    [
        (frames.from_opensim, [1, 2]),
        (frames.to_opensim, 3.0),
        (frames.matrix_from_quaternion, [0, 0, 0, 0]),
        (frames.matrix_from_quaternion, [0, 0, 1]),
        (frames.quaternion_from_matrix, np.zeros(3)),
    ],
)
def test_wrong_shapes_are_refused(function, value):
    with pytest.raises(HumanModelError, match=r'shape|length'):
        function(value)


def test_compiled_quaternions_are_those_of_the_plain_function():
    """Any rotation, half turns about the axes among them."""
    rng = np.random.default_rng(3)
    q = rng.normal(size=(200, 4))
    half_turns = np.vstack([np.eye(4), [[1.0, 1.0, 0.0, 0.0], [0.0, 1.0, 1.0, 1e-9]]])
    rotation = frames.matrix_from_quaternion(np.vstack([q, half_turns]))
    compiled = compiled_blocks.quaternions(rotation)
    np.testing.assert_allclose(compiled, frames.quaternion_from_matrix(rotation), atol=1e-12)
