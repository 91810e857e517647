# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where the markers sit on one person: offsets in the segments' frames, with weights."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from human_model.anthropometry import segment_lengths
from human_model.subject import Calibration, Subject
from human_model.typing import Array
from motion_tracker.core.exceptions import MarkerSetError
from motion_tracker.core.markers.marker_set import MarkerSet


@dataclass(frozen=True, eq=False)
class MarkerModel:
    """Markers of one person.

    Attributes
    ----------
    names, segments : tuple of str, n
    offsets : ndarray (n, 3)
        In the segment's anatomical frame [m].
    weights : ndarray (n,)
        Of the squared distance in the fit.
    """

    names: tuple[str, ...]
    segments: tuple[str, ...]
    offsets: Array
    weights: Array

    def __post_init__(self) -> None:
        """Check that the parts belong together."""
        n = len(self.names)
        if len(self.segments) != n or self.offsets.shape != (n, 3) or self.weights.shape != (n,):
            raise MarkerSetError(
                f'marker model: {n} names, {len(self.segments)} segments, '
                f'offsets {self.offsets.shape}, weights {self.weights.shape}'
            )

    def only(self, names: Sequence[str]) -> 'MarkerModel':
        """Model of those markers that are in ``names``, in this model's order."""
        keep = [i for i, name in enumerate(self.names) if name in set(names)]
        return MarkerModel(
            tuple(self.names[i] for i in keep),
            tuple(self.segments[i] for i in keep),
            self.offsets[keep],
            self.weights[keep],
        )


def from_anthropometry(marker_set: MarkerSet, subject: Subject) -> MarkerModel:
    """Marker model from a marker set alone, scaled with the subject's segment lengths.

    Only markers that have a position in the set and are used for tracking are in it.
    """
    placed = marker_set.positions(segment_lengths(subject)[0])
    markers = [m for m in marker_set.markers if m.tracking and m.name in placed]
    if not markers:
        raise MarkerSetError(
            f'marker set {marker_set.name}: no tracking marker has a position; '
            'a static trial is needed'
        )
    return MarkerModel(
        tuple(m.name for m in markers),
        tuple(m.segment for m in markers),
        np.array([placed[m.name] for m in markers]),
        np.array([m.weight for m in markers]),
    )


def from_calibration(calibration: Calibration, marker_set: MarkerSet | None) -> MarkerModel:
    """Marker model from a static trial's calibration; weights come from the marker set, else 1."""
    weight = {m.name: m.weight for m in marker_set.markers} if marker_set else {}
    return MarkerModel(
        calibration.marker_names,
        calibration.segments,
        np.array(calibration.local_offsets),
        np.array([weight.get(name, 1.0) for name in calibration.marker_names]),
    )


def model_for(subject: Subject, marker_set: MarkerSet | None) -> tuple[MarkerModel, str]:
    """Best marker model there is for a subject, and in words where it comes from.

    Raises
    ------
    MarkerSetError
        If the subject has no calibration and no marker set is given.
    """
    if subject.calibration is not None and subject.calibration.marker_names:
        rms = subject.calibration.residual_rms
        return (
            from_calibration(subject.calibration, marker_set),
            # A recording without a static trial carries its marker set scaled, with residual 0.
            f'static trial, {1000 * rms:.1f} mm rms' if rms > 0.0 else 'scaled by anthropometry',
        )
    if marker_set is None:
        raise MarkerSetError(
            f'subject {subject.pseudonym!r}: neither a calibration nor a marker set is given'
        )
    return from_anthropometry(marker_set, subject), f'{marker_set.name} scaled by anthropometry'
