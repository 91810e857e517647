# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A lifecycle transition whose request or answer is lost is still made, and seen."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

pytest.importorskip('rclpy', reason='lifecycle services need rclpy')

from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState
from rclpy.task import Future

from lifting_cli.lifecycle_change import LifecycleChange

CONFIGURE = Transition.TRANSITION_CONFIGURE
BEFORE = State.PRIMARY_STATE_UNCONFIGURED
AFTER = State.PRIMARY_STATE_INACTIVE
ENDED = State.PRIMARY_STATE_FINALIZED


class Remote:
    """A node that is changed through services; requests and answers are lost as told."""

    def __init__(self, lost_requests=0, lost_answers=0, refuses=False, ready_after=0):
        self.state = BEFORE
        self.requests = 0
        self.lost_requests = lost_requests
        self.lost_answers = lost_answers
        self.refuses = refuses
        self.polls = ready_after
        self.destroyed = 0

    def create_client(self, service, _name):
        call = self.change if service is ChangeState else self.tell
        return SimpleNamespace(call_async=call, service_is_ready=self.ready)

    def destroy_client(self, _client):
        self.destroyed += 1

    def ready(self):
        self.polls -= 1
        return self.polls < 0

    def change(self, request):
        assert request.transition.id == CONFIGURE
        self.requests += 1
        if self.requests <= self.lost_requests:
            return Future()
        success = self.state == BEFORE and not self.refuses
        if success:
            self.state = AFTER
        if self.requests <= self.lost_answers:
            return Future()
        return answered(success=success)

    def tell(self, _request):
        return answered(current_state=SimpleNamespace(id=self.state))


def answered(**fields):
    """Return a future with an answer."""
    future = Future()
    future.set_result(SimpleNamespace(**fields))
    return future


def outcome(remote):
    """Poll until the outcome is known; at most 50 times."""
    change = LifecycleChange(remote, 'node', CONFIGURE, unanswered=0.0)
    for _ in range(50):
        change.poll()
        if change.success is not None:
            break
    change.close()
    assert remote.destroyed == 2
    return change.success


def test_answered_at_once():
    remote = Remote()
    assert outcome(remote) is True
    assert remote.requests == 1


def test_waits_for_the_service():
    assert outcome(Remote(ready_after=5)) is True


@pytest.mark.parametrize('count', [1, 3])
def test_lost_answer(count):
    remote = Remote(lost_answers=count)
    assert outcome(remote) is True
    assert remote.requests == 1


@pytest.mark.parametrize('count', [1, 3])
def test_lost_request_is_sent_again(count):
    remote = Remote(lost_requests=count)
    assert outcome(remote) is True
    assert remote.requests == count + 1


def test_refused_at_once():
    remote = Remote(refuses=True)
    assert outcome(remote) is False
    assert remote.requests == 1


def test_refusal_whose_answer_was_lost():
    assert outcome(Remote(refuses=True, lost_answers=1)) is False


def test_node_that_ended_in_an_error():
    remote = Remote(lost_answers=9)
    remote.change = lambda _request: setattr(remote, 'state', ENDED) or Future()
    assert outcome(remote) is False


def test_slow_node_is_not_given_up():
    """A node that is busy answers nothing until it is done."""
    remote = Remote()
    future = Future()
    remote.change = lambda _request: future
    remote.tell = lambda _request: Future()
    change = LifecycleChange(remote, 'node', CONFIGURE, unanswered=0.0)
    for _ in range(20):
        change.poll()
    assert change.success is None
    future.set_result(SimpleNamespace(success=True))
    change.poll()
    assert change.success is True
