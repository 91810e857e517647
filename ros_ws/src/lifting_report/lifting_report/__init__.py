# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Results files of a run and the report page made from them."""

from lifting_report.page import build_report
from lifting_report.report_data import ReportData

__all__ = ['ReportData', 'build_report']
