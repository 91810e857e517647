# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Turns the wrap objects of a model as read into the flat arrays of the compiled functions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array, IntArray
from muscle_analyzer.core.exceptions import UnsupportedElementError
from muscle_analyzer.core.multibody.model import MultibodyModel
from muscle_analyzer.core.muscles.ellipsoid_wrapping import HYBRID, MIDPOINT
from muscle_analyzer.core.osim.model import OsimModel, PathWrap

#: Kinds of wrap object of the path functions.
CYLINDER, ELLIPSOID, SPHERE, TORUS = 0, 1, 2, 3
_KINDS = {'cylinder': CYLINDER, 'ellipsoid': ELLIPSOID, 'sphere': SPHERE, 'torus': TORUS}
_METHODS = {'hybrid': HYBRID, 'midpoint': MIDPOINT}
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


class WrapTable(NamedTuple):
    """Wrap objects that muscles of one model use, and these uses.

    Attributes
    ----------
    kind, body : (n_o,)
    rotation, translation : (n_o, 3, 3), (n_o, 3)
        Body from wrap object's frame [m].
    dimensions : (n_o, 3)
        Cylinder: radius, length; ellipsoid: half axes; sphere: radius; torus: radius of the tube
        and of its centre line [m].
    axis, sign : (n_o,)
        Active half.
    start : (n_m + 1,)
        Uses of muscle m are ``start[m]`` to ``start[m + 1] - 1``.
    surface : (n_w,)
        Number of the wrap object.
    method : (n_w,)
        How an ellipsoid's guide is chosen.
    first, last : (n_w,)
        First and last point between which the path may wrap.
    geodesic : (1,)
        Whether a path over a single cylinder is its geodesic or OpenSim's construction
        (see `cylinder_wrapping`); over more than one it always is the geodesic.
    """

    kind: IntArray
    body: IntArray
    rotation: Array
    translation: Array
    dimensions: Array
    axis: IntArray
    sign: IntArray
    start: IntArray
    surface: IntArray
    method: IntArray
    first: IntArray
    last: IntArray
    geodesic: NDArray[np.bool_]


def starts(counts: list[int]) -> IntArray:
    """Return where each of several runs begins in one array of all, and where the last ends."""
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]).astype(np.int64)


def wrap_table(
    model: OsimModel, multibody: MultibodyModel, uses: list[tuple[int, PathWrap]], geodesic: bool
) -> WrapTable:
    """Collect the wrap objects that muscles use.

    Parameters
    ----------
    uses
        Number of the muscle and its use of an object, in the order of the muscles.
    geodesic
        See `WrapTable`.

    Raises
    ------
    UnsupportedElementError
        For a wrap object, quadrant or method that is not modelled; names it.
    """
    objects: dict[str, int] = {}
    methods, ranges = [], []
    for m, use in uses:
        muscle = model.muscles[m]
        surface = model.wrap_object(use.wrap_object)
        objects.setdefault(surface.name, len(objects))
        where = f'{model.source}: muscle {muscle.name}: wrap object {surface.name}'
        if surface.kind not in _KINDS:
            raise UnsupportedElementError(f'{where}: kind {surface.kind} is not modelled')
        if surface.quadrant not in _HALVES:
            raise UnsupportedElementError(f'{where}: quadrant {surface.quadrant} is not modelled')
        # Only ellipsoids heed the method.
        method = use.method if surface.kind == 'ellipsoid' else 'hybrid'
        if method not in _METHODS or (method == 'midpoint' and surface.quadrant != 'all'):
            raise UnsupportedElementError(
                f'{where}: method {method} on quadrant {surface.quadrant} is not modelled'
            )
        methods.append(_METHODS[method])
        first, last = use.range
        ranges.append(
            (first - 1 if first >= 1 else 0, last - 1 if last >= 1 else len(muscle.points) - 1)
        )
    surfaces = [model.wrap_object(name) for name in objects]
    n_o = len(surfaces)
    dimensions = np.zeros((n_o, 3))
    for k, surface in enumerate(surfaces):
        dimensions[k, : len(surface.dimensions)] = surface.dimensions
    halves = np.array([_HALVES[surface.quadrant] for surface in surfaces], np.int64).reshape(-1, 2)
    limits = np.array(ranges, np.int64).reshape(-1, 2)
    owners = [m for m, _ in uses]
    return WrapTable(
        kind=np.array([_KINDS[surface.kind] for surface in surfaces], np.int64),
        body=np.array([multibody.body_index(s.frame.body) for s in surfaces], np.int64),
        rotation=np.array([s.frame.rotation for s in surfaces]).reshape(n_o, 3, 3),
        translation=np.array([s.frame.translation for s in surfaces]).reshape(n_o, 3),
        dimensions=dimensions,
        axis=np.ascontiguousarray(halves[:, 0]),
        sign=np.ascontiguousarray(halves[:, 1]),
        start=starts([owners.count(m) for m in range(len(model.muscles))]),
        surface=np.array([objects[use.wrap_object] for _, use in uses], np.int64),
        method=np.array(methods, np.int64),
        first=np.ascontiguousarray(limits[:, 0]),
        last=np.ascontiguousarray(limits[:, 1]),
        geodesic=np.array([geodesic]),
    )
