"""An algorithm never meets machine code that was made of something else: in new processes."""

from __future__ import annotations

import dis
import math
import os
import subprocess
import sys
from enum import IntEnum
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numba import types

import hem
import structures
from hem.authoring import kernel
from hem.engine import parts_of, uses
from structures import indexed, triangle_soup
from tests.extent import exhaustive

ROOT = Path(__file__).parents[3]

PLAN = """
from typing import NamedTuple
import numpy as np

class Plan(NamedTuple):
    vertices: np.ndarray
"""

COUNTING = """
def above(queries, operations):
    coordinate = queries["coordinate"]
    @kernel
    def count(m, plan):
        found = 0
        for v in plan.vertices:
            if coordinate(m, v, 2) > {limit}:
                found += 1
        return found
    return count
"""

ALGORITHM = "import conf\nfrom hem.authoring import kernel\n" + COUNTING.format(limit="conf.LIMIT")

RUN = """
import hem, structures
from plans import Plan
{above}
s = structures.build("indexed", hem.generate("torus", 100))
told = s.run(above, Plan(s.vertices()))
assert told == (s.points[:, 2] > {limit}).sum(), told
"""

CELL = """
from hem.authoring import kernel
exec(compile({counting!r}, "/tmp/ipykernel_1/cell.py", "exec"))
"""


def in_new_process(folder: Path, text: str, **environment: str) -> str:
    """What a program prints that stands in a folder, which also has its machine code."""
    own = {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}", "PYTHONDONTWRITEBYTECODE": "1"}
    own |= {"NUMBA_CACHE_DIR": str(folder / "machine code"), **environment}
    command = [sys.executable, "-c", text]
    ended = subprocess.run(command, env={**os.environ, **own}, capture_output=True, text=True)
    assert not ended.returncode, ended.stderr
    return ended.stdout


def test_a_constant_of_another_file_is_never_that_of_a_former_run(tmp_path):
    (tmp_path / "plans.py").write_text(PLAN)
    (tmp_path / "alg.py").write_text(ALGORITHM)
    for limit in (0.1, 9.0):
        (tmp_path / "conf.py").write_text(f"LIMIT = {limit}")
        in_new_process(tmp_path, RUN.format(above="from alg import above", limit=limit))


@exhaustive
def test_a_number_in_a_cell_of_a_notebook_is_never_that_of_a_former_run(tmp_path):
    (tmp_path / "plans.py").write_text(PLAN)
    for limit in (0.1, 9.0):
        above = CELL.format(counting=COUNTING.format(limit=limit))
        in_new_process(tmp_path, RUN.format(above=above, limit=limit))


def compiled(limit: int, body: str) -> Any:
    """A function of a cell, whose imported constants have this value."""
    conf = ModuleType("conf")
    conf.LIMIT, conf.Kind = limit, IntEnum("Kind", {"LIMIT": limit})
    conf.inner = ModuleType("inner")
    conf.inner.TABLE = np.array([limit])
    scope = {"conf": conf, "LIMIT": limit, "Kind": conf.Kind, "kernel": kernel}
    text = f"def made(closed):\n    @kernel\n    def it(i):\n        {body}\n    return it"
    exec(compile(text, "/tmp/ipykernel_1/cell.py", "exec"), scope)
    return scope["made"](limit)


@pytest.mark.parametrize(
    "body",
    ["LIMIT", "conf.LIMIT", "conf.inner.TABLE[i]", "Kind.LIMIT", "conf.Kind.LIMIT", "closed"],
)
def test_what_a_constant_is_enters_the_name(body):
    one, same, other = (compiled(limit, f"return {body}") for limit in (1, 1, 2))
    assert uses._digest([one], "") == uses._digest([same], "") != uses._digest([other], "")


@pytest.mark.parametrize(
    ("body", "otherwise"),
    [
        ("return i + 1", "return i + 2"),
        ("return [j + 1 for j in (i, i)]", "return [j + 2 for j in (i, i)]"),
        ("return (lambda j: j + 1)(i)", "return (lambda j: j + 2)(i)"),
        ("return i.real", "return i.imag"),
        ("return i + 1", "return i + 1.0"),
    ],
)
def test_what_is_written_enters_the_name(body, otherwise):
    assert uses._digest([compiled(1, body)], "") != uses._digest([compiled(1, otherwise)], "")


@kernel
def one():
    return 1


@kernel
def two():
    return 2


@pytest.mark.parametrize(
    ("it", "other"),
    [
        ((one, two), (two, one)),
        ((np.float32, one), (np.float64, one)),
        ((np.sin, one), (np.cos, one)),
        ((math.sin, one), (math.cos, one)),
        ((types.int32, one), (types.int64, one)),
    ],
)
def test_what_is_called_enters_the_name_by_where_it_is_called(it, other):
    def made(first, second):
        @kernel
        def kernel_of_both(i):
            return first(i) + second()

        return kernel_of_both

    assert uses._digest([made(*it)], "") == uses._digest([made(*it)], "")
    assert uses._digest([made(*it)], "") != uses._digest([made(*other)], "")


def test_what_a_function_of_a_module_is_made_of_enters_the_name():
    assert uses.source_of(indexed.split_face_records) in parts_of(
        triangle_soup.split_face_records, set()
    )


SCRIPT = PLAN + ALGORITHM.replace("import conf", "LIMIT = 0").replace("conf.", "")
SCRIPT += """
import hem, structures
class Within(NamedTuple):
    plan: Plan
    also: np.ndarray
def nested(queries, operations):
    count = above(queries, operations)
    @kernel
    def within(m, plan):
        return count(m, plan.plan) + plan.also[0]
    return within
s = structures.build("indexed", hem.generate("torus", 100))
plan = Plan(s.vertices())
assert s.run(above, plan) + 7 == s.run(nested, Within(plan, np.array([7])))
"""


def test_a_script_that_is_run_again_finds_its_machine_code(tmp_path):
    kept = []
    for _ in range(2):
        in_new_process(tmp_path, SCRIPT)
        kept.append({it.name for it in tmp_path.rglob("*.nbc")})
    assert kept[0] == kept[1] != set()


@exhaustive
def test_text_that_is_of_no_module_runs_again(tmp_path):
    """Numba could not load what it kept of it."""
    for _ in range(2):
        in_new_process(tmp_path, f"exec({SCRIPT!r}, {{'__name__': 'page'}})")


DIGEST = """
import math, types
import numpy as np
from hem.authoring import kernel
from hem.engine import uses

names, table, thing = frozenset("some names in a set".split()), np.arange(3), object()
one, other = types.ModuleType("one"), types.ModuleType("other")
one.other, other.one, one.limit, other.limit = other, one, 2, 3

def make(closed, also):
    @kernel
    def count(m, plan):
        steps = [lambda i: i + math.pi, lambda i: i in {{"a", "b", "c", "d"}}]
        return names, table[0], thing, one.limit, other.one.other.limit, closed, also, steps, {more}
    return count

print(uses._digest([make({{1: thing}}, (thing, 2.5))], ""))
"""


def test_unchanged_code_has_one_name_in_every_process(tmp_path):
    named = {
        in_new_process(tmp_path, DIGEST.format(more=more), PYTHONHASHSEED=seed)
        for more in ("1", "2")
        for seed in ("1", "2")
    }
    assert len(named) == 2


def test_globals_are_those_that_dis_tells():
    for kind in structures.REGISTRY.values():
        for it in kind.declared.operating.values():
            for part in parts_of(it.kernel, set()):
                told = dis.get_instructions(part)
                named = {one.argval for one in told if one.opname == "LOAD_GLOBAL"}
                assert uses._names(part.__code__)[0] == sorted(named)


def test_an_attribute_called_as_a_global_is_none():
    scope: dict[str, object] = {"points": 1}
    exec("def count(m, plan):\n    return plan.points\ndef read():\n    return points", scope)
    assert not uses._named(scope["count"])
    assert uses._named(scope["read"]) == {"points": 1}


def test_more_names_than_an_instruction_can_count_are_all_found():
    names = [f"name{i}" for i in range(300)]
    scope: dict[str, object] = dict.fromkeys(names, 0)
    exec(f"def count():\n    return {', '.join(names)}", scope)
    assert uses._named(scope["count"]).keys() == set(names)


LISTS = """
from typing import NamedTuple
import numpy as np
import hem, structures
from hem.authoring import kernel

class Plan(NamedTuple):
    numbers: list
    told: np.ndarray

def adding(queries, operations):
    @kernel
    def add(m, plan):
        for it in plan.numbers:
            plan.told[0] += it
        return 0
    return add

s, plan = structures.build("indexed", hem.generate("torus", 100)), Plan([1, 2, 4], np.zeros(1))
for _ in range(1000):
    s.run(adding, plan)
assert plan.told[0] == 7000
"""


def test_a_list_in_a_plan_is_left_whole(tmp_path):
    in_new_process(tmp_path, LISTS)


def test_an_algorithm_without_its_decorator_is_named():
    s = structures.build("indexed", hem.generate("torus", 100))
    with pytest.raises(TypeError, match=r"lambda.* makes no @kernel algorithm\(m, plan\)"):
        s.run(lambda queries, operations: undecorated, None)
    assert not s.uncompiled().build(s.to_triangles()).run(lambda q, o: undecorated, None)


def undecorated(m: Any, plan: Any) -> int:
    return 0
