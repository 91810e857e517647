# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Import from files to a bag that stands alone, and back out of the bag."""

from dataclasses import replace

import numpy as np
import pytest
from rosbags.interfaces import QosDurability

from human_model.opensim_storage import Storage, write_storage
from lifting_messages.names import split
from lifting_recordings.bag_writer import START_TIME_NS
from lifting_recordings.exceptions import BagError, FileFormatError, SubjectFileError
from lifting_recordings.importer import ImportOptions, read_recording, write_bag
from lifting_recordings.opensim_files import MarkerTable, write_trc
from lifting_recordings.reader import BagReader

# Rows: axes of an OpenSim file (x forward, y up, z right) in graph axes.
OPENSIM = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def import_recording(options):
    """Import without the steps of `lifting.import_recording` that need other packages."""
    return write_bag(options, read_recording(options))


@pytest.fixture
def files(standing, tmp_path):
    """Write the standing figure as TRC in millimetres, MOT and subject file."""
    file = standing.turned(standing.raw, OPENSIM)
    rate = 1.0 / (file.time[1] - file.time[0])
    positions = file.positions.copy() * 1000.0
    positions[50:60, 3] = np.nan
    write_trc(tmp_path / 'a.trc', MarkerTable(file.names, file.time, positions, 'mm', rate))
    columns, values = [], []
    for plate in file.plates:
        cop = np.stack(
            (
                plate.moment[:, 2] / plate.force[:, 1],
                np.zeros(len(plate.time)),
                -plate.moment[:, 0] / plate.force[:, 1],
            ),
            axis=1,
        )
        free = plate.moment - np.cross(cop, plate.force)
        for what, block in (('v', plate.force), ('p', cop), ('m', free)):
            columns += [f'ground_force_{plate.name}_{what}{axis}' for axis in 'xyz']
            values.append(block)
    write_storage(
        tmp_path / 'a.mot', Storage('a', tuple(columns), file.time, np.concatenate(values, axis=1))
    )
    (tmp_path / 'subject.yaml').write_text(standing.subject_file)
    return ImportOptions(
        markers=tmp_path / 'a.trc',
        forces=tmp_path / 'a.mot',
        subject=tmp_path / 'subject.yaml',
        output=tmp_path / 'bag',
    )


def test_round_trip_through_trc_mot_and_bag(files, standing):
    report = import_recording(files)
    n = standing.raw.time.size
    assert report.messages['markers'] == n
    assert report.messages['force_plates/left/wrench'] == n
    markers = np.full(standing.raw.positions.shape, np.nan)
    force, moment = np.zeros((n, 3)), np.zeros((n, 3))
    with BagReader(files.output) as bag:
        assert bag.loss is None
        rows = {'/markers': 0, '/force_plates/left/wrench': 0}
        for topic, stamp, message in bag.messages(list(rows)):
            i = rows[topic]
            rows[topic] += 1
            assert stamp == START_TIME_NS + round(standing.raw.time[i] * 1e9)
            header = message.header.stamp
            assert header.sec * 1_000_000_000 + header.nanosec == stamp
            assert message.header.frame_id == 'world'
            if topic == '/markers':
                assert message.frame_number == i
                columns = [standing.raw.names.index(name) for name in split(message.names)]
                markers[i, columns] = message.positions.reshape(-1, 3)
            else:
                w = message.wrench
                force[i] = w.force.x, w.force.y, w.force.z
                moment[i] = w.torque.x, w.torque.y, w.torque.z
    assert np.all(np.isnan(markers[50:60, 3]))
    seen = np.isfinite(markers)
    assert np.count_nonzero(~seen) == 30
    np.testing.assert_allclose(markers[seen], standing.raw.positions[seen], atol=1e-8)
    np.testing.assert_allclose(force, standing.raw.plates[1].force, rtol=1e-7, atol=1e-6)
    np.testing.assert_allclose(moment, standing.raw.plates[1].moment, rtol=1e-7, atol=1e-5)


def test_subject_and_task_are_latched_and_say_what_was_detected(files):
    import_recording(files)
    with BagReader(files.output) as bag:
        for name in ('/subject', '/task'):
            assert bag.topics[name].qos[0].durability == QosDurability.TRANSIENT_LOCAL
        assert bag.topics['/markers'].qos[0].durability == QosDurability.VOLATILE
        messages = {topic: m for topic, _, m in bag.messages(['/subject', '/task'])}
    assert messages['/subject'].mass == 70.0
    assert messages['/subject'].sex == 2
    assert np.isnan(messages['/subject'].calibration_rms)
    for part in ('a.trc', 'mm', '+y', 'right foot', 'left foot'):
        assert part in messages['/task'].source
    assert messages['/task'].simulated is False


def test_existing_bag_is_not_overwritten(files):
    import_recording(files)
    with pytest.raises(BagError, match='exists already'):
        import_recording(files)


def test_nothing_is_written_when_a_file_is_wrong(files):
    with pytest.raises(FileFormatError, match='does not exist'):
        import_recording(replace(files, forces=files.forces.with_name('no.mot')))
    with pytest.raises(FileFormatError, match=r"\.c3d or \.trc, not '\.mot'"):
        import_recording(replace(files, markers=files.forces, forces=None))
    assert not files.output.exists()


def test_forces_of_another_time_are_refused(files):
    table_path = files.forces
    lines = table_path.read_text().splitlines()
    start = lines.index('endheader') + 2
    for i in range(start, len(lines)):
        stamp, _, rest = lines[i].partition('\t')
        lines[i] = f'{float(stamp) + 100.0}\t{rest}'
    table_path.write_text('\n'.join(lines))
    with pytest.raises(FileFormatError, match='does not overlap the markers'):
        import_recording(files)


def test_rename_of_a_marker_that_is_not_there(files):
    text = files.subject.read_text() + 'recording: {rename: {NOPE: RHEE}}\n'
    files.subject.write_text(text)
    with pytest.raises(SubjectFileError, match=r'recording\.rename\.NOPE'):
        import_recording(files)


def test_swapped_labels_are_set_right_by_rename(files, standing):
    text = files.markers.read_text()
    swapped = text.replace('RHEE', 'xx').replace('LHEE', 'RHEE').replace('xx', 'LHEE')
    files.markers.write_text(swapped)
    with pytest.raises(BagError, match='labels are swapped'):
        import_recording(files)
    files.subject.write_text(
        standing.subject_file + 'recording: {rename: {RHEE: LHEE, LHEE: RHEE}}\n'
    )
    assert import_recording(files).messages['markers'] == standing.raw.time.size


def test_box_pose_from_box_markers(standing, tmp_path, files):
    raw = standing.turned(standing.raw, OPENSIM)
    layout = {'B1': (0.1, 0.15, 0.05), 'B2': (0.1, -0.15, 0.05), 'B3': (-0.1, 0.15, 0.05)}
    yaw = 0.3
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    box = np.array([0.4, 0.05, 0.3])
    corners = (box + np.array(list(layout.values())) @ turn.T) @ OPENSIM.T
    positions = np.concatenate((raw.positions, np.tile(corners, (raw.time.size, 1, 1))), axis=1)
    names = (*raw.names, *layout)
    write_trc(files.markers, MarkerTable(names, raw.time, positions, 'm', 100.0))
    entries = ', '.join(f'{k}: {list(v)}' for k, v in layout.items())
    files.subject.write_text(
        standing.subject_file + f'recording: {{box_markers: {{{entries}}}}}\n'
    )
    import_recording(files)
    with BagReader(files.output) as bag:
        _, _, message = next(bag.messages(['/box/pose']))
    p, q = message.pose.position, message.pose.orientation
    np.testing.assert_allclose((p.x, p.y, p.z), box, atol=1e-6)
    np.testing.assert_allclose(abs(2.0 * np.arctan2(q.z, q.w)), yaw, atol=1e-6)
