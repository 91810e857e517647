# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters are declared with range and unit, and bad values are refused."""

import pytest
import rclpy
from rclpy.node import Node

from lifting_messages.exceptions import ParameterError
from lifting_messages.parameters import Parameter
from lifting_node.parameters import declare

TABLE = (
    Parameter('cutoff', 'Low-pass of the motion', 'Hz', 6.0, 1.0, 30.0),
    Parameter('frame', 'Disc frame', '', 'chaffin', choices=('chaffin', 'vertebral')),
)


@pytest.fixture
def make_node():
    """Return a maker of nodes with parameter overrides."""
    rclpy.init()
    nodes = []

    def make(*overrides):
        arguments = ['--ros-args']
        for override in overrides:
            arguments += ['-p', override]
        nodes.append(Node('station_part', cli_args=arguments))
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    rclpy.shutdown()


def test_defaults_and_descriptors_reach_the_node(make_node):
    """The unit stands in the description, the range in the descriptor."""
    node = make_node()
    assert declare(node, TABLE) == {'cutoff': 6.0, 'frame': 'chaffin'}
    descriptor = node.describe_parameter('cutoff')
    assert descriptor.description == 'Low-pass of the motion [Hz]'
    assert descriptor.floating_point_range[0].to_value == 30.0


@pytest.mark.parametrize(
    ('override', 'name'),
    [('cutoff:=300.0', 'cutoff'), ('cutoff:=six', 'cutoff'), ('frame:=other', 'frame')],
)
def test_a_bad_value_is_refused_by_name(make_node, override, name):
    """Out of range, wrong type and unknown choice say which parameter."""
    with pytest.raises(ParameterError, match=name):
        declare(make_node(override), TABLE)
