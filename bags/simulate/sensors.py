# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What cameras, plates and box tracker would have seen: placement, soft tissue, noise, steps.

All settings stand in `tasks.yaml` with their sources. A marker moves on its segment in proportion
to the angles of the joints next to that segment (a linear model of soft-tissue movement), each
marker in directions of its own; it returns to its place in the posture of the static trial.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bags.simulate.body import Body
from bags.simulate.forces import SimulatedForces
from bags.simulate.tasks import Stage
from scipy.spatial.transform import Rotation

from human_model import compiled
from human_model.typing import Array
from lifting_recordings.recording import Plate
from motion_tracker.core.markers.marker_set import load_marker_set

# Joints next to each segment, whose angles move its soft tissue.
_NEIGHBOURS = {
    'pelvis': ('hip_flexion_r', 'hip_flexion_l', 'lumbar_extension'),
    'lumbar': ('lumbar_extension', 'lumbar_rotation', 'thorax_extension'),
    'thorax': ('thorax_extension', 'arm_flex_r', 'arm_flex_l'),
    'head': ('thorax_extension',),
    'upper_arm': ('arm_flex', 'arm_add', 'elbow_flex'),
    'forearm': ('elbow_flex', 'pro_sup'),
    'hand': ('wrist_flex',),
    'thigh': ('hip_flexion', 'knee_angle'),
    'shank': ('knee_angle', 'ankle_angle'),
    'foot': ('ankle_angle',),
    'toes': ('ankle_angle',),
}
# Marker coordinates are stored in steps of 2^-17 m (8 micrometres), as cameras give them.
_MARKER_STEP = 2.0**-17
# Marker placement is that of one session: the same in all recordings.
_SESSION_SEED = 58


@dataclass(frozen=True)
class PlacedMarkers:
    """The markers on this person.

    Attributes
    ----------
    names, segments : tuple of str
        Of each marker.
    local : ndarray (m, 3)
        Place in the segment's frame in the posture of the static trial [m].
    slopes : tuple of dict
        Per marker: coordinate name to displacement (3,) [m/rad].
    """

    names: tuple[str, ...]
    segments: tuple[str, ...]
    local: Array
    slopes: tuple[dict[str, Array], ...]


def place_markers(stage: Stage, body: Body) -> PlacedMarkers:
    """Put the markers of the set on the person, not quite where the book says."""
    rng = np.random.default_rng(_SESSION_SEED)
    settings = stage.settings
    marker_set = load_marker_set(stage.marker_set)
    book = marker_set.positions(body.lengths)
    segments, local, slopes = [], [], []
    for name in marker_set.names:
        segment = marker_set.marker(name).segment
        kind, side = (
            (segment[:-2], segment[-2:]) if segment[-2:] in ('_r', '_l') else (segment, '')
        )
        size = settings['soft_tissue_mm_per_rad'][kind] * 1e-3
        own: dict[str, Array] = {}
        for joint in _NEIGHBOURS[kind]:
            coordinate = joint if joint[-2:] in ('_r', '_l') or not side else joint + side
            direction = rng.normal(size=3)
            own[coordinate] = size * direction / np.linalg.norm(direction)
        offset = rng.normal(0.0, settings['marker_placement_mm'] * 1e-3, 3)
        segments.append(segment)
        local.append(book[name] + offset)
        slopes.append(own)
    return PlacedMarkers(marker_set.names, tuple(segments), np.array(local), tuple(slopes))


def marker_places(
    stage: Stage, body: Body, markers: PlacedMarkers, q: Array, rest: Array, seed: int
) -> Array:
    """Return what the cameras see (n, m, 3) [m].

    Parameters
    ----------
    stage, body, markers : Stage, Body, PlacedMarkers
        Settings, person, markers.
    q : ndarray (n, n_q)
        Postures.
    rest : ndarray (n_q,)
        Posture in which the soft tissue is at its place.
    seed : int
        Of the noise.
    """
    rng = np.random.default_rng(seed)
    skeleton = body.skeleton
    index = np.array([skeleton.parameters.index(s) for s in markers.segments])
    places = np.empty((len(q), len(markers.names), 3))
    columns = [
        [(skeleton.index(name), slope) for name, slope in own.items()] for own in markers.slopes
    ]
    for i, posture in enumerate(q):
        moved = markers.local.copy()
        for m, own in enumerate(columns):
            for j, slope in own:
                moved[m] += (posture[j] - rest[j]) * slope
        places[i] = compiled.point_positions(skeleton.tree, posture, index, moved)
    places += rng.normal(0.0, stage.settings['marker_noise_mm'] * 1e-3, places.shape)
    return np.round(places / _MARKER_STEP) * _MARKER_STEP


def plate_readings(stage: Stage, forces: SimulatedForces, seed: int) -> dict[str, Plate]:
    """Return the readings of both plates, moments about the laboratory origin."""
    rng = np.random.default_rng(seed)
    settings = stage.settings
    plates = {}
    for k, side in enumerate(('right', 'left')):
        force = forces.ground_force[:, k]
        moment = np.cross(forces.centre_of_pressure[:, k], force) + forces.free_moment[:, k]
        readings = []
        for values, noise, step in (
            (force, settings['plate_force_noise'], settings['plate_force_step']),
            (moment, settings['plate_moment_noise'], settings['plate_moment_step']),
        ):
            noisy = values + rng.normal(0.0, noise, values.shape)
            readings.append(np.round(noisy / step) * step)
        plates[side] = Plate(side, forces.time, readings[0], readings[1])
    return plates


def box_readings(stage: Stage, box: Array, seed: int) -> tuple[Array, Array]:
    """Return the tracked position (n, 3) [m] and quaternion (n, 4) xyzw of the box."""
    rng = np.random.default_rng(seed)
    settings = stage.settings
    position = box[:, :3] + rng.normal(0.0, settings['box_noise_mm'] * 1e-3, (len(box), 3))
    tilt = rng.normal(0.0, np.radians(settings['box_noise_degrees']), (len(box), 3))
    turn = Rotation.from_euler('z', box[:, 3:]) * Rotation.from_rotvec(tilt)
    return np.round(position / _MARKER_STEP) * _MARKER_STEP, turn.as_quat(canonical=True)
