# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Every joint type against rotations written out by hand, and its derivatives."""

import re

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.osim.reader import read_osim

COORDINATE = """<Coordinate name="{name}"><default_value>0</default_value><range>-9 9</range>
<locked>{locked}</locked></Coordinate>"""
MODEL = """<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="one joint">
<gravity>0 -9.81 0</gravity><Ground name="ground"/>
<BodySet><objects><Body name="part"><mass>1</mass><mass_center>0 0 0</mass_center>
<inertia>1 1 1 0 0 0</inertia></Body></objects></BodySet>
<JointSet><objects><{tag} name="joint"><socket_parent_frame>base</socket_parent_frame>
<socket_child_frame>moved</socket_child_frame><coordinates>{coordinates}</coordinates>
<frames><PhysicalOffsetFrame name="base"><socket_parent>/ground</socket_parent>
<translation>0.1 0.2 0.3</translation><orientation>0.4 -0.3 0.2</orientation>
</PhysicalOffsetFrame><PhysicalOffsetFrame name="moved"><socket_parent>/bodyset/part
</socket_parent><translation>0 -0.1 0.05</translation></PhysicalOffsetFrame></frames>{extra}
</{tag}></objects></JointSet></Model></OpenSimDocument>"""
AXES = {'rotation': (1, 2, 3), 'translation': (1, 2, 3)}


def turn(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * skew @ skew


X, Y, Z = np.eye(3)
BASE = turn(X, 0.4) @ turn(Y, -0.3) @ turn(Z, 0.2)


def one_joint(path, tag, n, extra='', locked='false'):
    names = ''.join(COORDINATE.format(name=f'q{i}', locked=locked) for i in range(n))
    path.write_text(MODEL.format(tag=tag, coordinates=names, extra=extra), encoding='utf-8')
    return path


def spatial_transform(**axes):
    """Write a transform; of each axis its direction, coordinate and function."""
    text = ''
    for kind, numbers in AXES.items():
        for i in numbers:
            axis, coordinate, function = axes.get(
                f'{kind}{i}', (np.eye(3)[i - 1], '', '<Constant><value>0</value></Constant>')
            )
            text += f'<TransformAxis name="{kind}{i}"><coordinates>{coordinate}</coordinates>'
            text += f'<axis>{" ".join(map(str, axis))}</axis>{function}</TransformAxis>'
    return f'<SpatialTransform>{text}</SpatialTransform>'


def state_at(model, q, qd=None, qdd=None):
    zero = np.zeros(len(q))
    q = np.asarray(q, dtype=float)
    qd, qdd = (zero if v is None else np.asarray(v, dtype=float) for v in (qd, qdd))
    return forward_kinematics(model.tree, q, qd, qdd)


def place(rotation, translation):
    """Return rotation and origin of the body behind the joint's moved frame."""
    whole = BASE @ rotation
    origin = np.array([0.1, 0.2, 0.3]) + BASE @ np.asarray(translation, dtype=float)
    return whole, origin - whole @ [0.0, -0.1, 0.05]


def check_derivatives(model, q):
    """Compare velocities, accelerations and Jacobian with differences in time."""
    rng = np.random.default_rng(3)
    qd, qdd = rng.uniform(-1.0, 1.0, (2, len(q)))
    q = np.asarray(q, dtype=float)
    step = 1e-5

    def later(t):
        return state_at(model, q + t * qd + 0.5 * t**2 * qdd, qd + t * qdd, qdd)

    now, after, before = later(0.0), later(step), later(-step)
    velocity = (after.position[1] - before.position[1]) / (2 * step)
    np.testing.assert_allclose(now.velocity[1], velocity, atol=1e-8)
    skew = (after.rotation[1] - before.rotation[1]) / (2 * step) @ now.rotation[1].T
    spin = [skew[2, 1], skew[0, 2], skew[1, 0]]
    np.testing.assert_allclose(now.angular_velocity[1], spin, atol=1e-8)
    for rate, derivative in (
        ('velocity', 'acceleration'),
        ('angular_velocity', 'angular_acceleration'),
    ):
        change = (getattr(after, rate)[1] - getattr(before, rate)[1]) / (2 * step)
        np.testing.assert_allclose(getattr(now, derivative)[1], change, atol=1e-7)
    twist = body_jacobians(model.tree, now)[1] @ qd
    np.testing.assert_allclose(twist[:3], now.angular_velocity[1], atol=1e-12)
    at_origin = now.velocity[1] - np.cross(now.angular_velocity[1], now.position[1])
    np.testing.assert_allclose(twist[3:], at_origin, atol=1e-12)


Q = [0.5, -0.7, 0.3, 0.04, -0.06, 0.08]
XYZ = turn(X, 0.5) @ turn(Y, -0.7) @ turn(Z, 0.3)


@pytest.mark.parametrize(
    ('tag', 'n', 'rotation', 'translation'),
    [
        ('WeldJoint', 0, np.eye(3), (0, 0, 0)),
        ('PinJoint', 1, turn(Z, 0.5), (0, 0, 0)),
        ('SliderJoint', 1, np.eye(3), (0.5, 0, 0)),
        ('UniversalJoint', 2, turn(X, 0.5) @ turn(Y, -0.7), (0, 0, 0)),
        ('BallJoint', 3, XYZ, (0, 0, 0)),
        ('GimbalJoint', 3, XYZ, (0, 0, 0)),
        ('PlanarJoint', 3, turn(Z, 0.5), (-0.7, 0.3, 0)),
        ('FreeJoint', 6, XYZ, (0.04, -0.06, 0.08)),
    ],
)
def test_joints_of_fixed_type(tmp_path, tag, n, rotation, translation):
    model = compile_model(read_osim(one_joint(tmp_path / 'joint.osim', tag, n)))
    assert model.source.joint('joint').kind == tag
    state = state_at(model, Q[:n])
    turned, origin = place(rotation, translation)
    np.testing.assert_allclose(state.rotation[1], turned, atol=1e-15)
    np.testing.assert_allclose(state.position[1], origin, atol=1e-15)
    if n:
        check_derivatives(model, Q[:n])


def test_custom_joint_with_oblique_axes_and_functions(tmp_path):
    """Two coordinates drive turns about oblique axes and a translation each, some of them both."""
    cubic = """<PolynomialFunction><coefficients>0.3 -0.2 0.5 0.1</coefficients>
      </PolynomialFunction>"""
    doubled = """<MultiplierFunction><function><LinearFunction><coefficients>1 0.1</coefficients>
      </LinearFunction></function><scale>2</scale></MultiplierFunction>"""
    level = '<Constant><value>-0.2</value></Constant>'
    transform = spatial_transform(
        rotation1=((0.6, 0.8, 0.0), 'q0', cubic),
        rotation2=((0.0, 0.0, -2.0), 'q1', doubled),
        rotation3=((0.0, 1.0, 0.0), '', level),
        translation1=((1.0, 0.0, 0.0), 'q0', doubled),
        translation3=((0.0, 0.6, 0.8), 'q1', cubic),
    )
    path = one_joint(tmp_path / 'joint.osim', 'CustomJoint', 2, transform)
    model = compile_model(read_osim(path))
    a, b = 0.5, -0.7

    def cubic_at(x):
        return 0.3 * x**3 - 0.2 * x**2 + 0.5 * x + 0.1

    rotation = turn((0.6, 0.8, 0.0), cubic_at(a)) @ turn((0, 0, -1), 2 * (b + 0.1)) @ turn(Y, -0.2)
    translation = 2 * (a + 0.1) * X + cubic_at(b) * np.array([0.0, 0.6, 0.8])
    state = state_at(model, [a, b])
    turned, origin = place(rotation, translation)
    np.testing.assert_allclose(state.rotation[1], turned, atol=1e-15)
    np.testing.assert_allclose(state.position[1], origin, atol=1e-15)
    check_derivatives(model, [a, b])


@pytest.mark.parametrize(
    ('function', 'expected'),
    [
        ('<Constant><value>0.3</value></Constant>', 0.3),
        ('<LinearFunction><coefficients>2 0.1</coefficients></LinearFunction>', 1.1),
        ('<PolynomialFunction><coefficients>1 2 3</coefficients></PolynomialFunction>', 4.25),
        ('<PiecewiseLinearFunction><x>0 1 2</x><y>0 1 5</y></PiecewiseLinearFunction>', 0.5),
        ('<SimmSpline><x>0 1 2 3</x><y>0 1 8 27</y></SimmSpline>', 0.125),
        ('<NaturalCubicSpline><x>0 1 2 3</x><y>0 1 8 27</y></NaturalCubicSpline>', 0.125),
        ('<natCubicSpline><x>0 1 2 3</x><y>0 1 8 27</y></natCubicSpline>', 0.125),
        (
            '<StepFunction><transition_start_time>0</transition_start_time><transition_end_time>1'
            '</transition_end_time><start_value>0</start_value><end_value>3</end_value>'
            '</StepFunction>',
            1.5,
        ),
        (
            '<MultiplierFunction><function><Constant><value>0.2</value></Constant></function>'
            '<scale>-4</scale></MultiplierFunction>',
            -0.8,
        ),
    ],
)
def test_every_function_moves_a_joint(tmp_path, function, expected):
    """At a coordinate of 0.5; the values follow from the functions' definitions."""
    transform = spatial_transform(translation1=((1.0, 0.0, 0.0), 'q0', function))
    path = one_joint(tmp_path / 'joint.osim', 'CustomJoint', 1, transform)
    model = compile_model(read_osim(path))
    _, origin = place(np.eye(3), (expected, 0.0, 0.0))
    np.testing.assert_allclose(state_at(model, [0.5]).position[1], origin, atol=1e-14)
    check_derivatives(model, [0.5])


@pytest.mark.parametrize('tag', ['EllipsoidJoint', 'ScapulothoracicJoint', 'BeamJoint'])
def test_other_joints_are_named(tmp_path, tag):
    with pytest.raises(UnsupportedElementError, match=f'joint.osim: <{tag} name="joint">'):
        read_osim(one_joint(tmp_path / 'joint.osim', tag, 3))


@pytest.mark.parametrize(
    ('function', 'coordinates', 'error', 'named'),
    [
        ('<Sine><amplitude>1</amplitude></Sine>', 'q0', UnsupportedElementError, '<Sine>'),
        ('', 'q0', OsimFormatError, 'has no function'),
        ('<GCVSpline><x>0 1</x></GCVSpline>', 'q0', UnsupportedElementError, '<GCVSpline>'),
        (
            '<LinearFunction><coefficients>1</coefficients></LinearFunction>',
            'q0',
            OsimFormatError,
            "coefficients>: '1', want 2 numbers",
        ),
        (
            '<SimmSpline><x>0 0 1</x><y>0 1 2</y></SimmSpline>',
            'q0',
            OsimFormatError,
            'x of a function must increase: 0.0, 0.0',
        ),
        (
            '<LinearFunction><coefficients>1 0</coefficients></LinearFunction>',
            'q0 q1',
            UnsupportedElementError,
            'function of 2 coordinates',
        ),
        (
            '<LinearFunction><coefficients>1 0</coefficients></LinearFunction>',
            'q7',
            OsimFormatError,
            "has no coordinate 'q7'",
        ),
        (
            '<LinearFunction><coefficients>1 0</coefficients></LinearFunction>',
            '',
            OsimFormatError,
            'function of no coordinate',
        ),
    ],
)
def test_axes_that_cannot_be_used_are_named(tmp_path, function, coordinates, error, named):
    transform = spatial_transform(rotation1=((1.0, 0.0, 0.0), coordinates, function))
    with pytest.raises(error, match=named):
        read_osim(one_joint(tmp_path / 'joint.osim', 'CustomJoint', 2, transform))


def test_wrong_number_of_coordinates_is_named(tmp_path):
    named = re.escape("<BallJoint name=\"joint\"> has coordinates ['q0', 'q1'], want 3")
    with pytest.raises(OsimFormatError, match=named):
        read_osim(one_joint(tmp_path / 'joint.osim', 'BallJoint', 2))
