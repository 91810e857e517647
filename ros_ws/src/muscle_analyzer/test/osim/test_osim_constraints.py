# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Constraints that are read, that hold already, and that are refused."""

import pytest

from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.osim.reader import read_osim

COUPLER = """<CoordinateCouplerConstraint name="follow"><isEnforced>{on}</isEnforced>
<coupled_coordinates_function><LinearFunction><coefficients>0.5 0.1</coefficients></LinearFunction>
</coupled_coordinates_function><independent_coordinate_names>{by}</independent_coordinate_names>
<dependent_coordinate_name>q2</dependent_coordinate_name><scale_factor>3</scale_factor>
</CoordinateCouplerConstraint>"""
WELD = """<{tag} name="loop"><isEnforced>true</isEnforced>
<socket_frame1>upper_point</socket_frame1><socket_frame2>/bodyset/lower</socket_frame2>
<frames><PhysicalOffsetFrame name="upper_point"><socket_parent>/bodyset/upper</socket_parent>
<translation>0 -0.3 0</translation></PhysicalOffsetFrame></frames></{tag}>"""


def lock(name):
    plain = f'<Coordinate name="{name}">'
    return plain, plain + '<locked>true</locked>'


def test_coupler_is_read_with_its_scale_factor(write_model):
    (coupler,) = read_osim(write_model(constraints=COUPLER.format(on='true', by='q1'))).couplers
    assert (coupler.independent, coupler.dependent) == ('q1', 'q2')
    assert coupler.function.derivatives(2.0) == pytest.approx((3.3, 1.5, 0.0))


def test_coupler_that_is_switched_off_is_listed(write_model):
    model = read_osim(write_model(constraints=COUPLER.format(on='false', by='q1')))
    assert model.couplers == ()
    assert 'CoordinateCouplerConstraint follow' in model.left_out


def test_coupler_of_two_or_unknown_coordinates_is_named(write_model):
    with pytest.raises(UnsupportedElementError, match='"follow">: a function of'):
        read_osim(write_model(constraints=COUPLER.format(on='true', by='q1 q2')))
    with pytest.raises(OsimFormatError, match="'follow': no coordinate 'q9'"):
        read_osim(write_model(constraints=COUPLER.format(on='true', by='q9')))


def test_weld_that_closes_a_loop_is_refused_unless_let_go(write_model):
    path = write_model(constraints=WELD.format(tag='WeldConstraint'))
    with pytest.raises(UnsupportedElementError, match='<WeldConstraint name="loop">'):
        read_osim(path)
    assert 'WeldConstraint loop' in read_osim(path, {'WeldConstraint'}).left_out


def test_weld_of_bodies_that_cannot_move_against_each_other_is_listed(write_model):
    path = write_model(lock('q2'), constraints=WELD.format(tag='WeldConstraint'))
    assert 'WeldConstraint loop' in read_osim(path).left_out
    # The shoulder moves both bodies: it does not matter whether it is locked.
    path = write_model(lock('q1'), constraints=WELD.format(tag='WeldConstraint'))
    with pytest.raises(UnsupportedElementError, match='WeldConstraint'):
        read_osim(path)


@pytest.mark.parametrize('tag', ['PointConstraint', 'ConstantDistanceConstraint'])
def test_other_constraints_are_named(write_model, tag):
    with pytest.raises(UnsupportedElementError, match=f'<{tag} name="loop">'):
        read_osim(write_model(lock('q2'), constraints=WELD.format(tag=tag)))
