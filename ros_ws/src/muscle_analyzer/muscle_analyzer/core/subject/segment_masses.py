# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Gives the musculoskeletal model the segment masses of the skeleton.

The lifting full-body model carries the mass of head, arms and trunk lower (0.21 m above L5-S1
for a stature of 1.756 m) than people measured by others (0.29 m by Dumas et al. 2007 and 2015,
0.28 m by de Leva 1996), so the two models of one person need different moments at L5-S1 when it
bends. `data/segment_bodies.csv` lists the bodies of each segment. Their masses are multiplied
by one factor and their mass centres shifted together, in upright standing, until both are the
segment's; their inertia tensors follow the masses and keep their shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from human_model.frames import to_opensim
from human_model.skeleton import Skeleton
from human_model.tables import read_table
from human_model.typing import Array
from muscle_analyzer.core.exceptions import ScalingError
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.osim.model import OsimModel
from muscle_analyzer.core.subject.body_points import upright_state


class MassDistribution(StrEnum):
    """Source of the segments' masses and mass centres.

    `model` keeps the proportions of the musculoskeletal model; `segments` takes masses and
    centres of mass of the skeleton (`human_model`: Dumas et al. 2007, 2015).
    """

    MODEL = 'model'
    SEGMENTS = 'segments'


class SegmentMass(NamedTuple):
    """A segment's mass [kg] and where its centre is in upright standing (3,), REP-103 axes [m]."""

    mass: float
    centre: Array


def segment_masses(skeleton: Skeleton) -> dict[str, SegmentMass]:
    """Return the masses of a skeleton's segments, at its zero coordinates."""
    frames = skeleton.forward(np.zeros(len(skeleton.coordinates)))
    parameters = skeleton.parameters
    return {
        name: SegmentMass(
            float(parameters.mass[i]), frames[i, :3, :3] @ parameters.com[i] + frames[i, :3, 3]
        )
        for i, name in enumerate(parameters.segments)
    }


def with_segment_masses(
    model: OsimModel, segments: Mapping[str, SegmentMass], points: Mapping[str, Array]
) -> OsimModel:
    """Return a scaled model whose segments have the given masses and centres of mass.

    Parameters
    ----------
    model : OsimModel
        Scaled to the subject.
    segments : mapping of str to SegmentMass
        By name of the skeleton's segments (`data/segment_bodies.csv`).
    points : mapping of str to (3,) array
        The subject's shared points in the same posture, REP-103 axes, m. A segment's centre
        keeps its way from its point; the models' joints are not all at the same places.

    Raises
    ------
    ScalingError
        If a segment or point is missing, or the bodies of a segment have no mass.
    """
    compiled = compile_model(model)
    state = upright_state(compiled)
    bodies = {body.name: body for body in model.bodies}
    columns = 'segment bodies joint point'
    for row in read_table('muscle_analyzer', 'segment_bodies.csv', columns):
        names = row['bodies'].split()
        if row['segment'] not in segments or row['point'] not in points:
            raise ScalingError(f'masses of the subject: no {row["segment"]!r} or {row["point"]!r}')
        indices = [compiled.body_index(name) for name in names]
        masses = np.array([bodies[name].mass for name in names])
        if not masses.sum() > 0.0:
            raise ScalingError(f'bodies {row["bodies"]}: mass of {masses.sum()} kg')
        centres = np.array(
            [
                state.position[i] + state.rotation[i] @ bodies[name].mass_center
                for i, name in zip(indices, names, strict=True)
            ]
        )
        wanted = segments[row['segment']]
        joints = [compiled.body_index(name) for name in row['joint'].split()]
        target = state.joint_position[joints].mean(axis=0)
        target = target + to_opensim(wanted.centre - points[row['point']])
        shift = target - masses @ centres / masses.sum()
        ratio = wanted.mass / masses.sum()
        for i, name in zip(indices, names, strict=True):
            body = bodies[name]
            bodies[name] = replace(
                body,
                mass=body.mass * ratio,
                mass_center=body.mass_center + state.rotation[i].T @ shift,
                inertia=body.inertia * ratio,
            )
    return replace(model, bodies=tuple(bodies[body.name] for body in model.bodies))
