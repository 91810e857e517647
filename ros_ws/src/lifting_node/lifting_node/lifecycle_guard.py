# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A lifecycle request that does not fit the state is refused instead of ending the process.

rclpy raises out of its `change_state` service if the transition does not start from the present
state, as when a supervisor asks again after a lost answer.  The exception leaves the executor.
"""

from __future__ import annotations

from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.lifecycle import LifecycleNode


def refuse_unfit_requests(node: LifecycleNode) -> None:
    """Make the `change_state` service of a node answer every request.

    Parameters
    ----------
    node : LifecycleNode
        As made; it is changed.
    """
    service = node._service_change_state
    change = service.callback

    def answer(request: Any, response: Any) -> Any:
        try:
            return change(request, response)
        except rclpy_implementation.RCLError as error:
            wanted = request.transition.label or request.transition.id
            node.get_logger().warning(f'transition {wanted} refused: {error}')
            response.success = False
            return response

    service.callback = answer
