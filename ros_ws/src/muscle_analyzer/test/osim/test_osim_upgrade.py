# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A model in the format of OpenSim 3 is the model that it is in the format of OpenSim 4."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.model_codec import encode
from muscle_analyzer.core.osim.reader import read_osim

COORDINATE = """<Coordinate name="q{0}"><default_value>0.2</default_value>
<range>-1 2</range></Coordinate>"""
PATH_3 = """<PathPoint name="p1"><location>0.1 0 0</location><body>ground</body></PathPoint>
<ConditionalPathPoint name="p2"><location>0 -0.1 0</location><body>upper</body>
<range>-1 0.5</range><coordinate>q1</coordinate></ConditionalPathPoint>
<MovingPathPoint name="p3"><body>upper</body>{xyz}<x_coordinate>q1</x_coordinate>
<y_coordinate>q1</y_coordinate><z_coordinate>q1</z_coordinate></MovingPathPoint>"""
PATH_4 = """<PathPoint name="p1"><location>0.1 0 0</location>
<socket_parent_frame>/ground</socket_parent_frame></PathPoint>
<ConditionalPathPoint name="p2"><location>0 -0.1 0</location>
<socket_parent_frame>/bodyset/upper</socket_parent_frame>
<range>-1 0.5</range><socket_coordinate>/jointset/hinge/q1</socket_coordinate>
</ConditionalPathPoint><MovingPathPoint name="p3">
<socket_parent_frame>/bodyset/upper</socket_parent_frame>{xyz}
<socket_x_coordinate>q1</socket_x_coordinate><socket_y_coordinate>q1</socket_y_coordinate>
<socket_z_coordinate>q1</socket_z_coordinate></MovingPathPoint>"""
XYZ = ''.join(
    f'<{a}_location><LinearFunction><coefficients>0.0{i} -0.1</coefficients></LinearFunction>'
    f'</{a}_location>'
    for i, a in enumerate('xyz')
)
MUSCLE = """<{tag} name="flexor">{off}<GeometryPath><PathPointSet><objects>{points}</objects>
</PathPointSet></GeometryPath><max_isometric_force>500</max_isometric_force>
<optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.12</tendon_slack_length>
<pennation_angle_at_optimal>0.1</pennation_angle_at_optimal></{tag}>"""
COUPLER = """<CoordinateCouplerConstraint name="follow">{off}<coupled_coordinates_function>
<LinearFunction><coefficients>0.5 0</coefficients></LinearFunction></coupled_coordinates_function>
<independent_coordinate_names>q1</independent_coordinate_names>
<dependent_coordinate_name>q2</dependent_coordinate_name></CoordinateCouplerConstraint>"""
DRUM = """<WrapObjectSet><objects><WrapSphere name="{0}"><translation>0 0.1 0</translation>
<radius>0.05</radius></WrapSphere></objects></WrapObjectSet>"""
MASS = '<mass>2</mass><mass_center>0 -0.1 0</mass_center>'


def body_3(name, joint):
    moments = {'xx': 0.1, 'yy': 0.2, 'zz': 0.3, 'xy': 0.01, 'xz': 0.02, 'yz': 0.03}
    inertia = ''.join(f'<inertia_{ij}>{value}</inertia_{ij}>' for ij, value in moments.items())
    return f'<Body name="{name}">{MASS}{inertia}<Joint>{joint}</Joint>{DRUM.format(name)}</Body>'


def joint_3(name, number, parent, reverse='false'):
    return f"""<PinJoint name="{name}"><parent_body>{parent}</parent_body>
<location_in_parent>0.1 0.2 0.3</location_in_parent>
<orientation_in_parent>0.3 0.2 0.1</orientation_in_parent><location>0 0.5 0</location>
<orientation>0 0 0.4</orientation><CoordinateSet><objects>{COORDINATE.format(number)}</objects>
</CoordinateSet><reverse>{reverse}</reverse></PinJoint>"""


def joint_4(name, number, parent, child):
    return f"""<PinJoint name="{name}"><socket_parent_frame>a</socket_parent_frame>
<socket_child_frame>b</socket_child_frame><coordinates>{COORDINATE.format(number)}</coordinates>
<frames><PhysicalOffsetFrame name="a"><socket_parent>{parent}</socket_parent>
<translation>0.1 0.2 0.3</translation><orientation>0.3 0.2 0.1</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="b"><socket_parent>/bodyset/{child}</socket_parent>
<translation>0 0.5 0</translation><orientation>0 0 0.4</orientation></PhysicalOffsetFrame>
</frames></PinJoint>"""


def document(version, bodies, joints, forces, markers, off):
    return f"""<OpenSimDocument Version="{version}"><Model name="two">
<gravity>0 -9.81 0</gravity><BodySet><objects>{bodies}</objects></BodySet>{joints}
<ConstraintSet><objects>{COUPLER.format(off=off[1])}</objects></ConstraintSet>
<ForceSet><objects>{forces}{MUSCLE.format(tag='Schutte1993Muscle', off=off[0], points='')}
</objects></ForceSet><MarkerSet><objects>{markers}</objects></MarkerSet>
</Model></OpenSimDocument>"""


def version_3(reverse='false', joint=None):
    upper = joint_3('hinge', 1, 'ground', reverse) if joint is None else joint
    ground = f'<Body name="ground"><mass>0</mass><Joint/>{DRUM.format("floor")}</Body>'
    muscle = MUSCLE.format(
        tag='Thelen2003Muscle', off='<isDisabled>false</isDisabled>', points=PATH_3.format(xyz=XYZ)
    )
    return document(
        30000,
        ground + body_3('upper', upper) + body_3('lower', joint_3('knee', 2, 'upper')),
        '',
        muscle,
        '<Marker name="m"><body>lower</body><location>0 1 0</location></Marker>',
        ('<isDisabled>true</isDisabled>', '<isDisabled>false</isDisabled>'),
    )


def version_4():
    inertia = '<inertia>0.1 0.2 0.3 0.01 0.02 0.03</inertia>'
    bodies = ''.join(
        f'<Body name="{name}">{MASS}{inertia}{DRUM.format(name)}</Body>'
        for name in ('upper', 'lower')
    )
    joints = joint_4('hinge', 1, '/ground', 'upper')
    joints += joint_4('knee', 2, '/bodyset/upper', 'lower')
    muscle = MUSCLE.format(
        tag='Thelen2003Muscle',
        off='<appliesForce>true</appliesForce>',
        points=PATH_4.format(xyz=XYZ),
    )
    marker = '<socket_parent_frame>/bodyset/lower</socket_parent_frame><location>0 1 0</location>'
    sets = f'<Ground name="ground">{DRUM.format("floor")}</Ground>'
    sets += f'<JointSet><objects>{joints}</objects></JointSet>'
    return document(
        40000,
        bodies,
        sets,
        muscle,
        f'<Marker name="m">{marker}</Marker>',
        ('<appliesForce>false</appliesForce>', '<isEnforced>true</isEnforced>'),
    )


def test_both_formats_give_one_model(tmp_path):
    path = tmp_path / 'model.osim'
    results = []
    for text in (version_3(), version_4()):
        path.write_text(text, encoding='utf-8')
        results.append(encode(read_osim(path)))
    (structure_3, numbers_3), (structure_4, numbers_4) = results
    assert structure_3 == structure_4
    np.testing.assert_array_equal(numbers_3, numbers_4)
    assert '"Schutte1993Muscle flexor"' in structure_3


@pytest.mark.parametrize(
    ('text', 'error', 'named'),
    [
        (version_3(reverse='true'), UnsupportedElementError, 'name="hinge"> <reverse>'),
        (version_3(joint=''), OsimFormatError, '<Body name="upper"> has no <Joint>'),
        (version_3().replace('"30000"', '"20302"'), OsimFormatError, "Version='20302'"),
        (version_3().replace('"30000"', '"30501"'), OsimFormatError, "Version='30501'"),
        (
            version_3().replace('<parent_body>ground', '<parent_body>hip'),
            OsimFormatError,
            "there is no frame '/bodyset/hip'",
        ),
    ],
)
def test_what_cannot_be_rewritten_is_named(tmp_path, text, error, named):
    path = tmp_path / 'model.osim'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(error, match=named):
        read_osim(path)
