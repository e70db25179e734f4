"""What the source code of kernels tells of how a structure is handled: counted, not judged by eye.

A kernel's code is its own and that of all parts that it calls, each once, without the annotations
and the docstrings.
"""

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple, TypeGuard

from hem.authoring import Kernel

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
    return (node for part in _parts(kernels) for node in ast.walk(_tree(part)))


def _parts(kernels: Iterable[Kernel]) -> Iterator[Callable[..., Any]]:
    """The functions of kernels and of all that they call, as they are written: each once."""
    waiting, met, written = list(kernels), set(), set()
    while waiting:
        kernel = waiting.pop()
        if kernel in met:
            continue
        met.add(kernel)
        function: Callable[..., Any] = getattr(kernel, "py_func", kernel)
        code = function.__code__
        if code not in written:
            written.add(code)
            yield function
        known = {**function.__globals__, **inspect.getclosurevars(function).nonlocals}
        called: list[Any] = [known.get(name) for name in (*code.co_names, *code.co_freevars)]
        waiting += [it for it in called if hasattr(it, "py_func")]


def _tree(function: Callable[..., Any]) -> ast.FunctionDef:
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
    assert isinstance(tree, ast.FunctionDef)
    return tree


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
