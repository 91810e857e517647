# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Turns the muscles of a model as read into the flat arrays of the compiled path functions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from muscle_analyzer.core.exceptions import UnsupportedElementError
from muscle_analyzer.core.multibody import MultibodyModel
from muscle_analyzer.core.osim_model import Muscle, OsimModel

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Kinds of wrap object the path functions know.
CYLINDER, ELLIPSOID = 0, 1
_KINDS = {'cylinder': CYLINDER, 'ellipsoid': ELLIPSOID}
#: Active halves of a wrap object: coordinate and sign; sign 0 is the whole surface.
_HALVES = {
    'all': (0, 0),
    'x': (0, 1),
    '-x': (0, -1),
    'y': (1, 1),
    '-y': (1, -1),
    'z': (2, 1),
    '-z': (2, -1),
}


class PathTable(NamedTuple):
    """
    Paths of all muscles of one model.

    Attributes
    ----------
    point_start : (n_m + 1,)
        Points of muscle m are ``point_start[m]`` to ``point_start[m + 1] - 1``; likewise the
        other ``*_start``.
    point_body, point_location : (n_p,), (n_p, 3)
        Body and place in it [m].
    wrap_start : (n_m + 1,)
    wrap_kind, wrap_body : (n_w,)
    wrap_rotation, wrap_translation : (n_w, 3, 3), (n_w, 3)
        Body from wrap object's frame [m].
    wrap_dimensions : (n_w, 3)
        Cylinder: radius, length; ellipsoid: half axes [m].
    wrap_axis, wrap_sign : (n_w,)
        Active half.
    wrap_first, wrap_last : (n_w,)
        First and last point between which the path may wrap.
    body_start, body_index : (n_m + 1,), (n_e,)
        Bodies that a muscle acts on.
    crossed_start, crossed_index : (n_m + 1,), (n_k,)
        Independent coordinates that can change a muscle's length.
    longest : (1,)
        Most points that a path can have, wrap points counted.
    geodesic : (1,)
        Whether a path over a single cylinder is its geodesic or OpenSim's construction
        (see `wrapping`); over more than one it always is the geodesic.
    """

    point_start: IntArray
    point_body: IntArray
    point_location: Array
    wrap_start: IntArray
    wrap_kind: IntArray
    wrap_body: IntArray
    wrap_rotation: Array
    wrap_translation: Array
    wrap_dimensions: Array
    wrap_axis: IntArray
    wrap_sign: IntArray
    wrap_first: IntArray
    wrap_last: IntArray
    body_start: IntArray
    body_index: IntArray
    crossed_start: IntArray
    crossed_index: IntArray
    longest: IntArray
    geodesic: NDArray[np.bool_]


def path_table(multibody: MultibodyModel, geodesic: bool = False) -> PathTable:
    """
    Build the table of a compiled model's muscles.

    Parameters
    ----------
    multibody
        The compiled model.
    geodesic
        Whether to use geodesics on single cylinders rather than OpenSim's construction.

    Raises
    ------
    UnsupportedElementError
        For a path point that moves in its body, or a wrap object or method that is not modelled;
        names it.
    """
    model = multibody.source
    wraps = [
        _wrap_row(model, multibody, muscle, number)
        for muscle in model.muscles
        for number in range(len(muscle.wraps))
        if model.wrap_object(muscle.wraps[number].wrap_object).active
    ]
    owners = [row[0] for row in wraps]
    points = [point for muscle in model.muscles for point in muscle.points]
    for muscle in model.muscles:
        for point in muscle.points:
            if point.kind != 'fixed':
                raise UnsupportedElementError(
                    f'{model.source}: muscle {muscle.name}: path point {point.name} is '
                    f'{point.kind}; only fixed path points are modelled'
                )
    point_body = [multibody.body_index(point.body) for point in points]
    point_start = _starts([len(muscle.points) for muscle in model.muscles])
    wrap_start = _starts([owners.count(muscle.name) for muscle in model.muscles])
    wrap_body = [row[2] for row in wraps]
    bodies = [
        sorted({*point_body[p0:p1], *wrap_body[w0:w1]})
        for p0, p1, w0, w1 in zip(
            point_start[:-1], point_start[1:], wrap_start[:-1], wrap_start[1:], strict=True
        )
    ]
    driven = _driven_motions(multibody)
    crossed = [_crossed(driven, body) for body in bodies]
    longest = (np.diff(point_start) + 2 * np.diff(wrap_start)).max(initial=0)
    n_w = len(wraps)
    return PathTable(
        point_start=point_start,
        point_body=np.array(point_body, np.int64),
        point_location=np.array([point.location for point in points]).reshape(-1, 3),
        wrap_start=wrap_start,
        wrap_kind=np.array([row[1] for row in wraps], np.int64),
        wrap_body=np.array(wrap_body, np.int64),
        wrap_rotation=np.array([row[3] for row in wraps]).reshape(n_w, 3, 3),
        wrap_translation=np.array([row[4] for row in wraps]).reshape(n_w, 3),
        wrap_dimensions=np.array([row[5] for row in wraps]).reshape(n_w, 3),
        wrap_axis=np.array([row[6][0] for row in wraps], np.int64),
        wrap_sign=np.array([row[6][1] for row in wraps], np.int64),
        wrap_first=np.array([row[7] for row in wraps], np.int64),
        wrap_last=np.array([row[8] for row in wraps], np.int64),
        body_start=_starts([len(body) for body in bodies]),
        body_index=np.array([b for body in bodies for b in body], np.int64),
        crossed_start=_starts([len(cross) for cross in crossed]),
        crossed_index=np.array([c for cross in crossed for c in cross], np.int64),
        longest=np.array([longest], np.int64),
        geodesic=np.array([geodesic]),
    )


def _starts(counts: list[int]) -> IntArray:
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]).astype(np.int64)


def _wrap_row(
    model: OsimModel, multibody: MultibodyModel, muscle: Muscle, number: int
) -> tuple[str, int, int, Array, Array, Array, tuple[int, int], int, int]:
    """Give one use of a wrap object as a row of the table, after its muscle's name."""
    use = muscle.wraps[number]
    surface = model.wrap_object(use.wrap_object)
    where = f'{model.source}: muscle {muscle.name}: wrap object {surface.name}'
    if surface.kind not in _KINDS:
        raise UnsupportedElementError(f'{where}: kind {surface.kind} is not modelled')
    if surface.quadrant not in _HALVES:
        raise UnsupportedElementError(f'{where}: quadrant {surface.quadrant} is not modelled')
    if surface.kind == 'ellipsoid' and use.method != 'hybrid':
        raise UnsupportedElementError(f'{where}: method {use.method} is not modelled')
    dimensions = np.zeros(3)
    dimensions[: len(surface.dimensions)] = surface.dimensions
    first, last = use.range
    return (
        muscle.name,
        _KINDS[surface.kind],
        multibody.body_index(surface.frame.body),
        surface.frame.rotation,
        surface.frame.translation,
        dimensions,
        _HALVES[surface.quadrant],
        first - 1 if first >= 1 else 0,
        last - 1 if last >= 1 else len(muscle.points) - 1,
    )


def _driven_motions(multibody: MultibodyModel) -> list[list[set[int]]]:
    """Give, for each body and independent coordinate, the elementary motions that move it."""
    tree = multibody.tree
    n_q = len(multibody.coordinate_names)
    driven: list[list[set[int]]] = []
    for body, parent in enumerate(tree.parent):
        sets = [set(driven[parent][q]) if parent >= 0 else set() for q in range(n_q)]
        for motion in range(tree.first_motion[body], tree.first_motion[body + 1]):
            coordinate = tree.motion_coordinate[motion]
            if coordinate >= 0 and tree.independent[coordinate] >= 0:
                sets[tree.independent[coordinate]].add(motion)
        driven.append(sets)
    return driven


def _crossed(driven: list[list[set[int]]], bodies: list[int]) -> list[int]:
    """Give the coordinates that move the bodies of one muscle against each other."""
    first = driven[bodies[0]]
    return [
        q for q in range(len(first)) if any(driven[body][q] != first[q] for body in bodies[1:])
    ]
