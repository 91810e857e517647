# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What the documents say is so: topics, commands, links, parameters, figures."""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from human_model.tables import read_table
from lifting_messages.topics import Quality, Topic

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
NODES = (
    'motion_tracker',
    'lift_predictor',
    'muscle_analyzer',
    'injury_monitor',
    'lifting_visualization',
)
README = (ROOT / 'README.md').read_text(encoding='utf-8')
TOPICS = (ROOT / 'docs' / 'topics.md').read_text(encoding='utf-8')
COMMANDS = (ROOT / 'docs' / 'commands.md').read_text(encoding='utf-8')
ALARMS = (ROOT / 'docs' / 'alarms.md').read_text(encoding='utf-8')
RECORDINGS = (ROOT / 'docs' / 'recordings.md').read_text(encoding='utf-8')
README_LINES = 120
DOCUMENTS = sorted(
    path
    for path in (
        *ROOT.glob('*.md'),
        *ROOT.glob('docs/*.md'),
        *ROOT.glob('bags/*.md'),
        *SOURCES.glob('*/*.md'),
    )
)


def alternatives(name: str) -> list[str]:
    """Write out the braces of a topic's name."""
    match = re.fullmatch(r'(.*)\{([^}]*)\}(.*)', name)
    if not match:
        return [name]
    return [match[1] + word + match[3] for word in match[2].split(',')]


def topics_of(package: str) -> ModuleType:
    """Return the module with the declared topics of a package."""
    return import_module(f'{package}.topics')


def declared(topics: Iterable[Topic]) -> dict[str, tuple[str, str]]:
    """Return type and quality of service by topic."""
    return {topic.name: (topic.type, topic.quality.name.lower()) for topic in topics}


def documented() -> dict[str, tuple[str, str, str]]:
    """Return type, quality of service and publisher by topic of the table in docs/topics.md."""
    rows = re.findall(
        r'^\| `([\w/{},]+)` \| `(\w+/\w+)` \| (\w+) \| (`?\w+`?) \|', TOPICS, re.MULTILINE
    )
    return {
        name: (kind, quality, publisher.strip('`'))
        for braces, kind, quality, publisher in rows
        for name in alternatives(braces)
    }


def test_topics_table_lists_the_outputs_of_the_packages() -> None:
    published = {
        name: (*endpoint, package)
        for package in NODES
        for name, endpoint in declared(topics_of(package).OUTPUTS).items()
    }
    assert {name: row for name, row in documented().items() if row[2] != 'bag'} == published


@pytest.mark.parametrize('package', NODES)
def test_an_input_is_published_with_its_type_and_quality(package: str) -> None:
    table = documented()
    read = declared(topics_of(package).INPUTS)
    assert read == {name: table[name][:2] for name in read}


def test_each_topic_of_a_recording_is_the_input_of_a_package() -> None:
    read = {topic.name for package in NODES for topic in topics_of(package).INPUTS}
    assert {name for name, row in documented().items() if row[2] == 'bag'} <= read


@pytest.mark.parametrize('package', NODES)
def test_a_station_has_a_handler_of_each_input_and_a_node(package: str) -> None:
    node = import_module(f'{package}.{package}_node')
    (kind,) = {
        found.STATION
        for found in vars(node).values()
        if isinstance(found, type) and found.__module__ == node.__name__
    }
    assert (package, topics_of(package).INPUTS) == (kind.PACKAGE, kind.INPUTS)
    assert set(kind().handlers) == {topic.name for topic in kind.INPUTS}


def docs_module(name: str) -> Any:
    """Import a script of docs/."""
    sys.path.insert(0, str(ROOT / 'docs'))
    try:
        return __import__(name)
    finally:
        sys.path.pop(0)


def drawn_flows() -> dict[tuple[str, str], set[str]]:
    """Return the topics on the arrows of the data flow figure, by their ends."""
    flows: dict[tuple[str, str], set[str]] = {}
    for label in docs_module('data_flow').LABELS:
        if label.flow is not None:
            words = ' '.join(label.lines).replace(' (live)', '')
            names = re.findall(r'(?:[^\s,{]|{[^}]*})+', words)
            flows.setdefault(label.flow, set()).update(
                name for braces in names for name in alternatives(braces)
            )
    return flows


def test_arrows_of_the_data_flow_are_the_declared_topics() -> None:
    names = {
        package: [
            {topic.name for topic in topics}
            for topics in (topics_of(package).INPUTS, topics_of(package).OUTPUTS)
        ]
        for package in NODES
    }
    computation = [package for package in NODES if package != 'lifting_visualization']
    flows = {}
    for package, (inputs, outputs) in names.items():
        read = {other: names[other][0] & outputs for other in computation}
        flows.update({(package, other): found for other, found in read.items() if found})
        flows[package, ''] = outputs.difference(*read.values())
        if package == 'motion_tracker':
            flows['', package] = inputs - {'subject', 'task'}
    assert drawn_flows() == flows


def full_types(tree: ast.Module) -> dict[str, str]:
    """Return service and action types by the name they are imported under."""
    return {
        alias.asname or alias.name: f'{node.module.rpartition(".")[0]}/{alias.name}'
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        and node.module
        and node.module.endswith(('.srv', '.action'))
        for alias in node.names
    }


def served(package: str) -> dict[str, str]:
    """Return type by name of the services and actions the modules beside a node's open."""
    found: dict[str, str] = {}
    for path in sorted((SOURCES / package / package).glob('*.py')):
        tree = ast.parse(path.read_text(encoding='utf-8'))
        found |= _served(package, tree, full_types(tree))
    return found


def _served(package: str, tree: ast.Module, types: dict[str, str]) -> dict[str, str]:
    found = {}
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = getattr(node.func, 'attr', getattr(node.func, 'id', ''))
        first = {'serve': 0, 'create_service': 0, 'ActionServer': 1}.get(name)
        if first is None:
            continue
        kind, topic = node.args[first : first + 2]
        assert isinstance(kind, ast.Name) and isinstance(topic, ast.Constant), ast.dump(node)
        found[str(topic.value).replace('~', package)] = types[kind.id]
    return found


def test_services_table_is_what_the_nodes_serve() -> None:
    rows = re.findall(
        r'^\| `([\w/]+)`(?: \(action\))? \| `(\w+/\w+)` \| [^|]*\|$', TOPICS, re.MULTILINE
    )
    assert dict(rows) == {
        name: kind for package in NODES for name, kind in served(package).items()
    }


@pytest.mark.parametrize('name', ['docs/topics.md', 'docs/architecture.md'])
def test_depths_of_the_queues_are_the_declared_ones(name: str) -> None:
    text = (ROOT / name).read_text(encoding='utf-8').replace(' 000', '000')
    for quality in Quality:
        assert re.search(rf'\b{quality.depth}\b', text), f'{name} does not name {quality.depth}'


def make_targets() -> set[str]:
    text = (ROOT / 'Makefile').read_text(encoding='utf-8')
    return set(re.findall(r'^([a-z-]+):', text, re.MULTILINE))


def lift_commands() -> dict[str, set[str]]:
    """Return the options of each subcommand of `lift`."""
    from lifting_cli.cli import _parser

    action = next(
        action for action in _parser()._actions if isinstance(action, argparse._SubParsersAction)
    )
    return {
        name: {option for entry in parser._actions for option in entry.option_strings}
        for name, parser in action.choices.items()
    }


def code_of(path: Path) -> list[str]:
    """Return code spans, and lines of code blocks, of a document."""
    text = path.read_text(encoding='utf-8')
    blocks = re.findall(r'^```\w*\n(.*?)^```', text, re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    lines += [line.strip() for line in text.splitlines() if line.startswith('    ')]
    return lines + re.findall(r'`([^`\n]+)`', text)


@pytest.mark.parametrize('path', DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_exist(path: Path) -> None:
    commands = lift_commands()
    for code in code_of(path):
        for words in re.findall(r'^(?:PYTHON=\S+ )?make ((?:[a-z-]+ ?)+)', code):
            assert set(words.split()) <= make_targets(), code
        match = re.search(r'(?:^|bringup )(?:\.venv/bin/)?lift ([a-z][a-z-]*)(.*)', code)
        if match:
            assert match[1] in commands, code
            assert set(re.findall(r'(--[a-z-]+)', match[2])) <= commands[match[1]], code


def test_every_lift_command_is_documented() -> None:
    assert [name for name in lift_commands() if f'| `lift {name}' not in COMMANDS] == []


def test_readme_is_a_first_page() -> None:
    assert len(README.splitlines()) <= README_LINES


def anchors(path: Path) -> set[str]:
    """Return the anchors of a document's headings."""
    headings = re.findall(r'^#+ (.*)$', path.read_text(encoding='utf-8'), re.MULTILINE)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


@pytest.mark.parametrize('path', DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_resolve(path: Path) -> None:
    for target in re.findall(r'\]\(([^)\s]+)\)', path.read_text(encoding='utf-8')):
        if re.match(r'[a-z]+:', target):
            continue
        place, _, anchor = target.partition('#')
        goal = (path.parent / place).resolve() if place else path
        assert goal.exists(), f'{path.name} links to {target}'
        if anchor:
            assert anchor in anchors(goal), f'{path.name} links to {target}'


def test_every_document_is_reached_from_the_readme() -> None:
    reached, new = set(), [ROOT / 'README.md']
    while new:
        path = new.pop()
        reached.add(path)
        for target in re.findall(r'\]\(([^)\s#]+\.md)', path.read_text(encoding='utf-8')):
            goal = (path.parent / target).resolve()
            if goal not in reached and goal.exists():
                new.append(goal)
    assert [str(path.relative_to(ROOT)) for path in DOCUMENTS if path not in reached] == []


def test_parameters_page_is_up_to_date() -> None:
    page = docs_module('parameters_table').page()
    stored = (ROOT / 'docs' / 'parameters.md').read_text(encoding='utf-8')
    assert stored == page, 'run docs/parameters_table.py'
    assert [node for node in NODES if f'## {node}\n' not in page] == []


def test_data_flow_figure_is_up_to_date_and_names_every_topic() -> None:
    module = docs_module('data_flow')
    figure = module.FIGURE.read_text(encoding='utf-8')
    assert figure == module.draw(), 'run docs/data_flow.py'
    words = re.findall(r'[\w/{},]+', re.sub(r'<[^>]*>', ' ', figure))
    drawn = {name for word in words for name in alternatives(word.strip(','))}
    assert set(documented()) <= drawn


def test_alarms_table_is_that_of_the_monitor() -> None:
    rows = read_table('injury_monitor', 'limits.csv', 'limit value')
    limits = {row['limit']: row['value'] for row in rows}
    table = {
        name: (limit, latching)
        for name, limit, latching in re.findall(
            r'^\| `(\w+)` \| ([^|]+) \| (yes|no) \|', ALARMS, re.MULTILINE
        )
    }
    alarms = read_table('injury_monitor', 'alarms.csv', 'alarm limit latching')
    assert set(table) == {row['alarm'] for row in alarms}
    for row in alarms:
        limit, latching = table[row['alarm']]
        assert latching == row['latching']
        first = re.match(r'[\d.]+', limit)
        assert first is not None
        names = [name for name in limits if name.startswith(row['limit'].split('_in_')[0])]
        assert first[0] in {limits[name] for name in names}, limit


def test_subject_file_example_is_accepted(tmp_path: Path) -> None:
    from lifting_recordings.subject_file import read_subject_file

    block = re.search(r'^```yaml\n(subject:.*?)^```', RECORDINGS, re.MULTILINE | re.DOTALL)
    assert block is not None
    path = tmp_path / 'person.yaml'
    path.write_text(block[1], encoding='utf-8')
    entry = read_subject_file(path)
    assert entry.task.box.mass == 12.0
