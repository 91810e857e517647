# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The whole transition table of the alarm states, entry by entry."""

from itertools import product

import pytest

from injury_monitor.core.alarm import AlarmState as S
from injury_monitor.core.alarm import Trigger as T
from injury_monitor.core.alarm import next_state
from injury_monitor.core.exceptions import AlarmCommandError

# Written out by hand from ISA-18.2; what is not here is refused (commands) or no change (samples).
PLAIN = {
    (S.NORMAL, T.RAISE): S.UNACKNOWLEDGED_ACTIVE,
    (S.NORMAL, T.SHELVE): S.SHELVED,
    (S.NORMAL, T.SUPPRESS): S.SUPPRESSED,
    (S.NORMAL, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.UNACKNOWLEDGED_ACTIVE, T.CLEAR): S.UNACKNOWLEDGED_RETURNED,
    (S.UNACKNOWLEDGED_ACTIVE, T.ACKNOWLEDGE): S.ACKNOWLEDGED_ACTIVE,
    (S.UNACKNOWLEDGED_ACTIVE, T.SHELVE): S.SHELVED,
    (S.UNACKNOWLEDGED_ACTIVE, T.SUPPRESS): S.SUPPRESSED,
    (S.UNACKNOWLEDGED_ACTIVE, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.ACKNOWLEDGED_ACTIVE, T.CLEAR): S.NORMAL,
    (S.ACKNOWLEDGED_ACTIVE, T.SHELVE): S.SHELVED,
    (S.ACKNOWLEDGED_ACTIVE, T.SUPPRESS): S.SUPPRESSED,
    (S.ACKNOWLEDGED_ACTIVE, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.UNACKNOWLEDGED_RETURNED, T.RAISE): S.UNACKNOWLEDGED_ACTIVE,
    (S.UNACKNOWLEDGED_RETURNED, T.ACKNOWLEDGE): S.NORMAL,
    (S.UNACKNOWLEDGED_RETURNED, T.SHELVE): S.SHELVED,
    (S.UNACKNOWLEDGED_RETURNED, T.SUPPRESS): S.SUPPRESSED,
    (S.UNACKNOWLEDGED_RETURNED, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.LATCHED_UNACKNOWLEDGED, T.RAISE): S.UNACKNOWLEDGED_ACTIVE,
    (S.LATCHED_UNACKNOWLEDGED, T.ACKNOWLEDGE): S.LATCHED_ACKNOWLEDGED,
    (S.LATCHED_UNACKNOWLEDGED, T.SHELVE): S.SHELVED,
    (S.LATCHED_UNACKNOWLEDGED, T.SUPPRESS): S.SUPPRESSED,
    (S.LATCHED_UNACKNOWLEDGED, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.LATCHED_ACKNOWLEDGED, T.RAISE): S.UNACKNOWLEDGED_ACTIVE,
    (S.LATCHED_ACKNOWLEDGED, T.RESET): S.NORMAL,
    (S.LATCHED_ACKNOWLEDGED, T.SHELVE): S.SHELVED,
    (S.LATCHED_ACKNOWLEDGED, T.SUPPRESS): S.SUPPRESSED,
    (S.LATCHED_ACKNOWLEDGED, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.SHELVED, T.UNSHELVE): S.NORMAL,
    (S.SHELVED, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.SUPPRESSED, T.UNSUPPRESS): S.NORMAL,
    (S.SUPPRESSED, T.REMOVE_FROM_SERVICE): S.OUT_OF_SERVICE,
    (S.OUT_OF_SERVICE, T.RETURN_TO_SERVICE): S.NORMAL,
}
LATCHING = PLAIN | {
    (S.UNACKNOWLEDGED_ACTIVE, T.CLEAR): S.LATCHED_UNACKNOWLEDGED,
    (S.ACKNOWLEDGED_ACTIVE, T.CLEAR): S.LATCHED_ACKNOWLEDGED,
}


@pytest.mark.parametrize(('state', 'trigger', 'latching'), list(product(S, T, (False, True))))
def test_every_state_meets_every_trigger(state, trigger, latching):
    expected = (LATCHING if latching else PLAIN).get((state, trigger))
    if expected is None and trigger in (T.RAISE, T.CLEAR):
        expected = state
    if expected is None:
        with pytest.raises(AlarmCommandError, match=state.name):
            next_state(state, trigger, latching)
    else:
        assert next_state(state, trigger, latching) is expected


@pytest.mark.parametrize(
    ('state', 'trigger'),
    [
        (S.SHELVED, T.UNSHELVE),
        (S.SUPPRESSED, T.UNSUPPRESS),
        (S.OUT_OF_SERVICE, T.RETURN_TO_SERVICE),
    ],
)
def test_the_end_of_silence_tells_what_is_the_case(state, trigger):
    assert next_state(state, trigger, active=True) is S.UNACKNOWLEDGED_ACTIVE
    assert next_state(state, trigger, latching=True, tripped=True) is S.LATCHED_UNACKNOWLEDGED
    assert next_state(state, trigger, latching=False, tripped=True) is S.NORMAL
