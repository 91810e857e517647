# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Curves and strengths of Millard and Thelen muscles against OpenSim 4.6.

The reference file was made by ``reference/make_muscle_strengths.py``.
"""

from pathlib import Path

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import OsimFormatError
from muscle_analyzer.core.muscles import millard_curves as millard
from muscle_analyzer.core.muscles.curves import MuscleParameters, strength
from muscle_analyzer.core.muscles.millard_curves import curve_table, curve_value, millard_curves
from muscle_analyzer.core.muscles.thelen_curves import (
    thelen_active,
    thelen_passive,
    thelen_rate,
    thelen_shapes,
)
from muscle_analyzer.core.opensim_bridge.model_writer import write_osim
from muscle_analyzer.core.osim.model import Muscle
from muscle_analyzer.core.osim.reader import read_osim

HERE = Path(__file__).parents[1]
MODELS = HERE.parents[3] / '.cache' / 'reference_models'
REFERENCE = dict(np.load(HERE / 'reference' / 'muscle_strengths.npz'))
#: Properties of the second curve of each kind in the reference file.
ACTIVE = {
    'min_norm_active_fiber_length': 0.35,
    'transition_norm_fiber_length': 0.8,
    'max_norm_active_fiber_length': 1.7,
    'shallow_ascending_slope': 0.7,
    'minimum_value': 0.05,
}
VELOCITY = {
    'concentric_slope_at_vmax': 0.1,
    'concentric_slope_near_vmax': 0.3,
    'isometric_slope': 4.5,
    'eccentric_slope_at_vmax': 0.05,
    'eccentric_slope_near_vmax': 0.2,
    'max_eccentric_velocity_force_multiplier': 1.5,
    'concentric_curviness': 0.7,
    'eccentric_curviness': 0.8,
}
PASSIVE = {
    'strain_at_zero_force': 0.1,
    'strain_at_one_norm_force': 0.6,
    'stiffness_at_low_force': 0.3,
    'stiffness_at_one_norm_force': 4.5,
    'curviness': 0.6,
}


def muscle(kind, name='m', **properties):
    """Make a muscle of 1000 N with fibres of 0.1 m, and a tendon of 0.2 m."""
    return Muscle(name, kind, 1000.0, 0.1, 0.2, 0.0, (), (), properties)


@pytest.mark.parametrize(
    ('curve', 'at', 'build', 'defaults', 'own'),
    [
        ('active', 'length', millard.active_curve, millard.ACTIVE, ACTIVE),
        ('rate', 'velocity', millard.velocity_curve, millard.VELOCITY, VELOCITY),
        ('passive', 'length', millard.passive_curve, millard.PASSIVE, PASSIVE),
    ],
)
def test_millard_curves_equal_opensim(curve, at, build, defaults, own):
    x = REFERENCE[at]
    table = curve_table([build(defaults), build(own)])
    for number, expected in enumerate(REFERENCE[curve]):
        found = [curve_value(*table, number, each) for each in x]
        np.testing.assert_allclose(found, expected, atol=1e-7)


def test_muscles_have_the_curves_that_their_file_gives():
    """The curves of two muscles of one model, and none of a third."""
    own = {f'ActiveForceLengthCurve/{name}': value for name, value in ACTIVE.items()}
    table, number = millard_curves(
        [muscle(millard.KIND), muscle('other'), muscle(millard.KIND, **own)]
    )
    np.testing.assert_array_equal(number, [[0, 1, 2], [-1, -1, -1], [3, 1, 2]])
    place = int(np.argmin(np.abs(REFERENCE['length'] - 0.7)))
    found = [curve_value(*table, k, REFERENCE['length'][place]) for k in (0, 3)]
    np.testing.assert_allclose(found, REFERENCE['active'][:, place], atol=1e-7)


def test_curves_come_back_from_a_written_model(write_model, tmp_path):
    own = '<PassiveFiberCurve/><FiberForceLengthCurve><curviness>0.6</curviness>'
    path = write_model(
        ('DeGrooteFregly2016Muscle', millard.KIND),
        ('<max_contraction_velocity>', f'{own}</FiberForceLengthCurve><max_contraction_velocity>'),
    )
    model = read_osim(path)
    assert model.muscles[0].properties['FiberForceLengthCurve/curviness'] == 0.6
    write_osim(tmp_path / 'written.osim', model)
    again = read_osim(tmp_path / 'written.osim')
    assert again.muscles[0].properties == model.muscles[0].properties


def test_curve_that_runs_backwards_names_its_muscle():
    wrong = {'ActiveForceLengthCurve/max_norm_active_fiber_length': 0.9}
    with pytest.raises(OsimFormatError, match='muscle m <ActiveForceLengthCurve>: sections'):
        millard_curves([muscle(millard.KIND, **wrong)])


def test_thelen_curves_satisfy_their_equations():
    """Velocity from force by equations 6 and 7 at full activation, and the published points."""
    shape, none = thelen_shapes([muscle('Thelen2003Muscle'), muscle('other')])
    assert np.isnan(none).all()
    force = np.array([0.0, 0.3, 0.8, 1.0, 1.1, 1.25, 1.32])
    af, most = 0.25, 1.4
    slow = (force - 1.0) / (1.0 + force / af)
    fast = (force - 1.0) * (most - 1.0) / ((2.0 + 2.0 / af) * (most - force))
    velocity = np.where(force <= 1.0, slow, fast)
    np.testing.assert_allclose([thelen_rate(shape, v) for v in velocity], force, atol=1e-12)
    assert thelen_active(shape, 1.0) == 1.0
    assert thelen_passive(shape, 1.6) == pytest.approx(1.0)
    assert thelen_passive(shape, 0.9) == 0.0
    # Beyond 0.95 of the greatest force it is a line, without a kink.
    at = (0.95 * most - 1.0) * (most - 1.0) / ((2.0 + 2.0 / af) * 0.05 * most)
    before, here, after, further = (
        thelen_rate(shape, at + shift) for shift in (-1e-6, 0.0, 1e-6, 2e-6)
    )
    assert after - here == pytest.approx(here - before, rel=1e-3)
    assert further - after == pytest.approx(after - here, rel=1e-9)


@pytest.mark.parametrize('name', ['Rajagopal2015', 'GPK_generic', 'arm26_ball'])
def test_strengths_equal_opensim(name):
    """Fully active muscles and stretched ones at random lengths and speeds, tendons rigid."""
    path = MODELS / f'{name}.osim'
    if not path.is_file():
        pytest.skip(f'{path.name} is not in {MODELS}: run scripts/reference_models.py')
    muscles = read_osim(path).muscles
    parameters = MuscleParameters.of(muscles)
    data = {key: REFERENCE[f'{name}_{key}'] for key in ('length', 'speed', 'active', 'passive')}
    compared = 0
    for k in range(len(data['length'])):
        active, passive = strength(parameters, data['length'][k], data['speed'][k], True)
        # OpenSim stops fibres at a shortest length, below which they carry nothing.
        free = data['active'][k] > 0.0
        compared += free.sum()
        np.testing.assert_allclose(active[free], data['active'][k][free], atol=1e-3, rtol=2e-6)
        if data['passive'].size:
            np.testing.assert_allclose(passive[free], data['passive'][k][free], atol=1e-3)
    assert compared > 0.9 * data['active'].size
