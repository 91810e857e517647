# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The person's segment masses in the musculoskeletal model."""

import numpy as np
import pytest

from human_model.frames import from_opensim
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.exceptions import ScalingError
from muscle_analyzer.core.subject.body_points import upright_state
from muscle_analyzer.core.subject.model import subject_model
from muscle_analyzer.core.subject.segment_masses import segment_masses, with_segment_masses

TRUNK = ('lumbar', 'thorax', 'head')


@pytest.fixture(scope='module', params=['male', 'female'])
def models(request, lifting_model):
    """Return skeleton, its masses and the two models of a person."""
    skeleton = Skeleton3D.of(Subject('p1', request.param, 63.5, 1.69, 30.0))
    points = skeleton.points(np.zeros(len(skeleton.coordinates)))
    masses = segment_masses(skeleton)
    arguments = (lifting_model, points, skeleton.parameters.lengths, 63.5)
    return skeleton, masses, subject_model(*arguments), subject_model(*arguments, segments=masses)


def upright(model, names):
    """Return mass and centre of mass of some bodies in upright standing, from L5-S1, REP-103."""
    multibody = model.multibody
    state = upright_state(multibody)
    which = [multibody.body_index(name) for name in names]
    mass = multibody.tree.mass[which]
    centre = [state.position[b] + state.rotation[b] @ multibody.tree.mass_center[b] for b in which]
    l5_s1 = state.joint_position[multibody.body_index('lumbar5')]
    return mass.sum(), from_opensim(mass @ np.array(centre) / mass.sum() - l5_s1)


def test_trunk_and_head_have_the_masses_of_the_skeleton(models):
    skeleton, masses, _, ours = models
    bodies = [f'lumbar{k}' for k in range(1, 6)] + ['Abdomen', 'torso', 'head']
    mass, centre = upright(ours, bodies)
    wanted = sum(masses[name].mass for name in TRUNK)
    place = sum(masses[name].mass * masses[name].centre for name in TRUNK) / wanted
    l5_s1 = skeleton.points(np.zeros(len(skeleton.coordinates)))['l5_s1']
    assert mass == pytest.approx(wanted, rel=1e-9)
    assert centre == pytest.approx(place - l5_s1, abs=1e-9)


def test_whole_body_weighs_the_same_and_stands_over_nearly_the_same_point(models):
    skeleton, _, theirs, ours = models
    everything = [name for name in ours.multibody.body_names if name != 'ground']
    mass, centre = upright(ours, everything)
    assert mass == pytest.approx(63.5, rel=1e-9)
    assert theirs.multibody.source.mass == pytest.approx(63.5, rel=1e-9)
    zero = np.zeros(len(skeleton.coordinates))
    own = skeleton.centre_of_mass(zero) - skeleton.points(zero)['l5_s1']
    # Joints that are not at the same places in both models: knees and shoulders, a few mm.
    assert centre == pytest.approx(own, abs=5e-3)
    # The model's own distribution has the trunk's mass lower.
    assert upright(theirs, everything)[1][2] < centre[2] - 0.01


def test_muscles_and_joints_stay(models):
    _, _, theirs, ours = models
    for a, b in zip(theirs.multibody.source.muscles, ours.multibody.source.muscles, strict=True):
        assert a.optimal_fiber_length == b.optimal_fiber_length
        assert a.tendon_slack_length == b.tendon_slack_length
    np.testing.assert_array_equal(
        upright_state(theirs.multibody).joint_position,
        upright_state(ours.multibody).joint_position,
    )
    for body in ours.multibody.source.bodies:
        assert np.all(np.linalg.eigvalsh(body.inertia) >= 0.0)


def test_missing_segment_is_named(models):
    skeleton, masses, theirs, _ = models
    points = skeleton.points(np.zeros(len(skeleton.coordinates)))
    less = {name: mass for name, mass in masses.items() if name != 'thorax'}
    with pytest.raises(ScalingError, match='thorax'):
        with_segment_masses(theirs.multibody.source, less, points)
