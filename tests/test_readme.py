# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What the documents say is so: topics, commands, links, parameters, figures."""

from __future__ import annotations

import argparse
import ast
import re
import sys
from importlib import import_module
from pathlib import Path

import pytest

from human_model.tables import read_table

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
QUALITIES = {
    'PLATES': 'plates',
    'FRAMES': 'frames',
    'LATCHED': 'latched',
    'RESULTS': 'results',
    'VIEW': 'view',
    'TRANSFORMS': 'transforms',
}
#: Values of the variable in a topic's name.
VARIABLES = {'side': ('right', 'left')}

Endpoint = tuple[str, str]


def alternatives(name: str) -> list[str]:
    """Write out the braces of a topic's name."""
    match = re.fullmatch(r'(.*)\{([^}]*)\}(.*)', name)
    if not match:
        return [name]
    return [match[1] + word + match[3] for word in match[2].split(',')]


def topic_names(node: ast.expr, assigned: dict[str, ast.expr], values: object) -> list[str]:
    """Return the topics an expression stands for; variables as in VARIABLES.

    Tables of the node's module are looked up in `values`, the imported module.
    """
    if isinstance(node, ast.Name):
        node = assigned[node.id]
    if isinstance(node, ast.Constant):
        return [str(node.value)]
    if isinstance(node, ast.Subscript):
        assert isinstance(node.value, ast.Name), ast.dump(node)
        keys = [node.slice.value] if isinstance(node.slice, ast.Constant) else []
        if isinstance(node.slice, ast.Name):
            keys = list(VARIABLES[node.slice.id])
        assert keys, ast.dump(node)
        return [getattr(values, node.value.id)[key] for key in keys]
    assert isinstance(node, ast.JoinedStr), ast.dump(node)
    names = ['']
    for part in node.values:
        if isinstance(part, ast.Constant):
            names = [name + str(part.value) for name in names]
        else:
            assert isinstance(part, ast.FormattedValue) and isinstance(part.value, ast.Name)
            names = [name + value for name in names for value in VARIABLES[part.value.id]]
    return names


def full_types(tree: ast.Module) -> dict[str, str]:
    """Return message, service and action types by the name they are imported under."""
    return {
        alias.asname or alias.name: f'{node.module.rpartition(".")[0]}/{alias.name}'
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        and node.module
        and node.module.endswith(('.msg', '.srv', '.action'))
        for alias in node.names
    }


def endpoints(package: str, methods: tuple[str, ...]) -> dict[str, Endpoint]:
    """Return type and quality of service by topic of what a node's source opens."""
    source = (SOURCES / package / package / f'{package}_node.py').read_text(encoding='utf-8')
    tree = ast.parse(source)
    module = import_module(f'{package}.{package}_node')
    types = full_types(tree)
    assigned = {
        target.id: node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    found = {}
    for node in ast.walk(tree):
        if not (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in methods
        ):
            continue
        kind = node.args[0]
        quality = [
            argument.attr
            for argument in node.args
            if isinstance(argument, ast.Attribute) and argument.attr in QUALITIES
        ]
        assert isinstance(kind, ast.Name) and len(quality) == 1, ast.dump(node)
        for name in topic_names(node.args[1], assigned, module):
            found[name] = (types[kind.id], QUALITIES[quality[0]])
    return found


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


def test_topics_table_is_what_the_nodes_publish() -> None:
    published = {
        name: (*endpoint, package)
        for package in NODES
        for name, endpoint in endpoints(package, ('advertise',)).items()
    }
    assert {name: row for name, row in documented().items() if row[2] != 'bag'} == published


@pytest.mark.parametrize('package', NODES)
def test_what_a_node_reads_is_published_with_that_type(package: str) -> None:
    table = documented()
    read = endpoints(package, ('subscribe', 'create_subscription'))
    assert read, 'the node reads nothing'
    assert read == {name: table[name][:2] for name in read}


def test_everything_from_the_bag_is_read_by_some_node() -> None:
    read = {name for package in NODES for name in endpoints(package, ('subscribe',))}
    assert {name for name, row in documented().items() if row[2] == 'bag'} <= read


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
        first = {'create_service': 0, 'ActionServer': 1}.get(name)
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
def test_depths_of_the_queues_are_those_of_the_nodes(name: str) -> None:
    from lifting_node import qos

    text = (ROOT / name).read_text(encoding='utf-8').replace(' 000', '000')
    for depth in (qos.PLATE_DEPTH, qos.FRAME_DEPTH, qos.LIFT_DEPTH):
        assert re.search(rf'\b{depth}\b', text), f'{name} does not name {depth}'


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


def docs_module(name: str) -> object:
    """Import a script of docs/."""
    sys.path.insert(0, str(ROOT / 'docs'))
    try:
        return __import__(name)
    finally:
        sys.path.pop(0)


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
