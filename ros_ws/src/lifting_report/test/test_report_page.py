# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The report page from made-up data (marked as such), complete and with parts missing."""

import re
from dataclasses import fields, replace
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest

from injury_monitor.core.assessment import Criterion
from lifting_report import build_report
from lifting_report.exceptions import ReportError
from lifting_report.figures.loads import muscle_groups
from lifting_report.page import render
from lifting_report.report_data import (
    Activations,
    AlarmRow,
    BodyPoints,
    Comparison,
    GroundForces,
    Header,
    JointAngles,
    JointLoads,
    Lifting,
    LiftReport,
    Missing,
    Pair,
    QualityRow,
    ReportData,
    Risk,
    SolveRow,
    SpineCurves,
    Torques,
)

# fmt: off
# Tables of made-up data: several numbers a line.
HEADER = Header(
    'P07', 'male', 63.5, 1.69, 31.0, 'symmetric_12kg', 'Made-up data for a test of the page',
    'made_up.mcap', 'Test of the page; no recording behind it.', True, 12.0, 500.0, 1.0, 2.0,
    'offline', '2026-01-01 12:00', '0.1.0')
MUSCLES = ('bflh_r', 'bflh_l', 'bfsh_r', 'vaslat_r', 'vaslat_l', 'vasmed_r', 'glmax1_r',
           'glmed2_l', 'LD_L1_r', 'LD_T7_l', 'MF_m1s_r', 'MF_m5t_3_l', 'LTpT_T1_r', 'LTpL_L5_l',
           'EO1_r', 'IO6_l')
PHRASES = (
    'SIMULATED RECORDING', 'P07', 'symmetric_12kg', 'made_up.mcap', '63.5',
    'NIOSH action limit, 3400 N', 'above the NIOSH action limit', 'avoidable', '1230',
    'Joint angles', 'Ground reaction', 'Joint torques', 'Torque index',
    'Muscle activations', 'lift_001', 'lift_002', 'RWL', 'LI', 'HM',
    'angle [deg]', 'force [N]', 'torque [N m]', 'activation [1]',
    'course of the lift [%]', 'body weight', 'dynamic strength limit',
    'Solve reports', 'PREDICTOR_TIME_LIMIT', 'stopped after 60 s',
    'marker distance, rms', 'Limits of the models', 'Gallagher and Marras 2012',
    'l5 s1 compression high', 'NIOSH maximum permissible limit, 6400 N',
    '0.4 s at the end of the bag were lost',
)
JOINT_NAMES = ('spine', 'shoulder', 'elbow', 'hip', 'knee', 'ankle')


def shape(n, scale, sharp=1.0):
    return scale * np.sin(np.pi * np.linspace(0.0, 1.0, n)) ** sharp


def angles(n, gain):
    bend = np.cos(0.5 * np.pi * np.linspace(0.0, 1.0, n))
    right = np.column_stack([gain * scale * bend for scale in (1.4, 0.9, 0.2, 1.6, 1.1, 0.3)])
    return JointAngles(np.linspace(0.0, 1.2, n), right, right + 0.05 * np.sin(6.0 * right))


def torques(n, gain):
    course = np.linspace(1.0, 0.4, n)[:, None]
    torque = gain * course * np.array([-120.0, 35.0, 20.0, -180.0, 60.0, -70.0])
    limit = np.array([260.0, 90.0, 80.0, 380.0, 300.0, 230.0]) * (0.9 + 0.1 * course)
    return Torques(np.linspace(0.0, 1.2, n), JOINT_NAMES, torque, -limit, limit)


def spine(n, compression, shear):
    time = np.linspace(0.0, 1.2, n)
    solved = np.ones(n, bool)
    solved[n // 5:n // 5 + 3] = False
    force = np.linspace(0.9, 0.35, n) * compression + shape(n, 0.1 * compression, 2.0)
    return SpineCurves(time, force, 0.3 * shear + shape(n, 0.7 * shear),
                       shape(n, -0.05 * shear), solved,
                       np.full(n, 0.004 * shear), np.full(n, compression * 0.0174),
                       'sacral end plate')


def joints(n, gain):
    names = ('l5_s1', 'l4_l5', 'hip_r', 'knee_r')
    compression = gain * np.outer(np.linspace(1.0, 0.4, n), [3000.0, 2800.0, 2500.0, 2000.0])
    solved = np.ones((n, len(names)), bool)
    solved[:, 2] = False
    return JointLoads(names, compression, 0.2 * compression, solved)


def body(n, lean):
    u = np.linspace(0.0, 1.0, n)
    names = ('pelvis', 'l5_s1', 'c7', 'head', 'shoulder_r', 'shoulder_l', 'elbow_r', 'elbow_l',
             'wrist_r', 'wrist_l', 'hand_r', 'hand_l', 'hip_r', 'hip_l', 'knee_r', 'knee_l',
             'ankle_r', 'ankle_l', 'heel_r', 'heel_l', 'mtp_r', 'mtp_l', 'toe_r', 'toe_l')
    tilt = lean * (1.0 - u)
    hip = np.column_stack([-0.35 * (1.0 - u), 0.55 + 0.35 * u])
    c7 = hip + 0.55 * np.column_stack([np.sin(tilt), np.cos(tilt)])
    hand = np.column_stack([0.38 * np.ones(n), 0.25 + 0.75 * u])
    places = {'pelvis': hip, 'l5_s1': hip + 0.1 * (c7 - hip), 'c7': c7,
              'head': c7 + 0.3 * (c7 - hip) + [0.03, 0.0], 'shoulder': c7 - 0.1 * (c7 - hip),
              'elbow': 0.55 * c7 + 0.45 * hand + [-0.05, 0.0], 'wrist': 0.15 * c7 + 0.85 * hand,
              'hand': hand, 'hip': hip,
              'knee': 0.5 * hip + [0.15, 0.25] * np.column_stack([1.0 - 0.8 * u, np.ones(n)]),
              'ankle': np.tile([-0.02, 0.08], (n, 1)), 'heel': np.tile([-0.07, 0.0], (n, 1)),
              'mtp': np.tile([0.13, 0.01], (n, 1)), 'toe': np.tile([0.2, 0.01], (n, 1))}
    points = np.zeros((n, len(names), 3))
    for k, name in enumerate(names):
        points[:, k, [0, 2]] = places[name.removesuffix('_r').removesuffix('_l')]
        points[:, k, 1] = -0.15 * name.endswith('_r') + 0.15 * name.endswith('_l')
    box = np.column_stack([hand[:, 0] + 0.02, np.zeros(n), hand[:, 1]])
    return BodyPoints(np.linspace(0.0, 1.2, n), names, points, box,
                      np.array([0.238, 0.305, 0.127]))


def criteria():
    rows = []
    for source, compression, shear, torque in (('measured', 3620.0, 846.0, 0.91),
                                               ('predicted', 2390.0, 612.0, 0.74)):
        rows += [
            Criterion('compression_action', source, compression, 3400.0, 3400.0 - compression,
                         'N', 'NIOSH 1981', 0.21, compression / HEADER.mass),
            Criterion('compression_maximum', source, compression, 6400.0,
                         6400.0 - compression, 'N', 'NIOSH 1981', 0.21, compression / HEADER.mass),
            Criterion('shear_frequent', source, shear, 700.0, 700.0 - shear, 'N',
                         'Gallagher and Marras 2012', 0.44, shear / HEADER.mass),
            Criterion('torque_index', source, torque, 1.0, 1.0 - torque, '1', 'eq. 4.12', 0.1,
                         detail='hip'),
            Criterion('activation_index', source, 0.62, 0.95, 0.33, '1', 'section 4.2.2', 0.7,
                         detail='MF_m1s_r')]
    return tuple(rows)


def lift(lift_id='lift_001', start=3.2):
    n = 121
    activation = np.clip(np.outer(shape(n, 1.0, 0.7), np.linspace(0.1, 0.9, len(MUSCLES))), 0, 1)
    good = np.ones(n, bool)
    good[30:33] = False
    time = np.linspace(0.0, 1.2, n)
    force = np.zeros((n, 2, 3))
    force[:, 0, 2] = 390.0 + shape(n, 90.0, 3.0)
    force[:, 1, 2] = 360.0 + shape(n, 80.0, 3.0)
    force[:, :, 0] = shape(n, 15.0)[:, None]
    return LiftReport(
        lift_id, start, 1.2, Pair(angles(n, 1.0), angles(61, 0.85)),
        Comparison(JOINT_NAMES, np.array([6.1, 9.0, 4.2, 7.7, 8.1, 2.2]),
                   np.array([0.99, 0.95, 0.4, 0.98, 0.97, np.nan]), 41.0, 0.81, 9.0, 0.35),
        Pair(GroundForces(time, force), GroundForces(time, 0.96 * force)),
        Pair(torques(n, 1.0), torques(61, 0.8)),
        Pair(Activations(time, MUSCLES, activation, good),
             Activations(time, MUSCLES, 0.7 * activation, np.ones(n, bool))),
        Pair(spine(n, 3800.0, 846.0), spine(61, 2500.0, 612.0)),
        Pair(joints(n, 1.0), joints(61, 0.7)),
        Pair(body(n, 1.25), body(61, 0.9)),
        Risk(criteria(), 1230.0, 234.0, 'action',
             'Peak L5-S1 compression 3620 N (57.0 N/kg), between the action limit and the maximum '
             'permissible limit; 1230 N of it were not necessary.', 3),
        Lifting((0.6, 0.82, 0.88, 1.0, 0.85, 0.95), 8.0, 1.5, 'HM', 'low',
                {'H [cm]': '42', 'V [cm]': '15', 'D [cm]': '75', 'A [deg]': '0'}),
        (SolveRow('motion tracker', 0, 'OK', '', 7, 1e-9, 1e-8, 0.41),
         SolveRow('lift predictor', 206, 'PREDICTOR_TIME_LIMIT', 'stopped after 60 s', 900, 0.02,
                  0.3, 60.0)),
        (QualityRow('marker distance, rms', 8.2, np.nan, 'mm', 'markers against the model'),))


def report(**changes):
    quality = (QualityRow('frames without solution', 3.0, np.nan, '1', 'left out of all peaks'),)
    alarms = (
        AlarmRow(3.46, 'l5_s1_compression_high', 'NORMAL', 'UNACKNOWLEDGED_ACTIVE', 3511.0, 3400.0,
                 -111.0, 'N', 'NIOSH 1981', 'lift_001'),
        AlarmRow(4.36, 'l5_s1_compression_high', 'UNACKNOWLEDGED_ACTIVE',
                 'UNACKNOWLEDGED_RETURNED', 2100.0, 3400.0, 1300.0, 'N', 'NIOSH 1981',
                 'lift_001'))
    data = ReportData(HEADER, (lift(),), alarms, quality,
                      ('0.4 s at the end of the bag were lost.',))
    return replace(data, **changes)
# fmt: on


class Outline(HTMLParser):
    """Collect ids, external references and check that elements are closed in order."""

    VOID = ('meta', 'br', 'img', 'link', 'input', 'hr')

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.references, self.texts = [], [], [], []

    def handle_starttag(self, tag, attributes):
        """Note one piece of the page."""
        if tag not in self.VOID:
            self.open.append(tag)
        for name, value in attributes:
            if name == 'id':
                self.ids.append(value)
            if name in ('src', 'href', 'xlink:href'):
                self.references.append(value)

    def handle_startendtag(self, tag, attributes):
        """Note one piece of the page."""
        self.handle_starttag(tag, attributes)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        """Note one piece of the page."""
        assert self.open.pop() == tag

    def handle_data(self, data):
        """Note one piece of the page."""
        self.texts.append(data)


def parse(page):
    outline = Outline()
    outline.feed(page)
    assert outline.open == []
    return outline


def words_of(data):
    return ' '.join(parse(render(data)).texts)


def without_figures(whole):
    nothing = Pair(Missing('left out'), Missing('left out'))
    pairs = [f.name for f in fields(LiftReport) if isinstance(getattr(whole, f.name), Pair)]
    return replace(whole, **dict.fromkeys(pairs, nothing))


def only(field):
    whole = lift()
    return replace(without_figures(whole), **{field: getattr(whole, field)})


@pytest.fixture(scope='module')
def page():
    return render(report(lifts=(lift(), lift('lift_002', 7.9))))


def test_page_needs_nothing_else_and_is_well_formed(page):
    outline = parse(page)
    assert all(reference.startswith('#') for reference in outline.references)
    assert not re.search(r'url\((?!#)', page) and '@import' not in page
    assert len(outline.ids) == len(set(outline.ids))
    assert {reference[1:] for reference in outline.references} <= set(outline.ids)
    for target in re.findall(r'url\(#([^)]+)\)', page):
        assert target in outline.ids


def test_every_figure_is_valid_svg_in_page_colours(page):
    figures = re.findall(r'<svg.*?</svg>', page, flags=re.DOTALL)
    assert len(figures) == 2 * 8
    for figure in figures:
        ElementTree.fromstring(figure)
        assert 'var(--measured)' in figure or 'var(--series-1)' in figure
        assert not re.search(r'#[0-9a-f]a[0-9a-f]b[0-9a-f]c\b', figure)
        assert 'aria-label="' in figure


def test_what_an_ergonomist_looks_for_is_there(page):
    words = ' '.join(parse(page).texts)
    for phrase in PHRASES:
        assert phrase in words, phrase
    for group in muscle_groups():
        assert group.name in words
    assert 'not in this model' not in words


def test_measured_recording_is_not_called_simulated():
    page = render(report(header=replace(HEADER, simulated=False), lifts=Missing('none')))
    assert 'SIMULATED' not in page and 'recorded from a person' in page


def test_the_page_is_the_same_every_time():
    data = report(lifts=(only('spine'),))
    assert render(data) == render(data)


def test_every_missing_part_says_why():
    whole = lift()
    changes = {}
    for field in fields(LiftReport):
        if isinstance(getattr(whole, field.name), Pair):
            changes[field.name] = Pair(
                Missing(f'no {field.name} measured'), Missing(f'no {field.name} predicted')
            )
        elif field.name in ('comparison', 'risk', 'lifting', 'solves', 'quality'):
            changes[field.name] = Missing(f'no {field.name} at all')
    words = words_of(
        report(
            lifts=(replace(whole, **changes),),
            alarms=Missing('no alarms at all'),
            recording_quality=Missing('no recording quality'),
        )
    )
    for field, value in changes.items():
        if field == 'comparison':
            continue  # stands in the captions of figures that are missing here
        reasons = value.missing().values() if isinstance(value, Pair) else (value.reason,)
        for reason in reasons:
            assert reason in words, reason
    assert 'no alarms at all' in words and 'no recording quality' in words
    assert render(report(lifts=Missing('no lift was found'))).count('no lift was found') == 1


@pytest.mark.parametrize(
    'field', ['angles', 'ground', 'torques', 'activations', 'spine', 'points']
)
def test_without_the_optimal_lift_the_recorded_one_is_still_drawn(field):
    pair = Pair(getattr(lift(), field).measured, Missing('the prediction was infeasible'))
    page = render(report(lifts=(replace(without_figures(lift()), **{field: pair}),)))
    assert page.count('<svg') == (2 if field == 'torques' else 1)
    assert 'the prediction was infeasible' in page


def test_comparison_missing_is_said_in_the_captions():
    whole, missing = lift(), Missing('r needs two lifts')
    few = replace(
        without_figures(whole), angles=whole.angles, ground=whole.ground, comparison=missing
    )
    page = render(report(lifts=(few,)))
    assert page.count('Agreement not available: r needs two lifts') == 2


def test_muscles_that_the_model_lacks_are_named():
    whole = without_figures(lift())
    few = replace(lift().activations.measured, muscles=('x_r',), activation=np.zeros((121, 1)))
    words = words_of(report(lifts=(replace(whole, activations=Pair(few, Missing('none'))),)))
    assert words.count('not in this model') == len(muscle_groups())


def test_no_sample_solved_draws_no_peak_and_says_unknown():
    whole = without_figures(lift())
    nothing = replace(lift().spine.measured, solved=np.zeros(121, bool))
    rows = tuple(
        replace(row, value=np.nan, margin=np.nan, time=np.nan)
        for row in criteria()
        if row.source == 'measured'
    )
    risk = Risk(rows, np.nan, np.nan, 'unknown', 'L5-S1 compression unknown.', 121)
    page = render(report(lifts=(replace(whole, risk=risk, spine=Pair(nothing, Missing('none'))),)))
    assert 'no solved sample of the recorded lift' in page
    assert '121 samples did not solve' in page


def test_names_from_outside_cannot_break_the_page():
    evil = '<script>alert("x")</script>'
    data = report(
        header=replace(HEADER, task=evil, subject=evil, source=evil),
        remarks=(evil,),
        lifts=(replace(without_figures(lift()), lift_id=evil),),
    )
    page = render(data)
    assert evil not in page and page.count('<script>') == 1
    parse(page)


def test_joints_without_published_strength_have_no_limit_and_no_index():
    plain = lift().torques.measured
    lower, upper = plain.lower.copy(), plain.upper.copy()
    lower[:, 0], upper[:, 0] = -np.inf, np.inf
    lower[:, 1] = 5.0
    odd = replace(plain, joints=('lumbar_extension', *plain.joints[1:]), lower=lower, upper=upper)
    words = words_of(
        report(lifts=(replace(without_figures(lift()), torques=Pair(odd, Missing('none'))),))
    )
    assert 'Spine (extension +)' in words and 'nan' not in words.lower().split()


def test_wrong_shapes_are_refused_by_field():
    with pytest.raises(ReportError, match=r'Torques\.lower'):
        Torques(np.zeros(3), ('hip',), np.zeros((3, 1)), np.zeros(3), np.zeros((3, 1)))
    with pytest.raises(ReportError, match=r'SpineCurves\.solved'):
        replace(spine(10, 1.0, 1.0), solved=np.ones(3, bool))
    with pytest.raises(ReportError, match=r'JointLoads\.solved'):
        replace(joints(10, 1.0), solved=np.ones(10, bool))


def test_peaks_of_joints_leave_out_what_did_not_solve(page):
    loads = joints(20, 1.0)
    assert loads.peak_compression[:2].tolist() == [3000.0, 2800.0]
    assert np.isnan(loads.peak_compression[2])
    assert loads.peak_shear[3] == pytest.approx(400.0)
    assert 'L4-L5' in page
    assert 'none solved' in page


def test_report_is_written_where_it_was_asked_for(tmp_path):
    path = build_report(report(lifts=Missing('none')), tmp_path / 'out' / 'report.html')
    assert path.read_text(encoding='utf-8').startswith('<!DOCTYPE html>')
