# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reading `.osim` files, good and bad ones."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.osim.xml import body_fixed_xyz

FORCE = '<{tag} name="extra"><appliesForce>{on}</appliesForce></{tag}>'


def test_pendulum_is_read_whole(write_model):
    model = read_osim(write_model())
    assert [body.name for body in model.bodies] == ['upper', 'lower']
    assert model.mass == pytest.approx(3.5)
    np.testing.assert_array_equal(model.body('upper').inertia, np.diag([0.02, 0.001, 0.02]))
    elbow = model.joint('elbow')
    assert (elbow.parent.body, elbow.child.body) == ('upper', 'lower')
    np.testing.assert_array_equal(elbow.parent.translation, [0.0, -0.3, 0.0])
    assert elbow.rotations[0].coordinate == 'q2'
    np.testing.assert_array_equal(elbow.rotations[0].axis, [0.0, 0.0, 1.0])
    (muscle,) = model.muscles
    assert [point.body for point in muscle.points] == ['ground', 'upper']
    assert muscle.properties['ignore_tendon_compliance'] == 1.0
    assert model.wrap_object('drum').dimensions == (0.02, 0.1)
    assert model.markers[0].body == 'lower'
    assert model.left_out == ('ContactSphere ball',)


def test_lifting_model_has_its_published_numbers(lifting_model):
    """30 bodies, 62 coordinates, 20 couplers, 318 muscles, 932 points, 41 + 3 wrap objects."""
    coordinates = [c for joint in lifting_model.joints for c in joint.coordinates]
    kinds = [wrap.kind for wrap in lifting_model.wrap_objects]
    assert (len(lifting_model.bodies), len(coordinates)) == (30, 62)
    assert (len(lifting_model.couplers), len(lifting_model.muscles)) == (20, 318)
    assert sum(len(muscle.points) for muscle in lifting_model.muscles) == 932
    assert sum(bool(muscle.wraps) for muscle in lifting_model.muscles) == 85
    assert (kinds.count('cylinder'), kinds.count('ellipsoid')) == (41, 3)
    assert sum('ContactSphere' in item for item in lifting_model.left_out) == 12


@pytest.mark.parametrize('tag', ['SmoothSphereHalfSpaceForce', 'CoordinateActuator'])
def test_contact_and_actuators_are_left_out_and_listed(write_model, tag):
    model = read_osim(write_model(forces=FORCE.format(tag=tag, on='true')))
    assert f'{tag} extra' in model.left_out
    assert model.muscles == ()


def test_unknown_force_is_named_unless_it_does_not_act(write_model):
    path = write_model(forces=FORCE.format(tag='BushingForce', on='true'))
    with pytest.raises(UnsupportedElementError, match=r'model\.osim: <BushingForce name="extra">'):
        read_osim(path)
    assert 'BushingForce extra' in read_osim(path, leave_out={'BushingForce'}).left_out
    path = write_model(forces=FORCE.format(tag='BushingForce', on='false'))
    assert 'BushingForce extra' in read_osim(path).left_out


@pytest.mark.parametrize(
    ('old', 'new', 'named'),
    [
        ('PinJoint', 'EllipsoidJoint', 'EllipsoidJoint'),
        ('WrapCylinder', 'WrapCone', 'WrapCone'),
        ('<PathPoint name="p1">', '<SurfacePoint name="p1">', None),
        ('<clamped>true', '<prescribed>true</prescribed><clamped>true', 'prescribed'),
    ],
)
def test_unknown_elements_are_named(write_model, old, new, named):
    replaced = [(old, new)]
    if named is None:
        named = 'SurfacePoint'
        replaced.append(('</PathPoint>', '</SurfacePoint>'))
        replaced.append(('<PathPoint name="p2">', '<SurfacePoint name="p2">'))
    with pytest.raises(UnsupportedElementError, match=named):
        read_osim(write_model(*replaced))


@pytest.mark.parametrize(
    ('old', 'new', 'named'),
    [
        ('<mass>2.0</mass>', '<mass>-2</mass>', r'name="upper".*<mass>: -2'),
        ('<mass>2.0</mass>', '<mass>two</mass>', r"<mass>: 'two'"),
        ('<mass>2.0</mass>', '<mass>nan</mass>', r"<mass>: 'nan'"),
        ('<mass>2.0</mass>', '', r'name="upper".*no <mass>'),
        ('<range>-3 3', '<range>3 -3', r'<range>: 3.0 > -3.0'),
        ('Coordinate name="q2"', 'Coordinate name="q1"', "coordinate 'q1' is there twice"),
        ('/bodyset/upper</socket_parent>', '/bodyset/arm</socket_parent>', '/bodyset/arm'),
        ('<radius>0.02', '<radius>0', 'not positive'),
        ('<optimal_fiber_length>0.1', '<optimal_fiber_length>0', '<optimal_fiber_length>: 0'),
        ('Version="40000"', 'Version="20302"', '20302'),
        ('</OpenSimDocument>', '', 'cannot be read as XML'),
    ],
)
def test_bad_values_are_named(write_model, old, new, named):
    with pytest.raises(OsimFormatError, match=named):
        read_osim(write_model((old, new)))


def test_values_that_are_not_given_come_from_the_files_defaults(write_model):
    """OpenSim takes them from the object of the same type in <defaults>, of muscles as well."""
    defaults = """<defaults><DeGrooteFregly2016Muscle name="default">
      <max_isometric_force>77</max_isometric_force><default_activation>0.3</default_activation>
      </DeGrooteFregly2016Muscle></defaults><gravity>"""
    given = '<max_isometric_force>500</max_isometric_force>'
    (muscle,) = read_osim(write_model(('<gravity>', defaults), (given, ''))).muscles
    assert muscle.max_isometric_force == 77.0
    assert muscle.properties['default_activation'] == 0.3
    (muscle,) = read_osim(write_model(('<gravity>', defaults))).muscles
    assert muscle.max_isometric_force == 500.0


def test_own_curve_of_a_muscle_replaces_that_of_the_defaults(write_model):
    tag = 'Millard2012EquilibriumMuscle'
    defaults = f"""<defaults><{tag} name="default"><FiberForceLengthCurve>
      <strain_at_zero_force>0.2</strain_at_zero_force></FiberForceLengthCurve>
      <ForceVelocityCurve><isometric_slope>4</isometric_slope></ForceVelocityCurve></{tag}>
      </defaults><gravity>"""
    own = """<FiberForceLengthCurve><strain_at_one_norm_force>0.8</strain_at_one_norm_force>
      <curviness></curviness></FiberForceLengthCurve><max_contraction_velocity>"""
    path = write_model(
        ('DeGrooteFregly2016Muscle', tag),
        ('<gravity>', defaults),
        ('<max_contraction_velocity>', own),
    )
    properties = read_osim(path).muscles[0].properties
    curves = {name: value for name, value in properties.items() if '/' in name}
    assert curves == {
        'FiberForceLengthCurve/strain_at_one_norm_force': 0.8,
        'ForceVelocityCurve/isometric_slope': 4.0,
    }


@pytest.mark.parametrize(
    'tag', ['Millard2012EquilibriumMuscle', 'Thelen2003Muscle', 'DeGrooteFregly2016Muscle']
)
def test_muscles_of_three_types_are_read(write_model, tag):
    (muscle,) = read_osim(write_model(('DeGrooteFregly2016Muscle', tag))).muscles
    assert muscle.kind == tag


@pytest.mark.parametrize('tag', ['Schutte1993Muscle_Deprecated', 'RigidTendonMuscle'])
def test_other_muscles_are_named(write_model, tag):
    with pytest.raises(UnsupportedElementError, match=f'<{tag} name="flexor"> is not modelled'):
        read_osim(write_model(('DeGrooteFregly2016Muscle', tag)))


def test_path_that_is_no_row_of_points_is_named(write_model):
    with pytest.raises(UnsupportedElementError, match='name="flexor">: path is no <GeometryPath>'):
        read_osim(write_model(('GeometryPath', 'FunctionBasedPath')))


def test_second_wrap_object_of_a_name_is_left_out(write_model):
    """OpenSim resolves a path's wrap object to the first of its name."""
    drum = """<WrapObjectSet><objects><WrapSphere name="drum"><radius>0.1</radius></WrapSphere>
      </objects></WrapObjectSet>"""
    model = read_osim(write_model(('<Body name="lower">', '<Body name="lower">' + drum)))
    (surface,) = model.wrap_objects
    assert (surface.kind, surface.frame.body) == ('cylinder', 'upper')
    assert 'WrapSphere drum of /bodyset/lower' in model.left_out


@pytest.mark.parametrize('quadrant', ['+X', 'x', 'X'])
def test_quadrants_are_read_as_opensim_writes_them(write_model, quadrant):
    path = write_model(('<quadrant>all', f'<quadrant>{quadrant}'))
    assert read_osim(path).wrap_object('drum').quadrant == 'x'


def test_offset_frames_without_offset_and_relative_sockets(write_model):
    offset = '<translation>0 0 0</translation><orientation>0 0 0</orientation>'
    plain = '<socket_parent_frame>/bodyset/lower'
    relative = '<socket_parent_frame>../../bodyset/lower'
    model = read_osim(write_model((offset, ''), (plain, relative)))
    np.testing.assert_array_equal(model.joint('elbow').child.translation, np.zeros(3))
    assert model.markers[0].body == 'lower'


def test_places_and_angles_that_are_not_given_are_zero(write_model):
    """As in OpenSim, which does not write what it was never told."""
    model = read_osim(
        write_model(
            ('<mass_center>0 -0.15 0</mass_center>', ''),
            ('<default_value>0</default_value>', ''),
            ('<pennation_angle_at_optimal>0.1</pennation_angle_at_optimal>', ''),
        )
    )
    np.testing.assert_array_equal(model.body('upper').mass_center, np.zeros(3))
    assert model.joint('elbow').coordinates[0].default_value == 0.0
    assert model.muscles[0].pennation_angle == 0.0


def test_missing_file_is_named(tmp_path):
    with pytest.raises(OsimFormatError, match=r'nothing\.osim'):
        read_osim(tmp_path / 'nothing.osim')


def test_body_fixed_turns_follow_each_other():
    """Turning 90 degrees about x and then about the new y takes z to the old x."""
    rotation = body_fixed_xyz(np.array([np.pi / 2, np.pi / 2, 0.0]))
    np.testing.assert_allclose(rotation @ [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(rotation @ [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], atol=1e-15)
