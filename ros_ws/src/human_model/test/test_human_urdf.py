# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The URDF of a skeleton, loaded by Pinocchio, moves and weighs like the skeleton."""

from xml.etree import ElementTree

import numpy as np
import pytest

from human_model.constants import GRAVITY
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.strength import LARGE, JointStrength
from human_model.urdf import NO_SPEED_LIMIT, WORLD, body_names, joint_effort, urdf

pin = pytest.importorskip('pinocchio', reason='Pinocchio (package pin) is not installed')


@pytest.fixture(scope='module', params=[Skeleton3D, Skeleton2D], ids=['3d', '2d'])
def person(request, man):
    """Return a skeleton, its URDF and Pinocchio's model of that."""
    skeleton = request.param.of(man)
    text = urdf(skeleton, 'S1', joint_effort(skeleton, JointStrength(skeleton.name, man)))
    model = pin.buildModelFromXML(text)
    model.gravity.linear = np.array([0, 0, -GRAVITY])
    return skeleton, text, model


def order(model, skeleton):
    """Index of each coordinate in Pinocchio's vectors; every name must be a joint."""
    assert set(model.names) == {'universe', *skeleton.coordinates}
    return np.array([model.joints[model.getJointId(name)].idx_q for name in skeleton.coordinates])


def test_links_are_where_the_segments_are(person, rng):
    skeleton, _, model = person
    index = order(model, skeleton)
    data = model.createData()
    for _ in range(5):
        q = rng.normal(size=len(skeleton.coordinates))
        theirs = np.empty_like(q)
        theirs[index] = q
        pin.framesForwardKinematics(model, data, theirs)
        frames = skeleton.forward(q)
        for i, segment in enumerate(skeleton.segments):
            placement = data.oMf[model.getFrameId(segment)]
            np.testing.assert_allclose(frames[i, :3, :3], placement.rotation, atol=1e-12)
            np.testing.assert_allclose(frames[i, :3, 3], placement.translation, atol=1e-12)


def test_mass_and_centre_of_mass(person, rng):
    skeleton, _, model = person
    index = order(model, skeleton)
    q = rng.normal(size=len(skeleton.coordinates))
    theirs = np.empty_like(q)
    theirs[index] = q
    assert pin.computeTotalMass(model) == pytest.approx(skeleton.total_mass, rel=1e-12)
    np.testing.assert_allclose(
        pin.centerOfMass(model, model.createData(), theirs), skeleton.centre_of_mass(q), atol=1e-12
    )


def test_inverse_dynamics(person, rng):
    skeleton, _, model = person
    index = order(model, skeleton)
    for _ in range(5):
        values = rng.normal(size=(3, len(index))) * [[0.8], [2.0], [10.0]]
        theirs = np.empty_like(values)
        theirs[:, index] = values
        expected = pin.rnea(model, model.createData(), *theirs)
        np.testing.assert_allclose(
            skeleton.inverse_dynamics(*values), expected[index], rtol=1e-10, atol=1e-8
        )


def test_limits_are_the_skeletons(person, man):
    skeleton, _, model = person
    index = order(model, skeleton)
    np.testing.assert_array_equal(model.lowerPositionLimit[index], skeleton.limits[:, 0])
    np.testing.assert_array_equal(model.upperPositionLimit[index], skeleton.limits[:, 1])
    np.testing.assert_array_equal(model.velocityLimit[index], NO_SPEED_LIMIT)
    strength = JointStrength(skeleton.name, man)
    for name, effort in zip(skeleton.coordinates, model.effortLimit[index], strict=True):
        if name not in strength.coordinates:
            assert effort == 0.0
            continue
        lower, upper = skeleton.limits[skeleton.index(name)]
        middle = strength.limits(name, 0.5 * (lower + upper), 0.0)
        assert effort >= max(-middle[0], middle[1]) > 0.0
        assert effort <= 2 * LARGE


def test_text_is_a_tree_of_named_links(person):
    skeleton, text, _ = person
    root = ElementTree.fromstring(text)
    links = [link.get('name') for link in root.findall('link')]
    assert len(links) == len(set(links))
    assert set(body_names(skeleton)) | {WORLD} <= set(links)
    assert set(skeleton.segments) <= set(links)
    parent = {
        joint.find('child').get('link'): joint.find('parent').get('link')
        for joint in root.findall('joint')
    }
    assert set(parent) == set(links) - {WORLD}
    massless = [link.get('name') for link in root.findall('link') if link.find('inertial') is None]
    assert set(massless) == set(links) - set(skeleton.segments)


def test_shapes_hold_about_the_volume_of_the_body(person):
    """Cylinders whose radii come from the masses hold a litre a kilogramme."""
    skeleton, text, _ = person
    cylinders = ElementTree.fromstring(text).findall('.//cylinder')
    litres = 1e3 * sum(
        np.pi * float(c.get('radius')) ** 2 * float(c.get('length')) for c in cylinders
    )
    assert litres == pytest.approx(skeleton.total_mass, rel=1e-9)
