# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Loads models through a cache on disk, so that an `.osim` file is parsed once per machine.

The name of an entry is a hash of the content of the model file, of the elements to leave out, and
of the modules that read it: if any of them changes, an old entry is not found. Entries are
written under another name and moved into place, so that two processes can build the same one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from tempfile import NamedTemporaryFile
from zipfile import BadZipFile

import numpy as np

from human_model.cache import cache_directory, source_hash
from muscle_analyzer.core.exceptions import ModelCacheError, OsimFormatError
from muscle_analyzer.core.osim.model import OsimModel
from muscle_analyzer.core.osim.model_codec import decode, encode
from muscle_analyzer.core.osim.reader import model_from
from muscle_analyzer.core.osim.xml import OsimXml


def load_model(
    path: Path | str, leave_out: Collection[str] = (), directory: Path | None = None
) -> OsimModel:
    """Return the model of an `.osim` file from the cache, or read it and put it there.

    Parameters
    ----------
    path : Path or str
        The file.
    leave_out : collection of str
        As of `read_osim`.
    directory : Path, optional
        Where entries are kept instead of the cache's usual place.

    Raises
    ------
    OsimFormatError, UnsupportedElementError
        As of `read_osim`.
    """
    path = Path(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise OsimFormatError(f'{path}: cannot be read: {error}') from error
    entry = (directory or cache_directory('models')) / f'{_key(content, leave_out)}.npz'
    try:
        return replace(_read_entry(entry), source=str(path))
    except (OSError, ModelCacheError):
        # Not there yet, or damaged: read the model itself and write the entry anew.
        model = model_from(OsimXml(path, content), leave_out)
    try:
        _write_entry(entry, model)
    except OSError:
        # A cache that cannot be written to (read-only home, full disk) costs time only.
        return model
    return model


def _key(content: bytes, leave_out: Collection[str]) -> str:
    digest = hashlib.sha256(source_hash(__file__).encode())
    digest.update('\n'.join(sorted(leave_out)).encode())
    digest.update(hashlib.sha256(content).digest())
    return digest.hexdigest()


def _read_entry(entry: Path) -> OsimModel:
    try:
        with np.load(entry, allow_pickle=False) as data:
            return decode(bytes(data['structure']).decode(), data['numbers'])
    except (BadZipFile, EOFError, KeyError, ValueError) as error:
        raise ModelCacheError(f'{entry}: {error!r}') from error


def _write_entry(entry: Path, model: OsimModel) -> None:
    entry.parent.mkdir(parents=True, exist_ok=True)
    structure, numbers = encode(model)
    with NamedTemporaryFile(dir=entry.parent, suffix='.part', delete=False) as file:
        try:
            np.savez(file, structure=np.frombuffer(structure.encode(), np.uint8), numbers=numbers)
            file.close()
            Path(file.name).replace(entry)
        except BaseException:
            Path(file.name).unlink(missing_ok=True)
            raise
