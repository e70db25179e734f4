"""Machine code that is kept on disk is named by all that is baked into it."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest
from numba import njit
from numba.core.base import BaseContext

import structures
from hem.algorithms.quadrics import add_quadrics
from hem.authoring.kernels import without
from hem.engine import Pinned, templates, uses
from hem.engine.pinned import loader
from hem.fracture.surface.nearest import closest
from hem.rendering.render import _runs

ROOT = Path(__file__).parents[2]

BAKED_IN = ("hem/edit.py", "hem/engine/pinned.py", "hem/authoring/operations/flip_edge.py")


@pytest.fixture
def digest(monkeypatch):
    """The name of one operation's machine code, were a file other than it is."""

    def digest(changed: str, *made_of: object) -> str:
        uses._shared_contents.cache_clear()
        read = uses._contents.__wrapped__
        monkeypatch.setattr(
            uses, "_contents", lambda file: read(file) + (b"#" if file.endswith(changed) else b"")
        )
        flip = structures.REGISTRY["plankton"].declared.operating["flip_edge"].kernel
        try:
            return uses._digest(made_of or [flip, structures.REGISTRY["plankton"].records_type], "")
        finally:
            monkeypatch.undo()
            uses._shared_contents.cache_clear()

    return digest


@pytest.mark.parametrize("file", [*BAKED_IN, "structures/pairs.py"])
def test_a_changed_file_gives_another_name(digest, file):
    assert digest(file) != digest("nothing of it")


def test_a_file_that_is_not_baked_in_changes_nothing(digest):
    assert digest("structures/half_edge.py") == digest("nothing of it")


def test_what_numba_keeps_by_itself_uses_nothing_of_other_files():
    """It would not notice that they change, as it looks at the file of the function alone."""
    looked_at = 0
    for file in (it for room in ("hem", "structures") for it in (ROOT / room).rglob("*.py")):
        tree = ast.parse(file.read_text("utf-8"))
        ours = [it for it in tree.body if isinstance(it, ast.ImportFrom)]
        ours = [it for it in ours if str(it.module).startswith(("hem", "structures"))]
        imported = {alias.asname or alias.name for it in ours for alias in it.names}
        for it in ast.walk(tree):
            if isinstance(it, ast.FunctionDef) and any(map(by_numba, it.decorator_list)):
                looked_at += 1
                inside = [name for line in it.body for name in ast.walk(line)]
                names = {name.id for name in inside if isinstance(name, ast.Name)}
                names -= {argument.arg for argument in it.args.args}
                assert not names & imported, f"{file}: {it.name} is to be @kept"
    assert looked_at > 10


def by_numba(decorator: ast.expr) -> bool:
    """Whether it has Numba keep a function on disk."""
    return "cache=True" in ast.unparse(decorator)


@pytest.mark.parametrize(
    ("function", "file"),
    [
        (closest, "algorithms/nearest.py"),
        (add_quadrics, "algorithms/parts.py"),
        (_runs, "hem/edit.py"),
    ],
)
def test_a_function_that_is_kept_is_named_by_the_files_of_what_it_uses(digest, function, file):
    assert digest(file, function) != digest("nothing of it", function)
    assert len(function.py_func.__qualname__) == len(f"{function.__name__}_") + 12


def test_arrays_that_lie_otherwise_than_expected_are_refused(monkeypatch):
    size = BaseContext.get_abi_sizeof
    monkeypatch.setattr(BaseContext, "get_abi_sizeof", lambda context, it: size(context, it) + 8)
    pinned = Pinned(np.zeros((2, 3), np.int16))
    load = loader(pinned.kind, ())
    with pytest.raises(Exception, match="lays arrays out otherwise"):
        njit(lambda address: load(address)[0][0, 0])(pinned.address)


def test_a_template_without_a_kernel_says_so():
    for template in (templates.single, templates.perform, templates.find_edge, templates.run):
        with pytest.raises(TypeError, match="not bound to a kernel"):
            template(*[0] * template.__code__.co_argcount)


def test_a_kernel_called_from_python_is_run_by_python():
    """It has no compiled entry for Python; without a source to run the process would end."""
    numbers = np.array([3, 1, 3, 2])
    assert without(numbers, 4, 3) == 2
    assert numbers.tolist()[:2] == [1, 2]
