"""What the source code of kernels tells of how a structure is handled: counted, not judged by eye.

A kernel's code is its own and that of all parts that it calls, each once, without the annotations
and the docstrings.
"""

import ast
import inspect
import textwrap
from collections.abc import Iterable, Iterator
from typing import NamedTuple, TypeGuard

from hem.authoring import Kernel
from hem.engine import parts_of

RECORDS = "m"  # what kernels call the records


class CodeFacts(NamedTuple):
    """Counts of what stands in the code.

    ``direction_tests``: kernels that compare what a record names with the vertex, edge or face that
    one comes from, to learn which way round the record lies. ``branches``: of ``if``, of
    conditional expressions and of loops that end by a condition. ``lines``: statements.
    """

    direction_tests: int
    branches: int
    lines: int


def code_facts(kernels: Iterable[Kernel]) -> CodeFacts:
    """The counts of some kernels together, each part once."""
    kernels = list(kernels)
    nodes, branches = list(_nodes(kernels)), (ast.If, ast.IfExp, ast.While)
    return CodeFacts(
        sum(any(map(_tests_direction, _nodes([it]))) for it in kernels),
        sum(isinstance(it, branches) for it in nodes),
        sum(isinstance(it, ast.stmt) and not _says_nothing(it) for it in nodes),
    )


def come_round_tests(kernels: Iterable[Kernel]) -> int:
    """How often a loop in some kernels asks whether it is back at where it began."""
    loops = (it for it in _nodes(kernels) if isinstance(it, ast.While))
    return sum(_compares(it, ast.Name, ast.Name) for loop in loops for it in ast.walk(loop))


def _nodes(kernels: Iterable[Kernel]) -> Iterator[ast.AST]:
    parts = {it.__code__: it for kernel in kernels for it in parts_of(kernel, set())}
    sources = (textwrap.dedent(inspect.getsource(it)) for it in parts.values())
    return (node for source in sources for node in ast.walk(ast.parse(source)))


def _tests_direction(it: ast.AST) -> bool:
    if not _compares(it, ast.Subscript, ast.Name):
        return False
    return any(isinstance(n, ast.Name) and n.id == RECORDS for n in ast.walk(it.left))


def _compares(it: ast.AST, one: type[ast.expr], other: type[ast.expr]) -> TypeGuard[ast.Compare]:
    """Whether it says that something of these two sorts is equal, or that it is not."""
    return (
        isinstance(it, ast.Compare)
        and len(it.ops) == 1
        and isinstance(it.ops[0], ast.Eq | ast.NotEq)
        and isinstance(it.left, one)
        and isinstance(it.comparators[0], other)
    )


def _says_nothing(it: ast.stmt) -> bool:
    """Whether it is a docstring, or the head of a function."""
    quoted = isinstance(it, ast.Expr) and isinstance(it.value, ast.Constant)
    return quoted or isinstance(it, ast.FunctionDef)
