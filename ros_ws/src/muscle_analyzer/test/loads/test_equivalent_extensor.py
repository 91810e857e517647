# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compression with one equivalent extensor: by hand, and of an analysed lift."""

import numpy as np
import pytest

from muscle_analyzer.core.loads.equivalent_extensor import (
    equivalent_compression,
    equivalent_l5_s1_compression,
)


def test_by_hand():
    """Extension of 100 N m over 50 mm are 2000 N; the trunk's 400 N rest on the disc too."""
    force = np.array([[50.0, 0.0, 400.0]] * 3)
    moment = np.array([[0.0, -100.0, 0.0], [0.0, 0.0, 0.0], [0.0, 10.0, 3.0]])
    assert equivalent_compression(force, moment) == pytest.approx([2400.0, 400.0, 600.0])


def test_of_a_lift(box_lift):
    """The axial net force is that of the reaction without the pull of the muscles."""
    analysis = box_lift.analyzer.analyze(box_lift.body, 'lift', 'measured')
    found = equivalent_l5_s1_compression(analysis)
    axial = analysis.joint_net_force[:, 0, 2]
    extension = -analysis.joint_net_moment[:, 0, 1]
    assert (extension > 50.0).all()
    assert found == pytest.approx(axial + extension / 0.05)
    # Shorter arms of the model's muscles: its own compression is higher.
    assert (analysis.compression > found).all()
