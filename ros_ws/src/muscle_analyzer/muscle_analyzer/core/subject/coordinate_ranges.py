# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ranges of motion that people have and the musculoskeletal model lacks.

Hands that hang beside the body are pronated further than the lifting full-body model lets its
forearm turn. At that limit the transfer has to choose between the hand's place and its direction.
`data/coordinate_ranges.csv` has published ranges that replace those of the model.
"""

from __future__ import annotations

import csv
from dataclasses import replace
from importlib.resources import files
from importlib.resources.abc import Traversable

from muscle_analyzer.core.exceptions import OptionError
from muscle_analyzer.core.osim.model import Coordinate, OsimModel


def with_published_ranges(model: OsimModel, path: Traversable | None = None) -> OsimModel:
    """Return the model with the ranges of a table in place of its own, rad.

    Parameters
    ----------
    model : OsimModel
        Coordinates that it has not are passed over: another model may have other arms.
    path : path, optional
        CSV file with the columns ``coordinate, lower, upper, source``; by default the table of
        this package.

    Raises
    ------
    OptionError
        If a value is not a number or a range is empty; names file, row and value.
    """
    path = path or files('muscle_analyzer') / 'data' / 'coordinate_ranges.csv'
    ranges = {}
    for row in csv.DictReader(path.read_text(encoding='utf-8').splitlines()):
        try:
            lower, upper = float(row['lower']), float(row['upper'])
        except ValueError as error:
            raise OptionError(f'{path}: {row["coordinate"]}: {error}') from None
        if not lower < upper:
            raise OptionError(f'{path}: {row["coordinate"]}: no range from {lower} to {upper}')
        ranges[row['coordinate']] = (lower, upper)

    def changed(coordinate: Coordinate) -> Coordinate:
        return replace(coordinate, range=ranges.get(coordinate.name, coordinate.range))

    joints = (
        replace(joint, coordinates=tuple(changed(c) for c in joint.coordinates))
        for joint in model.joints
    )
    return replace(model, joints=tuple(joints))
