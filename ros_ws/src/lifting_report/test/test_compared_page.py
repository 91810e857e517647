# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The page of two lifts from made-up data, complete and with parts missing."""

import numpy as np
import pytest

from lifting_report.compared import (
    ComparedLift,
    muscle_course,
    peak,
    published_limits,
    share_beyond,
)
from lifting_report.compared_page import render
from lifting_report.figures.loads import MuscleGroup, muscle_groups
from lifting_report.report_data import (
    Activations,
    GroundForces,
    Header,
    LiftReport,
    Missing,
    Pair,
    SpineCurves,
)

N = 101
TIME = np.linspace(0.0, 2.0, N)
BELL = np.sin(np.pi * TIME / 2.0) ** 2
EVIL = '<script>alert("x")</script>'
NOTHING = Pair(Missing('left out'), Missing('left out'))


def spine(compression, solved=None):
    none = np.full(N, np.nan)
    good = np.ones(N, bool) if solved is None else solved
    return SpineCurves(
        TIME, compression * BELL, 0.3 * compression * BELL, -80.0 * BELL, good, none, none,
        'bruno2015',
    )  # fmt: skip


def lift(name, compression, *, left=0.4, predicted=True, mass=63.5):
    muscles = ('vaslat_l', 'vaslat_r', 'glmax1_l', 'glmax2_l')
    activation = np.outer(BELL, [left, 0.2, 0.6, 0.2])
    activations = Activations(TIME, muscles, activation, np.ones(N, bool))
    ground = GroundForces(TIME, np.tile([0.0, 0.0, 300.0], (N, 2, 1)))
    second = {
        'spine': spine(0.8 * compression), 'activations': activations, 'ground': ground,
    } if predicted else {}  # fmt: skip
    gone = Missing('the prediction was infeasible')
    header = Header(
        'P07', 'male', mass, 1.69, 31.0, name, 'made up', name, 'made up', False, 7.0, 100.0, 0.2,
        1.0, 'offline', 'now', '0.1.0',
    )  # fmt: skip
    return ComparedLift(name, header, LiftReport(
        'lift_001', 0.0, 2.0, NOTHING, Missing(''),
        Pair(ground, second.get('ground', gone)), NOTHING,
        Pair(activations, second.get('activations', gone)),
        Pair(spine(compression), second.get('spine', gone)), NOTHING, NOTHING, Missing(''),
        Missing(''), Missing(''), Missing(''),
    ))  # fmt: skip


def test_peak_says_where_and_keeps_the_sign_of_lateral_shear():
    assert peak(spine(3000.0), 'compression') == pytest.approx((3000.0, 50.0))
    assert peak(spine(3000.0), 'lateral_shear') == pytest.approx((-80.0, 50.0))
    assert np.isnan(peak(Missing('none'), 'compression')).all()


def test_peak_and_share_leave_out_what_did_not_solve():
    solved = BELL < 0.5
    largest, _ = peak(spine(4000.0, solved), 'compression')
    assert largest == pytest.approx(4000.0 * BELL[solved].max())
    assert share_beyond(spine(4000.0, solved), 'compression', 2000.0) == 0.0
    whole = share_beyond(spine(4000.0), 'compression', 2000.0)
    assert whole == pytest.approx(50.0, abs=1.0)
    assert np.isnan(share_beyond(spine(4000.0, np.zeros(N, bool)), 'compression', 1.0))


def test_limits_are_the_published_ones():
    limits = published_limits()
    assert [line.value for line in limits['compression']] == [3400.0, 6400.0]
    assert [line.value for line in limits['anterior_shear']] == [1000.0, 700.0]
    assert limits['lateral_shear'] == ()


def test_course_is_the_mean_of_the_fascicles_of_one_side():
    compared = lift('a', 3000.0)
    group = MuscleGroup('Gluteus maximus', '^glmax[0-9]_')
    assert muscle_course(compared, 'measured', group, 'left').peak == pytest.approx(0.4)
    assert isinstance(muscle_course(compared, 'measured', group, 'right'), Missing)


@pytest.fixture(scope='module')
def page():
    """Return the page of two whole lifts, one of them with a name meant to break it."""
    return render((lift(EVIL, 3000.0), lift('turned', 3600.0, left=0.7)), 'now')


def test_differences_are_told_in_words(page):
    assert '600\u202fN (20%) higher' in page
    assert 'most up vastus lateralis left (+0.30)' in page
    assert 'on the left is 0.50 higher than on the right' in page
    assert 'Not equal' not in page
    assert page.count('<svg') == 4


def test_what_else_differs_and_what_is_missing_is_said():
    other = lift('b', 3600.0, predicted=False, mass=80.0)
    page = render((lift('a', 3000.0), other), 'now')
    assert '<strong>Not equal:</strong> the persons.' in page

    assert 'b, optimal: not available, the prediction was infeasible' in page
    assert 'nan' not in page.lower().replace('nano', '')


def test_without_any_prediction_no_figure_is_made_up():
    both = render(tuple(lift(name, 3000.0, predicted=False) for name in 'ab'), 'now')
    assert both.count('<svg') == 3


def test_names_from_outside_cannot_break_the_page(page):
    assert EVIL not in page
    assert page.count('<script>') == 1


def test_every_muscle_has_a_row_for_each_side(page):
    for group in muscle_groups():
        for side in ('left', 'right'):
            assert f'<td>{group.name}</td><td>{side}</td>' in page
