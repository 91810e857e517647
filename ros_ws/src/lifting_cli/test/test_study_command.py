# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift study` as a process: killed and started again, on a Dask cluster, over two networks."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from lift_predictor.core.study.store import BATCH

pq = pytest.importorskip('pyarrow.parquet', reason='pyarrow is not installed')
pytest.importorskip('distributed', reason='Dask is not installed')

PATIENCE = 120.0
STUDY = """
name: test
subjects:
  sample: {count: %d, seed: 4, sex: {choice: {male: 1, female: 1}}, stature: {normal: [1.7, 0.08]},
           bmi: 24, age: 30}
tasks:
  - {name: given, box_mass: 5.0, box_size: [0.24, 0.3, 0.13], start: [0.37, 0, 0.07],
     end: [0.5, 0, 0.95], feet: [0, 0]}
  - {name: behind, box_mass: 5.0, box_size: [0.24, 0.3, 0.13], start: [0.37, 0, 0.07],
     end: [-0.5, 0.05, 0.95], feet: [0, 0]}
"""


def study_file(tmp_path: Path, count: int) -> Path:
    path = tmp_path / 'study.yaml'
    path.write_text(STUDY % count, encoding='utf-8')
    return path


def command(path: Path, output: Path, *more: str) -> list[str]:
    return [
        sys.executable, '-m', 'lifting_cli.cli', 'study', str(path), '--output', str(output),
        *more,
    ]  # fmt: skip


def run(path: Path, output: Path, *more: str) -> str:
    """Run a study to its end; return what it printed."""
    done = subprocess.run(
        command(path, output, *more), capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def rows(output: Path) -> list[dict]:
    return pq.read_table(output / 'results.parquet').to_pylist()


def check_complete(found: list[dict], count: int) -> None:
    """Every case has one row: a lift for the one task, the reason for the other."""
    assert len({row['case_id'] for row in found}) == len(found) == 2 * count
    given = [row for row in found if row['task'] == 'given']
    behind = [row for row in found if row['task'] == 'behind']
    assert all(row['status'] == 0 and row['effort'] > 0.0 for row in given), given
    assert all(row['status_name'] == 'PREDICTOR_BAD_INPUT' for row in behind), behind
    assert all('turns' in row['message'] and row['effort'] is None for row in behind)


def test_killed_study_goes_on_and_solves_nothing_twice(tmp_path: Path) -> None:
    # More than one batch: however fast the machine, rows are on the disk before the study ends.
    subjects, cases = 40, 80
    assert cases > BATCH
    path, output = study_file(tmp_path, subjects), tmp_path / 'out'
    first = subprocess.Popen(
        command(path, output, '--processes', '1'), stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        deadline = time.monotonic() + PATIENCE
        while not list(output.glob('parts/*.parquet')):
            assert first.poll() is None, 'the study was over before it could be killed'
            assert time.monotonic() < deadline, 'no rows were written'
            time.sleep(0.02)
    finally:
        os.killpg(first.pid, signal.SIGKILL)
        first.wait()
    parts = [pq.read_table(part).to_pylist() for part in output.glob('parts/*.parquet')]
    saved = {row['case_id']: row for part in parts for row in part}
    assert 0 < len(saved) < cases
    assert f'{len(saved)} of {cases} cases were solved before' in run(path, output)
    found = rows(output)
    check_complete(found, subjects)
    for row in found:
        if row['case_id'] in saved:
            assert row['process'] == saved[row['case_id']]['process']


def free_port() -> int:
    with socket.socket() as one:
        one.bind(('127.0.0.1', 0))
        return int(one.getsockname()[1])


@contextmanager
def process(*words: str) -> Iterator[subprocess.Popen]:
    """Run a process in the background; it is killed at the end come what may."""
    with subprocess.Popen(
        words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    ) as running:
        try:
            yield running
        finally:
            os.killpg(running.pid, signal.SIGKILL)


def scheduler(port: int, host: str) -> list[str]:
    return [
        sys.executable, '-m', 'distributed.cli.dask_scheduler', '--host', host,
        '--port', str(port), '--no-dashboard',
    ]  # fmt: skip


def worker(address: str, folder: Path, name: str) -> list[str]:
    return [
        sys.executable, '-m', 'distributed.cli.dask_worker', address, '--nthreads', '1',
        '--no-dashboard', '--local-directory', str(folder / name), '--name', name,
    ]  # fmt: skip


def test_cluster_gives_the_rows_of_one_machine(tmp_path: Path) -> None:
    path, port = study_file(tmp_path, 3), free_port()
    address = f'tcp://127.0.0.1:{port}'
    with ExitStack() as stack:
        stack.enter_context(process(*scheduler(port, '127.0.0.1')))
        for name in ('a', 'b'):
            stack.enter_context(process(*worker(address, tmp_path, name)))
        printed = run(path, tmp_path / 'cluster', '--scheduler', address)
    assert f'of {address}' in printed
    found = rows(tmp_path / 'cluster')
    check_complete(found, 3)
    run(path, tmp_path / 'local', '--processes', '1')
    for one, other in zip(found, rows(tmp_path / 'local'), strict=True):
        assert one['case_id'] == other['case_id']
        assert one['objective'] == pytest.approx(other['objective'], rel=1e-9)


def test_scheduler_that_is_not_there_is_named(tmp_path: Path) -> None:
    address = f'tcp://127.0.0.1:{free_port()}'
    done = subprocess.run(
        command(study_file(tmp_path, 1), tmp_path / 'out', '--scheduler', address),
        capture_output=True, text=True, timeout=PATIENCE, check=False,
    )  # fmt: skip
    assert done.returncode == 1
    assert f'scheduler {address}: does not answer' in done.stderr


@contextmanager
def two_networks() -> Iterator[tuple[str, str, str]]:
    """Make two network namespaces with a cable between them; give their names and one address."""
    if shutil.which('ip') is None:
        pytest.skip('there is no ip command to make network namespaces with')
    one, two = (f'lift{os.getpid()}{side}' for side in 'ab')
    cable = (f'l{os.getpid() % 100000}a', f'l{os.getpid() % 100000}b')
    made = []
    try:
        for name in (one, two):
            done = subprocess.run(
                ['ip', 'netns', 'add', name], capture_output=True, text=True, check=False
            )
            if done.returncode:
                pytest.skip(f'network namespaces are not permitted here: {done.stderr.strip()}')
            made.append(name)
        subprocess.run(
            ['ip', 'link', 'add', cable[0], 'type', 'veth', 'peer', 'name', cable[1]], check=True
        )
        for name, end, place in zip((one, two), cable, ('10.213.7.1', '10.213.7.2'), strict=True):
            subprocess.run(['ip', 'link', 'set', end, 'netns', name], check=True)
            inside = ['ip', 'netns', 'exec', name, 'ip']
            subprocess.run([*inside, 'addr', 'add', f'{place}/24', 'dev', end], check=True)
            subprocess.run([*inside, 'link', 'set', end, 'up'], check=True)
            subprocess.run([*inside, 'link', 'set', 'lo', 'up'], check=True)
        yield one, two, '10.213.7.1'
    finally:
        for name in made:
            subprocess.run(['ip', 'netns', 'delete', name], check=True)


def test_worker_in_another_network_solves_the_cases(tmp_path: Path) -> None:
    path = study_file(tmp_path, 2)
    with two_networks() as (one, two, host), ExitStack() as stack:
        address = f'tcp://{host}:8786'
        inside, other = (['ip', 'netns', 'exec', name] for name in (one, two))
        stack.enter_context(process(*inside, *scheduler(8786, host)))
        far = stack.enter_context(process(*other, *worker(address, tmp_path, 'far')))
        done = subprocess.run(
            [*inside, *command(path, tmp_path / 'out', '--scheduler', address)],
            capture_output=True, text=True, timeout=PATIENCE, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert far.poll() is None
    found = rows(tmp_path / 'out')
    check_complete(found, 2)
    # Solved by the only worker there was, which is not this process nor its child.
    assert len({row['process'] for row in found}) == 1
