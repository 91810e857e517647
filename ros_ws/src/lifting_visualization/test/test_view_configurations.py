# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The configurations for RViz and Foxglove name topics and fields that exist."""

import json
import re
from pathlib import Path

import pytest
import yaml

CONFIG = Path(__file__).parents[1] / 'config'
STATION = '/station_1/'

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifting_interfaces.msg import AlarmEvent, SpineLoad  # noqa: E402

from lifting_node import qos  # noqa: E402

TOPICS = {'visualization', 'robot_description', 'spine_load', 'alarms'}
TYPES = {'spine_load': SpineLoad, 'alarms': AlarmEvent}


def foxglove():
    return json.loads((CONFIG / 'foxglove.json').read_text(encoding='utf-8'))


def test_foxglove_layout_places_every_panel_once():
    layout = foxglove()

    def leaves(node):
        if isinstance(node, str):
            return [node]
        assert node['direction'] in ('row', 'column')
        return leaves(node['first']) + leaves(node['second'])

    placed = leaves(layout['layout'])
    assert sorted(placed) == sorted(layout['configById'])


def test_foxglove_shows_topics_and_fields_that_exist():
    text = json.dumps(foxglove())
    named = re.findall(rf'"{STATION}(\w+)(?:\{{(\w+)==(\d+)\}})?(?:\.(\w+))?', text)
    assert {topic for topic, *_ in named} == TOPICS
    for topic, switch, value, field in named:
        fields = TYPES[topic].get_fields_and_field_types() if topic in TYPES else {}
        assert not field or field in fields
        if switch:
            assert (topic, switch, int(value)) == ('spine_load', 'source', SpineLoad.LIVE)


def test_foxglove_draws_the_limits_of_the_parameters():
    table = Path(__file__).parents[1] / 'lifting_visualization' / 'data' / 'parameters.yaml'
    parameters = yaml.safe_load(table.read_text(encoding='utf-8'))
    lines = [
        float(path['value'])
        for path in foxglove()['configById']['Plot!compression']['paths']
        if not path['value'].startswith('/')
    ]
    assert lines == [
        parameters[f'compression_{name}']['default'] for name in ('action', 'maximum')
    ]


def test_rviz_asks_for_what_is_offered():
    file = yaml.safe_load((CONFIG / 'station_1.rviz').read_text(encoding='utf-8'))
    manager = file['Visualization Manager']
    assert manager['Global Options']['Fixed Frame'] == 'world'
    displays = {display['Class'].rpartition('/')[2]: display for display in manager['Displays']}
    offered = {
        'MarkerArray': ('Topic', 'visualization', qos.VIEW),
        'RobotModel': ('Description Topic', 'robot_description', qos.LATCHED),
        'Wrench': ('Topic', 'l5_s1/reaction', qos.FRAMES),
    }
    for name, (key, topic, profile) in offered.items():
        asked = displays[name][key]
        assert asked['Value'] == STATION + topic
        assert asked['Reliability Policy'].lower() == profile.reliability.name.lower()
        durability = asked['Durability Policy'].replace(' ', '_').lower()
        assert durability == profile.durability.name.lower()
    assert displays['RobotModel']['TF Prefix'] == STATION.strip('/')
