"""Machine code that is kept on disk is named by all that is baked into it."""

from __future__ import annotations

import numpy as np
import pytest

import structures
from hem.authoring.kernels import without
from hem.engine import uses

BAKED_IN = ("hem/edit.py", "hem/engine/pinned.py", "hem/authoring/operations/flip_edge.py")


@pytest.fixture
def digest(monkeypatch):
    """The name of one operation's machine code, were a file other than it is."""

    def digest(changed: str = "") -> str:
        uses._shared_contents.cache_clear()
        read = uses._contents.__wrapped__
        monkeypatch.setattr(
            uses, "_contents", lambda file: read(file) + (b"#" if file.endswith(changed) else b"")
        )
        flip = structures.REGISTRY["plankton"].declared.operating["flip_edge"]
        try:
            return uses._digest([flip.kernel, structures.REGISTRY["plankton"].records_type], "")
        finally:
            monkeypatch.undo()
            uses._shared_contents.cache_clear()

    return digest


@pytest.mark.parametrize("file", [*BAKED_IN, "structures/pairs.py"])
def test_a_changed_file_gives_another_name(digest, file):
    assert digest(file) != digest("nothing of it")


def test_a_file_that_is_not_baked_in_changes_nothing(digest):
    assert digest("structures/half_edge.py") == digest("nothing of it")


def test_a_kernel_called_from_python_is_run_by_python():
    """It has no compiled entry for Python; without a source to run the process would end."""
    numbers = np.array([3, 1, 3, 2])
    assert without(numbers, 4, 3) == 2
    assert numbers.tolist()[:2] == [1, 2]
