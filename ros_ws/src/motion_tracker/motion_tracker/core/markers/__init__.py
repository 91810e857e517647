# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker sets, the places of the markers on the segments, frames of markers."""
