# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Models and recordings that several tests use."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.exceptions import ModelFileError
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.multibody.inverse_dynamics import add_force
from muscle_analyzer.core.multibody.model import MultibodyModel, compile_model
from muscle_analyzer.core.opensim_bridge.derivatives import differentiate, smooth
from muscle_analyzer.core.opensim_bridge.motion_on_model import motion_on_model
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.subject.model_file import lifting_model_path

SQUATS = Path(__file__).resolve().parents[5] / 'shared' / 'data' / 'squats_bodyweight'

BODY = """
<Body name="{name}"><mass>{mass}</mass><mass_center>0 {centre} 0</mass_center>
<inertia>{inertia} 0.001 {inertia} 0 0 0</inertia>{extra}</Body>"""

PIN = """
<PinJoint name="{name}">
  <socket_parent_frame>{parent}_offset</socket_parent_frame>
  <socket_child_frame>{child}_offset</socket_child_frame>
  <coordinates><Coordinate name="{coordinate}"><default_value>0</default_value>
    <range>-3 3</range><clamped>true</clamped></Coordinate></coordinates>
  <frames>
    <PhysicalOffsetFrame name="{parent}_offset"><socket_parent>{parent_path}</socket_parent>
      <translation>0 {height} 0</translation><orientation>0 0 0</orientation>
    </PhysicalOffsetFrame>
    <PhysicalOffsetFrame name="{child}_offset"><socket_parent>/bodyset/{child}</socket_parent>
      <translation>0 0 0</translation><orientation>0 0 0</orientation></PhysicalOffsetFrame>
  </frames>
</PinJoint>"""

MUSCLE = """
<DeGrooteFregly2016Muscle name="flexor">
  <GeometryPath name="path"><PathPointSet><objects>
    <PathPoint name="p1"><socket_parent_frame>/ground</socket_parent_frame>
      <location>0.1 0 0</location></PathPoint>
    <PathPoint name="p2"><socket_parent_frame>/bodyset/upper</socket_parent_frame>
      <location>0.02 -0.2 0</location></PathPoint>
  </objects></PathPointSet></GeometryPath>
  <max_isometric_force>500</max_isometric_force>
  <optimal_fiber_length>0.1</optimal_fiber_length>
  <tendon_slack_length>0.12</tendon_slack_length>
  <pennation_angle_at_optimal>0.1</pennation_angle_at_optimal>
  <max_contraction_velocity>10</max_contraction_velocity>
  <ignore_tendon_compliance>true</ignore_tendon_compliance>
</DeGrooteFregly2016Muscle>"""

COUPLER = """
<CoordinateCouplerConstraint name="follow"><isEnforced>true</isEnforced>
  <coupled_coordinates_function><PolynomialFunction><coefficients>0.4 -0.3 0.1</coefficients>
  </PolynomialFunction></coupled_coordinates_function>
  <independent_coordinate_names>q1</independent_coordinate_names>
  <dependent_coordinate_name>q2</dependent_coordinate_name>
  <scale_factor>1</scale_factor></CoordinateCouplerConstraint>"""

UPPER = {'mass': 2.0, 'centre': -0.15, 'inertia': 0.02, 'length': 0.3}
LOWER = {'mass': 1.5, 'centre': -0.2, 'inertia': 0.03}
CYLINDER = """
<WrapObjectSet><objects><WrapCylinder name="drum"><active>true</active>
<xyz_body_rotation>0 0 0</xyz_body_rotation><translation>0 -0.1 0</translation>
<quadrant>all</quadrant><radius>0.02</radius><length>0.1</length></WrapCylinder></objects>
</WrapObjectSet>"""


def pendulum_text(constraints='', forces=MUSCLE, version='40000', elbow_first=False):
    """Return a model of two links that hang on the ground, pinned about z."""
    upper = BODY.format(name='upper', extra=CYLINDER, **UPPER)
    lower = BODY.format(name='lower', extra='', **LOWER)
    shoulder = PIN.format(
        name='shoulder',
        parent='ground',
        child='upper',
        parent_path='/ground',
        height=0,
        coordinate='q1',
    )
    elbow = PIN.format(
        name='elbow',
        parent='upper',
        child='lower',
        parent_path='/bodyset/upper',
        height=-UPPER['length'],
        coordinate='q2',
    )
    joints = elbow + shoulder if elbow_first else shoulder + elbow
    return f"""<?xml version="1.0"?><OpenSimDocument Version="{version}"><Model name="pendulum">
<gravity>0 -9.81 0</gravity><Ground name="ground"/>
<BodySet><objects>{upper}{lower}</objects></BodySet>
<JointSet><objects>{joints}</objects></JointSet>
<ConstraintSet><objects>{constraints}</objects></ConstraintSet>
<ForceSet><objects>{forces}</objects></ForceSet>
<ContactGeometrySet><objects><ContactSphere name="ball"/></objects></ContactGeometrySet>
<MarkerSet><objects><Marker name="tip"><socket_parent_frame>/bodyset/lower</socket_parent_frame>
<location>0 -0.4 0</location></Marker></objects></MarkerSet></Model></OpenSimDocument>"""


@pytest.fixture
def write_model(tmp_path):
    """Return a function that writes a pendulum, some text in it replaced, and gives its path."""

    def write(*replaced, **options):
        text = pendulum_text(**options)
        for old, new in replaced:
            assert old in text, old
            text = text.replace(old, new)
        path = tmp_path / 'model.osim'
        path.write_text(text, encoding='utf-8')
        return path

    return write


@pytest.fixture
def pendulum(write_model):
    return compile_model(read_osim(write_model()))


@pytest.fixture
def coupled_pendulum(write_model):
    return compile_model(read_osim(write_model(constraints=COUPLER)))


@pytest.fixture(scope='session')
def lifting_model():
    """Return the lifting full-body model of the pose2sim wheel as read."""
    try:
        path = lifting_model_path()
    except ModelFileError as error:
        pytest.skip(str(error))
    return read_osim(path)


@pytest.fixture(scope='session')
def lifting_multibody(lifting_model):
    return compile_model(lifting_model)


def read_storage(path):
    """Return column names and numbers of an OpenSim storage file."""
    lines = path.read_text(encoding='utf-8').splitlines()
    end = next(i for i, line in enumerate(lines) if line.strip() == 'endheader')
    numbers = [[float(x) for x in line.split()] for line in lines[end + 2 :] if line.strip()]
    return lines[end + 1].split(), np.array(numbers)


@dataclass(frozen=True)
class Squats:
    """The squat recording on OpenSim's scaled model, with OpenSim's inverse kinematics."""

    model: MultibodyModel
    time: np.ndarray
    q: np.ndarray
    qd: np.ndarray
    qdd: np.ndarray
    external: np.ndarray

    def reference(self, name):
        """Return names and numbers of one of OpenSim's result files."""
        return read_storage(SQUATS / 'opensim46_reference' / name)

    def sample(self, time):
        """Return the number of the sample at a time."""
        return int(np.argmin(np.abs(self.time - time)))


@pytest.fixture(scope='session')
def squats():
    if not SQUATS.is_dir():
        pytest.skip(f'the squat recording is not beside the repository ({SQUATS})')
    model = compile_model(read_osim(SQUATS / 'opensim46_reference' / 'lfb_subject4.osim'))
    names, motion = read_storage(SQUATS / 'opensim46_reference' / 'ik.mot')
    time = motion[:, 0]
    turns = np.array([not n.endswith(('_tx', '_ty', '_tz')) for n in model.coordinate_names])
    q = motion[:, [names.index(n) for n in model.coordinate_names]]
    q = smooth(time, q * np.where(turns, np.pi / 180.0, 1.0), 6.0)
    names, plates = read_storage(SQUATS / 'squats1_grf.mot')
    plates = plates[np.searchsorted(plates[:, 0], time - 1e-6)]
    external = np.zeros((time.size, len(model.body_names), 6))
    for body, plate in (('calcn_r', 1), ('calcn_l', 2)):
        force, point, moment = (
            plates[:, [names.index(f'ground_force_{plate}_{kind}{a}') for a in 'xyz']]
            for kind in 'vpm'
        )
        for i in range(time.size):
            add_force(external[i], model.body_index(body), force[i], point[i], moment[i])
    return Squats(model, time, q, *differentiate(time, q), external)


@dataclass(frozen=True)
class BoxLift:
    """A short part of a lift: its analyzer, the body motion, and that on the model."""

    analyzer: MuscleAnalyzer
    body: object
    motion: object


@pytest.fixture(scope='session')
def box_lift():
    """Return 0.3 s of rising with a box; the left foot leaves the ground at the end."""
    subject = Subject('p01', 'male', 63.5, 1.69, 25)
    try:
        analyzer = MuscleAnalyzer(subject, MuscleAnalyzerOptions().as_opensim())
    except ModelFileError as error:
        pytest.skip(str(error))
    skeleton = Skeleton3D.of(subject)
    bend = {
        'hip_flexion_r': 0.9, 'hip_flexion_l': 0.85, 'knee_angle_r': 0.8, 'knee_angle_l': 0.75,
        'ankle_angle_r': 0.2, 'ankle_angle_l': 0.2, 'lumbar_extension': -0.4, 'arm_flex_r': 0.6,
        'arm_flex_l': 0.55, 'lumbar_bending': 0.05, 'pelvis_tilt': -0.2,
    }  # fmt: skip
    standing = skeleton.standing()
    by = skeleton.vector(bend, standing) - standing
    time = 0.01 * np.arange(31)
    phase = 2.0 * time[:, None]
    q = standing + by * np.cos(phase)
    force = np.zeros((time.size, 2, 3))
    force[:, :, 2] = [420.0, 400.0]
    force[:, :, 0] = [8.0, -5.0]
    points = skeleton.body_motion(time, q, 0.0 * q, 0.0 * q)
    cop = np.stack([points.point('mtp_r'), points.point('mtp_l')], axis=1)
    cop[:, :, 2] = 0.0
    force[-3:, 1] = 0.0
    cop[-3:, 1] = np.nan
    hand = np.zeros((time.size, 2, 3))
    hand[:, :, 2] = [-62.0, -58.0]
    hand[:, :, 1] = [3.0, -3.0]
    moment = np.zeros((time.size, 2, 3))
    moment[:, 0, 2] = 1.5
    body = skeleton.body_motion(
        # Stamps as of a recording: seconds since 1970.
        1.7e9 + time, q, -2.0 * by * np.sin(phase), -4.0 * by * np.cos(phase),
        ground_force=force, centre_of_pressure=cop, hand_force=hand, free_moment=moment,
    )  # fmt: skip
    motion = motion_on_model(analyzer.new_transfer(body.skeleton), body, 1.7e9)
    return BoxLift(analyzer, body, motion)
