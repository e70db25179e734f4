"""What a query reads, entry by entry: as many as are counted, and all that its answer rests on."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from hem.contract import QUERIES
from hem.engine import interpreted
from tests.structures.conftest import OF_ARRAYS, shuffled

GARBAGE = 1 << 29
"""An entry that leads nowhere."""


def built(name: str) -> structures.Structure:
    s = structures.build(name, shuffled(hem.generate("grid", 25)))
    s.vertex_faces(0)  # finds what is found when first asked
    return s


@pytest.mark.parametrize("query", QUERIES)
def test_as_many_entries_are_read_as_are_counted(name, query):
    s = built(name)
    for handle in s.handles(QUERIES[query].source)[:5].tolist():
        assert len(s.reads(query, handle)) == s.work(query, np.array([handle]))[0]


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_the_entries_that_are_read_suffice_for_the_faces_that_the_triangle_list_has(name):
    mesh = shuffled(hem.generate("grid", 25))
    s, garbled = built(name), built(name)
    kernel, places = interpreted(s.kernels["vertex_faces"]), {}
    for field in s.fields:
        taken = sum(it.width for _, it in places.values() if it.array == field.array)
        places[field.name] = taken, field
    for v in range(len(mesh.points)):
        for array in {it.array for it in s.fields} - {"vertex_point"}:
            getattr(garbled.records, array)[:] = GARBAGE
        for field, row, column in s.reads("vertex_faces", v):
            if field in places:
                first, its = places[field]
                good, bad = (getattr(it.records, its.array) for it in (s, garbled))
                key = row if good.ndim == 1 else (row, first + column)
                bad[key] = good[key]
        out = np.full(64, -1)
        count = kernel(garbled.records, v, out)
        assert sorted(out[:count]) == np.flatnonzero((mesh.triangles == v).any(axis=1)).tolist()


def test_a_walk_over_objects_reads_the_faces_that_the_triangle_list_has():
    mesh = shuffled(hem.generate("grid", 25))
    s = built("half_edge_objects")
    for v in range(len(mesh.points)):
        read = s.reads("vertex_faces", v)
        asked = [s.half_edges[it.row].face.index for it in read if it.field == "half_edge.face"]
        assert sorted(asked) == np.flatnonzero((mesh.triangles == v).any(axis=1)).tolist()
