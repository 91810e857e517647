# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""External loads, reserve actuators and set-ups of OpenSim's tools, as XML documents.

Tags as OpenSim 4.6 prints them (`printToXML` of `ExternalLoads`, `InverseDynamicsTool` and
`AnalyzeTool`). Paths in them are relative to the folder of the export, which must be the current
one of the process that runs the tools; so the folder can be moved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from human_model.typing import Array
from muscle_analyzer.core.opensim_bridge.xml_tree import (
    add_flag,
    add_numbers,
    add_set,
    add_text,
    named,
    write_document,
)
from muscle_analyzer.core.recruitment.reserves import Reserve

#: Files of an export, beside each other in one folder.
MODEL = 'model.osim'
COORDINATES = 'coordinates.mot'
LOADS_DATA = 'external_loads.mot'
LOADS = 'external_loads.xml'
RESERVES = 'reserves.xml'
INVERSE_DYNAMICS = 'setup_inverse_dynamics.xml'
STATIC_OPTIMIZATION = 'setup_static_optimization.xml'
JOINT_REACTION = 'setup_joint_reaction.xml'
RESULTS = 'results'
#: What the tools write into the folder of the results.
TORQUES_RESULT = 'inverse_dynamics.sto'
FORCES_RESULT = 'lift_StaticOptimization_force.sto'
ACTIVATIONS_RESULT = 'lift_StaticOptimization_activation.sto'
REACTIONS_RESULT = 'lift_JointReaction_ReactionLoads.sto'
#: Further results of the script: path lengths, moment arms, times.
SCRIPT_RESULT = 'opensim.json'
#: Name of the tools, with which their results' file names begin.
TOOL = 'lift'
#: The reserve of a coordinate is this and the coordinate's name.
RESERVE_PREFIX = 'reserve_'
#: Digits of the results.
PRECISION = 16
#: OpenSim's own settings of the optimiser.
OPTIMIZER_TOLERANCE, OPTIMIZER_ITERATIONS = 1e-4, 100


@dataclass(frozen=True, eq=False)
class PointForce:
    """A force from outside on one body over time, ground axes of OpenSim.

    Attributes
    ----------
    name : str
        Begins the labels of its columns.
    body : str
    force : (n, 3) array
        N.
    point : (n, 3) array
        Where it acts, in the ground's frame, m.
    moment : (n, 3) array
        Free moment, N m.
    """

    name: str
    body: str
    force: Array
    point: Array
    moment: Array

    def columns(self) -> tuple[str, ...]:
        """Return the labels of its nine columns: force, point, moment."""
        return tuple(f'{self.name}_{kind}{axis}' for kind in 'vpm' for axis in 'xyz')


def write_external_loads(path: Path, forces: Sequence[PointForce]) -> None:
    """Write the document that assigns the columns of `LOADS_DATA` to bodies."""
    root = named('ExternalLoads', TOOL)
    objects = SubElement(root, 'objects')
    for force in forces:
        element = SubElement(objects, 'ExternalForce', name=force.name)
        add_text(element, 'applied_to_body', force.body)
        add_text(element, 'force_expressed_in_body', 'ground')
        add_text(element, 'point_expressed_in_body', 'ground')
        add_text(element, 'force_identifier', f'{force.name}_v')
        add_text(element, 'point_identifier', f'{force.name}_p')
        add_text(element, 'torque_identifier', f'{force.name}_m')
    add_text(root, 'datafile', LOADS_DATA)
    write_document(path, root)


def write_reserves(path: Path, reserves: Sequence[Reserve]) -> None:
    """Write one `CoordinateActuator` a coordinate (by default unbounded), as a set to append."""
    root = named('ForceSet', 'reserves')
    objects = SubElement(root, 'objects')
    for reserve in reserves:
        name = f'{RESERVE_PREFIX}{reserve.coordinate}'
        element = SubElement(objects, 'CoordinateActuator', name=name)
        add_text(element, 'coordinate', reserve.coordinate)
        add_numbers(element, 'optimal_force', reserve.torque)
    write_document(path, root)


def write_inverse_dynamics(path: Path, start: float, end: float) -> None:
    """Write the set-up of the inverse dynamics of a whole motion, unfiltered."""
    root = named('InverseDynamicsTool', TOOL)
    add_text(root, 'results_directory', RESULTS)
    add_text(root, 'model_file', MODEL)
    add_numbers(root, 'time_range', [start, end])
    add_text(root, 'forces_to_exclude', 'Muscles')
    add_text(root, 'external_loads_file', LOADS)
    add_text(root, 'coordinates_file', COORDINATES)
    add_numbers(root, 'lowpass_cutoff_frequency_for_coordinates', -1.0)
    add_text(root, 'output_gen_force_file', TORQUES_RESULT)
    write_document(path, root)


def write_static_optimization(
    path: Path,
    start: float,
    end: float,
    step: int,
    exponent: float,
    physiology: bool,
    tolerance: float = OPTIMIZER_TOLERANCE,
    iterations: int = OPTIMIZER_ITERATIONS,
) -> None:
    """Write the set-up of the static optimisation.

    Parameters
    ----------
    path : Path
    start, end : float
        s.
    step : int
        Every so many samples: each takes OpenSim seconds.
    exponent : float
        Of the activations in the cost.
    physiology : bool
        Whether force depends on the fibre's length and velocity.
    tolerance : float
        At which the optimiser stops.
    iterations : int
        After which it gives up.
    """
    analysis = named('StaticOptimization', 'StaticOptimization')
    _add_times(analysis, step)
    add_flag(analysis, 'use_model_force_set', True)
    add_numbers(analysis, 'activation_exponent', exponent)
    add_flag(analysis, 'use_muscle_physiology', physiology)
    add_numbers(analysis, 'optimizer_convergence_criterion', tolerance)
    add_numbers(analysis, 'optimizer_max_iterations', iterations)
    write_document(path, _analyze_tool(start, end, analysis))


def write_joint_reaction(path: Path, start: float, end: float, step: int) -> None:
    """Write the set-up of the reactions of all joints, on the child, in ground axes."""
    analysis = named('JointReaction', 'JointReaction')
    _add_times(analysis, step)
    add_text(analysis, 'forces_file', f'{RESULTS}/{FORCES_RESULT}')
    add_text(analysis, 'joint_names', 'ALL')
    add_text(analysis, 'apply_on_bodies', 'child')
    add_text(analysis, 'express_in_frame', 'ground')
    write_document(path, _analyze_tool(start, end, analysis))


def _add_times(analysis: Element, step: int) -> None:
    """Append when an analysis works: every so many samples as long as the tool does."""
    add_flag(analysis, 'on', True)
    add_text(analysis, 'start_time', '-Inf')
    add_text(analysis, 'end_time', 'Inf')
    add_text(analysis, 'step_interval', str(step))
    add_flag(analysis, 'in_degrees', False)


def _analyze_tool(start: float, end: float, analysis: Element) -> Element:
    root = named('AnalyzeTool', TOOL)
    add_text(root, 'model_file', MODEL)
    add_flag(root, 'replace_force_set', False)
    add_text(root, 'force_set_files', RESERVES)
    add_text(root, 'results_directory', RESULTS)
    add_text(root, 'output_precision', str(PRECISION))
    add_numbers(root, 'initial_time', start)
    add_numbers(root, 'final_time', end)
    add_flag(root, 'solve_for_equilibrium_for_auxiliary_states', False)
    add_set(root, 'AnalysisSet', [analysis])
    add_text(root, 'external_loads_file', LOADS)
    add_text(root, 'coordinates_file', COORDINATES)
    add_numbers(root, 'lowpass_cutoff_frequency_for_coordinates', -1.0)
    return root
