# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""CasADi functions as straight-line C code, divided into what depends on a sweep's seed and not.

The instructions are brought into single-assignment form. Those without a seed among their
arguments make the base pass; the values that sweeps need of it are kept in an array. Each seed's
own make its sweep. Long passes are cut into several C functions, because compilers take long for
large ones; values that cross a cut are kept in a work array, all others are local variables.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from lift_predictor.core.solvers.emit import INPUTS, instructions

CHUNK: Final = 400
"""Statements of one C function at most."""
ARGUMENTS: Final = (
    'const vec *restrict in, const double *restrict p, const vec *restrict multiplier, '
    'const vec *restrict seed, {}vec *restrict base, vec *restrict out'
)
PASSED: Final = 'in, p, multiplier, seed, base, out'
BASE: Final = -1


@dataclass
class _Value:
    """One value: a leaf with its text, or an operation on other values."""

    group: int
    text: str = ''
    template: str = ''
    operands: tuple[int, ...] = ()
    kept: int = -1


def passes(function: Any, name: str, n_fixed: int, has_values: bool) -> str:
    """C code of the base pass NAME_base and of the sweeps NAME_0, NAME_1, ...

    Parameters
    ----------
    function : casadi.Function
        Of (z, s), p, perhaps multipliers, then one seed for each sweep. Outputs: the values, if
        any, then one column for each sweep, which depends on its own seed only.
    name : str
        Beginning of the C names; NAME_base_size is the length of the kept array.
    n_fixed : int
        Inputs that are no seeds.
    has_values : bool
        Whether the first output belongs to the base pass.
    """
    values, outputs = _read(function, n_fixed)
    kept = 0
    for value in values:
        if value.template and value.group != BASE:
            for operand in value.operands:
                source = values[operand]
                if source.group == BASE and source.template and source.kept < 0:
                    source.kept = kept
                    kept += 1
    parts = [f'enum {{ {name}_base_size = {kept + 1} }};']
    first = 1 if has_values else 0
    for group in range(BASE, function.n_in() - n_fixed):
        column = (0 if has_values else None) if group == BASE else first + group
        wanted = {i: v for (out, i), v in outputs.items() if out == column}
        label = 'base' if group == BASE else str(group)
        parts.append(_emit(f'{name}_{label}', group, values, wanted))
    return '\n'.join(parts)


def _read(function: Any, n_fixed: int) -> tuple[list[_Value], dict[tuple[int, int], int]]:
    values: list[_Value] = []
    register: dict[int, int] = {}
    outputs: dict[tuple[int, int], int] = {}
    for instruction in instructions(function):
        if instruction.output is not None:
            outputs[instruction.output] = register[instruction.operands[0]]
            continue
        operands = tuple(register[i] for i in instruction.operands)
        value = _Value(BASE, instruction.constant, instruction.template, operands)
        if instruction.input is not None:
            which, index = instruction.input
            fixed = which < n_fixed
            value.text = INPUTS[which].format(index) if fixed else f'seed[{index}]'
            value.group = BASE if fixed else which - n_fixed
        groups = {values[i].group for i in operands} - {BASE}
        if len(groups) > 1:
            raise ValueError(f'{function.name()}: a value depends on two seeds')
        value.group = groups.pop() if groups else value.group
        register[instruction.register] = len(values)
        values.append(value)
    return values, outputs


def _emit(name: str, group: int, values: list[_Value], wanted: dict[int, int]) -> str:
    """One pass as C functions."""
    order = [i for i, v in enumerate(values) if v.group == group and v.template]
    chunk_of = {i: n // CHUNK for n, i in enumerate(order)}
    last: dict[int, int] = {}
    for i in order:
        for operand in values[i].operands:
            if operand in chunk_of:
                last[operand] = chunk_of[i]
    n_chunks = max(-(-len(order) // CHUNK), 1)
    crossing = {i for i, c in last.items() if c > chunk_of[i] and values[i].kept < 0}
    slot, size = _slots(order, crossing, chunk_of, last)
    results: dict[int, list[int]] = {}
    lines: list[list[str]] = [[] for _ in range(n_chunks)]
    for index, i in wanted.items():
        if i in chunk_of:
            results.setdefault(i, []).append(index)
        else:
            lines[0].append(f'    out[{index}] = {values[i].text};')

    def text(operand: int, chunk: int) -> str:
        value = values[operand]
        if not value.template:
            return value.text
        if operand in chunk_of and chunk_of[operand] == chunk:
            return f'v{operand}'
        return f'base[{value.kept}]' if value.kept >= 0 else f'w[{slot[operand]}]'

    for i in order:
        value, chunk = values[i], chunk_of[i]
        right = value.template.format(*(text(o, chunk) for o in value.operands))
        lines[chunk].append(f'    const vec v{i} = {right};')
        if value.kept >= 0:
            lines[chunk].append(f'    base[{value.kept}] = v{i};')
        if i in crossing:
            lines[chunk].append(f'    w[{slot[i]}] = v{i};')
        lines[chunk].extend(f'    out[{index}] = v{i};' for index in results.get(i, ()))
    arguments = ARGUMENTS.format('' if group == BASE else 'const ')
    parts = [
        f'static __attribute__((noinline)) void {name}_part{n}({arguments}, vec *restrict w) {{\n'
        + '\n'.join(body)
        + '\n}'
        for n, body in enumerate(lines)
    ]
    calls = '\n'.join(f'    {name}_part{n}({PASSED}, w);' for n in range(n_chunks))
    parts.append(f'static void {name}({arguments}) {{\n    vec w[{size + 1}];\n{calls}\n}}')
    return '\n'.join(parts)


def _slots(
    order: list[int], crossing: set[int], chunk_of: dict[int, int], last: dict[int, int]
) -> tuple[dict[int, int], int]:
    """Places in the work array, used again for values whose last chunk is over."""
    slot: dict[int, int] = {}
    free: list[int] = []
    ends: dict[int, list[int]] = {}
    size, chunk = 0, 0
    for i in order:
        while chunk < chunk_of[i]:
            free.extend(ends.pop(chunk, []))
            chunk += 1
        if i in crossing:
            if free:
                slot[i] = free.pop()
            else:
                slot[i] = size
                size += 1
            ends.setdefault(last[i], []).append(slot[i])
    return slot, size
