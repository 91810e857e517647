# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Each table of the project names its sources, and one reader reads all of them."""

import re
from pathlib import Path

import pytest

from human_model.tables import read_file

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
TABLES = sorted(
    path
    for folder in (*SOURCES.glob('*/*/data'), ROOT / 'docs' / 'data')
    for path in folder.rglob('*.csv')
)
#: A source is a publication with its year, a file, a model, data of others, or a choice of ours.
CITED = re.compile(
    r'\b(18|19|20)\d\d\b|\.(py|osim|xml|csv|trc)\b|thesis|table \d|OpenSim|full-body model|ANSUR'
    r'|Millard torque generators|Occupational Biomechanics|Reference Guide|Vicon|Pose2Sim|Visual3D'
    r'|OpenCap|marker set plug_in_gait'
    r'|this project|engineering choice'
)
READER = SOURCES / 'human_model' / 'human_model' / 'tables.py'


def name(path: Path) -> str:
    """Return the path in the repository."""
    return str(path.relative_to(ROOT))


def test_tables_are_found() -> None:
    packages = {path.relative_to(SOURCES).parts[0] for path in TABLES if SOURCES in path.parents}
    assert {'human_model', 'injury_monitor', 'motion_tracker', 'muscle_analyzer'} <= packages


@pytest.mark.parametrize('path', TABLES, ids=name)
def test_every_row_has_a_source(path: Path) -> None:
    rows = read_file(path, '', sourced=True)
    assert [row['source'] for row in rows if not CITED.search(row['source'])] == []


def test_no_other_module_reads_tables() -> None:
    folders = (SOURCES, ROOT / 'docs', ROOT / 'benchmarks', ROOT / 'bags', ROOT / 'scripts')
    reads = re.compile(r'csv\.(DictReader|reader)|(loadtxt|genfromtxt|read_csv)\(')
    found = [
        name(path)
        for folder in (*folders, ROOT / 'tests')
        for path in sorted(folder.rglob('*.py'))
        if path not in (READER, Path(__file__).resolve())
        and reads.search(path.read_text(encoding='utf-8'))
    ]
    assert found == []
