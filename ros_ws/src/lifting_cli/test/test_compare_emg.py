# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift compare-emg` on a recording whose EMG is made from the activations computed for it."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from lifting_cli.cli import main
from lifting_cli.recorded_lifts import recorded_lifts
from lifting_recordings.bag_writer import BagWriter
from lifting_recordings.exceptions import UnreadableBagError
from lifting_recordings.importer import _emg_stream
from lifting_recordings.reader import BagReader
from lifting_recordings.recording import Analog
from lifting_report.recorded_emg import emg_of_lift, recorded_emg
from lifting_report.report_data import Activations, Missing
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

BAG = Path(__file__).resolve().parents[4] / 'bags' / 'symmetric_7kg'
RATE = 1000.0
#: The made EMG comes so much before the activation [s].
EARLY = 0.08


def write_emg(path, start, time, values, names, *, messages=(), spoil=None):
    """Write a recording: given messages, and EMG blocks as the import writes them."""
    analog = Analog(names, ('V',) * len(names), time, values)
    with BagWriter(path) as writer:
        for name, kind in messages:
            writer.topic(name.strip('/'), kind, transient_local=name in ('/subject', '/task'))
        blocks = list(_emg_stream(writer, round(start * 1e9), analog))
        if spoil is not None:
            spoil(blocks)
        entries = [(stamp, topic, message) for stamp, topic, message in blocks]
        if messages:
            with BagReader(BAG) as source:
                entries += [
                    (stamp, topic.strip('/'), message)
                    for topic, stamp, message in source.messages([n for n, _ in messages])
                ]
        for stamp, topic, message in sorted(entries, key=lambda entry: entry[0]):
            writer.write(topic, stamp, message)
    return path


@pytest.fixture(scope='module')
def bag_with_emg(tmp_path_factory):
    """Return a recording with two EMG channels: noise with the course of two activations."""
    recorded = recorded_lifts(BAG)
    lift = recorded.lift(1)
    analyzer = MuscleAnalyzer(recorded.subject)
    motion = lift.lift.motion
    analysis = analyzer.analyze(motion, lift.lift.lift_id, 'measured', lift.status)
    with BagReader(BAG) as reader:
        wanted = [
            (name, topic.msgtype) for name, topic in reader.topics.items()
            if name.strip('/') in ('subject', 'task', 'markers', 'box/pose')
            or name.endswith('wrench')
        ]  # fmt: skip
        seconds = (reader.end_ns - reader.start_ns) * 1e-9
    time = np.arange(round(seconds * RATE)) / RATE
    rng = np.random.default_rng(8)
    columns = []
    for muscle in ('vaslat_r', 'vasmed_l'):
        activation = analysis.activation[:, analysis.muscle_names.index(muscle)]
        size = np.interp(time, analysis.time - recorded.start - EARLY, activation)
        columns.append(2e-3 * size * np.sign(rng.standard_normal(time.size)))
    path = tmp_path_factory.mktemp('emg') / 'with_emg'
    values = np.stack(columns, axis=1)
    return write_emg(path, recorded.start, time, values, ('EMG1', 'VML'), messages=wanted)


def test_emg_of_a_recording_is_what_was_written(tmp_path):
    time = np.arange(105) / RATE
    values = np.random.default_rng(1).standard_normal((105, 2))
    path = write_emg(tmp_path / 'emg', 1e9 + 0.25, time, values, ('BFR', 'BF left'))
    emg = recorded_emg(path, 1e9)
    assert (emg.channels, emg.units) == (('BFR', 'BF left'), ('V', 'V'))
    np.testing.assert_allclose(emg.time, 0.25 + time, atol=1e-9)
    np.testing.assert_array_equal(emg.values, values)


def test_gaps_and_changing_channels_are_refused(tmp_path):
    time = np.arange(100) / RATE
    values = np.zeros((100, 1))

    def drop(blocks):
        del blocks[3]

    def rename(blocks):
        blocks[4][2].layout.dim[1].label = 'other [V]'

    def scramble(blocks):
        blocks[0][2].layout.dim[0].label = 'samples'

    for spoil, message in (
        (drop, r'block at 0\.040000 s where 0\.030000 s was to follow'),
        (rename, 'channels or rate change on the way'),
        (scramble, 'does not say rate, channels and units of 10 values'),
    ):
        path = tmp_path / spoil.__name__
        write_emg(path, 1e9, time, values, ('BFR',), spoil=spoil)
        with pytest.raises(UnreadableBagError, match=message):
            recorded_emg(path, 1e9)


def test_a_recording_without_emg_is_refused(capsys, tmp_path):
    assert main(['compare-emg', str(BAG), '--out', str(tmp_path)]) == 1
    assert "has no EMG (topic 'emg' is missing or empty)" in capsys.readouterr().err


def test_course_and_phase_come_back(bag_with_emg, tmp_path, capsys):
    """The low-pass of 5 Hz is wide for a lift of 1.5 s: hence not exactly 1 and 80 ms."""
    arguments = ['compare-emg', str(bag_with_emg), '--channel', 'EMG1=VL_r']
    assert main([*arguments, '--mvc', 'VML=0.002', '--out', str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert 'EMG1: divided by the maximum of the recording' in printed
    page = (tmp_path / 'emg.html').read_text(encoding='utf-8')
    for words in ('with_emg, lift_001', 'Vastus lateralis, right', 'Vastus medialis, left'):
        assert words in page
    assert page.count('<svg') == 1
    assert re.search(r'<td>VML</td>.*?<td>MVC</td>', page)
    first, second = json.loads((tmp_path / 'emg.json').read_text(encoding='utf-8'))
    assert (first['muscle'], first['side']) == ('Vastus lateralis', 'r')
    assert (second['muscle'], second['normalised_by']) == ('Vastus medialis', 'MVC')
    for match in (first, second):
        assert match['lag'] == pytest.approx(EARLY, abs=0.02)
        assert match['best_correlation'] > 0.97
        assert match['correlation'] < match['best_correlation']
    # With the MVC that was written the sizes agree too.
    late = np.interp(second['time'], np.add(second['time'], EARLY), second['envelope'])
    inner = slice(25, -25)
    np.testing.assert_allclose(late[inner], second['activation'][inner], atol=0.1)


def test_a_channel_that_says_nothing_is_refused(bag_with_emg, tmp_path, capsys):
    assert main(['compare-emg', str(bag_with_emg), '--out', str(tmp_path)]) == 1
    assert "EMG channel 'EMG1' names no muscle and side" in capsys.readouterr().err


@pytest.mark.parametrize('words', [['--mvc', 'BFR=loud'], ['--mvc', 'BFR'], ['--channel', '=BF']])
def test_options_that_say_nothing_are_refused(words, capsys):
    with pytest.raises(SystemExit):
        main(['compare-emg', str(BAG), *words])
    assert words[1] in capsys.readouterr().err


@pytest.fixture(scope='module')
def run_with_emg(bag_with_emg, tmp_path_factory):
    """Return the folder of an offline run of the recording with EMG."""
    output = tmp_path_factory.mktemp('run')
    assert main(['run', str(bag_with_emg), '--offline', '--output', str(output)]) == 0
    return output


def test_report_of_a_run_shows_the_emg_of_its_recording(run_with_emg, bag_with_emg, tmp_path):
    page = (run_with_emg / 'report.html').read_text(encoding='utf-8')
    section = page.partition('EMG beside the computed activations')[2]
    assert 'Vastus medialis, left' in section
    # EMG1 names no muscle: it is left out, and the page says so.
    assert 'Not compared: EMG channel &#39;EMG1&#39; names no muscle and side' in section
    shown = re.search(r'<td>VML</td>.*?([−\d]+)\u202fms', section)
    assert float(shown[1].replace('−', '-')) == pytest.approx(1e3 * EARLY, abs=20.0)
    again = tmp_path / 'again.html'
    results = str(run_with_emg / 'results.mcap')
    recording = ['--recording', str(bag_with_emg)]
    assert main(['report', results, '--output', str(again), *recording]) == 0
    assert f'{shown[1]}\u202fms' in again.read_text(encoding='utf-8')
    assert main(['report', results, '--output', str(again)]) == 0
    assert 'EMG beside' not in again.read_text(encoding='utf-8')


def test_emg_that_cannot_be_compared_gives_the_reason(bag_with_emg):
    start = recorded_lifts(bag_with_emg).start
    emg = recorded_emg(bag_with_emg, start)
    time = np.linspace(0.0, 1.0, 50)
    there = Activations(time, ('vasmed_l',), np.zeros((50, 1)), np.ones(50, bool))
    found = emg_of_lift(emg, 'lift_9', there, 1e4)
    assert "lift 'lift_9'" in found.reason
    assert 'is not within the EMG' in found.reason
    gone = emg_of_lift(emg, 'lift_9', Missing('it died'), 0.0)
    assert gone.reason == 'no computed activations to lay the EMG beside: it died'
