# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Write `specimens.osim`, a model of nobody that has one of everything that can be read.

A chain of bodies with every type of joint and function; muscles across its gimbal joint over
surfaces of every type, half and method, at random; moving and conditional points. Run it with the
package on the path, then ``make_model_references.py specimens.osim model_specimens.npz``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

#: Seed of the muscles' ends, and muscles over each surface.
SEED, COPIES = 4, 3
HALVES = ('all', 'x', '-x', 'y', '-y', 'z', '-z')
#: Joint types in the order of the chain, with the ranges of their coordinates.
TURN, SHIFT = (-0.9, 0.9), (-0.05, 0.05)
CHAIN = {
    'PlanarJoint': (TURN, SHIFT, SHIFT),
    'BallJoint': (TURN, TURN, TURN),
    'SliderJoint': (SHIFT,),
    'GimbalJoint': (TURN, TURN, TURN),
    'UniversalJoint': (TURN, TURN),
    'WeldJoint': (),
    'FreeJoint': (TURN, TURN, TURN, SHIFT, SHIFT, SHIFT),
    'PinJoint': (TURN,),
    'CustomJoint': (TURN, SHIFT),
}
FUNCTIONS = {
    'rotation1': (
        '0.6 0.8 0', 0,
        '<SimmSpline><x>-1 -0.3 0.2 0.5 1</x><y>-1 -0.4 0.1 0.6 0.8</y></SimmSpline>',
    ),
    'rotation2': (
        '0 0.6 0.8', 0,
        '<PolynomialFunction><coefficients>0.3 -0.2 0.5 0.1</coefficients></PolynomialFunction>',
    ),
    'rotation3': ('0.8 0 -0.6', None, '<Constant><value>0.2</value></Constant>'),
    'translation1': (
        '1 0 0', 0,
        '<MultiplierFunction><function><PiecewiseLinearFunction><x>-1 0 0.4 1</x><y>0 1 3 2</y>'
        '</PiecewiseLinearFunction></function><scale>0.05</scale></MultiplierFunction>',
    ),
    'translation2': (
        '0 1 0', 1,
        '<StepFunction><transition_start_time>-0.04</transition_start_time>'
        '<transition_end_time>0.03</transition_end_time><start_value>-0.1</start_value>'
        '<end_value>0.1</end_value></StepFunction>',
    ),
    'translation3': (
        '0 0 1', 1, '<LinearFunction><coefficients>1.5 0.01</coefficients></LinearFunction>',
    ),
}  # fmt: skip
BODY = """<Body name="{name}"><mass>1</mass><mass_center>0 0 0</mass_center>
<inertia>1 1 1 0 0 0</inertia>{wraps}</Body>
"""
JOINT = """<{tag} name="{name}_joint"><socket_parent_frame>base</socket_parent_frame>
<socket_child_frame>moved</socket_child_frame><coordinates>{coordinates}</coordinates><frames>
<PhysicalOffsetFrame name="base"><socket_parent>{parent}</socket_parent>
<translation>0.05 -0.2 0.02</translation><orientation>0.2 -0.3 0.1</orientation>
</PhysicalOffsetFrame><PhysicalOffsetFrame name="moved">
<socket_parent>/bodyset/{name}</socket_parent><translation>0.01 0.15 -0.02</translation>
<orientation>-0.1 0.2 0.3</orientation></PhysicalOffsetFrame></frames>{extra}</{tag}>
"""
COORDINATE = """<Coordinate name="{name}"><default_value>0</default_value>
<range>{low} {high}</range><clamped>false</clamped></Coordinate>"""
MUSCLE = """<Millard2012EquilibriumMuscle name="{name}"><GeometryPath name="path"><PathPointSet>
<objects>{points}</objects></PathPointSet><PathWrapSet><objects>{wraps}</objects></PathWrapSet>
</GeometryPath><max_isometric_force>500</max_isometric_force>
<optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.12</tendon_slack_length>
<pennation_angle_at_optimal>0</pennation_angle_at_optimal></Millard2012EquilibriumMuscle>
"""
POINT = """<{tag} name="{name}"><socket_parent_frame>/bodyset/{body}</socket_parent_frame>
{rest}</{tag}>"""
ABOVE, BELOW = 'slider', 'gimbal'


def surfaces() -> dict[str, tuple[str, str]]:
    """Return every surface's element and method by its name."""
    shapes = {
        'cylinder': ('WrapCylinder', '<radius>0.04</radius><length>0.3</length>', ('hybrid',)),
        'sphere': ('WrapSphere', '<radius>0.05</radius>', ('hybrid',)),
        'ellipsoid': (
            'WrapEllipsoid', '<dimensions>0.04 0.06 0.05</dimensions>',
            ('hybrid', 'midpoint'),
        ),
        'torus': (
            'WrapTorus', '<inner_radius>0.02</inner_radius><outer_radius>0.06</outer_radius>',
            ('hybrid',),
        ),
    }  # fmt: skip
    found = {}
    for kind, (tag, size, methods) in shapes.items():
        for half in HALVES:
            # A midpoint over a half is not read.
            for method in methods if half == 'all' else methods[:1]:
                name = f'{kind}_{method}_{half}'
                text = f"""<{tag} name="{name}"><active>true</active>
<xyz_body_rotation>1.3 0.2 -0.1</xyz_body_rotation><translation>0.01 0.15 -0.02</translation>
<quadrant>{half}</quadrant>{size}</{tag}>"""
                found[name] = text, method
    return found


def fixed(name: str, body: str, place: np.ndarray) -> str:
    """Write a fixed point."""
    location = '<location>{:.4f} {:.4f} {:.4f}</location>'.format(*place)
    return POINT.format(tag='PathPoint', name=name, body=body, rest=location)


def ends(rng: np.random.Generator) -> tuple[str, str]:
    """Draw a point above and one below the gimbal joint."""
    around = rng.uniform(-0.08, 0.08, (2, 3))
    around[:, 1] = rng.uniform(-0.18, -0.1), rng.uniform(-0.02, 0.06)
    return (
        fixed('first', ABOVE, around[0] + [0.05, -0.02, 0.02]), fixed('last', BELOW, around[1])
    )  # fmt: skip


def special_muscles(rng: np.random.Generator) -> str:
    """Write muscles with conditional and moving points, and over two surfaces."""
    text = ''
    first, last = ends(rng)
    for number, (joint, axis, low, high) in enumerate(
        (('gimbal', 0, -0.3, 0.2), ('gimbal', 2, 0.0, 1.5), ('universal', 0, -1.0, 0.1))
    ):
        via = POINT.format(
            tag='ConditionalPathPoint', name='via', body=ABOVE,
            rest=f'<location>0.1 -0.15 0.03</location><range>{low} {high}</range>'
            '<socket_coordinate>'
            f'/jointset/{joint}_joint/{joint}_{axis}</socket_coordinate>',
        )  # fmt: skip
        text += MUSCLE.format(name=f'conditional_{number}', points=first + via + last, wraps='')
    curve = '<SimmSpline><x>-1 -0.4 0 0.3 1</x><y>{}</y></SimmSpline>'
    values = ('0.02 0.05 0.06 0.05 0.01', '-0.2 -0.17 -0.15 -0.16 -0.2', '0 0.01 0.03 0.02 0.01')
    for coordinate in ('gimbal_0', 'gimbal_1', 'pin_0'):
        place = ''.join(
            f'<{axis}_location>{curve.format(y)}</{axis}_location><socket_{axis}_coordinate>'
            f'/jointset/{coordinate[:-2]}_joint/{coordinate}</socket_{axis}_coordinate>'
            for axis, y in zip('xyz', values, strict=True)
        )
        via = POINT.format(tag='MovingPathPoint', name='slide', body=ABOVE, rest=place)
        text += MUSCLE.format(name=f'moving_{coordinate}', points=first + via + last, wraps='')
    return text


def main() -> None:
    """Write the file beside this script."""
    rng = np.random.default_rng(SEED)
    wraps = surfaces()
    bodies, joints, parent = '', '', '/ground'
    for tag, ranges in CHAIN.items():
        name = tag.removesuffix('Joint').lower()
        inner = ''.join(text for text, _ in wraps.values()) if name == BELOW else ''
        objects = f'<WrapObjectSet><objects>{inner}</objects></WrapObjectSet>'
        bodies += BODY.format(name=name, wraps=objects if inner else '')
        coordinates = ''.join(
            COORDINATE.format(name=f'{name}_{i}', low=low, high=high)
            for i, (low, high) in enumerate(ranges)
        )
        extra = ''
        if tag == 'CustomJoint':
            for axis, (direction, number, function) in FUNCTIONS.items():
                moved = '' if number is None else f'{name}_{number}'
                extra += f'<TransformAxis name="{axis}"><coordinates>{moved}</coordinates>'
                extra += f'<axis>{direction}</axis>{function}</TransformAxis>'
            extra = f'<SpatialTransform>{extra}</SpatialTransform>'
        joints += JOINT.format(
            tag=tag, name=name, parent=parent, coordinates=coordinates, extra=extra
        )
        parent = f'/bodyset/{name}'
    muscles = special_muscles(rng)
    for name, (_, method) in wraps.items():
        use = f"""<PathWrap name="w"><wrap_object>{name}</wrap_object><method>{method}</method>
<range>-1 -1</range></PathWrap>"""
        for copy in range(COPIES):
            points = ''.join(ends(rng))
            muscles += MUSCLE.format(name=f'{name}_{copy}', points=points, wraps=use)
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<!-- SPDX-FileCopyrightText: 2026 The lift monitor authors -->
<!-- SPDX-License-Identifier: Apache-2.0 -->
<OpenSimDocument Version="40000"><Model name="specimens"><gravity>0 -9.81 0</gravity>
<Ground name="ground"/><BodySet><objects>{bodies}</objects></BodySet>
<JointSet><objects>{joints}</objects></JointSet>
<ForceSet><objects>{muscles}</objects></ForceSet>
<MarkerSet><objects><Marker name="tip"><socket_parent_frame>/bodyset/custom</socket_parent_frame>
<location>0.1 0.2 0.3</location></Marker></objects></MarkerSet></Model></OpenSimDocument>
"""
    (Path(__file__).parent / 'specimens.osim').write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
