"""Random operations on random meshes: sound after each, and the same on every structure."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hem
import structures
from hem.authoring import VALENCE
from hem.contract.operations import Operations
from tests.extent import some, waiting_for
from tests.structures.conftest import OF_ARRAYS, octahedron, shuffled, strip
from tests.structures.histories.actions import (
    BATCHES,
    KINDS,
    NUMBERS,
    POLYGON_KINDS,
    Action,
    aim,
    faces_of,
    perform,
    surface_of,
)
from tests.structures.histories.world import HANDLING, World, check_mesh
from tests.structures.test_polygons import CUBE, mixed, sheet

TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def several() -> hem.TriangleMesh:
    """A tetrahedron, a strip, one triangle and a vertex without faces."""
    band = strip(4)
    triangles = [*TETRAHEDRON, *(band.triangles + 4).tolist(), (10, 11, 12)]
    return hem.TriangleMesh(np.random.default_rng(0).random((14, 3)), triangles)


STARTS = {
    "one triangle": lambda: hem.TriangleMesh(np.eye(3), [(0, 1, 2)]),
    "pillow": lambda: hem.TriangleMesh(np.eye(3), [(0, 1, 2), (0, 2, 1)]),
    "tetrahedron": lambda: hem.TriangleMesh(np.eye(4)[:, :3], TETRAHEDRON),
    "octahedron": octahedron,
    "strip": lambda: strip(6),
    "several components": several,
    "torus": lambda: shuffled(hem.generate("torus", 30)),
    "grid": lambda: shuffled(hem.generate("grid", 25)),
    "high valence": lambda: shuffled(hem.generate("cone", 40)),
}


POLYGONS = {
    "cube": lambda: CUBE,
    "sheet": lambda: sheet(3),
    "mixed": mixed,
    "dual": lambda: structures.build("plankton", STARTS["torus"]()).dual().to_polygons(),
}


def histories(*kinds: str) -> st.SearchStrategy[list[Action]]:
    """Some actions of these kinds."""
    numbers = (st.integers(0, NUMBERS - 1) for _ in range(3))
    return st.lists(st.builds(Action, st.sampled_from(kinds), *numbers), min_size=1, max_size=25)


ACTIONS = histories(*KINDS, *BATCHES)


@pytest.mark.parametrize("start", STARTS)
@settings(max_examples=some(12), deadline=None, derandomize=True)
@given(actions=histories(*KINDS, *BATCHES, *HANDLING))
def test_anything_does_what_the_faces_alone_say_on_every_structure(start, actions):
    world = World(STARTS[start]())
    for action in actions:
        world.step(action)
        world.check(thorough=False)
    world.check()


@pytest.mark.parametrize("start", POLYGONS)
@settings(max_examples=some(15), deadline=None, derandomize=True)
@given(actions=histories(*2 * POLYGON_KINDS, *KINDS, *BATCHES, *HANDLING))
def test_anything_does_what_the_faces_alone_say_on_polygons(start, actions):
    world = World(POLYGONS[start]())
    for action in actions:
        world.step(action)
        world.check(thorough=False)
    world.check()


@pytest.mark.parametrize("start", STARTS)
@settings(max_examples=some(8), deadline=None, derandomize=True)
@given(actions=ACTIONS)
def test_compacting_keeps_the_mesh_and_its_remapping_is_right(start, actions):
    for name in structures.NAMES:
        s = structures.build(name, STARTS[start]())
        for action in actions:
            aimed = aim(surface_of(s), action)
            if aimed is not None:
                perform(s, aimed)
        edges = s.edges()
        ends = s.edge_vertices(edges).values.reshape(-1, 2)
        faces, points = faces_of(s), s.points.copy()
        vertices, remapped, renamed = s.compact()
        s.validate()
        moved = {
            int(remapped[f]): sorted(vertices[list(corners)].tolist())
            for f, corners in faces.items()
        }
        assert moved == {f: sorted(corners) for f, corners in faces_of(s).items()}
        assert sorted(vertices[vertices >= 0].tolist()) == list(range(s.n_vertices))
        alive = vertices >= 0
        assert np.array_equal(points[alive], s.points[vertices[alive]])
        assert np.isnan(points[~alive]).all()
        found = s.edge_vertices(renamed(edges)).values.reshape(-1, 2)
        assert np.array_equal(np.sort(found), np.sort(vertices[ends]))
        told = sum(s.memory(names=True).values())
        assert not s.fields or told == sum(it.nbytes for it in s.arrays)


def test_operations_keep_their_promise_on_the_counts(name):
    """Interior and border, as the docstrings say: vertices, edges, faces."""
    s = structures.build(name, hem.generate("grid", 100))
    rows = s.edge_faces(s.edges())
    border, inner = (int(s.edges()[rows.counts == k][20]) for k in (1, 2))
    face = int(s.edge_faces(inner)[0])
    far = next(int(e) for e in s.edges()[::-1] if s.can_flip_edge(int(e)))

    def collapsible(faces: int) -> int:
        edges = (int(e) for e in s.edges() if len(s.edge_faces(int(e))) == faces)
        return next(e for e in edges if s.can_collapse_edge(e))

    for change, call in [
        ((1, 3, 2), lambda: s.split_edge(inner, (0, 0, 0))),
        ((1, 2, 1), lambda: s.split_edge(border, (0, 0, 0))),
        ((1, 3, 2), lambda: s.split_face(face, (0, 0, 0))),
        ((0, 0, 0), lambda: s.flip_edge(far)),
        ((-1, -3, -2), lambda: s.collapse_edge(collapsible(2))),
        ((-1, -2, -1), lambda: s.collapse_edge(collapsible(1))),
    ]:
        before = np.array([s.n_vertices, s.n_edges, s.n_faces])
        call()
        assert tuple(np.array([s.n_vertices, s.n_edges, s.n_faces]) - before) == change


def test_handles_of_untouched_elements_stay_valid(name):
    s, rng = structures.build(name, shuffled(hem.generate("torus", 100))), np.random.default_rng(3)
    ends = {int(e): frozenset(s.edge_vertices(int(e)).tolist()) for e in s.edges()}
    corners = faces_of(s)
    for _ in range(60):
        face = int(rng.choice(s.faces()))
        a, b, _ = s.face_vertices(face).tolist()
        aimed = [("split_edge", (a, b)), ("split_face", (face,)), ("collapse_edge", (a, b))]
        kind, elements = aimed[rng.integers(3)]
        around = set(s.face_vertices(s.vertex_faces([a, b]).values).values.tolist())
        edge = s.find_edge(a, b)
        if kind == "split_face":
            s.split_face(face, (0, 0, 0))
        elif kind == "split_edge":
            s.split_edge(edge, (0, 0, 0))
        elif s.can_collapse_edge(edge):
            s.collapse_edge(edge)
        ends = {e: pair for e, pair in ends.items() if not pair <= around}
        corners = {f: t for f, t in corners.items() if not set(t) & {a, b, *elements}}
        for e, pair in ends.items():
            assert frozenset(s.edge_vertices(e).tolist()) == pair
        now = faces_of(s)
        assert all(now[f] == t for f, t in corners.items())


def ends_at(s: structures.Structure, v: int) -> set[tuple[int, ...]]:
    """The ends of the edges at a vertex."""
    return {tuple(row.tolist()) for row in s.edge_vertices(s.vertex_edges(v))}


def test_what_a_collapse_keeps_stays_where_it_is_and_so_do_the_edges_it_had(name):
    s = structures.build(name, hem.generate("sphere", 162))
    a, b = s.edge_vertices(int(s.edges()[40])).tolist()
    place, spokes, ends = s.points[a].copy(), set(s.vertex_edges(a).tolist()), ends_at(s, a)
    edit = s.collapse_edge(s.find_edge(a, b), keep=a)
    assert edit.vertex == a
    assert np.array_equal(s.points[a], place)
    assert np.isnan(s.points[b]).all()
    assert len(ends & ends_at(s, a)) == len(ends) - 1
    if s.stable_edge_handles:
        assert len(spokes & set(s.vertex_edges(a).tolist())) == len(spokes) - 1


@pytest.mark.parametrize("reference_bytes", waiting_for([4], [4, 8]))
def test_batches_do_what_one_by_one_does(name, reference_bytes):
    one, many = (structures.build(name, hem.generate("grid", 400), reference_bytes) for _ in "12")
    rng = np.random.default_rng(2)
    faces, points = rng.choice(one.faces(), 50, replace=False), rng.random((50, 3))
    new = many.split_faces(faces, points)
    single = zip(faces.tolist(), points, strict=True)
    assert new.tolist() == [one.split_face(f, p).vertex for f, p in single]
    pairs = [one.edge_vertices(int(e)).tolist() for e in rng.choice(one.edges(), 50, replace=False)]
    edges = [many.find_edge(*pair) for pair in pairs]
    new = many.split_edges(edges, points)
    single = zip(pairs, points, strict=True)
    assert new.tolist() == [one.split_edge(one.find_edge(*pair), p).vertex for pair, p in single]
    pairs = [one.edge_vertices(int(e)).tolist() for e in rng.permutation(one.edges())]
    done = many.collapse_edges([many.find_edge(*pair) for pair in pairs])
    # Record by record the same handles, as both have the same history.
    expected = []
    for edge in [one.find_edge(*pair) for pair in pairs]:
        try:
            one.collapse_edge(edge)
            expected.append(True)
        except hem.TopologyError:
            expected.append(False)
    assert 50 < sum(expected) < len(expected)
    if name in ("winged_edge", "half_edge"):
        assert done.tolist() == expected
        assert faces_of(one) == faces_of(many)
    many.validate()
    one.validate()


def test_batches_of_collapses_give_the_same_mesh_on_every_structure():
    """Of edges that share no vertex: what becomes of the edges at a merged one is told below."""
    mesh, rng = shuffled(hem.generate("grid", 400)), np.random.default_rng(4)
    many, pairs, met = [structures.build(name, mesh) for name in structures.NAMES], [], set()
    for pair in rng.permutation(mesh.triangles[:, :2]).tolist():
        if not met & {*pair}:
            pairs.append(pair)
            met |= {*pair}
    done = [s.collapse_edges([s.find_edge(*pair) for pair in pairs]) for s in many]
    assert all(np.array_equal(it, done[0]) for it in done)
    assert done[0].sum() > 100
    for s in many:
        s.validate()
        check_mesh(surface_of(many[0]), s)
    hem.require_sound(many[0].to_triangles(), 1)


def test_an_edge_at_a_merged_vertex_lives_on_only_where_no_ends_name_it(name):
    s = structures.build(name, octahedron())
    edge, spoke = s.find_edge(0, 1), s.find_edge(1, 3)
    s.collapse_edge(edge, keep=0)
    if s.emulated or not s.stable_edge_handles:
        with pytest.raises(hem.MeshError):
            s.edge_faces(spoke)
    else:
        assert s.edge_vertices(spoke).tolist() == [0, 3]
    assert s.find_edge(0, 3) is not None


def test_subdividing_every_face_triples_the_faces_at_their_centroids(name):
    mesh = hem.generate("torus", 100)
    s = structures.build(name, mesh)
    new = s.split_all_faces()
    assert (s.n_vertices, s.n_edges, s.n_faces) == (300, 900, 600)
    assert new.tolist() == list(range(100, 300))
    assert np.allclose(s.points[new], mesh.points[mesh.triangles].mean(axis=1), atol=1e-6)
    assert [len(ring) for ring in s.vertex_faces(new)] == [3] * 200
    s.validate()


def test_the_centroid_of_a_face_depends_on_no_first_corner():
    """1e20, -1e20 and 1 add up to 1 or to 0, by the order in which they are added."""
    points, places = [(1e20, 0, 0), (-1e20, 1, 0), (1, 0, 1)], set()
    for name, first in product(structures.NAMES, range(3)):
        s = structures.build(name, hem.TriangleMesh(points, [np.roll(range(3), first)]))
        (new,) = s.split_all_faces()
        places.add(tuple(s.points[new].tolist()))
    assert len(places) == 1


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_storage_grows_by_doubling(name):
    s, rooms = structures.build(name, hem.generate("torus", 100)), []
    for _ in range(2000):
        s.split_face(0, (0, 0, 0))
        rooms.append(len(s.arrays[0]))
    grown = sorted(set(rooms))
    assert len(grown) <= 6
    assert all(b >= 2 * a for a, b in pairwise(grown))
    s.validate()


def test_a_vertex_whose_valence_grows_without_end_is_answered(name):
    s = structures.build(name, hem.generate("torus", 100))
    v = int(s.face_vertices(5)[0])
    for i in range(3000):
        s.split_face(int(s.vertex_faces(v)[i % 6]) if i < 20 else 5, (0, 0, 0))
    for v in s.face_vertices(5).tolist():
        assert set(s.vertex_vertices(v).tolist()) == {
            int(u) for e in s.vertex_edges(v) for u in s.edge_vertices(int(e))
        } - {v}
    s.validate()


def test_a_copy_is_apart_from_its_original(name):
    s = structures.build(name, hem.generate("torus", 100))
    before, heard = faces_of(s), []
    s.subscribe(heard.append)
    twin = s.copy()
    twin.split_face(3, (0, 0, 0))
    twin.collapse_edges(twin.edges()[:40])
    assert faces_of(s) == before
    assert not heard
    s.validate()
    twin.validate()


@pytest.mark.parametrize("operation", ["split_edge", "split_face", "collapse_edge", "flip_edge"])
def test_counted_and_compiled_operations_do_the_same(name, operation):
    counted, compiled = (structures.build(name, hem.generate("sphere", 162)) for _ in "12")
    handle = 7 if operation == "split_face" else int(counted.edges()[30])
    work = counted.operation_work(operation, handle)
    point = ((0, 0, 0),) if operation.startswith("split") else ()
    getattr(compiled, operation)(handle, *point)
    assert faces_of(counted) == faces_of(compiled)
    counted.validate()
    assert work > 10


def test_splits_of_recorded_edges_take_the_same_work_on_any_mesh():
    for name in (it for it, kind in structures.REGISTRY.items() if not kind.emulated):
        for operation in ("split_edge", "split_face"):
            work = set()
            for n in (100, 900):
                s = structures.build(name, hem.generate("torus", n))
                handle = 7 if operation == "split_face" else int(s.edges()[n])
                work.add(s.operation_work(operation, handle))
            assert len(work) == 1


def test_an_operation_is_bound_when_it_is_first_asked_for(name, monkeypatch):
    bound, method = [], Operations.method
    monkeypatch.setattr(Operations, "method", lambda its, of: bound.append(of) or method(its, of))
    s = structures.build(name, octahedron())
    s.split_face(0, (0, 0, 1))
    s.split_face(1, (1, 0, 0))
    assert bound == ["split_face"]
    s.flip_edge(int(s.edges()[0]))
    assert bound == ["split_face", "flip_edge"]


def every(s: structures.Structure, operation: str) -> list[tuple[int, ...]]:
    """All handles that an operation may be asked for, with all that may stand beside them."""
    element, nothing = s.operations[operation].element, [[]]
    first = s.half_edges() if element == "half-edge" else s.handles(element)
    if operation == "add_vertex":
        first = [-1]
    beside = {"collapse_edge": [*nothing, *([v] for v in s.vertices().tolist())]}
    beside["cut_across"] = beside["split_vertex"] = [[h] for h in first]
    beside["add_face"] = [[*pair] for pair in product(first, repeat=2)]
    return [(int(h), *map(int, row)) for h in first for row in beside.get(operation, nothing)]


def notch() -> hem.PolygonMesh:
    """A triangle in a pentagon, of which two corners are joined by an edge that is no side."""
    return hem.PolygonMesh(np.random.default_rng(0).random((5, 3)), [(1, 4, 0), (1, 2, 3, 0, 4)])


def quads() -> hem.PolygonMesh:
    """Four around a vertex on the border, which has as many edges as there is scratch for."""
    return hem.PolygonMesh(
        np.random.default_rng(0).random((10, 3)),
        [(0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i) for i in range(4)],
    )


@pytest.mark.parametrize("start", [lambda: strip(4), octahedron, quads, notch])
def test_what_is_only_checked_changes_nothing_and_is_what_would_be_done(name, start):
    mesh = start()
    if isinstance(mesh, hem.PolygonMesh) and not structures.REGISTRY[name].holds_polygons:
        return
    s = structures.build(name, mesh, compiled=False)
    s.add_vertex((0, 0, 1))

    def is_done(operation: str, row: tuple[int, ...], point: object = (0, 0, 2)) -> bool:
        own = s.copy()
        try:
            own.operate(operation, *row, point=point)
        except hem.TopologyError:
            assert own.same_as(s)
            return False
        own.validate()
        bound = own.records.counts[VALENCE]
        assert max(own.valence().max(), own.most_corners) <= bound, operation
        return True

    before = s.copy()
    for operation, its in s.operations.items():
        rows = every(s, operation)
        args = [[*row, -1, -1][:3] for row in rows]
        points = np.full((len(rows), 3), (0, 0, 2)) if its.takes_a_point else None
        told = s.prepare(operation, args, points).check().tolist()
        s.validate()
        assert s.same_as(before), operation
        assert told == [is_done(operation, row) for row in rows], operation
        if its.takes_a_point and any(told):
            with pytest.raises(hem.MeshError, match="finite"):
                s.operate(operation, *rows[told.index(True)], point=(0, np.nan, 0))
            assert s.same_as(before), operation
