"""TriangleMesh: what it takes, what it refuses, and what it tells of itself."""

import pickle
import subprocess
import sys
import warnings
from collections import Counter
from itertools import combinations
from typing import Any, Literal

import numpy as np
import pytest
from numpy.typing import ArrayLike

import hem
from hem.meshes import foretold

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def test_arrays_of_the_right_type_are_shared_if_nobody_can_write_to_them() -> None:
    points, triangles = SQUARE.copy(), HALVES.copy()
    mesh = hem.TriangleMesh(points, triangles)
    again = hem.TriangleMesh(mesh.points, mesh.triangles)
    for kept, shared, given in (
        (mesh.points, again.points, points),
        (mesh.triangles, again.triangles, triangles),
    ):
        assert not np.shares_memory(kept, given)
        assert np.shares_memory(shared, kept)
        assert given.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            kept[0, 0] = 1


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("kind", [np.int8, np.uint16, np.int64, np.uint64, np.float64])
def test_other_types_and_orders_become_contiguous_float32_and_int32(
    order: Literal["C", "F"], kind: type[np.generic]
) -> None:
    mesh = hem.TriangleMesh(SQUARE.astype(np.float64, order=order), HALVES.astype(kind))
    assert [mesh.points.dtype.name, mesh.triangles.dtype.name] == ["float32", "int32"]
    assert mesh.points.flags.c_contiguous
    assert mesh.triangles.flags.c_contiguous
    assert np.array_equal(mesh.points, SQUARE)
    assert np.array_equal(mesh.triangles, HALVES)


@pytest.mark.parametrize(
    ("points", "triangles", "words", "rows"),
    [
        (SQUARE[:, :2], HALVES, "shape", None),
        (SQUARE, [[0, 1]], "shape", None),
        (SQUARE, [0, 1, 2], "shape", None),
        (SQUARE, [[0, 1], [2]], "rows of three", None),
        (SQUARE, [["a", "b", "c"]], "numbers", None),
        (SQUARE, [[0, 1, 2**70]], "64 bits", None),
        (SQUARE.astype(complex), HALVES, "numbers", None),
        (np.where(SQUARE > 0, np.nan, SQUARE), HALVES, "not finite", [1, 2, 3]),
        (np.where(SQUARE > 0, np.inf, SQUARE), HALVES, "not finite", [1, 2, 3]),
        (SQUARE.astype(float) * 1e300, HALVES, "float32", [1, 2, 3]),
        (SQUARE, [[0, 1, 2], [0, 1, 4]], r"out of the range 0 … 3, such as 4 \(", [1]),
        (SQUARE, [[0, -1, 2], [0, 1, 2]], r"such as -1 \(", [0]),
        (SQUARE, [[1, 2, 9], [1, 2, 3]], r"such as 9 \(", [0]),
        (SQUARE, [[0, 1, 2], [0, 1, 2**31]], "beyond int32", [1]),
        (SQUARE, [[1, 2, 3], [1, 3, 4]], "count from 1", [1]),
        (SQUARE, [[0, 1, 2], [0, 1, 2.5]], "whole numbers", [1]),
        (SQUARE, [[0, 1, np.nan]], "whole numbers", [0]),
        (SQUARE, [[0, 1, 2], [0, 1, np.inf]], "whole numbers", [1]),
        (SQUARE, [[0, 1, 2], [3, 1, 3], [2, 2, 1]], "a vertex twice", [1, 2]),
        ([], [[0, 1, 2]], "no points", [0]),
        (np.broadcast_to(SQUARE[0], (2**31, 3)), [], "points are more than int32", None),
        (SQUARE, np.broadcast_to(HALVES[0], (2**31, 3)), "triangles are more than int32", None),
    ],
)
def test_what_is_no_mesh_is_refused_naming_the_rows(
    points: ArrayLike, triangles: ArrayLike, words: str, rows: list[int] | None
) -> None:
    with (
        pytest.raises(hem.MeshError, match=words) as refusal,
        warnings.catch_warnings(action="error"),
    ):
        hem.TriangleMesh(points, triangles)
    named = refusal.value.elements.get("rows")
    assert (named if named is None else named.tolist()) == rows


def test_what_is_masked_is_no_position_and_no_corner() -> None:
    points = np.ma.masked_equal(SQUARE, 1)
    faces = np.ma.array([[0, 1, 2, 3], [0, 1, 2, 3]], mask=[4 * [False], [False] * 3 + [True]])
    for make in (hem.TriangleMesh, hem.PolygonMesh, lambda *it: hem.as_mesh(it)):
        with pytest.raises(hem.MeshError, match="some of the points are masked"):
            make(points, HALVES)
        with pytest.raises(hem.MeshError, match=r"some of the (faces|triangles) are masked"):
            make(SQUARE, faces if make is hem.PolygonMesh else np.ma.masked_equal(HALVES, 3))
        mesh = make(np.ma.array(SQUARE), np.ma.array(HALVES, mask=False))
        assert mesh.face_rows().to_list() == HALVES.tolist()


def test_an_error_lists_the_first_elements_and_how_many_more_there_are() -> None:
    error = hem.MeshError("wrong", edges=[[i, i + 1] for i in range(9)], faces=[])
    assert str(error) == "wrong (edges: 0-1, 1-2, 2-3, 3-4, 4-5, 5-6 and 3 more)"
    assert list(error.elements) == ["edges"]
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error)
    assert np.array_equal(again.elements["edges"], error.elements["edges"])


def test_errors_are_value_errors_and_topology_apart_from_mesh() -> None:
    assert issubclass(hem.NonManifoldError, hem.MeshError)
    assert issubclass(hem.MeshError, ValueError)
    assert issubclass(hem.TopologyError, ValueError)
    assert not issubclass(hem.TopologyError, hem.MeshError)


@pytest.mark.parametrize("none", [[], np.zeros((0, 3)), np.zeros((0, 3), np.int64)])
def test_the_empty_mesh_is_legal(none: ArrayLike) -> None:
    mesh = hem.TriangleMesh(none, none)
    assert (mesh.points.shape, mesh.triangles.shape) == ((0, 3), (0, 3))
    assert [mesh.points.dtype.name, mesh.triangles.dtype.name] == ["float32", "int32"]
    summary = mesh.summary()
    assert (summary.vertices, summary.edges, summary.faces, summary.components) == (0, 0, 0, 0)
    assert mesh.welded().triangles.shape == mesh.flipped().triangles.shape == (0, 3)


def test_flipping_turns_every_face_and_twice_gives_the_mesh() -> None:
    mesh = hem.TriangleMesh(SQUARE, HALVES)
    turned = {tuple(np.roll(t, -int(np.argmin(t)))) for t in mesh.flipped().triangles}
    assert turned == {(0, 2, 1), (0, 3, 2)}
    assert np.array_equal(mesh.flipped().flipped().triangles, HALVES)


def test_welding_leaves_one_vertex_per_position_in_order_of_first_occurrence() -> None:
    random = np.random.default_rng(1)
    points = random.integers(-1, 2, (60, 3)).astype(np.float32) * random.choice([1, -1.0], (60, 1))
    triangles = [t for t in random.integers(0, 60, (200, 3)) if len(set(t)) == 3]
    mesh = hem.TriangleMesh(points, triangles)
    welded = mesh.welded()

    positions = list(dict.fromkeys(tuple(p) for p in points.tolist()))  # -0.0 is 0.0 as a key
    assert [tuple(p) for p in welded.points.tolist()] == positions
    places = [[tuple(points[v].tolist()) for v in t] for t in triangles]
    kept = [t for t in places if len(set(t)) == 3]
    assert [[tuple(p) for p in t] for t in welded.points[welded.triangles].tolist()] == kept


def test_welding_within_a_tolerance_joins_chains_and_parts_the_rest() -> None:
    random = np.random.default_rng(2)
    points = random.random((120, 3)).astype(np.float32)
    tolerance = 0.12
    label = np.arange(120)
    for i, j in combinations(range(120), 2):
        if np.linalg.norm(points[i].astype(float) - points[j]) <= tolerance:
            label[label == label[j]] = label[i]
    first = {x: min(np.flatnonzero(label == x)) for x in set(label.tolist())}
    faces = [[first[label[v]] for v in t] for t in combinations(range(0, 120, 7), 3)]
    welded = hem.TriangleMesh(points, [*combinations(range(0, 120, 7), 3)]).welded(tolerance)
    assert 1 < len(welded.points) < 120
    assert np.array_equal(welded.points, points[sorted(first.values())])
    kept = [points[t].tolist() for t in faces if len(set(t)) == 3]
    assert welded.points[welded.triangles].tolist() == kept


def test_welding_parts_what_is_next_to_nothing_apart() -> None:
    points = np.array([(0, 0, 0), (1e-30, 0, 0), (2e-30, 0, 0), (-0.0, 0, 0)])
    assert np.array_equal(hem.TriangleMesh(points, []).welded().points, np.float32(points[:3]))


@pytest.mark.parametrize(
    "tolerance", [-1.0, np.nan, np.inf, "a", None, [1.0], pytest.param(10**400, id="no float")]
)
def test_a_tolerance_is_finite_and_not_negative(tolerance: Any) -> None:
    with pytest.raises(hem.MeshError, match="tolerance"):
        hem.TriangleMesh(SQUARE, HALVES).welded(tolerance)


@pytest.mark.parametrize("dtype", ["x", "float16", int, object()])
def test_positions_are_kept_as_float32_or_float64(dtype: Any) -> None:
    mesh = hem.TriangleMesh(SQUARE, HALVES)
    for make in (hem.TriangleMesh, hem.PolygonMesh):
        with pytest.raises(hem.MeshError, match="float32 or float64"):
            make(SQUARE, HALVES, dtype)
    with pytest.raises(hem.MeshError, match="float32 or float64"):
        mesh.astype(dtype)


def test_whole_floats_are_indices_of_triangles_and_of_polygons() -> None:
    for make in (hem.TriangleMesh, hem.PolygonMesh):
        mesh = make(SQUARE, HALVES.astype(float))
        assert mesh.face_rows().to_list() == HALVES.tolist()
        assert mesh.face_rows().values.dtype == np.int32
        for wrong in (0.5, np.nan, np.inf):
            with pytest.raises(hem.MeshError, match="not whole numbers") as refused:
                make(SQUARE, np.where(HALVES == 3, wrong, HALVES))
            assert [it.tolist() for it in refused.value.elements.values()] == [[1]]
        with pytest.raises(hem.MeshError, match="out of the range"):
            make(SQUARE, HALVES + 1.0)


def test_a_summary_counts_what_sets_count() -> None:
    random = np.random.default_rng(3)
    triangles = [t for t in random.integers(0, 40, (25, 3)).tolist() if len(set(t)) == 3]
    mesh = hem.TriangleMesh(random.random((50, 3)), triangles)
    edges = [frozenset(p) for t in triangles for p in combinations(t, 2)]
    used = {v for t in triangles for v in t}
    valences = [sum(v in e for e in set(edges)) for v in used]
    parts: list[set[int]] = []
    for triangle in triangles:
        touching = [part for part in parts if part & set(triangle)]
        parts = [p for p in parts if p not in touching] + [set(triangle).union(*touching)]

    summary = mesh.summary()
    assert (summary.vertices, summary.edges, summary.faces) == (50, len(set(edges)), len(triangles))
    assert summary.unreferenced == 50 - len(used)
    assert summary.border_edges == sum(edges.count(e) == 1 for e in set(edges))
    assert summary.components == len(parts)
    assert summary.euler == len(used) - len(set(edges)) + len(triangles)
    assert (summary.valence_min, summary.valence_max) == (min(valences), max(valences))
    assert summary.valence_mean == pytest.approx(np.mean(valences))


def test_a_summary_and_a_mesh_read_well() -> None:
    mesh = hem.TriangleMesh(np.vstack([SQUARE, [[5, 5, 5]]]), HALVES)
    assert repr(mesh) == "TriangleMesh(5 vertices, 2 faces)"
    for line in ("vertices      5 (1 without faces)", "edges         5 (4 on the border)"):
        assert line in str(mesh.summary())


def test_importing_hem_imports_none_of_the_heavy_libraries() -> None:
    heavy = ["pymeshlab", "pandas", "matplotlib", "scipy", "numba"]
    program = f"import hem, sys; print([m for m in {heavy} if m in sys.modules])"
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert said.stdout.strip() == "[]", said.stderr


@pytest.mark.parametrize("name", ["torus:400", "grid:400", "isosurface:400", "bunny"])
def test_how_much_of_places_is_foretold_is_how_often_the_usual_one_is_right(name: str) -> None:
    triangles, places = hem.find_mesh(name).triangles.tolist(), {}
    for a, b, c in triangles:
        places |= {(a, b): 0, (b, c): 1, (c, a): 2}
    seen = [(place, places[b, a]) for (a, b), place in places.items() if (b, a) in places]
    usual = {one: Counter(it for mine, it in seen if mine == one).most_common(1)[0][1]
             for one in range(3)}  # fmt: skip
    assert foretold(np.array(triangles)) == pytest.approx(sum(usual.values()) / len(seen))
    assert foretold(np.zeros((0, 3), np.int32)) == 1
