# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""C code of node functions, on vectors with one node in each lane (see data/kernel/lanes.h)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final, NamedTuple

import casadi as ca

from lift_predictor.core.solvers.constants import c_macros
from lift_predictor.core.solvers.node_function import Derivatives

CHUNK: Final = 4000
"""Instructions of one C function at most: compilers take long for larger ones."""

TEMPLATES: Final[dict[int, str]] = {
    ca.OP_ASSIGN: '{0}', ca.OP_ADD: '{0} + {1}', ca.OP_SUB: '{0} - {1}',
    ca.OP_MUL: '{0} * {1}', ca.OP_DIV: '{0} / {1}', ca.OP_NEG: '-{0}',
    ca.OP_SQ: '{0} * {0}', ca.OP_TWICE: '{0} + {0}', ca.OP_INV: '1.0 / {0}',
    ca.OP_SQRT: 'v_sqrt({0})', ca.OP_FABS: 'v_fabs({0})', ca.OP_SIGN: 'v_sign({0})',
    ca.OP_EXP: 'v_exp({0})', ca.OP_LOG: 'v_log({0})', ca.OP_TANH: 'v_tanh({0})',
    ca.OP_SIN: 'v_sin({0})', ca.OP_COS: 'v_cos({0})', ca.OP_TAN: 'v_tan({0})',
    ca.OP_ASIN: 'v_asin({0})', ca.OP_ACOS: 'v_acos({0})', ca.OP_ATAN: 'v_atan({0})',
    ca.OP_POW: 'v_pow({0}, {1})', ca.OP_CONSTPOW: 'v_pow({0}, {1})',
    ca.OP_ATAN2: 'v_atan2({0}, {1})', ca.OP_FMIN: 'v_fmin({0}, {1})',
    ca.OP_FMAX: 'v_fmax({0}, {1})', ca.OP_COPYSIGN: 'v_copysign({0}, {1})',
    ca.OP_LT: 'truth({0} < {1})', ca.OP_LE: 'truth({0} <= {1})', ca.OP_EQ: 'truth({0} == {1})',
    ca.OP_NE: 'truth({0} != {1})', ca.OP_NOT: 'truth({0} == 0.0)',
    ca.OP_AND: 'truth(({0} != 0.0) & ({1} != 0.0))',
    ca.OP_OR: 'truth(({0} != 0.0) | ({1} != 0.0))', ca.OP_IF_ELSE_ZERO: 'v_if({0}, {1})',
}  # fmt: skip
"""C expressions of CasADi's operations."""

INPUTS: Final = ('in[{}]', 'spread(p[{}])', 'multiplier[{}]')
"""C expressions of an element of a function's inputs."""

ARGUMENTS: Final = {
    'value': 'const vec *in, const double *p',
    'first': 'const vec *in, const double *p',
    'second': 'const vec *in, const double *p, const vec *multiplier',
}


def library_source(functions: Sequence[Derivatives]) -> str:
    """C source of all functions, their table `lift_functions` and the constants of the method."""
    parts, entries = [c_macros()], []
    for function in functions:
        names = {}
        # Functions too large to be written out bring their own code (sweeps.py).
        own_source = function.source()
        for kind in ARGUMENTS:
            names[kind] = f'{function.name}_{kind}'
            if own_source is not None:
                continue
            derived = getattr(function, kind)
            names[kind] = 'NULL'
            if derived is not None:
                names[kind] = f'{function.name}_{kind}'
                parts.append(_function(names[kind], kind, derived))
        tables = []
        for table in ('jacobian_row', 'jacobian_column', 'hessian_row', 'hessian_column'):
            indices = getattr(function, table)
            name = f'{function.name}_{table}'
            numbers = ', '.join(str(i) for i in indices) or '0'
            parts.append(f'static const int {name}[] = {{{numbers}}};')
            tables.append(name)
        if own_source is not None:
            parts.append(own_source)
        sizes = (
            function.n_in, function.n_parameters, function.n_g,
            len(function.jacobian_row), len(function.hessian_row),
        )  # fmt: skip
        entries.append(
            f'    {{"{function.name}", {", ".join(map(str, sizes))}, '
            f'{", ".join((*tables, *names.values()))}}},'
        )
    table = '\n'.join(entries)
    parts.append(f'const struct function lift_functions[] = {{\n{table}\n}};')
    parts.append(f'const int lift_n_functions = {len(functions)};')
    return '\n'.join(parts) + '\n'


def _function(name: str, kind: str, function: Any) -> str:
    statements = _statements(function)
    arguments = ARGUMENTS[kind]
    passed = ', '.join(part.split()[-1].lstrip('*') for part in arguments.split(','))
    if len(statements) <= CHUNK:
        size = max(function.sz_w(), 1)
        body = '\n'.join(statements)
        return f'static void {name}({arguments}, vec *out) {{\n    vec w[{size}];\n{body}\n}}'
    chunks = [statements[i : i + CHUNK] for i in range(0, len(statements), CHUNK)]
    parts = [
        f'static __attribute__((noinline)) void {name}_{i}({arguments}, vec *restrict out, '
        f'vec *restrict w) {{\n' + '\n'.join(chunk) + '\n}'
        for i, chunk in enumerate(chunks)
    ]
    calls = '\n'.join(f'    {name}_{i}({passed}, out, w);' for i in range(len(chunks)))
    parts.append(
        f'static void {name}({arguments}, vec *out) {{\n    vec w[{function.sz_w()}];\n{calls}\n}}'
    )
    return '\n'.join(parts)


def _statements(function: Any) -> list[str]:
    statements = []
    for instruction in instructions(function):
        operands = tuple(f'w[{i}]' for i in instruction.operands)
        if instruction.output is not None:
            statements.append(f'    out[{instruction.output[1]}] = {operands[0]};')
            continue
        value = instruction.constant or instruction.template.format(*operands)
        if instruction.input is not None:
            which, index = instruction.input
            value = INPUTS[which].format(index)
        statements.append(f'    w[{instruction.register}] = {value};')
    return statements


class Instruction(NamedTuple):
    """One instruction of a CasADi function.

    Attributes
    ----------
    operands : tuple of int
        Registers that it reads.
    register : int
        Register that it writes; -1: none.
    input, output : (int, int) or None
        Number of the function's input or output, and index of the element.
    constant : str
        C expression of a constant.
    template : str
        C expression of an operation on the operands.
    """

    operands: tuple[int, ...] = ()
    register: int = -1
    input: tuple[int, int] | None = None
    output: tuple[int, int] | None = None
    constant: str = ''
    template: str = ''


def instructions(function: Any) -> Iterator[Instruction]:
    """Yield the instructions of a CasADi function.

    Raises
    ------
    NotImplementedError
        For an operation without C code or a constant that is not finite.
    """
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        read, written = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_OUTPUT:
            yield Instruction((read[0],), output=(written[0], written[1]))
        elif operation == ca.OP_INPUT:
            yield Instruction(register=written[0], input=(read[0], read[1]))
        elif operation == ca.OP_CONST:
            constant = float(function.instruction_constant(k))
            if not math.isfinite(constant):
                raise NotImplementedError(f'{function.name()} holds the constant {constant}')
            yield Instruction(register=written[0], constant=f'spread({constant!r})')
        elif operation in TEMPLATES:
            yield Instruction(tuple(read), written[0], template=TEMPLATES[operation])
        else:
            raise NotImplementedError(f'operation {operation} of {function.name()} has no C code')
