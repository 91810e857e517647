# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Import with the static trial and the registration of the plates."""

from pathlib import Path

import numpy as np
import pytest

import lifting
from lifting_messages.names import split
from lifting_recordings.reader import BagReader

ROOT = Path(__file__).resolve().parents[4]
SQUATS = ROOT.parent / 'shared' / 'data' / 'squats_bodyweight'


@pytest.mark.skipif(not SQUATS.is_dir(), reason=f'the real recording is not at {SQUATS}')
def test_real_squats_import_with_one_call(tmp_path):
    report = lifting.import_recording(
        lifting.ImportOptions(
            markers=SQUATS / 'squats1.trc',
            forces=SQUATS / 'squats1_grf.mot',
            static=SQUATS / 'static1.trc',
            subject=ROOT / 'bags' / 'subjects' / 'squats_bodyweight.yaml',
            output=tmp_path / 'squats',
        )
    )
    assert report.messages['markers'] == 1346
    said = ' '.join(report.statements)
    assert 'ground_force_1: right foot' in said
    assert 'ground_force_2: left foot' in said
    assert '60.1 kg' in said
    assert 'Both plates were moved by +21 mm forward and +3 mm to the left' in said
    with BagReader(report.bag) as bag:
        subject = next(bag.messages(['/subject']))[2]
        first = next(bag.messages(['/markers']))[2]
    assert subject.calibration_rms < 0.005
    assert len(subject.marker_names) * 3 == subject.marker_offsets.size
    # Row 1 of the file: C7 at (-0.278799, 1.46173, -0.61037), x forward, y up, z right.
    c7 = first.positions.reshape(-1, 3)[split(first.names).index('C7')]
    np.testing.assert_allclose(c7, (-0.278799, 0.61037, 1.46173), atol=1e-9)
