# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What is written can be read, empty sequences at the end included."""

import numpy as np
import pytest

from lifting_messages import make
from lifting_messages.conversions import point
from lifting_recordings.reader import BagReader
from lifting_report.results_writer import ResultsWriter


def test_messages_come_back_as_they_were(tmp_path):
    joints = make(
        'sensor_msgs/JointState', name=['a', 'b'], position=[1.0, 2.0], velocity=[3.0, 4.0]
    )
    failed = make('PredictedLift', lift_id='lift_001')
    failed.report.status = 202
    failed.report.message = 'no feasible motion'
    risk = make('RiskAssessment', criterion=['x'], multipliers=[1.0, 0.9, 0.8, 0.7, 0.6, 0.5])
    place = point(np.array([1.0, 2.0, np.nan]))
    task = make('Task', task_id='t', box_size=[0.1, 0.2, 0.3], box_start=place)
    moments = [
        make('trajectory_msgs/JointTrajectoryPoint', positions=positions)
        for positions in ([1.5], [])
    ]
    path = make('trajectory_msgs/JointTrajectory', joint_names=['a'], points=moments)
    messages = {
        'joint_states': joints,
        'predicted_lift': failed,
        'risk_assessment': risk,
        'task': task,
        'path': path,
    }
    with ResultsWriter(tmp_path / 'results.mcap', 'cell') as writer:
        for topic, message in messages.items():
            message.header.stamp.sec = 7
            writer.write(topic, message)
    with BagReader(tmp_path / 'results.mcap') as bag:
        read = {name.removeprefix('/cell/'): message for name, _, message in bag.messages()}
    assert set(read) == set(messages)
    assert list(read['joint_states'].velocity) == [3.0, 4.0]
    assert read['joint_states'].effort.size == 0
    assert read['predicted_lift'].report.status == 202
    assert read['predicted_lift'].report.message == 'no feasible motion'
    assert list(read['risk_assessment'].multipliers) == pytest.approx([1, 0.9, 0.8, 0.7, 0.6, 0.5])
    assert list(read['task'].box_size) == [0.1, 0.2, 0.3]
    assert np.isnan(read['task'].box_start.z)
    assert [list(point.positions) for point in read['path'].points] == [[1.5], []]
