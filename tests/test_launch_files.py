# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Launch and parameter files are right for a full ROS 2, as far as that shows without one.

`launch` and `launch_ros` are not on PyPI: recording stand-ins take their place, so that every
launch file runs and the packages and executables it asks for are checked against this workspace.
"""

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType
from unittest.mock import MagicMock

import pytest
import yaml

SOURCE = Path(__file__).parents[1] / 'ros_ws' / 'src'
LAUNCH_FILES = sorted(SOURCE.glob('*/launch/*.launch.py'))
PARAMETER_FILES = sorted(SOURCE.glob('*/config/*.yaml'))
NODES = (
    'motion_tracker',
    'lift_predictor',
    'muscle_analyzer',
    'injury_monitor',
    'lifting_visualization',
)


@pytest.fixture
def stand_ins(monkeypatch):
    """Put recorders in the place of `launch` and `launch_ros`; return that of LifecycleNode."""
    recorder = MagicMock(name='LifecycleNode')
    for name in (
        'launch',
        'launch.actions',
        'launch.conditions',
        'launch.event_handlers',
        'launch.events',
        'launch.launch_description_sources',
        'launch.substitutions',
        'launch_ros',
        'launch_ros.actions',
        'launch_ros.event_handlers',
        'launch_ros.events',
        'launch_ros.events.lifecycle',
        'launch_ros.substitutions',
        'ament_index_python',
        'ament_index_python.packages',
    ):
        module = ModuleType(name)
        module.__getattr__ = lambda attribute, parent=name: MagicMock(name=f'{parent}.{attribute}')
        monkeypatch.setitem(sys.modules, name, module)
    sys.modules['launch_ros.actions'].LifecycleNode = recorder
    return recorder


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_launch_file_starts_executables_that_exist(path, stand_ins):
    """Every node it starts is an entry point of its package."""
    spec = importlib.util.spec_from_file_location(path.stem.replace('.', '_'), path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.generate_launch_description() is not None
    assert stand_ins.call_args_list, f'{path} starts no lifecycle node'
    for call in stand_ins.call_args_list:
        package, executable = call.kwargs['package'], call.kwargs['executable']
        setup = (SOURCE / package / 'setup.cfg').read_text(encoding='utf-8')
        assert re.search(rf'^ +{executable} = {package}\.\w+:main$', setup, re.MULTILINE)


def test_graph_restarts_every_node_and_passes_the_journal(stand_ins):
    path = SOURCE / 'lifting_bringup' / 'launch' / 'lift.launch.py'
    spec = importlib.util.spec_from_file_location('lift_launch', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.generate_launch_description()
    calls = {call.kwargs['package']: call.kwargs for call in stand_ins.call_args_list}
    assert set(calls) == set(NODES)
    assert all(kwargs['respawn'] and kwargs['respawn_delay'] > 0.0 for kwargs in calls.values())
    names = {key for part in calls['injury_monitor']['parameters'][1:] for key in part}
    assert 'journal' in names


@pytest.mark.parametrize('node', NODES)
def test_parameter_file_repeats_the_declared_defaults(node):
    """A user who starts from the file starts from the same values as without it."""
    table = SOURCE / node / node / 'data' / 'parameters.yaml'
    declared = yaml.safe_load(table.read_text(encoding='utf-8'))
    config = yaml.safe_load(
        (SOURCE / node / 'config' / f'{node}.yaml').read_text(encoding='utf-8')
    )
    ((root, section),) = config.items()
    assert root.endswith(node)
    values = section['ros__parameters']
    assert values == {name: entry['default'] for name, entry in declared.items()}


def test_there_is_one_launch_file_for_the_graph_and_one_for_each_node():
    """No node is left without its own launch file."""
    names = {path.name for path in LAUNCH_FILES}
    assert {'lift.launch.py', *(f'{node}.launch.py' for node in NODES)} <= names
