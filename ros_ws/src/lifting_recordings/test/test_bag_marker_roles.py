# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker names of the common conventions are known, in all their spellings."""

import numpy as np
import pytest

from lifting_recordings.exceptions import ConventionError
from lifting_recordings.marker_roles import MarkerRoles, known_role

# Names of one convention: pelvis front, pelvis back, heel, toe, trunk, of the right side.
CONVENTIONS = {
    'Plug-in Gait': ('RASI', 'RPSI', 'RHEE', 'RTOE', 'RSHO'),
    'OpenCap laboratory': ('r.ASIS', 'r.PSIS', 'r_calc', 'r_toe', 'R_Shoulder'),
    'OpenCap augmented': (
        'r.ASIS_study', 'r.PSIS_study', 'r_calc_study', 'r_toe_study', 'r_shoulder_study',
    ),
    'Pose2Sim': (None, None, 'RHeel', 'RBigToe', 'RShoulder'),
    'CAST': ('R_IAS', 'R_IPS', 'R_FCC', 'R_FM2', 'R_SAE'),
    'BTS': ('r asis', None, 'r heel', 'r met', 'r should'),
    'OpenSim gait2392': ('R.ASIS', None, 'R.Heel', 'R.Toe.Tip', 'R.Acromium'),
    'OpenSim Rajagopal': ('RASI', 'RPSI', 'RCAL', 'RMT1', 'RACR'),
    'words': ('Right ASIS', 'right_psis', 'R_Heel', 'R.Toe', 'RightShoulder'),
    'side behind': ('ASIS_R', 'PSIS.R', 'heel right', 'ToeR', 'shoulder-r'),
}  # fmt: skip
MIDDLE = {
    'C7': 'trunk', 'CLAV': 'trunk', 'C7_study': 'trunk', 'Neck': 'trunk', 'CV7': 'trunk',
    'SACR': 'pelvis_back', 'V.Sacral': 'pelvis_back', 'sacrum': 'pelvis_back',
}  # fmt: skip
ROLES = ('pelvis_front', 'pelvis_back', 'heel', 'toe', 'trunk')
SWAP = str.maketrans('Rr', 'Ll')


def left_of(name: str) -> str:
    for right, left in (('Right', 'Left'), ('right', 'left')):
        if right in name:
            return name.replace(right, left)
    if name[0] in 'Rr':
        return name[0].translate(SWAP) + name[1:]
    return name[:-1] + name[-1].translate(SWAP)


@pytest.mark.parametrize('names', CONVENTIONS.values(), ids=CONVENTIONS)
def test_names_of_a_convention_have_their_roles(names):
    for role, name in zip(ROLES, names, strict=True):
        if name is None:
            continue
        kind = 'forefoot' if name == 'RMT1' else role
        assert known_role(name) == (kind, 'right'), name
        assert known_role(left_of(name)) == (kind, 'left'), left_of(name)


def test_markers_in_the_middle():
    for name, role in MIDDLE.items():
        assert known_role(name) == (role, 'middle')


@pytest.mark.parametrize(
    'name', ['HEEL', 'LKNE', 'RTHI', 'LHLX', 'RFIN', 'BOX1', 'STRN', 'L1', 'RELB', 'head', 'T10']
)
def test_other_names_have_no_role(name):
    assert known_role(name) is None


def test_forefoot_stands_in_for_the_toe_only_where_there_is_none():
    positions = np.arange(9.0).reshape(1, 3, 3)
    roles = MarkerRoles(('RTOE', 'RMT5', 'LMT5'))
    np.testing.assert_array_equal(roles.mean(positions, 'toe', 'right'), positions[:, 0])
    np.testing.assert_array_equal(roles.mean(positions, 'toe', 'left'), positions[:, 2])


def test_missing_role_says_what_to_write():
    names = tuple(f'M{i}' for i in range(60))
    with pytest.raises(ConventionError) as error:
        MarkerRoles(names).require(np.zeros((1, 60, 3)), 'heel', 'left')
    assert 'recording: {roles: {MARKER: heel left}}' in str(error.value)
    assert 'M11 and 48 more' in str(error.value)
