# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""C3D: a file written with ezc3d, two type-2 plates and EMG, comes back in SI and graph axes."""

import ezc3d
import numpy as np
import pytest

from lifting_recordings.alignment import ConventionOptions, align
from lifting_recordings.c3d_files import read_c3d
from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.importer import ImportOptions, read_recording, write_bag
from lifting_recordings.plate_assignment import Carried
from lifting_recordings.reader import BagReader

RATE, RATIO = 100.0, 10
# Corners of the plates in laboratory axes [mm]; the plate's z points down, as C3D plates have it.
CORNERS = {
    'fp1': [(200, -10, 0), (200, -410, 0), (-200, -410, 0), (-200, -10, 0)],
    'fp2': [(200, 410, 0), (200, 10, 0), (-200, 10, 0), (-200, 410, 0)],
}


def import_recording(options):
    """Import without the steps of `lifting.import_recording` that need other packages."""
    return write_bag(options, read_recording(options))


def plate_axes(corners: np.ndarray) -> np.ndarray:
    """Return the plate's axes as columns: C3D manual, FORCE_PLATFORM:CORNERS."""
    x = corners[0] + corners[3] - corners[1] - corners[2]
    y = corners[0] + corners[1] - corners[2] - corners[3]
    x, y = x / np.linalg.norm(x), y / np.linalg.norm(y)
    return np.stack((x, y, np.cross(x, y)), axis=1)


@pytest.fixture
def file(standing, tmp_path):
    """Write the standing figure as a C3D file (mm, N, Nmm) with prefix and EMG."""
    raw = standing.raw
    n = raw.time.size
    c3d = ezc3d.c3d()
    p = c3d['parameters']
    p['POINT']['RATE']['value'] = [RATE]
    p['POINT']['LABELS']['value'] = [f'S1:{name}' for name in raw.names]
    p['POINT']['UNITS']['value'] = ['mm']
    points = np.ones((4, len(raw.names), n))
    points[:3] = raw.positions.transpose(2, 1, 0) * 1000.0
    channels = []
    for plate in raw.plates:
        corners = np.array(CORNERS[plate.name], dtype=float)
        axes = plate_axes(corners)
        centre = corners.mean(axis=0) * 1e-3
        force = plate.force @ axes
        moment = (plate.moment - np.cross(centre, plate.force)) @ axes * 1000.0
        channels += [*force.T, *moment.T]
    channels.append(1e-3 * np.sin(40.0 * raw.time))
    fine = np.repeat(np.array(channels), RATIO, axis=1)
    c3d['data']['points'] = points
    c3d['data']['analogs'] = fine[np.newaxis]
    names = [f'{k}{i}' for i in (1, 2) for k in ('Fx', 'Fy', 'Fz', 'Mx', 'My', 'Mz')]
    p['ANALOG']['RATE']['value'] = [RATE * RATIO]
    p['ANALOG']['LABELS']['value'] = [*names, 'EMG_BFR']
    p['ANALOG']['UNITS']['value'] = [*(['N'] * 3 + ['Nmm'] * 3) * 2, 'V']
    corners = np.array([CORNERS['fp1'], CORNERS['fp2']], dtype=float)
    for name, value in (
        ('USED', np.array([2])),
        ('TYPE', np.array([2, 2])),
        ('ZERO', np.array([0, 0])),
        ('CORNERS', corners.transpose(2, 1, 0)),
        ('ORIGIN', np.zeros((3, 2))),
        ('CHANNEL', np.arange(1, 13).reshape(2, 6).T),
    ):
        p['FORCE_PLATFORM'][name]['value'] = value
    path = tmp_path / 'a.c3d'
    c3d.write(str(path))
    return path


def test_points_plates_and_emg(file, standing):
    raw = read_c3d(file)
    assert raw.units == 'mm'
    assert raw.names == standing.raw.names
    np.testing.assert_allclose(raw.positions, standing.raw.positions * 1000.0, atol=1e-3)
    assert raw.analog is not None
    assert raw.analog.names == ('EMG_BFR',)
    assert raw.analog.units == ('V',)
    assert raw.analog.values.shape == (RATIO * standing.raw.time.size, 1)
    found = align(raw, standing.stature, Carried(standing.mass), ConventionOptions())
    for side, truth in zip(('right', 'left'), standing.raw.plates, strict=True):
        plate = found.plates[side]
        assert plate.time.size == RATIO * truth.time.size
        np.testing.assert_allclose(plate.force[::RATIO], truth.force, atol=1e-3)
        np.testing.assert_allclose(plate.moment[::RATIO], truth.moment, atol=1e-3)


def test_unlabelled_points_are_left_out_and_said(file, standing, tmp_path):
    c3d = ezc3d.c3d(str(file))
    labels = c3d['parameters']['POINT']['LABELS']['value']
    labels[0] = '*17'
    c3d.write(str(tmp_path / 'b.c3d'))
    raw = read_c3d(tmp_path / 'b.c3d')
    assert raw.names == standing.raw.names[1:]
    np.testing.assert_allclose(raw.positions, standing.raw.positions[:, 1:] * 1000.0, atol=1e-3)
    assert any('1 unlabelled points left out' in note for note in raw.notes)


def test_label_given_twice_is_named(file, tmp_path):
    c3d = ezc3d.c3d(str(file))
    labels = c3d['parameters']['POINT']['LABELS']['value']
    labels[0] = labels[1]
    c3d.write(str(tmp_path / 'b.c3d'))
    with pytest.raises(FileFormatError, match="'CLAV' appears twice"):
        read_c3d(tmp_path / 'b.c3d')


def test_file_with_unlabelled_points_only_is_refused(file, tmp_path):
    c3d = ezc3d.c3d(str(file))
    labels = c3d['parameters']['POINT']['LABELS']['value']
    labels[:] = [f'*{i}' for i in range(len(labels))]
    c3d.write(str(tmp_path / 'b.c3d'))
    with pytest.raises(FileFormatError, match=r'b\.c3d.*none of its 12 points has a label'):
        read_c3d(tmp_path / 'b.c3d')


def test_prefix_chooses_the_subject(file, standing, tmp_path):
    c3d = ezc3d.c3d(str(file))
    labels = c3d['parameters']['POINT']['LABELS']['value']
    labels[-1] = 'Box:C7'
    c3d.write(str(tmp_path / 'b.c3d'))
    with pytest.raises(FileFormatError, match=r"'C7' appears twice.*--label-prefix, one of S1, B"):
        read_c3d(tmp_path / 'b.c3d')
    assert read_c3d(tmp_path / 'b.c3d', prefix='S1').names == (*standing.raw.names[:-1], 'Box:C7')


def test_named_channels_only(file):
    raw = read_c3d(file, ('EMG_BFR',))
    assert raw.analog is not None
    with pytest.raises(FileFormatError, match="field 'ANALOG:LABELS': no channel 'EMG_X'"):
        read_c3d(file, ('EMG_X',))


def test_foreign_and_truncated_files(file, tmp_path):
    bad = tmp_path / 'bad.c3d'
    bad.write_bytes(b'')
    with pytest.raises(FileFormatError, match='is not a C3D file'):
        read_c3d(bad)
    bad.write_bytes(b'plain text, not a C3D file')
    with pytest.raises(FileFormatError, match='is not a C3D file'):
        read_c3d(bad)
    bad.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(FileFormatError, match=r'bad\.c3d: is cut off: 200 frames'):
        read_c3d(bad)


def test_import_keeps_plates_at_their_rate_and_emg(file, standing, tmp_path):
    (tmp_path / 'subject.yaml').write_text(standing.subject_file)
    report = import_recording(
        ImportOptions(file, tmp_path / 'subject.yaml', tmp_path / 'bag', compress=False)
    )
    n = standing.raw.time.size
    assert report.messages['force_plates/right/wrench'] == RATIO * n
    with BagReader(tmp_path / 'bag') as bag:
        blocks = [m for _, _, m in bag.messages(['/emg'])]
    assert blocks[0].layout.dim[1].label == 'EMG_BFR [V]'
    assert blocks[0].layout.dim[0].label == 'samples, 1000 Hz'
    samples = np.concatenate([block.data for block in blocks])
    expected = np.repeat(1e-3 * np.sin(40.0 * standing.raw.time), RATIO)
    np.testing.assert_allclose(samples, expected, atol=1e-8)


def test_forces_beside_a_c3d_file_are_refused(file, standing, tmp_path):
    (tmp_path / 'subject.yaml').write_text(standing.subject_file)
    options = ImportOptions(file, tmp_path / 'subject.yaml', tmp_path / 'bag', forces=file)
    with pytest.raises(FileFormatError, match='brings its own forces'):
        import_recording(options)
