"""What compiled code visits on the way around an element, against the answers to the queries."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
import pytest

import hem
import structures
from hem.arrays import Array
from hem.authoring import Kernel, Kernels, kernel, visiting, walks
from tests.extent import OF_EACH_KIND, waiting_for

QUERIES = "vertex_vertices", "vertex_edges", "vertex_faces", "face_vertices"


class Plan(NamedTuple):
    """What is asked, and what comes of it."""

    vertices: Array
    faces: Array
    seen: Array  # (4, n, 3) int64: per query and element, how many, their sum, and that of squares
    counted: Array  # (4, n) int64
    out: Any


@kernel
def add(m: Any, it: int, state: tuple[int, int, int], plan: Plan) -> tuple[int, int, int]:
    n, total, squares = state
    small = it & 0xFFFF
    return n + 1, total + small, squares + small * small


def asking(query: str) -> Any:
    def make(k: Kernels, operations: Kernels) -> Kernel:
        visit_all, count = visiting(k[query], add), walks.counting(k[query])
        place, of_vertices = QUERIES.index(query), query.startswith("vertex")

        @kernel
        def ask(m: Any, plan: Plan) -> int:
            elements = plan.vertices if of_vertices else plan.faces
            for i in range(len(elements)):
                it = elements[i]
                n, total, squares = visit_all(m, it, (0, 0, 0), plan)
                plan.seen[place, it, 0] = n
                plan.seen[place, it, 1] = total
                plan.seen[place, it, 2] = squares
                plan.counted[place, it] = count(m, it, plan.out)
            return 0

        return ask

    return make


ASKING = {query: asking(query) for query in QUERIES}


def holes_in_a_disk(name: str) -> structures.Structure:
    """Closed and open fans, vertices of one face, and vertices without any."""
    s = structures.build(name, hem.generate("grid", 64))
    for face in s.faces()[::9].tolist():
        with suppress(hem.TopologyError):  # two fans would meet
            s.remove_face(face)
    assert 80 < s.n_faces < 98
    s.add_vertex([9.0, 9.0, 9.0])
    return s


MADE = {
    "closed": lambda name: structures.build(name, hem.generate("torus", 100)),
    "with holes": holes_in_a_disk,
    "with holes, a copy": lambda name: holes_in_a_disk(name).copy(),
    "empty": lambda name: structures.build(name, hem.TriangleMesh(np.zeros((0, 3)), [])),
}
FEW = *OF_EACH_KIND, "winged_edge"  # which meets one half-edge too many on the border


@pytest.mark.parametrize("made", MADE)
@pytest.mark.parametrize("name", waiting_for(FEW, structures.NAMES))
def test_every_answer_is_visited_and_counted_once(name: str, made: str) -> None:
    if made.startswith("with holes") and not hasattr(structures.REGISTRY[name], "remove_face"):
        pytest.skip("takes no face away")
    s = MADE[made](name)
    n = max(len(s.points), s.face_end, 1)
    seen, counted = np.zeros((4, n, 3), np.int64), np.zeros((4, n), np.int64)
    plan = Plan(s.vertices(), s.faces(), seen, counted, s.scratch(0)[0])
    for make in ASKING.values():
        s.run(make, plan)
    for place, query in enumerate(QUERIES):
        for it in s.handles(query.split("_")[0]).tolist():
            small = np.asarray(getattr(s, query)(it), np.int64) & 0xFFFF
            assert seen[place, it].tolist() == [len(small), small.sum(), (small**2).sum()]
            assert counted[place, it] == len(small)
