# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Limits in force and their sources."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.limits import Zone, limits_for, read_limits, zone_meaning


def test_published_values_and_sources():
    limits = limits_for(50.0)
    assert limits.compression_action.value == 3400.0
    assert limits.compression_maximum.value == 6400.0
    assert 'NIOSH (1981)' in limits.compression_action.source
    assert 'NIOSH (1981)' in limits.compression_maximum.source
    assert 'Gallagher and Marras (2012)' in limits.shear.source
    assert all(limit.source for limit in read_limits().values())


@pytest.mark.parametrize(
    ('loads', 'value', 'within'),
    [
        (0.0, 1000.0, True),
        (100.0, 1000.0, True),
        (100.5, 700.0, True),
        (1000.0, 700.0, True),
        (1001.0, 700.0, False),
    ],
)
def test_shear_limit_follows_loads_a_day(loads, value, within):
    limits = limits_for(loads)
    assert limits.shear.value == value
    assert limits.shear_within_source is within


@pytest.mark.parametrize('loads', [-1.0, math.nan, math.inf])
def test_bad_loads_are_refused(loads):
    with pytest.raises(InvalidInputError, match='loads_per_day'):
        limits_for(loads)


@given(st.floats(min_value=-1e4, max_value=1e5))
def test_zone_agrees_with_the_margins(compression):
    limits = limits_for(50.0)
    expected = (
        Zone.HAZARDOUS
        if limits.compression_maximum.margin(compression) <= 0.0
        else Zone.ACTION
        if limits.compression_action.margin(compression) <= 0.0
        else Zone.NOMINAL
    )
    assert limits.zone(compression) is expected


def test_zone_of_nothing_is_unknown_and_every_zone_has_a_meaning():
    assert limits_for(50.0).zone(math.nan) is Zone.UNKNOWN
    assert len({zone_meaning(zone) for zone in Zone}) == len(Zone)


def test_unknown_limit_name_is_refused():
    with pytest.raises(InvalidInputError, match='no_such_limit'):
        limits_for(50.0).by_name('no_such_limit')
