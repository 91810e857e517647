# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Labels and gaps of raw markers: prefixes of subjects, points without a label, 0, 0, 0."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model.typing import Array
from lifting_recordings.exceptions import FileFormatError

# Trajectories without a name: empty, a star and a number (Vicon), "Unlabeled 1234" (Motive).
_UNLABELLED = re.compile(r'(\*.*|unlabell?ed\W*\d*)?', re.IGNORECASE)
#: Markers that a note names one by one; more are counted.
_NAMED = 8


@dataclass(frozen=True)
class Labels:
    """Markers to keep.

    Attributes
    ----------
    columns : tuple of int
        Their positions among the points of the file.
    names : tuple of str
        Their names, unique.
    notes : tuple of str
        Statements for the report.
    """

    columns: tuple[int, ...]
    names: tuple[str, ...]
    notes: tuple[str, ...]


def select_labels(
    path: Path, labels: Sequence[str], prefix: str | None, *, field: str, line: int | None = None
) -> Labels:
    """Choose the labelled markers of a file and name them without the prefix of their subject.

    Parameters
    ----------
    path : Path
        For messages.
    labels : sequence of str
        As in the file, for example ``'Subject1:C7'``.
    prefix : str or None
        Subject whose markers are wanted. A marker of another prefix keeps its whole label if its
        name is also one of the subject's.
    field, line
        Place of the labels in the file, for messages.

    Raises
    ------
    FileFormatError
        No marker has a label, a name occurs twice, or the prefix is not in the file.
    """
    labels = [label.strip() for label in labels]
    kept = [i for i, label in enumerate(labels) if not _UNLABELLED.fullmatch(label)]
    if not kept:
        raise FileFormatError(
            path,
            f'none of its {len(labels)} points has a label: label the trajectories first',
            line=line,
            field=field,
        )
    parts = [labels[i].rpartition(':')[::2] for i in kept]
    prefixes = tuple(dict.fromkeys(p for p, _ in parts if p))
    if prefix is not None and prefixes and prefix not in prefixes:
        raise FileFormatError(
            path,
            f'no label has the prefix {prefix!r}: --label-prefix is one of {", ".join(prefixes)}',
            line=line,
            field=field,
        )
    chosen = {name for before, name in parts if before == prefix}
    names = tuple(
        name if before == prefix or name not in chosen else f'{before}:{name}'
        for before, name in parts
    )
    _unique(path, names, [labels[i] for i in kept], prefixes, field, line)
    notes = []
    if prefixes:
        which = f'those of {prefix} chosen' if prefix in prefixes else 'left out'
        notes.append(f'{path.name}: prefixes of the labels ({", ".join(prefixes)}): {which}.')
    if len(kept) < len(labels):
        notes.append(f'{path.name}: {len(labels) - len(kept)} unlabelled points left out.')
    return Labels(tuple(kept), names, tuple(notes))


def _unique(
    path: Path,
    names: tuple[str, ...],
    labels: list[str],
    prefixes: tuple[str, ...],
    field: str,
    line: int | None,
) -> None:
    """Refuse a name that occurs twice."""
    name, count = Counter(names).most_common(1)[0]
    if count == 1:
        return
    same = [label for label, bare in zip(labels, names, strict=True) if bare == name]
    hint = 'rename one of them in the file'
    if len(set(same)) == count:
        hint = f'choose a subject with --label-prefix, one of {", ".join(prefixes)}'
    raise FileFormatError(
        path, f'{name!r} appears twice ({", ".join(same)}): {hint}', line=line, field=field
    )


def without_zeros(
    path: Path, names: Sequence[str], positions: Array
) -> tuple[Array, tuple[str, ...]]:
    """Return the positions with NaN where a marker is not seen, and the notes of it.

    A marker at exactly 0, 0, 0 is not seen: many programs fill gaps so. A value that is not
    finite is not seen either, and no coordinate of a marker is seen alone.

    Parameters
    ----------
    path : Path
        For the notes.
    names : sequence of str
        Of the markers.
    positions : ndarray, shape (n, n_markers, 3)
        Any units.

    Raises
    ------
    FileFormatError
        No marker is seen in any frame.
    """
    zero = np.all(positions == 0.0, axis=2)
    seen = np.all(np.isfinite(positions), axis=2) & ~zero
    if not seen.any():
        raise FileFormatError(path, 'no marker is seen in any frame', field='positions')
    notes = []
    if zero.any():
        found = [f'{names[int(i)]} ({zero[:, i].sum()})' for i in np.flatnonzero(zero.any(axis=0))]
        more = f' and {len(found) - _NAMED} more' if len(found) > _NAMED else ''
        notes.append(
            f'{path.name}: markers at exactly 0, 0, 0 are not seen (frames): '
            f'{", ".join(found[:_NAMED])}{more}.'
        )
    return np.where(seen[:, :, None], positions, np.nan), tuple(notes)
