# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Chain tables: transformations, and every joint axis and sign against anatomy and OpenSim."""

from pathlib import Path

import numpy as np
import pytest

from human_model import dh
from human_model.dh import DHRow, dh_transform, load_chain
from human_model.exceptions import ChainError, TableError
from human_model.tables import Row, read_file

UP, DOWN, FORWARD, BACK = (2, 1), (2, -1), (0, 1), (0, -1)
LEFT, RIGHT = (1, 1), (1, -1)
STEP = 0.1

#: Which way a point goes, seen from the pelvis, when a coordinate grows from the neutral posture.
#: Names without a side hold for both sides; IN is towards the midline.
IN, OUT = (1, 'in'), (1, 'out')
MOVES = {
    'pelvis_tx': ('c7', FORWARD),
    'pelvis_ty': ('c7', UP),
    'pelvis_tz': ('c7', RIGHT),
    'pelvis_tilt': ('c7', BACK),
    'pelvis_list': ('c7', RIGHT),
    'pelvis_rotation': ('toe', LEFT),
    'lumbar_extension': ('c7', BACK),
    'lumbar_bending': ('c7', RIGHT),
    'thorax_extension': ('c7', BACK),
    'thorax_bending': ('c7', RIGHT),
    'arm_flex': ('hand', FORWARD),
    'arm_add': ('hand', IN),
    'elbow_flex': ('hand', FORWARD),
    'wrist_flex': ('hand', IN),
    'wrist_dev': ('hand', BACK),
    'hip_flexion': ('toe', FORWARD),
    'hip_adduction': ('toe', IN),
    'hip_rotation': ('toe', IN),
    'knee_angle': ('toe', BACK),
    'ankle_angle': ('toe', UP),
    'mtp_angle': ('toe', DOWN),
}
#: Rotations that move no shared point in the neutral posture: world axis of the right side.
TURNS = {
    'lumbar_rotation': ('thorax', (0, 0, 1)),  # to the left
    'thorax_rotation': ('thorax', (0, 0, 1)),
    'arm_rot': ('upper_arm', (0, 0, 1)),  # inward
    'pro_sup': ('hand', (0, 0, 1)),  # pronation: the palm turns from the thigh to the back
    'subtalar_angle': ('foot', (1, 0, 0)),  # inversion: the sole turns to the midline
}


def base_and_side(coordinate):
    if coordinate[-2:] in ('_r', '_l'):
        return coordinate[:-2], coordinate[-1]
    return coordinate, ''


def test_every_coordinate_moves_as_anatomy_says(skeleton):
    start = skeleton.points(skeleton.standing())
    frames = skeleton.forward(skeleton.standing())
    for coordinate in skeleton.coordinates:
        base, side = base_and_side(coordinate)
        q = skeleton.standing()
        q[skeleton.index(coordinate)] += STEP
        if base in TURNS:
            segment, axis = TURNS[base]
            i = skeleton.parameters.index(f'{segment}_{side}' if side else segment)
            turned = skeleton.forward(q)[i, :3, :3] @ frames[i, :3, :3].T
            expected = np.array(axis, dtype=float) * (-1.0 if side == 'l' else 1.0)
            spin = (
                np.array(
                    [
                        turned[2, 1] - turned[1, 2],
                        turned[0, 2] - turned[2, 0],
                        turned[1, 0] - turned[0, 1],
                    ]
                )
                / 2
            )
            assert spin == pytest.approx(np.sin(STEP) * expected, abs=1e-12), coordinate
            continue
        point, (axis, sign) = MOVES[base]
        name = point if point == 'c7' else f'{point}_{side or "r"}'
        if sign in ('in', 'out'):
            sign = (1 if sign == 'in' else -1) * (1 if side == 'r' else -1)
        moved = skeleton.points(q)[name] - start[name]
        assert sign * moved[axis] > 0.005, coordinate
        assert sign * moved[axis] == pytest.approx(np.abs(moved).max()), coordinate


def test_only_what_hangs_on_a_joint_moves(body):
    start = body.points(body.standing())
    for coordinate, still in (
        ('elbow_flex_r', 'elbow_r'),
        ('knee_angle_l', 'knee_l'),
        ('lumbar_extension', 'l5_s1'),
        ('hip_flexion_r', 'toe_l'),
        ('ankle_angle_r', 'ankle_r'),
        ('mtp_angle_l', 'heel_l'),
        ('arm_add_l', 'hand_r'),
        ('pelvis_rotation', 'pelvis'),
    ):
        q = body.standing()
        q[body.index(coordinate)] += STEP
        assert body.points(q)[still] == pytest.approx(start[still], abs=1e-15)


def test_axes_agree_with_opensim(body):
    """Axis of each coordinate against OpenSim 4.6's, measured on the lifting full-body model.

    Ours are orthogonal; OpenSim's elbow, knee, ankle, subtalar and toe axes are oblique, so the
    angle between them is up to 38 degrees (subtalar), but the sign must be the same.
    """
    oblique = {
        'elbow_flex': 14,
        'knee_angle': 18,
        'ankle_angle': 12,
        'subtalar_angle': 39,
        'mtp_angle': 36,
        'pro_sup': 4,
        'wrist_flex': 4,
        'wrist_dev': 4,
    }
    renamed = {
        'L5_S1_Flex_Ext': 'lumbar_extension',
        'L5_S1_Lat_Bending': 'lumbar_bending',
        'L5_S1_axial_rotation': 'lumbar_rotation',
    }
    path = Path(__file__).parent / 'data' / 'opensim_joint_axes.csv'
    rows = read_file(path, 'coordinate x y z')
    assert len(rows) == 37
    for row in rows:
        name = renamed.get(row['coordinate'], row['coordinate'])
        theirs = np.array(row.numbers(*'xyz'))
        ours = body.tree.axis[body.index(name)]
        angle = np.degrees(np.arccos(np.clip(theirs @ ours, -1, 1)))
        assert angle < oblique.get(base_and_side(name)[0], 0.2), (name, angle)


def test_neutral_posture_is_upright_with_level_soles(skeleton):
    points = skeleton.points(skeleton.standing())
    for name in ('heel_r', 'toe_r', 'heel_l', 'toe_l'):
        assert points[name][2] == pytest.approx(0.0, abs=1e-12)
    assert points['head'][2] == pytest.approx(1.69, abs=1e-9)
    assert points['hand_r'][2] < points['pelvis'][2]
    assert points['toe_r'][0] > 0 > points['heel_r'][0]
    assert points['shoulder_l'][1] > 0 > points['shoulder_r'][1]
    for frame in skeleton.forward(skeleton.standing()):
        assert frame[:3, :3] == pytest.approx(np.eye(3), abs=1e-12)


def test_coordinates_are_in_the_named_order():
    arm = ('arm_flex', 'arm_add', 'arm_rot', 'elbow_flex', 'pro_sup', 'wrist_flex', 'wrist_dev')
    leg = (
        'hip_flexion',
        'hip_adduction',
        'hip_rotation',
        'knee_angle',
        'ankle_angle',
        'subtalar_angle',
        'mtp_angle',
    )
    lengths = dict.fromkeys(
        (
            'l5s1_forward',
            'l5s1_height',
            't12l1_forward',
            't12l1_height',
            'shoulder_forward',
            'shoulder_height',
            'shoulder_half_width',
            'c7_forward',
            'c7_height',
            'upper_arm',
            'forearm',
            'hand_grip',
            'hip_half_width',
            'thigh',
            'shank',
            'ankle_mtp',
            'mtp_drop',
            'toes',
        ),
        0.1,
    )
    assert load_chain('3d_40dof', lengths).coordinates == (
        'pelvis_tx',
        'pelvis_ty',
        'pelvis_tz',
        'pelvis_tilt',
        'pelvis_list',
        'pelvis_rotation',
        'lumbar_extension',
        'lumbar_bending',
        'lumbar_rotation',
        'thorax_extension',
        'thorax_bending',
        'thorax_rotation',
        *(f'{name}_r' for name in arm),
        *(f'{name}_l' for name in arm),
        *(f'{name}_r' for name in leg),
        *(f'{name}_l' for name in leg),
    )
    assert load_chain('2d_10dof', lengths).coordinates == (
        'pelvis_tx',
        'pelvis_ty',
        'pelvis_tilt',
        'lumbar_extension',
        'arm_flex',
        'elbow_flex',
        'hip_flexion',
        'knee_angle',
        'ankle_angle',
        'mtp_angle',
    )


def test_transform_is_the_product_of_its_four_motions(rng):
    theta, d, a, alpha = rng.normal(size=4)

    def about(axis, angle):
        matrix = np.eye(4)
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix[i, i] = matrix[j, j] = np.cos(angle)
        matrix[j, i], matrix[i, j] = np.sin(angle), -np.sin(angle)
        return matrix

    along_z, along_x = np.eye(4), np.eye(4)
    along_z[2, 3], along_x[0, 3] = d, a
    expected = about(2, theta) @ along_z @ along_x @ about(0, alpha)
    assert dh_transform(theta, d, a, alpha) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize('kind', ['revolute', 'prismatic'])
@pytest.mark.parametrize('sign', [1, -1])
def test_derivatives_by_finite_differences(kind, sign):
    row = DHRow('c', kind, -1, sign, 0.3, 0.2, 0.5, -0.7, '', '')
    first, second = row.derivatives(0.4)
    h = 1e-4
    plus, minus, here = row.transform(0.4 + h), row.transform(0.4 - h), row.transform(0.4)
    assert first == pytest.approx((plus - minus) / (2 * h), abs=1e-8)
    assert second == pytest.approx((plus - 2 * here + minus) / h**2, abs=1e-6)


ROW = {
    'row': '1',
    'coordinate': 'x',
    'kind': 'revolute',
    'parent': '0',
    'sign': '1',
    'theta': '0',
    'd': '0',
    'a': '0',
    'alpha': '0',
    'segment': '',
    'branch': '',
}


def tables(*rows):
    """Return a reader of tables that gives these rows."""
    found = tuple(Row('dh.csv', line, row) for line, row in enumerate(rows, 2))
    return lambda package, name, columns: found


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        ({'parent': '3'}, "'parent': rows .* follow their parents"),
        ({'kind': 'spherical'}, "'kind': .*'spherical'"),
        ({'coordinate': ''}, "'coordinate': a row of kind revolute .*''"),
        ({'sign': '2'}, "'sign': .*'2'"),
        ({'theta': 'pi/3'}, "'theta': .*'pi/3'"),
    ],
)
def test_bad_rows_are_named(monkeypatch, change, words):
    monkeypatch.setattr(dh, 'read_table', tables({**ROW, **change}))
    with pytest.raises(TableError, match=f'line 2, column {words}'):
        load_chain('3d_40dof', {})


def test_a_coordinate_may_not_occur_twice(monkeypatch):
    monkeypatch.setattr(dh, 'read_table', tables(ROW, {**ROW, 'row': '2'}))
    with pytest.raises(ChainError, match='twice'):
        load_chain('3d_40dof', {})
