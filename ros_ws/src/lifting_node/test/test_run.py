# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The process of a node."""

import os

import pytest

pytest.importorskip('rclpy', reason='rclpy is not installed')

from lifting_messages.exceptions import ParameterError
from lifting_node.discovery import STAY_ON_MACHINE
from lifting_node.run import run_node

RANGE = STAY_ON_MACHINE[0]


@pytest.mark.parametrize(('given', 'used'), [(None, 'LOCALHOST'), ('SUBNET', 'SUBNET')])
def test_discovery_stays_on_the_machine_unless_set(monkeypatch, given, used):
    if given is None:
        monkeypatch.delenv(RANGE, raising=False)
    else:
        monkeypatch.setenv(RANGE, given)
    found = []

    def factory():
        found.append(os.environ[RANGE])
        raise ParameterError('the node need not start')

    with pytest.raises(SystemExit) as caught:
        run_node(factory, [])
    assert (found, caught.value.code) == ([used], 2)
