# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ranges of motion that people have and the musculoskeletal model lacks.

Hands that hang beside the body are pronated further than the lifting full-body model lets its
forearm turn. At that limit the transfer has to choose between the hand's place and its direction.
`data/coordinate_ranges.csv` has published ranges that replace those of the model.
"""

from __future__ import annotations

from dataclasses import replace

from human_model.tables import read_table
from muscle_analyzer.core.osim.model import Coordinate, OsimModel


def with_published_ranges(model: OsimModel) -> OsimModel:
    """Return the model with the published ranges in place of its own, rad.

    Coordinates that the model lacks are ignored: another model may have other arms.
    """
    ranges = {}
    for row in read_table('muscle_analyzer', 'coordinate_ranges.csv', 'coordinate lower upper'):
        lower, upper = row.number('lower'), row.number('upper')
        if not lower < upper:
            raise row.error('upper', f'a number above {lower:g} is needed')
        ranges[row['coordinate']] = (lower, upper)

    def changed(coordinate: Coordinate) -> Coordinate:
        return replace(coordinate, range=ranges.get(coordinate.name, coordinate.range))

    joints = (
        replace(joint, coordinates=tuple(changed(c) for c in joint.coordinates))
        for joint in model.joints
    )
    return replace(model, joints=tuple(joints))
