# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Scaling by hand, and against a model that OpenSim's scale tool made from the same file."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import ScalingError
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.subject.model import default_path_lengths
from muscle_analyzer.core.subject.scaling import scale_model

FACTORS = {'upper': np.array([1.1, 1.2, 1.3]), 'lower': np.array([0.9, 0.9, 0.9])}


@pytest.fixture
def scaled(write_model):
    model = read_osim(write_model())
    return model, scale_model(model, FACTORS, 7.0, default_path_lengths)


def test_everything_fixed_to_a_body_is_stretched(scaled):
    _, model = scaled
    np.testing.assert_allclose(model.body('upper').mass_center, [0.0, -0.15 * 1.2, 0.0])
    np.testing.assert_allclose(model.joint('elbow').parent.translation, [0.0, -0.36, 0.0])
    (muscle,) = model.muscles
    np.testing.assert_allclose(muscle.points[0].location, [0.1, 0.0, 0.0])
    np.testing.assert_allclose(muscle.points[1].location, [0.022, -0.24, 0.0])
    np.testing.assert_allclose(model.markers[0].location, [0.0, -0.36, 0.0])
    assert model.wrap_object('drum').dimensions == pytest.approx((0.02 * 1.15, 0.1 * 1.3))
    np.testing.assert_allclose(model.wrap_object('drum').frame.translation, [0.0, -0.12, 0.0])


def test_masses_add_up_and_inertia_is_that_of_the_stretched_body(scaled):
    model, stretched = scaled
    assert stretched.mass == pytest.approx(7.0)
    assert stretched.body('lower').mass / stretched.mass == pytest.approx(1.5 / 3.5)
    lower = model.body('lower').inertia
    np.testing.assert_allclose(stretched.body('lower').inertia, lower * 2.0 * 0.9**2)
    # Second moments of diag(0.02, 0.001, 0.02): 0.0005, 0.0195, 0.0005.
    x, y, z = 2.0 * np.array([0.0005 * 1.21, 0.0195 * 1.44, 0.0005 * 1.69])
    np.testing.assert_allclose(stretched.body('upper').inertia, np.diag([y + z, x + z, x + y]))


def test_fibre_and_tendon_follow_the_path(scaled):
    model, stretched = scaled
    ratio = np.hypot(0.078, 0.24) / np.hypot(0.08, 0.2)
    before, after = model.muscles[0], stretched.muscles[0]
    assert after.optimal_fiber_length == pytest.approx(before.optimal_fiber_length * ratio)
    assert after.tendon_slack_length == pytest.approx(before.tendon_slack_length * ratio)
    assert after.max_isometric_force == before.max_isometric_force


def test_muscle_forces_are_multiplied_if_asked_for(write_model):
    model = read_osim(write_model())
    strong = scale_model(model, FACTORS, 28.0, default_path_lengths, np.array([4.0]))
    assert strong.muscles[0].max_isometric_force == pytest.approx(4.0 * 500.0)


@pytest.mark.parametrize('factors', [[1.0, 1.0], [0.0], [np.nan]])
def test_factors_of_forces_that_do_not_fit_are_refused(write_model, factors):
    with pytest.raises(ScalingError, match='muscle forces'):
        scale_model(
            read_osim(write_model()), FACTORS, 7.0, default_path_lengths, np.array(factors)
        )


@pytest.mark.parametrize(
    ('factors', 'mass', 'named'),
    [
        ({'upper': FACTORS['upper']}, 7.0, "no scale factor for body 'lower'"),
        ({**FACTORS, 'lower': np.array([1.0, 0.0, 1.0])}, 7.0, "body 'lower'"),
        (FACTORS, -1.0, '-1.0 kg'),
    ],
)
def test_bad_input_is_named(write_model, factors, mass, named):
    with pytest.raises(ScalingError, match=named):
        scale_model(read_osim(write_model()), factors, mass, default_path_lengths)


def _opensim_factors(generic, scaled):
    """Return what OpenSim's scale tool multiplied each body's axes with, from both models."""
    ratios = {body.name: ([], [], []) for body in generic.bodies}

    def add(body, before, after):
        for axis in range(3):
            if body in ratios and abs(before[axis]) > 1e-3:
                ratios[body][axis].append(after[axis] / before[axis])

    for a, b in zip(generic.bodies, scaled.bodies, strict=True):
        add(a.name, a.mass_center, b.mass_center)
    for a, b in zip(generic.joints, scaled.joints, strict=True):
        add(a.parent.body, a.parent.translation, b.parent.translation)
        add(a.child.body, a.child.translation, b.child.translation)
    for a, b in zip(generic.muscles, scaled.muscles, strict=True):
        for p, q in zip(a.points, b.points, strict=True):
            add(p.body, p.location, q.location)
    known = {
        name: np.array([np.median(r) if r else np.nan for r in axes])
        for name, axes in ratios.items()
    }
    # Axes without any offset along them (head, hands) were scaled like the body's others.
    return {name: np.where(np.isnan(f), np.nanmean(f), f) for name, f in known.items()}


def test_same_factors_give_the_model_of_opensims_scale_tool(lifting_model, squats):
    """Every body, joint, wrap object and muscle; but the pelvis' inertia (see the module)."""
    theirs = squats.model.source
    factors = _opensim_factors(lifting_model, theirs)
    ours = scale_model(lifting_model, factors, theirs.mass, default_path_lengths)
    for a, b in zip(ours.bodies, theirs.bodies, strict=True):
        assert a.mass == pytest.approx(b.mass, rel=1e-9)
        np.testing.assert_allclose(a.mass_center, b.mass_center, atol=1e-9)
        if a.name != 'pelvis':
            np.testing.assert_allclose(a.inertia, b.inertia, rtol=1e-6)
    for a, b in zip(ours.joints, theirs.joints, strict=True):
        np.testing.assert_allclose(a.parent.translation, b.parent.translation, atol=1e-9)
        for axis, other in zip(a.translations, b.translations, strict=True):
            for x in (0.0, 0.6, 1.5):
                expected = other.function.derivatives(x)[0]
                assert axis.function.derivatives(x)[0] == pytest.approx(expected, abs=1e-9)
    for a, b in zip(ours.wrap_objects, theirs.wrap_objects, strict=True):
        assert a.dimensions == pytest.approx(b.dimensions, rel=1e-6)
    ratios = [
        (
            a.optimal_fiber_length / b.optimal_fiber_length,
            a.tendon_slack_length / b.tendon_slack_length,
        )
        for a, b in zip(ours.muscles, theirs.muscles, strict=True)
    ]
    np.testing.assert_allclose(ratios, 1.0, atol=2e-3)
