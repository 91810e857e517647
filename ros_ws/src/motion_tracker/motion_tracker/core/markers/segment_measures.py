# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Segment lengths that two landmarks of one segment measure (``data/segment_measures.csv``)."""

from collections.abc import Mapping

import numpy as np

from human_model.tables import read_table
from human_model.typing import Array
from motion_tracker.core.markers.marker_set import MarkerSet


def measured_lengths(
    marker_set: MarkerSet, markers: Mapping[str, Array], predicted: Mapping[str, float]
) -> dict[str, float]:
    """Lengths [m] from pairs of landmarks, as far as all of their markers are there.

    A length is the predicted one times the ratio of the landmarks' mean distance to that of their
    places in the marker set: markers stand on the skin, and how far off is the set's matter.

    Parameters
    ----------
    marker_set
        Set the markers belong to.
    markers
        Mean positions (3,) in the static trial, world [m].
    predicted
        Segment lengths of the person from anthropometry [m].
    """
    placed = marker_set.positions(predicted)
    found = {}
    for row in read_table('motion_tracker', 'segment_measures.csv', 'marker_set length pairs'):
        names = row['pairs'].split()
        if row['marker_set'] != marker_set.name or not all(n in markers for n in names):
            continue
        pairs = list(zip(names[::2], names[1::2], strict=True))
        seen, expected = (
            np.mean([np.linalg.norm(at[a] - at[b]) for a, b in pairs]) for at in (markers, placed)
        )
        found[row['length']] = float(predicted[row['length']] * seen / expected)
    return found
