# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A known strength is found again from the weight that it can lift."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.exceptions import PercentileError
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.percentile import (
    WEIGHT_TOLERANCE,
    StrengthSearch,
    percentile_by_enumeration,
    percentile_by_root,
)
from lift_predictor.core.predictor import LiftPredictor

SIZE = (0.238, 0.305, 0.127)
Z = 0.8


@pytest.fixture(scope='module')
def known(subject: Subject, make_lift):
    """Return a lift and the largest box that a man of strength_z = 0.8 lifts so."""
    strong = LiftPredictor()
    lift = make_lift(7.0)
    result = strong.maximum_weight(replace(subject, strength_z=Z), lift, Box(7.0, SIZE))
    assert result.report.ok
    return lift, Box(result.mass, SIZE)


@pytest.fixture(scope='module')
def by_root(subject: Subject, predictor: LiftPredictor, known):
    return percentile_by_root(predictor, subject, *known)


def test_known_strength_is_found_again(by_root, known) -> None:
    assert by_root.z_score == pytest.approx(Z, abs=0.02)
    assert by_root.predicted == pytest.approx(by_root.measured, abs=WEIGHT_TOLERANCE)
    assert by_root.measured == pytest.approx(known[1].mass * 9.80665)
    assert by_root.prediction.report.ok
    assert by_root.percentile == pytest.approx(78.8, abs=0.7)


def test_a_prediction_with_the_found_strength_is_the_same(by_root, subject, known) -> None:
    again = LiftPredictor()
    result = again.maximum_weight(replace(subject, strength_z=by_root.z_score), *known)
    assert result.weight == pytest.approx(by_root.predicted, rel=1e-6)


def test_enumeration_gives_the_same_to_its_step(subject, predictor, known, by_root) -> None:
    step = 0.5
    found = percentile_by_enumeration(predictor, subject, *known, step=step)
    assert found.z_score == pytest.approx(round(by_root.z_score / step) * step)
    assert len(found.tried) > len(by_root.tried) / 2
    z, weight = np.array(found.tried).T
    np.testing.assert_allclose(np.diff(z), step)
    lifted = weight[np.isfinite(weight)]
    assert np.all(np.diff(lifted) > 0.0), 'the stronger lift more'
    assert np.isnan(weight[: len(weight) - len(lifted)]).all()


def test_the_starting_strength_does_not_matter(subject, known, by_root) -> None:
    weak = replace(subject, strength_z=-1.0)
    assert percentile_by_root(LiftPredictor(), weak, *known).z_score == pytest.approx(
        by_root.z_score, abs=0.02
    )


def test_impossible_weights_are_refused(subject, predictor, make_lift) -> None:
    with pytest.raises(PercentileError, match=r'60 kg .* no plausible strength'):
        percentile_by_root(predictor, subject, make_lift(7.0), Box(60.0, SIZE))


def test_plausible_range_leaves_every_joint_its_strength(predictor, known, subject) -> None:
    search = StrengthSearch(predictor, subject, *known)
    low, high = search.range
    assert low < 0.0 < high
    for z in (low, high):
        person = Person.of(replace(subject, strength_z=z))
        parameters = search.task_of(z).parameters
        np.testing.assert_allclose(parameters.strength_upper, person.strength_upper, atol=1e-12)
        np.testing.assert_allclose(parameters.strength_lower, person.strength_lower, atol=1e-12)
        assert np.all(person.strength_upper[:, 7] > 0.0)
        assert np.all(person.strength_lower[:, 7] < 0.0)
