# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The skeleton as flat arrays for compiled code: one body a coordinate, massless or not.

`TreeArrays` is a named tuple of plain arrays, so numba takes it as an argument. In the neutral
posture every body's axes are parallel to the world's (REP-103); body ``j`` moves with coordinate
``j`` and has its origin on that joint:

    R_j = R_parent exp(axis_j q_j),       p_j = p_parent + R_parent offset_j          (revolute)
    R_j = R_parent,                       p_j = p_parent + R_parent (offset_j + axis_j q_j)
                                                                                     (prismatic)

with ``R = I, p = 0`` for parent -1 (world). A segment's anatomical frame is
``R_segment = R_b``, ``p_segment = p_b + R_b segment_offset`` with ``b = segment_body``.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from human_model.anthropometry import SegmentParameters
from human_model.dh import Chain
from human_model.exceptions import ChainError
from human_model.typing import Array, BoolArray, IntArray

REVOLUTE = 0
PRISMATIC = 1


class TreeArrays(NamedTuple):
    """Flat arrays of a skeleton of n_q coordinates and n_s segments.

    Attributes
    ----------
    parent : int64 (n_q,)
        Parent body, -1 for the world; parents come before children.
    kind : int64 (n_q,)
        0 revolute, 1 prismatic.
    axis : float64 (n_q, 3)
        Unit axis in the parent body's axes, sign included.
    offset : float64 (n_q, 3)
        Joint position in the parent body [m].
    segment_body : int64 (n_s,)
        Body each segment is fixed to.
    segment_offset : float64 (n_s, 3)
        Segment origin (proximal joint) in its body [m].
    mass : float64 (n_s,)
        kg.
    com : float64 (n_s, 3)
        Centre of mass in the segment frame [m].
    inertia : float64 (n_s, 3, 3)
        About the centre of mass, segment axes [kg m^2].
    moves : bool (n_q, n_q)
        ``moves[b, j]``: coordinate j moves body b.
    """

    parent: IntArray
    kind: IntArray
    axis: Array
    offset: Array
    segment_body: IntArray
    segment_offset: Array
    mass: Array
    com: Array
    inertia: Array
    moves: BoolArray


def row_segments(chain: Chain) -> tuple[dict[str, int], dict[str, Array]]:
    """Row each segment is fixed to, and the neutral world position of its proximal joint [m].

    The axis of a row passes through the origin of the row's parent, so that is where the joint
    is; a segment on a fixed row (the head) has its origin in that row's own frame.
    """
    neutral = chain.frames(np.zeros(len(chain.coordinates)))
    rows: dict[str, int] = {}
    origins: dict[str, Array] = {}
    for i, row in enumerate(chain.rows):
        if row.segment:
            rows[row.segment] = i
            origins[row.segment] = neutral[i if row.kind == 'fixed' else row.parent, :3, 3]
    return rows, origins


def build_tree(chain: Chain, parameters: SegmentParameters) -> TreeArrays:
    """Flatten a chain and the inertia of its segments.

    The order of segments is that of the parameters.

    Raises
    ------
    ChainError
        If the chain's segments and the parameters' differ.
    """
    if set(chain.segments) != set(parameters.segments):
        raise ChainError(
            f'{chain.name}: segments {sorted(set(chain.segments))} of the chain and '
            f'{sorted(set(parameters.segments))} of the parameters differ'
        )
    neutral = chain.frames(np.zeros(len(chain.coordinates)))
    body_of_row: dict[int, int] = {-1: -1}
    parent: list[int] = []
    kind: list[int] = []
    axis: list[Array] = []
    position: list[Array] = []
    for i, row in enumerate(chain.rows):
        if row.kind == 'fixed':
            body_of_row[i] = body_of_row[row.parent]
            continue
        body_of_row[i] = len(parent)
        before = np.eye(4) if row.parent < 0 else neutral[row.parent]
        parent.append(body_of_row[row.parent])
        kind.append(PRISMATIC if row.kind == 'prismatic' else REVOLUTE)
        axis.append(row.sign * before[:3, 2])
        position.append(before[:3, 3])
    n = len(parent)
    offset = [
        position[j] - (position[parent[j]] if parent[j] >= 0 else np.zeros(3)) for j in range(n)
    ]
    moves = np.zeros((n, n), dtype=np.bool_)
    for j in range(n):
        if parent[j] >= 0:
            moves[j] = moves[parent[j]]
        moves[j, j] = True
    rows, origins = row_segments(chain)
    bodies = [body_of_row[rows[name]] for name in parameters.segments]
    return TreeArrays(
        parent=np.array(parent, dtype=np.int64),
        kind=np.array(kind, dtype=np.int64),
        axis=_clean(axis),
        offset=_clean(offset),
        segment_body=np.array(bodies, dtype=np.int64),
        segment_offset=_clean(
            [
                origins[name] - position[body]
                for name, body in zip(parameters.segments, bodies, strict=True)
            ]
        ),
        mass=np.array(parameters.mass),
        com=np.array(parameters.com),
        inertia=np.array(parameters.inertia),
        moves=moves,
    )


def segment_points(
    points: Mapping[str, tuple[str, Array]], segments: tuple[str, ...]
) -> tuple[IntArray, Array]:
    """Segment index (n,) and local position (n, 3) [m] of named points."""
    index = np.array([segments.index(segment) for segment, _ in points.values()], dtype=np.int64)
    local = np.array([position for _, position in points.values()], dtype=np.float64)
    return index, local.reshape(-1, 3)


def _clean(rows: list[Array]) -> Array:
    """Array with the rounding dust of quarter turns (below 1e-15) removed."""
    array = np.array(rows, dtype=np.float64)
    array[np.abs(array) < 1e-15] = 0.0
    return np.ascontiguousarray(array)
