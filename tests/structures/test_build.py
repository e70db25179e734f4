"""Building: what is kept, what it weighs, what is refused."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import hem
import structures
from hem.authoring import EDGE_ROOM, FACE_ROOM, VALENCE
from hem.authoring.records import grown
from hem.meshes import undirected_edges
from hem.room import ADDRESSES, LARGE, behind
from tests.structures.conftest import HOLDS_ANYTHING, NEEDS_MANIFOLD, OF_ARRAYS, shuffled

NON_MANIFOLD = {
    "edge in three faces": ([(0, 1, 2), (1, 0, 3), (0, 1, 4)], "edges", [[0, 1]]),
    "faces that run the same way": ([(0, 1, 2), (0, 1, 3)], "edges", [[0, 1]]),
    "two fans in a vertex": ([(0, 1, 2), (0, 3, 4)], "vertices", [0]),
    "edge in four faces": ([(0, 1, 2), (1, 0, 3), (0, 1, 4), (1, 0, 5)], "edges", [[0, 1]]),
}


def turned(triangles: np.ndarray) -> list[tuple[int, ...]]:
    """Each triangle from its smallest corner on, in the order of the faces."""
    return [tuple(np.roll(t, -int(np.argmin(t))).tolist()) for t in triangles]


def test_a_mesh_comes_back_as_it_was_face_by_face(name, mesh):
    back = structures.build(name, mesh).to_triangles()
    assert np.array_equal(back.points, mesh.points)
    assert turned(back.triangles) == turned(mesh.triangles)


def test_the_valence_that_building_tells_is_that_of_the_mesh(name, mesh):
    told = structures.build(name, mesh).records.counts[VALENCE]
    edges, _ = undirected_edges(mesh.triangles)
    most = np.bincount(np.ravel(edges)).max(initial=0)
    assert told == 0 or most <= told <= max(most + 1, 3)  # 0 where nobody has counted


def test_a_structure_does_not_share_its_arrays_with_the_mesh(name):
    mesh = hem.generate("torus", 100)
    before = mesh.points.copy()
    structures.build(name, mesh).move_vertex(0, (7, 7, 7))
    assert np.array_equal(mesh.points, before)


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_no_kernel_is_given_positions_of_eight_bytes(name):
    mesh = hem.generate("grid", 9).astype(np.float64)
    with pytest.raises(hem.MeshError, match="holds float32"):
        structures.REGISTRY[name].build(mesh)
    assert np.array_equal(structures.build(name, mesh).points, mesh.points.astype(np.float32))


@pytest.mark.parametrize("name", NEEDS_MANIFOLD)
@pytest.mark.parametrize("case", NON_MANIFOLD)
def test_what_is_not_manifold_is_refused_with_its_elements(name, case):
    triangles, kind, elements = NON_MANIFOLD[case]
    mesh = hem.TriangleMesh(np.random.default_rng(0).random((6, 3)), triangles)
    with pytest.raises(hem.NonManifoldError) as refusal:
        structures.build(name, mesh)
    assert refusal.value.elements[kind].tolist() == elements


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
@pytest.mark.parametrize("case", NON_MANIFOLD)
def test_the_indexed_mesh_holds_what_is_not_manifold(name, case):
    mesh = hem.TriangleMesh(np.random.default_rng(0).random((6, 3)), NON_MANIFOLD[case][0])
    s = structures.build(name, mesh)
    s.validate()
    assert s.n_faces == len(mesh.triangles)


@pytest.mark.parametrize("name", NEEDS_MANIFOLD)
def test_a_fault_is_found_wherever_it_lies(name):
    """Random pairs of far vertices of a torus merged: two closed fans in one vertex each time."""
    mesh, rng = hem.generate("torus", 400), np.random.default_rng(1)
    for _ in range(20):
        a, b = rng.choice(400, 2, replace=False)
        triangles = np.where(mesh.triangles == b, a, mesh.triangles)
        if len({*triangles[(triangles == a).any(axis=1)].ravel()}) < 13:
            continue
        with pytest.raises(hem.NonManifoldError) as refusal:
            structures.build(name, hem.TriangleMesh(mesh.points, triangles))
        assert a in refusal.value.elements["vertices"]


@pytest.mark.parametrize("name", NEEDS_MANIFOLD)
def test_a_face_too_many_is_found_at_a_vertex_of_large_valence(name):
    mesh = hem.generate("cone", 3000)
    again = np.vstack([mesh.triangles, mesh.triangles[[1500]]])
    with pytest.raises(hem.NonManifoldError):
        structures.build(name, hem.TriangleMesh(mesh.points, again))


@pytest.mark.parametrize("name", [it for it in NEEDS_MANIFOLD if it in OF_ARRAYS])
def test_more_half_edges_than_int32_can_name_are_refused(name, monkeypatch):
    monkeypatch.setattr("hem.authoring.pairing.MOST_HALF_EDGES", 599)
    assert structures.build(name, hem.generate("grid", 100)).n_faces == 162
    with pytest.raises(hem.MeshError, match="200 faces have more half-edges"):
        structures.build(name, hem.generate("torus", 100))


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_more_elements_than_handles_can_name_find_no_room(name, monkeypatch):
    def large(array, used, length):
        return np.broadcast_to(array[:1], (length, *array.shape[1:]))  # takes no memory

    monkeypatch.setattr("hem.authoring.records.longer", large)
    s = structures.build(name, hem.generate("torus", 100))
    with pytest.raises(hem.MeshError, match="more than handles can name"):
        s.reserve(1_200_000_000)


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_room_that_is_doubled_ends_where_references_can_name_no_more(name, monkeypatch):
    def doubled(array, used, length):
        return np.broadcast_to(array[:1], (2 * length, *array.shape[1:]))

    s = structures.build(name, hem.generate("torus", 100))
    monkeypatch.setattr("hem.authoring.records.longer", doubled)
    faces = 350_000_000  # six half-edges each
    rooms = grown(s.records, type(s).fields, 0, faces).counts[[FACE_ROOM, EDGE_ROOM]]
    assert np.iinfo(np.int32).max >= min(rooms) >= 200 + faces
    with pytest.raises(hem.MeshError, match="more than references of 4 bytes"):
        grown(s.records, type(s).fields, 0, 2**31)


@pytest.mark.parametrize("reference_bytes", [4, 8])
def test_a_renumbered_mesh_is_the_same_surface(name, reference_bytes):
    mesh = shuffled(hem.generate("torus", 900), seed=3)
    s = structures.build(name, mesh, reference_bytes)
    s.validate()
    assert (s.n_vertices, s.n_edges, s.n_faces) == (900, 2700, 1800)


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_slices_side_by_side_build_what_one_slice_builds(name, monkeypatch):
    mesh = shuffled(hem.generate("torus", 400))
    alone = structures.build(name, mesh).records
    monkeypatch.setattr("hem.authoring.slices.slice_count", lambda n: 3)
    monkeypatch.setattr("hem.authoring.pairing.slice_count", lambda n: 3)
    for one, many in zip(alone, structures.build(name, mesh).records, strict=True):
        assert np.array_equal(one, many)


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_every_byte_of_the_arrays_is_a_field_or_a_name(name):
    for reference_bytes in (4, 8):
        s = structures.build(name, hem.generate("torus", 400), reference_bytes)
        told = sum(s.memory(names=True).values())
        assert told == sum(array.nbytes for array in s.arrays)


@pytest.mark.parametrize(
    ("structure", "size"),
    [("half-edge", 4), (["indexed"], 4), ("half_edge", 2), ("half_edge", None), ("half_edge", [8])],
)
def test_a_name_or_size_that_does_not_exist_is_refused(structure, size):
    with pytest.raises(hem.MeshError, match=r"half_edge|4 or 8"):
        structures.build(structure, hem.generate("torus", 100), reference_bytes=size)


@pytest.mark.skipif(ADDRESSES == 1, reason="here addresses count as memory")
@pytest.mark.parametrize("name", OF_ARRAYS)
def test_no_large_array_is_moved_while_a_mesh_grows_threefold(name):
    s = structures.build(name, hem.generate("torus", 100_000))
    large = [it.ctypes.data for it in s.arrays if it.nbytes >= LARGE]
    assert large
    s.split_all_faces()
    assert len(s.points) == 300_000
    assert set(large) <= {it.ctypes.data for it in s.arrays}


@pytest.mark.skipif(ADDRESSES == 1, reason="here addresses count as memory")
@pytest.mark.parametrize("reference_bytes", [4, 8])
@pytest.mark.parametrize("name", OF_ARRAYS)
def test_behind_every_large_array_there_are_addresses_as_soon_as_it_is_built(name, reference_bytes):
    s = structures.build(name, hem.generate("torus", 150_000), reference_bytes)
    behind_each = [behind(it) / it.nbytes for it in s.arrays if it.nbytes >= LARGE]
    assert min(behind_each) >= ADDRESSES - 1


def test_without_a_compiler_it_is_said_what_to_do():
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-c", "import structures"]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert "ImportError: meshes need Numba's compiler: unset NUMBA_DISABLE_JIT" in ended.stderr


def test_where_no_folder_can_be_written_it_is_said_what_to_do():
    nowhere = "from numba.core.caching import CacheImpl; CacheImpl._locator_classes = []"
    command = [sys.executable, "-c", f"{nowhere}; import structures"]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert "ImportError: set NUMBA_CACHE_DIR to a folder that can be written" in ended.stderr
