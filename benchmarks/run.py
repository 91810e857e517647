# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what the README says: `make bench`, or `python benchmarks/run.py --only cold muscle`.

Each benchmark is a module with a function `run()` that returns its figures by name. They are
written to `results/predictor.json` and `results/muscle.json`, and printed beside their targets and
the dissertation's times.
Run on a machine that does nothing else: the load average is written down with the figures.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import sys
import time
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.targets import TARGETS  # noqa: E402 (the repository is no package)

RESULTS: Final = ROOT / 'benchmarks' / 'results'
ONE_THREAD: Final = ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS', 'NUMBA_NUM_THREADS')

SUITES: Final[dict[str, dict[str, str]]] = {
    'predictor': {
        'sagittal': 'benchmarks.predictor_sagittal',
        'cold': 'benchmarks.predictor_cold',
        'spatial': 'benchmarks.predictor_spatial',
        'pareto': 'benchmarks.predictor_pareto',
        'infeasible': 'benchmarks.predictor_infeasible',
        'random': 'benchmarks.predictor_random',
    },
    'muscle': {
        'frame': 'benchmarks.muscle',
        'in_vivo': 'benchmarks.muscle_in_vivo',
        'chain': 'benchmarks.muscle_chain',
        'stations': 'benchmarks.muscle_stations',
    },
}
"""Result file and its benchmarks, quick ones first."""


def measure(suite: str, only: list[str]) -> dict[str, float]:
    """Run the benchmarks of a suite; those whose module does not exist are left out, and said."""
    figures: dict[str, float] = {}
    for name, module in SUITES[suite].items():
        if only and name not in only and suite not in only:
            continue
        if not (ROOT / f'{module.replace(".", "/")}.py').exists():
            print(f'{name}: no {module}')
            continue
        begin = time.perf_counter()
        measured = importlib.import_module(module).run()
        for key, value in measured.items():
            # Counts of the same name add up: violations of all benchmarks.
            both = key in figures and key == 'dense_grid_violations'
            figures[key] = float(value) + (figures[key] if both else 0.0)
        print(f'{name}: {time.perf_counter() - begin:.0f} s', flush=True)
    return figures


def write(suite: str, figures: dict[str, float], whole: bool) -> Path:
    """Write the figures; a partial run changes its own ones only."""
    from benchmarks.machine import machine_facts

    path = RESULTS / f'{suite}.json'
    old = json.loads(path.read_text(encoding='utf-8')) if path.exists() and not whole else {}
    facts = machine_facts()
    stamps = dict.fromkeys(figures, facts['load_average'])
    merged = {
        'machine': facts,
        'figures': old.get('figures', {}) | figures,
        'load_average': old.get('load_average', {}) | stamps,
    }
    RESULTS.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(merged, indent=2) + '\n', encoding='utf-8')
    return path


def table(suite: str, figures: dict[str, float]) -> str:
    """Table of the figures that have a target, with IPOPT's beside them, then of the others."""
    targets = TARGETS[suite]
    lines = [f'{"":30}{"measured":>12}{"IPOPT":>12}{"target":>12}{"dissertation":>14}']
    for key, target in targets.items():
        if key not in figures:
            continue
        ipopt = f'{figures[f"ipopt_{key}"]:.4g}' if f'ipopt_{key}' in figures else ''
        old = f'{target.dissertation:g}' if target.dissertation is not None else ''
        mark = '' if target.met(figures[key]) else '  missed'
        lines.append(f'{key:30}{figures[key]:12.4g}{ipopt:>12}{target!s:>12}{old:>14}{mark}')
    others = [k for k in figures if k not in targets and k.removeprefix('ipopt_') not in targets]
    lines += [f'{key:30}{figures[key]:12.4g}' for key in others]
    return '\n'.join(lines)


def main() -> int:
    """Run what is asked for; return the exit code."""
    names = [*SUITES, *(name for suite in SUITES.values() for name in suite)]
    parser = argparse.ArgumentParser(description='Speed and accuracy figures.')
    parser.add_argument('--only', nargs='+', choices=names, default=[], metavar='NAME',
                        help=f'of {", ".join(names)}')  # fmt: skip
    only = parser.parse_args().only
    for name in ONE_THREAD:
        os.environ[name] = '1'
    for suite in SUITES:
        figures = measure(suite, only)
        if figures:
            path = write(suite, figures, not only)
            print(table(suite, figures))
            print(f'written to {path.relative_to(ROOT)}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
