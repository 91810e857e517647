# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A tracker from parameter values, the same for the node and for runs without ROS."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy.typing as npt

from human_model.constants import SIDES
from human_model.subject import Subject
from motion_tracker.core.forces.force_plates import PlateGeometry
from motion_tracker.core.lifts.lift_events import LiftEventSettings
from motion_tracker.core.markers.marker_set import load_marker_set
from motion_tracker.core.tracked import TrackerSettings
from motion_tracker.core.tracker import MotionTracker


def settings_from(values: Mapping[str, Any]) -> TrackerSettings:
    """Return settings from the values of ``data/parameters.yaml`` by name."""
    events = LiftEventSettings(
        minimum_rise=values['minimum_rise'],
        minimum_body_rise=values['minimum_body_rise'],
        rest_speed=values['rest_speed'],
    )
    return TrackerSettings(
        motion_cutoff=values['motion_cutoff'],
        plate_cutoff=values['plate_cutoff'],
        force_threshold=values['force_threshold'],
        wait=values['wait'],
        longest_gap=values['longest_gap'],
        margin=values['margin'],
        mass_tolerance=values['mass_tolerance'],
        events=events,
    )


def tracker_from(
    values: Mapping[str, Any],
    subject: Subject,
    marker_set: str,
    box_mass: float,
    box_size: npt.ArrayLike,
    first_lift: int = 1,
    clock: Callable[[], float] | None = None,
    settings: TrackerSettings | None = None,
    session: str = '',
) -> MotionTracker:
    """Tracker of one recording.

    Parameters
    ----------
    values
        Parameters by name; their ``marker_set``, if not empty, goes before the argument.
    subject, marker_set, box_mass, box_size
        Of the recording; see `MotionTracker`.
    first_lift
        Number of the first lift.
    clock
        Time now [s], for live streams; None when reading files.
    settings
        Replace those of ``values``.
    session
        End of the lifts' names; '' for none.

    Raises
    ------
    MotionTrackerError
        If the marker set does not exist or does not fit, or a value is refused.
    """
    name = values['marker_set'] or marker_set
    plates = {
        side: PlateGeometry(f'{side} plate', surface_height=values['plate_surface_height'])
        for side in SIDES
    }
    return MotionTracker(
        subject,
        load_marker_set(name) if name else None,
        box_mass,
        box_size,
        plates,
        settings_from(values) if settings is None else settings,
        first_lift,
        clock,
        session,
    )
