"""The cost of a query, counted in reads: exact, so the classes of table 1 are exact as well."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from hem.contract import QUERIES
from hem.engine import CountingArray, interpreted
from tests.extent import OF_EACH_KIND
from tests.structures.conftest import OF_ARRAYS, shuffled

SCANS = {
    "vertex_vertices",
    "vertex_edges",
    "vertex_faces",
    "edge_edges",
    "edge_faces",
    "face_faces",
}


def reads(name: str, n_vertices: int, query: str) -> int:
    s = structures.build(name, hem.generate("torus", n_vertices))
    getattr(s, query)(s.handles(QUERIES[query].source)[:1])  # finds what is found when first asked
    return int(s.work(query, s.handles(QUERIES[query].source)[[7]])[0])


def test_the_faces_around_a_half_edge_vertex_take_one_read_and_three_per_face():
    for n_vertices in (100, 900):
        assert reads("half_edge", n_vertices, "vertex_faces") == 1 + 3 * 6


@pytest.mark.parametrize("query", QUERIES)
def test_reads_do_not_depend_on_the_size_unless_the_mesh_is_scanned(name, query):
    small, large = reads(name, 100, query), reads(name, 900, query)
    if structures.REGISTRY[name].searches and query in SCANS:
        assert large > 8 * small
    else:
        assert large <= small + (10 if name == "indexed_adjacency" else 2)  # which hashes


@pytest.mark.parametrize("query", QUERIES)
def test_compiled_and_interpreted_kernels_give_the_same_answer(name, query):
    s = structures.build(name, hem.generate("grid", 49))
    handles = s.handles(QUERIES[query].source)
    getattr(s, query)(handles)  # finds what is found when first asked
    before = {
        field: array.copy() for field, array in zip(s.records._fields, s.arrays, strict=False)
    }
    checksum, asked = 0, s._queries
    for handle in handles:
        wanted, out = asked._ready(query, np.array([handle]))
        asked._declared.queries[query].work(wanted, out, s._state.records)
        answer = getattr(s, query)(int(handle))
        assert list(out[: len(answer)]) == answer.tolist()
        checksum = (checksum + len(answer)) ^ (int(answer[-1]) if len(answer) else 0)
    compiled = name in OF_EACH_KIND  # a sweep is for measuring alone, and compiled for that alone
    swept = s if compiled else structures.build(name, hem.generate("grid", 49), compiled=False)
    assert swept.sweep(query, handles) == checksum
    assert all(np.array_equal(getattr(s.records, field), kept) for field, kept in before.items())


def test_every_element_read_is_counted_once():
    counted = CountingArray(np.arange(12).reshape(4, 3))
    assert counted[1, 2] == 5
    assert counted.accesses == 1
    assert counted[2].tolist() == [6, 7, 8]
    assert counted.accesses == 4
    assert len(counted) == counted.shape[0] == 4
    assert counted.accesses == 4


@pytest.mark.parametrize("key", [-1, (-1, 0)])
def test_what_compiled_code_would_read_elsewhere_is_an_error_where_work_is_counted(key):
    counted = CountingArray(np.arange(12).reshape(4, 3))
    with pytest.raises(IndexError, match="lies before the array"):
        counted[key]
    with pytest.raises(IndexError, match="lies before the array"):
        counted[key] = 0
    assert counted.accesses == 0


# Entry by entry: as many as are counted, and all that an answer rests on --------------------------

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
