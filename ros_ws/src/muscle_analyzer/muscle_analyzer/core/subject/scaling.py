# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Scales a model: one factor per body and axis, as OpenSim's scale tool does.

Everything fixed to a body is stretched along the body's axes: joint frames, path points, wrap
objects, markers, mass centres. Masses keep their distribution and add up to the subject's. Optimal
fibre and tendon slack lengths are multiplied by the ratio of the muscle's path lengths after and
before, in the default posture. Maximum isometric forces are kept unless factors are given
(`muscle_strength`).

One thing differs from OpenSim: inertia tensors are those of the stretched mass distribution
itself, where OpenSim takes a cylinder if the factors of a body's axes differ. With equal factors
both agree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.exceptions import ScalingError
from muscle_analyzer.core.osim.model import (
    GROUND,
    Body,
    Frame,
    Joint,
    Muscle,
    OsimModel,
    PathPoint,
    TransformAxis,
    WrapObject,
)

PathLengths = Callable[[OsimModel], Array]


def scale_model(
    model: OsimModel,
    factors: Mapping[str, Array],
    mass: float,
    path_lengths: PathLengths,
    force_factors: Array | None = None,
) -> OsimModel:
    """Return the model stretched to a subject.

    Parameters
    ----------
    model : OsimModel
    factors : mapping of str to (3,) array
        Per body, along its own axes; every body but the ground must be there.
    mass : float
        Of the subject, kg.
    path_lengths : callable
        Returns the muscles' path lengths (n_muscles,) of a model in its default posture, m.
    force_factors : array (n_muscles,), optional
        What the maximum isometric forces are multiplied with; without it they are kept.

    Raises
    ------
    ScalingError
        If a factor is missing or not positive, or the mass is not positive.
    """
    by_body = _checked_factors(model, factors)
    if not (np.isfinite(mass) and mass > 0.0):
        raise ScalingError(f'mass of the subject: {mass} kg is not positive')
    mass_ratio = mass / model.mass
    stretched = replace(
        model,
        bodies=tuple(_scale_body(body, by_body[body.name], mass_ratio) for body in model.bodies),
        joints=tuple(_scale_joint(joint, by_body) for joint in model.joints),
        wrap_objects=tuple(_scale_wrap(w, by_body[w.frame.body]) for w in model.wrap_objects),
        markers=tuple(
            replace(marker, location=marker.location * by_body[marker.body])
            for marker in model.markers
        ),
        muscles=tuple(
            replace(muscle, points=tuple(_scale_point(p, by_body[p.body]) for p in muscle.points))
            for muscle in model.muscles
        ),
    )
    if not model.muscles:
        return stretched
    ratio = path_lengths(stretched) / path_lengths(model)
    if not np.all(np.isfinite(ratio)):
        bad = model.muscles[int(np.argmin(np.isfinite(ratio)))].name
        raise ScalingError(f'muscle {bad!r}: path length in the default posture is not finite')
    forces = np.ones_like(ratio) if force_factors is None else force_factors
    if forces.shape != ratio.shape or not np.all(np.isfinite(forces) & (forces > 0.0)):
        raise ScalingError(
            f'{model.source}: factors of {forces.size} muscle forces are given for '
            f'{ratio.size} muscles, or not all are positive'
        )
    return replace(
        stretched,
        muscles=tuple(
            _scale_muscle(muscle, float(r), float(f))
            for muscle, r, f in zip(stretched.muscles, ratio, forces, strict=True)
        ),
    )


def _checked_factors(model: OsimModel, factors: Mapping[str, Array]) -> dict[str, Array]:
    checked = {GROUND: np.ones(3)}
    for body in model.bodies:
        if body.name not in factors:
            raise ScalingError(f'{model.source}: no scale factor for body {body.name!r}')
        factor = np.asarray(factors[body.name], dtype=np.float64)
        if factor.shape != (3,) or not np.all(np.isfinite(factor)) or np.any(factor <= 0.0):
            raise ScalingError(f'body {body.name!r}: scale factors {factor} are not positive')
        checked[body.name] = factor
    return checked


def _scale_body(body: Body, factor: Array, mass_ratio: float) -> Body:
    # Second moments of the mass distribution stretch with the axes; inertia follows from them.
    second = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    second = mass_ratio * second * np.outer(factor, factor)
    return Body(
        body.name,
        body.mass * mass_ratio,
        body.mass_center * factor,
        np.trace(second) * np.eye(3) - second,
    )


def _scale_frame(frame: Frame, factor: Array) -> Frame:
    return replace(frame, translation=frame.translation * factor)


def _scale_joint(joint: Joint, by_body: Mapping[str, Array]) -> Joint:
    """Stretch both frames, and the translations by the parent's factors along their axes."""
    factor = by_body[joint.parent.body]
    first, second, third = (
        _scale_translation(axis, factor * (joint.parent.rotation @ axis.axis))
        for axis in joint.translations
    )
    return replace(
        joint,
        parent=_scale_frame(joint.parent, factor),
        child=_scale_frame(joint.child, by_body[joint.child.body]),
        translations=(first, second, third),
    )


def _scale_translation(axis: TransformAxis, stretched: Array) -> TransformAxis:
    """Stretch a translation, unless it is a line in its coordinate: that is a length already."""
    if axis.function.is_line():
        return axis
    return replace(axis, function=axis.function.scaled(float(np.linalg.norm(stretched))))


def _scale_wrap(wrap: WrapObject, factor: Array) -> WrapObject:
    """Stretch a surface: each of its own axes becomes as long as the body makes it."""
    along = np.linalg.norm(factor[:, None] * wrap.frame.rotation, axis=0)
    match wrap.kind:
        case 'cylinder':
            by = np.array([0.5 * (along[0] + along[1]), along[2]])
        case 'ellipsoid':
            by = along
        case 'sphere':
            by = along.mean(keepdims=True)
        case _:
            by = np.full(2, 0.5 * (along[0] + along[1]))
    dimensions = tuple(float(d * b) for d, b in zip(wrap.dimensions, by, strict=True))
    return replace(wrap, frame=_scale_frame(wrap.frame, factor), dimensions=dimensions)


def _scale_point(point: PathPoint, factor: Array) -> PathPoint:
    functions = tuple(
        f.scaled(float(s)) for f, s in zip(point.location_functions, factor, strict=False)
    )
    return replace(point, location=point.location * factor, location_functions=functions)


def _scale_muscle(muscle: Muscle, length_ratio: float, force_ratio: float) -> Muscle:
    return replace(
        muscle,
        optimal_fiber_length=muscle.optimal_fiber_length * length_ratio,
        tendon_slack_length=muscle.tendon_slack_length * length_ratio,
        max_isometric_force=muscle.max_isometric_force * force_ratio,
    )
