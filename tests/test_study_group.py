# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated group of the Pareto study."""

import numpy as np
import pytest
from bags.simulate.group import (
    AGE_RANGE,
    GROUP_SIZE,
    MASS,
    STATURE,
    lifting_task,
    simulated_lift,
    study_group,
)


def test_group_has_the_published_statures_and_masses():
    group = study_group()
    assert len(group) == GROUP_SIZE == 12
    for name, (mean, deviation) in (('stature', STATURE), ('mass', MASS)):
        values = [getattr(subject, name) for subject in group]
        assert np.mean(values) == pytest.approx(mean, rel=1e-4)
        assert np.std(values, ddof=1) == pytest.approx(deviation, rel=1e-2)
    assert all(AGE_RANGE[0] <= subject.age <= AGE_RANGE[1] for subject in group)
    assert {subject.sex for subject in group} == {'male'}


def test_same_seed_same_group():
    first, again, other = study_group(), study_group(), study_group(seed=1)
    assert [s.to_dict() for s in first] == [s.to_dict() for s in again]
    assert [s.mass for s in first] != [s.mass for s in other]


def test_simulated_lift_carries_person_and_box():
    subject = study_group()[0]
    task = lifting_task('symmetric_max')
    lift = simulated_lift(subject, task)
    motion = lift.window
    assert lift.box_mass == task.box_mass
    assert (motion.time[0], motion.time[-1]) == pytest.approx((lift.start, lift.end))
    impulse = np.trapezoid(motion.ground_force.sum(axis=1), motion.time, axis=0)[2]
    weight = (subject.mass + task.box_mass) * 9.80665
    # The box is slowed at the end of the lift.
    assert impulse / (lift.end - lift.start) == pytest.approx(weight, rel=0.05)
    assert 'simulated' in lift.report.message
