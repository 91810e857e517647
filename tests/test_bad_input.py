# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings that are not as they should be, through all pipelines: what is said, what is not."""

from copy import deepcopy
from types import SimpleNamespace

import numpy as np
import pytest

from human_model.report import SolveStatus
from lifting_cli.cli import main
from lifting_cli.graph_errors import GraphError
from lifting_cli.offline import run_offline
from lifting_messages.names import join, split
from lifting_recordings.bag_writer import BagWriter
from lifting_recordings.exceptions import BagError
from lifting_recordings.reader import BagReader
from lifting_report.results_file import MEASURED, PREDICTED, read_results

BAG = 'symmetric_7kg'
#: Stretch of the recording with the lift in it [s], for what needs no more.
LIFT = (2.5, 7.0)
#: Before the lift [s]: standing.
STANDING = (0.0, 1.5)


def rewrite(source, target, change, stretch=None):
    """Write a recording anew: `change` gives for topic, time [s] and message what replaces it.

    It returns a message, or a list of (time [s], message) with others' times.
    """
    with BagReader(source) as bag, BagWriter(target) as writer:
        for name, topic in bag.topics.items():
            latched = name in ('/subject', '/task')
            writer.topic(name.strip('/'), topic.msgtype, transient_local=latched)
        for name, stamp, message in bag.messages():
            time = (stamp - bag.start_ns) * 1e-9
            latched = name in ('/subject', '/task')
            if stretch and not latched and not stretch[0] <= time <= stretch[1]:
                continue
            changed = change(name.strip('/'), time, deepcopy(message))
            if not isinstance(changed, list):
                changed = [] if changed is None else [(time, changed)]
            for at, new in changed:
                writer.write(name.strip('/'), bag.start_ns + round(at * 1e9), new)
    return target


@pytest.fixture
def broken(bags, tmp_path, capsys):
    """Return a function that runs a changed recording: what was said, and the results."""

    def run(change, stretch=LIFT, bag=BAG):
        path = rewrite(bags / bag, tmp_path / 'changed', change, stretch)
        results = run_offline(path, tmp_path / 'out')
        return SimpleNamespace(
            said=capsys.readouterr().out, results=read_results(results), path=results
        )

    return run


def loads(path):
    """Return stamp-ordered (source, status, compression) of every L5-S1 sample of a file."""
    with BagReader(path) as bag:
        topics = [name for name in bag.topics if name.endswith('/spine_load')]
        blocks = [m for _, _, m in bag.messages(topics)] if topics else []
    sources = np.concatenate([np.full(len(m.status), m.source) for m in blocks] or [[]])
    status = np.concatenate([m.status for m in blocks] or [[]])
    compression = np.concatenate([m.compression for m in blocks] or [[]])
    return sources, status, compression


def live_load(path):
    """Return status and compression [N] of the live samples by stamp [ns]."""
    with BagReader(path) as bag:
        (topic,) = [name for name in bag.topics if name.endswith('/spine_load')]
        return {
            m.header.stamp.sec * 10**9 + m.header.stamp.nanosec: (m.status[0], m.compression[0])
            for _, _, m in bag.messages([topic])
            if m.source == m.LIVE
        }


def test_cut_off_file_is_read_as_far_as_it_goes(bags, tmp_path, capsys):
    folder = tmp_path / 'cut'
    folder.mkdir()
    for file in (bags / BAG).glob('*.[my]*'):
        content = file.read_bytes()
        if file.suffix == '.mcap':
            content = content[: int(0.9 * len(content))]
        (folder / file.name).write_bytes(content)
    results = run_offline(folder, tmp_path / 'out')
    said = ' '.join(capsys.readouterr().out.split())
    with BagReader(folder) as bag:
        assert bag.loss is not None
        assert str(bag.loss) in said
        frames = bag.topics['/markers'].count
        assert 0.0 < bag.loss.seconds_lost < 2.0
        assert bag.loss.messages_lost > 0
    found = read_results(results)
    assert found.live_samples == frames > 500
    assert 'risk_assessment' in found.lifts['lift_001'].single


def test_foreign_and_missing_files_are_named(tmp_path, capsys):
    foreign = tmp_path / 'holiday.mcap'
    foreign.write_bytes(b'\xff\xd8 not a recording at all')
    for path in (foreign, tmp_path / 'nowhere'):
        with pytest.raises(BagError, match=path.name):
            run_offline(path, tmp_path / 'out')
        assert main(['run', str(path), '--offline', '--output', str(tmp_path / 'out')]) == 1
        assert str(path) in capsys.readouterr().err


def test_recording_without_subject_is_refused(bags, tmp_path):
    path = rewrite(
        bags / BAG,
        tmp_path / 'changed',
        lambda topic, _, message: None if topic == 'subject' else message,
        STANDING,
    )
    with pytest.raises(GraphError, match='subject'):
        run_offline(path, tmp_path / 'out')


def test_without_plates_no_load_looks_good(broken):
    found = broken(lambda topic, _, message: None if 'plates' in topic else message)
    sources, status, _ = loads(found.path)
    assert np.all(status[sources != 3] != 0)
    assert 'plate' in found.said
    assert found.results.live_unsolved == found.results.live_samples > 0
    measured = found.results.lifts['lift_001'].single['measured_lift']
    assert np.all(np.asarray(measured.motion.status) == SolveStatus.TRACKER_NO_GROUND_FORCE)


def test_one_plate_that_falls_silent_is_named(broken):
    def change(topic, time, message):
        return None if topic == 'force_plates/left/wrench' and time > 4.5 else message

    found = broken(change)
    assert 'samples missing of the left plate' in ' '.join(found.said.split())
    sources, status, _ = loads(found.path)
    live = status[sources == 1]
    assert not live[100:150].any()
    assert np.all(live[-100:] != 0)


def test_markers_in_millimetres_are_refused(broken):
    def change(topic, _, message):
        if topic == 'markers':
            message.positions *= 1000.0
        return message

    found = broken(change, STANDING)
    assert 'millimetres' in found.said
    assert found.results.live_samples == 0
    assert found.results.lifts == {}


def test_markers_that_are_not_numbers(broken, bags, offline):
    """One marker for good, all of them for 0.2 s of the lift: nothing wrong looks good."""

    def change(topic, time, message):
        if topic == 'markers':
            x = message.positions[::3]
            x[7] = np.nan
            if 4.6 <= time < 4.8:
                x[:] = np.nan
        return message

    found = broken(change, None)
    expected = live_load(offline(bags / BAG))
    good = 0
    for stamp, (status, compression) in live_load(found.path).items():
        if status == 0:
            good += 1
            # What one marker of 58 less changes.
            assert compression == pytest.approx(expected[stamp][1], rel=0.05, abs=50.0)
    # Lost: the gap itself and what the filters need to forget it.
    assert good == pytest.approx(len(expected) - 6 - 20 - 48, abs=5)
    measured = found.results.lifts['lift_001'].single['measured_lift'].motion
    status = np.asarray(measured.status)
    # And 0.1 s on each side, as far as the zero-phase filter carries the gap.
    assert np.count_nonzero(status) == pytest.approx(20 + 2 * 10, abs=3)


def test_swapped_sides_are_named(broken):
    sides = {'L': 'R', 'R': 'L'}

    def change(topic, _, message):
        if topic == 'markers':
            names = split(message.names)
            message.names = join(sides.get(name[0], name[0]) + name[1:] for name in names)
        return message

    found = broken(change)
    sources, status, _ = loads(found.path)
    assert np.all(status[sources == 1] != 0)
    assert 'left and right side are all exchanged' in ' '.join(found.said.split())


def test_two_swapped_markers_are_not_good_data(broken):
    pair = {'RKNE': 'LKNE', 'LKNE': 'RKNE'}

    def change(topic, _, message):
        if topic == 'markers':
            message.names = join(pair.get(name, name) for name in split(message.names))
        return message

    found = broken(change, STANDING)
    sources, status, _ = loads(found.path)
    assert np.all(status[sources == 1] != 0)


def test_unsorted_and_doubled_stamps_change_nothing(bags, tmp_path, offline):
    """Every tenth frame twice, every hundredth plate sample late once more."""
    last = {}

    def change(topic, time, message):
        entries = [(time, message)]
        number = round(time * 1000)
        if topic == 'markers' and number % 100 == 0:
            entries.append((time, message))
        if 'plates' in topic:
            if number % 100 == 0 and topic in last:
                entries.append((time, last[topic]))
            last[topic] = message
        return entries

    path = rewrite(bags / BAG, tmp_path / 'changed', change)
    with BagReader(path) as bag:
        assert bag.topics['/markers'].count > 750
    repeated = loads(run_offline(path, tmp_path / 'out'))
    for found, expected in zip(repeated, loads(offline(bags / BAG)), strict=True):
        np.testing.assert_array_equal(found, expected)


def test_mass_that_the_plates_do_not_confirm(broken):
    """Entered 8 % too high: from the first quiet standing on no load is good, no alarm rises."""

    def change(topic, _, message):
        if topic == 'subject':
            message.mass *= 1.08
        return message

    found = broken(change, None)
    said = 'force plates: 63.5 kg in quiet standing, subject.mass: 68.6 kg, deviation -7.4 %'
    assert said in ' '.join(found.said.split())
    sources, status, compression = loads(found.path)
    live = sources == 1
    known = np.flatnonzero(status[live])[10]
    assert known < 100
    assert np.all(status[live][known:] != 0)
    assert np.all(np.isnan(compression[live][known:]))
    lift = found.results.lifts['lift_001']
    measured = lift.single['measured_lift']
    assert np.all(np.asarray(measured.motion.status) == SolveStatus.TRACKER_MASS_MISMATCH)
    assert 'subject.mass: 68.6 kg' in measured.report.message
    assert np.all(np.isnan(lift.blocks['spine_load', MEASURED].compression))
    assert lift.single['predicted_lift'].report.status == SolveStatus.PREDICTOR_BAD_INPUT
    assert found.results.alarms == []


def test_recording_that_begins_in_motion(broken, bags, offline):
    """The live filters take the first frame for rest: their first half second is no load."""
    found = broken(lambda _topic, _time, message: message, (2.6, 4.5))
    whole = live_load(offline(bags / BAG))
    begun = live_load(found.path)
    status = [status for status, _ in begun.values()]
    assert all(status[:48])
    assert not any(status[48:])
    for stamp, (code, compression) in begun.items():
        if code == 0:
            assert compression == pytest.approx(whole[stamp][1], rel=0.02, abs=20.0)


def test_recording_without_a_lift(broken):
    found = broken(lambda _topic, _time, message: message, STANDING)
    assert found.results.lifts == {}
    assert 'no lift found' in found.said
    assert found.results.live_samples > 100


def test_box_that_nobody_can_lift(broken):
    """60 kg: the trunk muscles are too weak, the optimal lift does not exist; both said."""

    def change(topic, _, message):
        if topic == 'task':
            message.box_mass = 60.0
        return message

    found = broken(change)
    lift = found.results.lifts['lift_001']
    prediction = lift.single['predicted_lift'].report
    assert prediction.status in (
        SolveStatus.PREDICTOR_INFEASIBLE,
        SolveStatus.PREDICTOR_NOT_CONVERGED,
        SolveStatus.PREDICTOR_BAD_INPUT,
    )
    assert prediction.message
    assert 'prediction failed' in found.said
    assert ('spine_load', PREDICTED) not in lift.blocks
    muscles = lift.blocks['muscle_analysis', MEASURED]
    weak = np.asarray(muscles.status) == SolveStatus.MUSCLE_TOO_WEAK
    assert weak.any()
    assert 'too weak' in muscles.report.message
    assessment = lift.single['risk_assessment']
    assert prediction.message in assessment.summary or 'predict' in assessment.summary


def test_target_out_of_reach(broken):
    """The box is to end at 2.9 m: nobody of 1.69 m gets there."""

    def change(topic, _, message):
        if topic == 'task':
            end = message.box_end
            end.x, end.y, end.z = 0.4, 0.0, 2.9
        return message

    found = broken(change)
    lift = found.results.lifts['lift_001']
    report = lift.single['predicted_lift'].report
    assert report.status == SolveStatus.PREDICTOR_UNREACHABLE
    assert report.message in ' '.join(found.said.split())
    assert ('spine_load', PREDICTED) not in lift.blocks
