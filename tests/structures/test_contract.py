"""The contract, checked on every structure against sets worked out from the triangle list alone."""

from functools import cache
from itertools import combinations

import numpy as np
import pytest

import hem
import structures
from tests.extent import waiting_for
from tests.structures.conftest import HOLDS_ANYTHING, NEEDS_MANIFOLD

CORE = structures.NAMES
QUERIES = [f"{a}_{b}" for a in ("vertex", "edge", "face") for b in ("vertices", "edges", "faces")]
ONE = hem.TriangleMesh(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.int32))
TWO = hem.TriangleMesh(
    np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32),
    np.array([[0, 1, 2], [0, 2, 3]], np.int32),
)
TETRA = hem.TriangleMesh(
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.int32),
)
MESHES = {
    "one triangle": lambda: ONE,
    "two triangles": lambda: TWO,
    "tetrahedron": lambda: TETRA,
    "torus": lambda: hem.generate("torus", n_vertices=400),
    "sphere": lambda: hem.generate("sphere", n_vertices=162),
    "grid": lambda: hem.generate("grid", n_vertices=100),
    "cone": lambda: hem.generate("cone", n_vertices=60),
}


class Truth:
    """Every relation of a mesh, as sets, from its triangles."""

    def __init__(self, triangles):
        self.faces = {f: tuple(map(int, t)) for f, t in enumerate(triangles)}
        self.edges = {}
        for f, t in self.faces.items():
            for pair in combinations(t, 2):
                self.edges.setdefault(frozenset(pair), set()).add(f)
        self.vertices = sorted({v for t in self.faces.values() for v in t})
        self.relation = cache(self.work_out)

    def work_out(self, query, x):
        kind, to = query.split("_")
        if kind == "vertex":
            faces = {f for f, t in self.faces.items() if x in t}
            edges = {e for e in self.edges if x in e}
            return {
                "faces": faces,
                "edges": edges,
                "vertices": {v for e in edges for v in e} - {x},
            }[to]
        if kind == "edge":
            return {
                "faces": self.edges[x],
                "vertices": set(x),
                "edges": {e for e in self.edges if e & x} - {x},
            }[to]
        edges = {frozenset(p) for p in combinations(self.faces[x], 2)}
        return {
            "vertices": set(self.faces[x]),
            "edges": edges,
            "faces": {f for e in edges for f in self.edges[e]} - {x},
        }[to]


def pair(s, edge):
    return frozenset(int(v) for v in s.edge_vertices(int(edge)))


def answer(s, query, handle):
    found = getattr(s, query)(handle)
    names = [pair(s, e) for e in found] if query.endswith("edges") else [int(x) for x in found]
    assert len(names) == len(set(names)), f"{query}({handle}) repeats a neighbor"
    return set(names)


def faces_of(s):
    """The live triangles by vertex handle, each rotated to start at its smallest."""
    rows = [[int(v) for v in s.face_vertices(int(f))] for f in s.faces()]
    return sorted(tuple(r[r.index(min(r)) :] + r[: r.index(min(r))]) for r in rows)


@pytest.fixture(params=CORE)
def name(request):
    return request.param


def test_the_structures_of_the_thesis_are_registered():
    assert structures.NAMES[:4] == structures.THESIS


@cache
def truth_of(mesh_name):
    """A mesh and what it says, worked out once for all structures."""
    mesh = MESHES[mesh_name]()
    return mesh, Truth(mesh.triangles)


@pytest.mark.parametrize("mesh_name", MESHES)
def test_queries_agree_with_the_triangle_list(name, mesh_name):
    mesh, truth = truth_of(mesh_name)
    s = structures.build(name, mesh)
    assert (s.n_vertices, s.n_edges, s.n_faces) == (
        len(mesh.points),
        len(truth.edges),
        len(mesh.triangles),
    )
    for query in QUERIES:
        kind = query.split("_")[0]
        handles = {"vertex": truth.vertices, "edge": s.edges(), "face": s.faces()}[kind]
        for handle in handles:
            key = pair(s, handle) if kind == "edge" else int(handle)
            assert answer(s, query, int(handle)) == truth.relation(query, key), query
        many = getattr(s, query)(np.asarray(handles))
        assert len(many.offsets) == len(handles) + 1, query
        for i, handle in enumerate(handles):
            batch = sorted(many.values[many.offsets[i] : many.offsets[i + 1]].tolist())
            assert batch == sorted(getattr(s, query)(int(handle)).tolist()), query


@pytest.mark.parametrize("sample", waiting_for(["cow"], ["cow", "bunny"]))
def test_a_model_survives_the_round_trip(name, sample):
    mesh = hem.sample(sample)
    s = structures.build(name, mesh)
    s.validate()
    back = s.to_triangles()
    assert np.array_equal(back.points, mesh.points)

    def turn(t):
        return sorted(tuple(np.roll(r, -int(np.argmin(r)))) for r in t)

    assert turn(back.triangles) == turn(mesh.triangles)


@pytest.mark.parametrize(
    ("reference_bytes", "expected"),
    [
        (
            8,
            {
                "indexed": 36,
                "indexed_adjacency": 112,
                "triangle_soup": 72,
                "triangle_neighbor": 116,
                "winged_edge": 228,
                "half_edge": 228,
                "plankton": 228,
                "directed_edge": 116,
            },
        ),
        (
            4,
            {
                "indexed": 36,
                "indexed_adjacency": 112,
                "triangle_soup": 72,
                "triangle_neighbor": 64,
                "winged_edge": 120,
                "half_edge": 120,
                "plankton": 120,
                "directed_edge": 64,
            },
        ),
    ],
)
def test_memory_per_vertex_on_a_torus_is_the_thesis_table(name, reference_bytes, expected):
    if name not in expected:  # objects, which weigh what Python gives them, and what others add
        return
    mesh = hem.generate("torus", n_vertices=10_000)
    s = structures.build(name, mesh, reference_bytes=reference_bytes)
    assert sum(s.memory().values()) == expected[name] * len(mesh.points)


def test_only_structures_without_edge_records_emulate(name):
    expected = (
        {"edge_vertices", "edge_edges", "edge_faces"}
        if name in (*HOLDS_ANYTHING, "triangle_neighbor")
        else set()
    )
    assert set(structures.build(name, TWO).emulated) == expected


@pytest.mark.parametrize(
    ("points", "triangles"),
    [
        (np.zeros((3, 3)), [[0, 1, 3]]),
        (np.zeros((3, 3)), [[0, 1, -1]]),
        (np.zeros((3, 3)), [[0, 1, 1]]),
        (np.full((3, 3), np.nan), [[0, 1, 2]]),
        (np.zeros((3, 2)), [[0, 1, 2]]),
        (np.zeros((3, 3)), [[0, 1]]),
    ],
)
def test_bad_input_is_refused_with_a_mesh_error(points, triangles):
    with pytest.raises(hem.MeshError):
        hem.TriangleMesh(points, triangles)


@pytest.mark.parametrize(
    "triangles",
    [
        [[0, 1, 2], [1, 0, 3], [0, 1, 4]],  # an edge in three faces
        [[0, 1, 2], [0, 1, 3]],  # two faces that run the same way along their edge
        [[0, 1, 2], [0, 3, 4]],  # two fans that meet in one vertex
    ],
)
def test_non_manifold_input_is_refused_by_what_cannot_represent_it(triangles):
    mesh = hem.TriangleMesh(np.random.default_rng(0).random((5, 3)), triangles)
    for name in HOLDS_ANYTHING:
        structures.build(name, mesh)
    for name in NEEDS_MANIFOLD:
        with pytest.raises(hem.NonManifoldError):
            structures.build(name, mesh)


# Operations


def test_splits_change_the_counts_as_documented(name):
    s = structures.build(name, hem.generate("torus", n_vertices=100))
    v, e, f = s.n_vertices, s.n_edges, s.n_faces
    edit = s.split_face(5, [9, 9, 9])
    assert edit.vertex == v
    assert np.allclose(s.points[edit.vertex], 9)
    assert (s.n_vertices, s.n_edges, s.n_faces) == (v + 1, e + 3, f + 2)
    s.split_edge(s.edges()[7], [8, 8, 8])
    assert (s.n_vertices, s.n_edges, s.n_faces) == (v + 2, e + 6, f + 4)
    s.validate()


def test_a_border_edge_splits_one_face(name):
    s = structures.build(name, TWO)
    s.split_edge(s.find_edge(0, 1), [0.5, 0, 0])
    assert faces_of(s) == [(0, 2, 3), (0, 4, 2), (1, 2, 4)]
    s.validate()


def test_collapsing_what_a_split_made_restores_the_faces(name):
    s = structures.build(name, hem.generate("sphere", n_vertices=162))
    before, edge = faces_of(s), s.edges()[20]
    a, _b = (int(v) for v in s.edge_vertices(edge))
    new = s.split_edge(edge, [0, 0, 0]).vertex
    s.collapse_edge(s.find_edge(new, a), keep=a)
    assert faces_of(s) == before
    s.validate()


def test_a_tetrahedron_refuses_to_collapse_and_stays_as_it_was(name):
    s = structures.build(name, TETRA)
    before = faces_of(s)
    for edge in s.edges():
        assert not s.can_collapse_edge(edge)
        with pytest.raises(hem.TopologyError):
            s.collapse_edge(edge)
    assert faces_of(s) == before


def test_the_same_operations_give_the_same_mesh_on_every_structure():
    def run(name):
        rng = np.random.default_rng(7)
        s = structures.build(name, hem.generate("grid", n_vertices=64))
        for _ in range(120):
            rows = faces_of(s)
            row = rows[rng.integers(len(rows))]
            a, b = row[0], row[1]
            edge, kind, point = s.find_edge(a, b), rng.integers(4), rng.random(3)
            if kind == 0:
                s.split_edge(edge, point)
            elif kind == 1:
                s.split_face(
                    next(
                        int(f)
                        for f in s.vertex_faces(a)
                        if set(row) == set(s.face_vertices(int(f)).tolist())
                    ),
                    point,
                )
            elif kind == 2 and s.can_collapse_edge(edge):
                s.collapse_edge(edge, keep=b)
            elif kind == 3 and s.can_flip_edge(edge):
                s.flip_edge(edge)
            s.validate()
        return faces_of(s)

    first, *rest = (run(name) for name in CORE)
    assert len(first) > 50
    assert all(other == first for other in rest)


def test_every_edit_reaches_the_subscribers(name):
    s, heard = structures.build(name, hem.generate("torus", n_vertices=100)), []
    s.subscribe(heard.append)
    edit = s.split_face(3, [0, 0, 0])
    assert heard == [edit] or (len(heard) == 1 and heard[0] is edit)


def test_an_operation_by_its_name_does_what_the_method_does(name):
    one, other = (structures.build(name, hem.generate("torus", n_vertices=100)) for _ in range(2))
    edge = int(one.edges()[7])
    assert (
        one.operate("split_edge", edge, point=(1, 2, 3)).vertex
        == other.split_edge(edge, (1, 2, 3)).vertex
    )
    assert faces_of(one) == faces_of(other)
    with pytest.raises(KeyError):
        one.operate("split_edges", edge)
