# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker sets: the files themselves, scaling, and refusal of damaged ones."""

import numpy as np
import pytest

from human_model.anthropometry import segment_lengths
from human_model.exceptions import TableError
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from motion_tracker.core.exceptions import MarkerSetError
from motion_tracker.core.markers.joint_centres import joint_centres, load_joint_definitions
from motion_tracker.core.markers.marker_model import from_anthropometry
from motion_tracker.core.markers.marker_set import (
    COLUMNS,
    DATA,
    REFERENCE_SUBJECT,
    available,
    load_marker_set,
    mirror_name,
)

HEADER = COLUMNS.replace(' ', ',')


def test_the_sets_have_the_size_their_names_say():
    assert available() == ('opencap_lab_51', 'plug_in_gait_39', 'plug_in_gait_58')
    assert len(load_marker_set('plug_in_gait_58').names) == 58
    # Six medial landmarks that are not worn, and SACR in place of LPSI and RPSI.
    assert len(load_marker_set('plug_in_gait_39').names) == 39 + 6 + 1
    # Four medial markers more, worn in the static trial only.
    assert len(load_marker_set('opencap_lab_51').names) == 51 + 4


@pytest.mark.parametrize('name', available())
def test_every_marker_sits_on_a_segment_of_the_skeleton_and_names_its_source(name):
    segments = Skeleton3D.of(REFERENCE_SUBJECT).segments
    for marker in load_marker_set(name).markers:
        assert marker.segment in segments
    rows = (DATA / 'marker_sets' / f'{name}.csv').read_text(encoding='utf-8').splitlines()[1:]
    assert all(
        'placement' in row and ('position' in row or 'ANSUR' in row or 'de Leva' in row)
        for row in rows
    )


def test_joint_centres_of_the_marker_set_are_those_of_the_skeleton(person, skeleton, marker_set):
    """Landmarks and skeleton describe one anatomy, also for other than the reference person."""
    frames = skeleton.forward(np.zeros(len(skeleton.coordinates)))
    markers = {}
    for name, local in marker_set.positions(skeleton.parameters.lengths).items():
        frame = frames[skeleton.segments.index(marker_set.marker(name).segment)]
        markers[name] = frame[:3, :3] @ local + frame[:3, 3]
    points = skeleton.points(np.zeros(len(skeleton.coordinates)))
    definitions = [
        d for d in load_joint_definitions(marker_set) if not d.joint.startswith('shoulder')
    ]
    for joint, centre in joint_centres(tuple(definitions), markers, {}).items():
        if joint.startswith('hip'):
            # Harrington's regression puts the hips wider than the model's: sagittal plane only.
            assert centre[[0, 2]] == pytest.approx(points[joint][[0, 2]], abs=5e-3), joint
        else:
            assert centre == pytest.approx(points[joint], abs=1e-3), joint


def test_positions_scale_with_the_lengths_they_name(marker_set):
    small = Subject('small', 'female', 52.0, 1.55, 30.0)
    reference = marker_set.positions(segment_lengths(REFERENCE_SUBJECT)[0])
    scaled = marker_set.positions(segment_lengths(small)[0])
    for marker in marker_set.markers:
        assert reference[marker.name] == pytest.approx(marker.position)
    ratio = segment_lengths(small)[0]['thigh'] / segment_lengths(REFERENCE_SUBJECT)[0]['thigh']
    assert scaled['LKNE'] == pytest.approx(reference['LKNE'] * ratio)


def test_left_and_right_are_mirrored_where_the_set_does_not_say_otherwise(marker_set):
    for marker in marker_set.markers:
        other = mirror_name(marker.name, marker_set.names)
        if marker.name[0] != 'L' or marker.name[1:] in ('1', 'UPA', 'FRM', 'THI', 'TIB'):
            continue
        assert other is not None
        twin = marker_set.marker(other)
        assert np.array(twin.position) == pytest.approx(np.array(marker.position) * [1, -1, 1])


@pytest.mark.parametrize(
    ('name', 'mirrored'),
    [
        ('LKNE', 'RKNE'),
        ('RKNE', 'LKNE'),
        ('r_knee', 'L_knee'),
        ('L.ASIS', 'r.ASIS'),
        ('C7', None),
        ('RBAK', None),
    ],
)
def test_mirror_names(name, mirrored):
    names = ('LKNE', 'RKNE', 'L_knee', 'r_knee', 'L.ASIS', 'r.ASIS', 'C7', 'RBAK')
    assert mirror_name(name, names) == mirrored


@pytest.mark.parametrize(
    ('row', 'words'),
    [
        ('A,pelvis,0.1,0,x,thigh,1,yes', "'z': a number .*'x'"),
        ('A,pelvis,0.1,0,,thigh,1,yes', "'z': a number .*''"),
        ('A,pelvis,0.1,0,0,thihg,1,yes', "'scale_with': 'thihg' is no segment length"),
        ('A,pelvis,0.1,0,0,thigh,-1,yes', "'weight': .*'-1'"),
        ('A,pelvis,0.1,0,0,thigh,1,maybe', "'tracking': .*'maybe'"),
        ('A,pelvis,0.1,0,0,thigh shank,1,yes', "'scale_with': one or three"),
    ],
)
def test_damaged_files_are_refused_by_file_line_and_field(tmp_path, row, words):
    path = tmp_path / 'own_set.csv'
    path.write_text(f'{HEADER}\n{row}\n', encoding='utf-8')
    with pytest.raises(TableError, match=rf'own_set\.csv, line 2, column {words}'):
        load_marker_set(path)


def test_a_marker_may_not_occur_twice(tmp_path):
    path = tmp_path / 'own_set.csv'
    row = 'A,pelvis,0,0,0,thigh,1,yes\n'
    path.write_text(f'{HEADER}\n{row}{row}', encoding='utf-8')
    with pytest.raises(MarkerSetError, match=r"own_set\.csv: marker 'A' occurs 2"):
        load_marker_set(path)


def test_missing_column_and_unknown_set_are_named(tmp_path):
    path = tmp_path / 'own_set.csv'
    path.write_text('marker,segment\nA,pelvis\n', encoding='utf-8')
    with pytest.raises(TableError, match=r"own_set\.csv, line 1, column 'x'"):
        load_marker_set(path)
    with pytest.raises(MarkerSetError, match='plug_in_gait_58'):
        load_marker_set('plug_in_gate')


def test_a_set_without_positions_needs_a_static_trial(tmp_path, person):
    path = tmp_path / 'own_set.csv'
    path.write_text(f'{HEADER}\nA,pelvis,,,,,1,yes\n', encoding='utf-8')
    with pytest.raises(MarkerSetError, match='static trial'):
        from_anthropometry(load_marker_set(path), person)
