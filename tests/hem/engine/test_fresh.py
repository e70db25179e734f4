"""Arrays that compiled code makes for Python are arrays like any other."""

import subprocess
import sys
import tracemalloc

import numpy as np
import pytest
from numba import njit

import hem
from hem.engine.fresh import fresh
from structures import REGISTRY


@njit
def first(values, count):
    return fresh(values, count)


@pytest.mark.parametrize("dtype", ["int8", "int32", "int64", "float32", "float64"])
@pytest.mark.parametrize("count", [0, 1, 7])
def test_a_fresh_array_holds_the_first_values_and_owns_them(dtype, count):
    values = np.arange(7, dtype=dtype)
    made, expected = first(values, count), values[:count].copy()
    assert made.dtype == values.dtype
    assert made.flags.owndata
    assert made.flags.writeable
    assert made.base is None
    assert sys.getrefcount(made) == sys.getrefcount(expected)
    values[:] = 100
    np.testing.assert_array_equal(made, expected)


def test_answers_leave_no_memory_behind():
    s = REGISTRY["half_edge"].build(hem.generate("torus", 100))
    asked = list(range(100)) * 20

    def ask():
        for vertex in asked:
            s.vertex_faces(vertex)

    ask()
    tracemalloc.start()
    ask()
    before, _ = tracemalloc.get_traced_memory()
    ask()
    after, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert after - before < len(asked)  # less than a byte each


def test_code_kept_on_disk_answers_the_same_in_a_new_process():
    ask = (
        "import hem; from structures import REGISTRY;"
        "s = REGISTRY['half_edge'].build(hem.generate('torus', 100));"
        "print([s.vertex_faces(v).tolist() for v in range(100)])"
    )
    s = REGISTRY["half_edge"].build(hem.generate("torus", 100))
    expected = [s.vertex_faces(v).tolist() for v in range(100)]
    said = subprocess.run([sys.executable, "-c", ask], check=True, capture_output=True, text=True)
    assert said.stdout.strip() == str(expected)
