# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The report page of a run."""

from lifting_bringup.report.data import ReportData
from lifting_bringup.report.page import build_report

__all__ = ['ReportData', 'build_report']
