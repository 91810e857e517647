# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The offline run imports neither rclpy nor a built message package."""

import subprocess
import sys

PROGRAM = """
import sys

class NoRos:
    def find_spec(self, name, path=None, target=None):
        top = name.partition('.')[0]
        if top in ('rclpy', 'lifting_interfaces', 'lifting_node') or top.endswith('_msgs'):
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, NoRos())
from lifting_cli.offline import run_offline
from pathlib import Path
print(run_offline(Path(sys.argv[1]), Path(sys.argv[2])))
"""


def test_offline_run_needs_no_ros(bags, tmp_path):
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM, str(bags / 'symmetric_7kg'), str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / 'results.mcap').exists()
