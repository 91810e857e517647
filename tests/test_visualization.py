# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures across packages: limits of the monitor, links of the URDF, a recorded run."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml

from human_model.frames import matrix_from_quaternion
from human_model.tables import read_table
from lifting_cli.session import RunOptions, run_online
from lifting_messages.conversions import motion_from_msg
from lifting_messages.stamps import to_seconds
from lifting_recordings.reader import BagReader

BAG = 'symmetric_7kg'
STATION = '/station_1/'
DISC = 'station_1/l5_s1'
RATE = 4.0

pytestmark = pytest.mark.timeout(180)


def test_colours_change_at_the_limits_of_the_monitor() -> None:
    parameters = yaml.safe_load(
        files('lifting_visualization').joinpath('data/parameters.yaml').read_text('utf-8')
    )
    rows = read_table('injury_monitor', 'limits.csv', 'limit value')
    limits = {row['limit']: row.number('value') for row in rows}
    for name in ('compression_action', 'compression_maximum'):
        assert parameters[name]['default'] == limits[name]


@pytest.fixture(scope='module')
def recorded(bags: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, list]:
    """Run a recording with its pictures recorded; return stamps [s] and messages by topic."""
    output = tmp_path_factory.mktemp('pictures')
    report = run_online(
        RunOptions(
            bags / BAG,
            output,
            rate=RATE,
            settle_timeout=60.0,
            visualize=True,
            record_visualization=True,
        )
    )
    assert report.exit_codes['lifting_visualization'] in (0, -15)
    found: dict[str, list] = {}
    with BagReader(report.results) as bag:
        for topic, stamp, message in bag.messages(list(bag.topics)):
            found.setdefault(topic.removeprefix(STATION), []).append((stamp * 1e-9, message))
    return found


def links(recorded: dict[str, list]) -> list:
    """Return the messages of /tf with the person's links."""
    return [
        message for _, message in recorded['/tf'] if message.transforms[0].child_frame_id != DISC
    ]


def poses(message: Any) -> dict[str, np.ndarray]:
    """Return the places (4, 4) in the laboratory of a message's frames."""
    found = {'world': np.eye(4)}
    for entry in message.transforms:
        place, turn = entry.transform.translation, entry.transform.rotation
        step = np.eye(4)
        step[:3, :3] = matrix_from_quaternion([turn.x, turn.y, turn.z, turn.w])
        step[:3, 3] = place.x, place.y, place.z
        found[entry.child_frame_id] = found[entry.header.frame_id] @ step
    return found


def test_urdf_and_tf_have_the_same_links(recorded: dict[str, list]) -> None:
    ((_, description),) = recorded['robot_description']
    robot = ElementTree.fromstring(description.data)
    joints = {
        (joint.find('parent').get('link'), joint.find('child').get('link'))
        for joint in robot.findall('joint')
    }
    prefix = STATION.strip('/') + '/'
    entries = [*links(recorded)[-1].transforms, *recorded['/tf_static'][-1][1].transforms]
    assert joints == {
        (entry.header.frame_id.removeprefix(prefix), entry.child_frame_id.removeprefix(prefix))
        for entry in entries
    }


def test_tf_puts_the_links_where_the_tracker_has_the_joints(recorded: dict[str, list]) -> None:
    """The live links against the markers of the same instant, in the same file."""
    pictures = {
        to_seconds(message.markers[0].header.stamp): message.markers
        for _, message in recorded['visualization']
        if message.markers[0].ns == 'person'
    }
    ((_, lift),) = recorded['measured_lift']
    names = motion_from_msg(lift.motion).point_names
    compared = 0
    for message in links(recorded)[::50]:
        drawn = pictures.get(to_seconds(message.transforms[0].header.stamp))
        if drawn is None:
            continue
        places = poses(message)
        joints = {
            name: np.array([p.x, p.y, p.z]) for name, p in zip(names, drawn[1].points, strict=True)
        }
        for point, link in (
            ('l5_s1', 'lumbar'),
            ('elbow_r', 'forearm_r'),
            ('wrist_l', 'hand_l'),
            ('knee_r', 'shank_r'),
            ('ankle_l', 'foot_l'),
            ('mtp_r', 'toes_r'),
        ):
            np.testing.assert_allclose(
                places[f'station_1/{link}'][:3, 3], joints[point], atol=1e-9
            )
            compared += 1
    assert compared >= 12


def test_tf_knows_the_frame_of_every_reaction(recorded: dict[str, list]) -> None:
    """A reaction turned into the laboratory by /tf presses the disc of the person, upwards."""
    discs = {
        to_seconds(message.transforms[0].header.stamp): poses(message)[DISC]
        for _, message in recorded['/tf']
        if message.transforms[0].child_frame_id == DISC
    }
    spines = {
        to_seconds(message.transforms[0].header.stamp): poses(message)['station_1/lumbar']
        for message in links(recorded)
    }
    reactions = [message for _, message in recorded['l5_s1/reaction']]
    assert {message.header.frame_id for message in reactions} == {DISC}
    assert len(reactions) > 100
    for message in reactions:
        stamp = to_seconds(message.header.stamp)
        force = message.wrench.force
        in_world = discs[stamp][:3, :3] @ [force.x, force.y, force.z]
        assert in_world[2] > 0.0
        assert discs[stamp][:3, 2] @ in_world == pytest.approx(force.z)
        # The disc of the musculoskeletal model is where the joint of the drawn skeleton is.
        np.testing.assert_allclose(discs[stamp][:3, 3], spines[stamp][:3, 3], atol=0.02)


def test_pictures_lie_in_the_time_of_the_recording(recorded: dict[str, list]) -> None:
    live = [stamp for stamp, _ in recorded['joint_states']]
    for topic in ('robot_description', 'visualization', '/tf', '/tf_static'):
        stamps = [stamp for stamp, _ in recorded[topic]]
        assert min(stamps) >= min(live) - 1.0, topic
        # The ghost goes on after the recording's end, until the run has settled.
        assert max(stamps) <= max(live) + 61.0, topic


def test_load_and_optimal_lift_are_shown(recorded: dict[str, list]) -> None:
    texts: dict[str, set[str]] = {}
    for _, message in recorded['visualization']:
        for marker in message.markers:
            if marker.text:
                texts.setdefault(marker.ns, set()).add(marker.text)
    assert texts['predicted'] == {'optimal lift, 7 kg'}
    compressions = {
        f'{value:.0f} N'
        for _, load in recorded['spine_load']
        if load.source == load.LIVE
        for value in load.compression
    }
    assert len(texts['l5_s1']) > 10
    assert texts['l5_s1'] <= compressions
