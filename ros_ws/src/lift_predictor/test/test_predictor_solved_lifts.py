# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The library of solved lifts and the starts made of it."""

from __future__ import annotations

import numpy as np
import pytest

from human_model.tables import Row
from lift_predictor.core.bspline import RestToRestSpline
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.sagittal import solved_lifts as module
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.solved_lifts import library_starts, solved_lifts


def test_lifts_are_different_motions_of_a_person() -> None:
    lifts = solved_lifts()
    assert len(lifts) >= 3
    for number, lift in enumerate(lifts):
        assert lift.shape == (5, 6)
        assert np.all(np.abs(lift) < np.pi)
        for other in lifts[:number]:
            assert np.abs(lift - other).max() > 0.2


def test_starts_are_the_same_motion_on_another_spline() -> None:
    s = np.linspace(0.0, 1.0, 23)
    same, finer = RestToRestSpline(7), RestToRestSpline(11)
    for start, fine in zip(library_starts(same), library_starts(finer), strict=True):
        assert start.near and fine.near
        motion = same.basis(s) @ start.control
        np.testing.assert_allclose(finer.basis(s) @ fine.control, motion, atol=0.02)


def test_bad_lift_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    row = Row('lifts.csv', 2, {'lift': '1', **dict.fromkeys(JOINTS, '0')})
    monkeypatch.setattr(module, 'read_table', lambda package, name, columns: (row,))
    with pytest.raises(TaskError, match='lift 1 has 1 points, not 5'):
        solved_lifts.__wrapped__()
