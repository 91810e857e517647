# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Converts the muscles of a model as read into flat arrays for the compiled path functions."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from human_model.typing import Array, IntArray
from muscle_analyzer.core.exceptions import OsimFormatError
from muscle_analyzer.core.multibody.model import MultibodyModel
from muscle_analyzer.core.muscles.wrap_table import WrapTable, starts, wrap_table
from muscle_analyzer.core.osim.functions import FunctionTable, function_table
from muscle_analyzer.core.osim.model import PathPoint

#: Tolerance around the range of a conditional point (constant of OpenSim) [rad or m].
CONDITION_MARGIN = 1e-5


class SpanTable(NamedTuple):
    """Straight spans of the muscles whose path need not be found.

    Attributes
    ----------
    start : (n_m + 1,)
        Spans of muscle m are ``start[m]`` to ``start[m + 1] - 1``.
    point, entry : (n_s, 2), (n_s, 2)
        Points at the ends, on different bodies, and places of these bodies in
        `PathTable.body_index`.
    fixed_length : (n_m,)
        Length of a muscle's spans that stay on one body [m].
    """

    start: IntArray
    point: IntArray
    entry: IntArray
    fixed_length: Array


class ProductTable(NamedTuple):
    """Factors of the moment arms: wrenches on bodies times columns of the bodies' Jacobians.

    Attributes
    ----------
    column_body, column_coordinate : (n_j,)
        Columns of the Jacobians that are not zero whatever the posture, as far as used.
    motion_start, motion : (n_j + 1,), (n_l,)
        Elementary motions that make column c are ``motion[motion_start[c]]`` to
        ``motion[motion_start[c + 1] - 1]``, those nearer the ground first.
    start : (n_k + 1,)
        Products for place k of `PathTable.crossed_index` are ``start[k]`` to ``start[k + 1] - 1``.
    entry, column : (n_t,)
        Place of the body in `PathTable.body_index`, and number of the column.
    """

    column_body: IntArray
    column_coordinate: IntArray
    motion_start: IntArray
    motion: IntArray
    start: IntArray
    entry: IntArray
    column: IntArray


class PathTable(NamedTuple):
    """Paths of all muscles of one model.

    Attributes
    ----------
    point_start : (n_m + 1,)
        Points of muscle m are ``point_start[m]`` to ``point_start[m + 1] - 1``; likewise the
        other ``*_start``.
    point_body, point_location : (n_p,), (n_p, 3)
        Body and place in it [m]; of a moving point where its coordinates are zero.
    point_condition, point_motion : (n_p,)
        Number of a point's condition and of its motion, or -1.
    condition_coordinate, condition_range : (n_c,), (n_c, 2)
        Tree coordinate, and the values between which a conditional point is there [rad or m].
    motion_coordinate, motion_independent, motion_function : (n_d, 3)
        Tree coordinates that move a point along x, y and z of its body, the independent ones
        behind them (-1 if locked), and the numbers of the functions.
    functions : FunctionTable
    wraps : WrapTable
    routed : (n_r,)
        Muscles whose path has to be found: those that may wrap, and those with points that are
        conditional or moving. All others are straight from point to point.
    spans : SpanTable
        Of the other muscles.
    body_start, body_index : (n_m + 1,), (n_e,)
        Bodies that a muscle acts on.
    crossed_start, crossed_index : (n_m + 1,), (n_k,)
        Independent coordinates that can change a muscle's length.
    products : ProductTable
    longest : (1,)
        Most points that a path can have, wrap points counted.
    """

    point_start: IntArray
    point_body: IntArray
    point_location: Array
    point_condition: IntArray
    point_motion: IntArray
    condition_coordinate: IntArray
    condition_range: Array
    motion_coordinate: IntArray
    motion_independent: IntArray
    motion_function: IntArray
    functions: FunctionTable
    wraps: WrapTable
    routed: IntArray
    spans: SpanTable
    body_start: IntArray
    body_index: IntArray
    crossed_start: IntArray
    crossed_index: IntArray
    products: ProductTable
    longest: IntArray


def path_table(multibody: MultibodyModel, geodesic: bool = False) -> PathTable:
    """Build the table of a compiled model's muscles.

    Parameters
    ----------
    multibody
        The compiled model.
    geodesic
        Whether to use geodesics on single cylinders rather than OpenSim's construction.

    Raises
    ------
    OsimFormatError
        For a path point that depends on a coordinate that does not exist.
    UnsupportedElementError
        For a wrap object, quadrant or method that is not modelled; names it.
    """
    model = multibody.source
    uses = [
        (m, muscle.wraps[number])
        for m, muscle in enumerate(model.muscles)
        for number in range(len(muscle.wraps))
        if model.wrap_object(muscle.wraps[number].wrap_object).active
    ]
    points = [point for muscle in model.muscles for point in muscle.points]
    conditions = [point for point in points if point.kind == 'conditional']
    motions = [point for point in points if point.kind == 'moving']
    point_body = np.array([multibody.body_index(point.body) for point in points], np.int64)
    point_location = np.array([point.location for point in points]).reshape(-1, 3)
    point_start = starts([len(muscle.points) for muscle in model.muscles])
    wraps = wrap_table(model, multibody, uses, geodesic)
    wrap_body = wraps.body[wraps.surface]
    bodies = [
        sorted({*point_body[p0:p1].tolist(), *wrap_body[w0:w1].tolist()})
        for (p0, p1), (w0, w1) in zip(pairwise(point_start), pairwise(wraps.start), strict=True)
    ]
    driven = _driven_motions(multibody)
    moved_by = np.array(
        [[_coordinate(multibody, p, name) for name in p.location_coordinates] for p in motions],
        np.int64,
    ).reshape(-1, 3)
    independent = multibody.tree.independent[moved_by]
    point_motion = _numbers_of('moving', points)
    crossed = []
    for (begin, end), body in zip(pairwise(point_start), bodies, strict=True):
        moving = [number for number in point_motion[begin:end] if number >= 0]
        by_motion = {int(q) for q in independent[moving].ravel() if q >= 0}
        crossed.append(sorted({*_crossed(driven, body), *by_motion}))
    special = np.array([point.kind != 'fixed' for point in points], np.bool_)
    routed = [
        bool(w1 > w0 or special[p0:p1].any())
        for (p0, p1), (w0, w1) in zip(pairwise(point_start), pairwise(wraps.start), strict=True)
    ]
    longest = (np.diff(point_start) + 2 * np.diff(wraps.start)).max(initial=0)
    return PathTable(
        point_start=point_start,
        point_body=point_body,
        point_location=point_location,
        point_condition=_numbers_of('conditional', points),
        point_motion=point_motion,
        condition_coordinate=np.array(
            [_coordinate(multibody, p, p.coordinate) for p in conditions], np.int64
        ),
        condition_range=np.array([p.range for p in conditions]).reshape(-1, 2)
        + [-CONDITION_MARGIN, CONDITION_MARGIN],
        motion_coordinate=moved_by,
        motion_independent=independent,
        motion_function=np.arange(3 * len(motions), dtype=np.int64).reshape(-1, 3),
        functions=function_table([f for p in motions for f in p.location_functions]),
        wraps=wraps,
        routed=np.flatnonzero(routed).astype(np.int64),
        spans=_spans(point_start, point_body, point_location, bodies, routed),
        body_start=starts([len(body) for body in bodies]),
        body_index=np.array([b for body in bodies for b in body], np.int64),
        crossed_start=starts([len(cross) for cross in crossed]),
        crossed_index=np.array([c for cross in crossed for c in cross], np.int64),
        products=_products(driven, bodies, crossed),
        longest=np.array([longest], np.int64),
    )


def _spans(
    point_start: IntArray,
    point_body: IntArray,
    point_location: Array,
    bodies: list[list[int]],
    routed: list[bool],
) -> SpanTable:
    """Return the straight spans of the muscles that are not routed."""
    counts: list[int] = []
    spans: list[tuple[int, int]] = []
    entries: list[list[int]] = []
    fixed_length = np.zeros(len(bodies))
    body_start = starts([len(body) for body in bodies])
    for m, (begin, end) in enumerate(pairwise(point_start.tolist())):
        before = len(spans)
        for p in () if routed[m] else range(begin, end - 1):
            ends = int(point_body[p]), int(point_body[p + 1])
            if ends[0] == ends[1]:
                way = point_location[p + 1] - point_location[p]
                fixed_length[m] += float(np.linalg.norm(way))
            else:
                spans.append((p, p + 1))
                entries.append([int(body_start[m]) + bodies[m].index(body) for body in ends])
        counts.append(len(spans) - before)
    return SpanTable(
        start=starts(counts),
        point=np.array(spans, np.int64).reshape(-1, 2),
        entry=np.array(entries, np.int64).reshape(-1, 2),
        fixed_length=fixed_length,
    )


def _products(
    driven: list[list[set[int]]], bodies: list[list[int]], crossed: list[list[int]]
) -> ProductTable:
    """Return the products of wrenches and columns of Jacobians that make the moment arms."""
    columns: dict[tuple[int, int], int] = {}
    counts, entries, of_columns = [], [], []
    body_start = starts([len(body) for body in bodies])
    for m, coordinates in enumerate(crossed):
        for q in coordinates:
            moved = [k for k, body in enumerate(bodies[m]) if driven[body][q]]
            counts.append(len(moved))
            for k in moved:
                entries.append(int(body_start[m]) + k)
                of_columns.append(columns.setdefault((bodies[m][k], q), len(columns)))
    motions = [sorted(driven[body][q]) for body, q in columns]
    pairs = np.array(list(columns), np.int64).reshape(-1, 2)
    return ProductTable(
        column_body=np.ascontiguousarray(pairs[:, 0]),
        column_coordinate=np.ascontiguousarray(pairs[:, 1]),
        motion_start=starts([len(own) for own in motions]),
        motion=np.array([e for own in motions for e in own], np.int64),
        start=starts(counts),
        entry=np.array(entries, np.int64),
        column=np.array(of_columns, np.int64),
    )


def _numbers_of(kind: str, points: list[PathPoint]) -> IntArray:
    """Count the points of one kind, -1 for the others."""
    is_kind = np.array([point.kind == kind for point in points], dtype=np.bool_)
    return np.where(is_kind, np.cumsum(is_kind) - 1, -1).astype(np.int64)


def _coordinate(multibody: MultibodyModel, point: PathPoint, name: str | None) -> int:
    """Return the index of a coordinate that a path point depends on among all of the tree."""
    names = multibody.tree_coordinate_names
    if name not in names:
        raise OsimFormatError(
            f'{multibody.source.source}: path point {point.name}: no coordinate {name!r}'
        )
    return names.index(name)


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
    """Return the coordinates that move the bodies of one muscle against each other."""
    first = driven[bodies[0]]
    return [
        q for q in range(len(first)) if any(driven[body][q] != first[q] for body in bodies[1:])
    ]
