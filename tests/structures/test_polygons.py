"""Polygons on Plankton's half-edges: laws, counts, refusals, and the article's walk."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hem
import structures
from structures.plankton import Plankton
from tests.structures.conftest import octahedron, strip

CUBE = hem.PolygonMesh(
    [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)],
    [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)],
)


def sheet(n: int = 5) -> hem.PolygonMesh:
    """n × n quads in the plane."""
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2).reshape(-1, 4)
    y, x = np.divmod(at.ravel(), n + 1)
    return hem.PolygonMesh(np.stack([x, y, 0 * x], axis=1), quads.tolist())


def mixed() -> hem.PolygonMesh:
    """Every second quad of a sheet merged with the next one, and a triangle split off another."""
    s = plankton(sheet())
    for face in (0, 2, 10, 12):
        shared = next(h for h in s.face_half_edges(face) if s.adjacent_face(s.pair(h)) == face + 1)
        s.merge_faces(int(shared))
    a, _, c, _ = s.face_half_edges(20).tolist()
    s.split_face(a, c)
    return s.to_polygons()


MESHES = {"cube": lambda: CUBE, "sheet": sheet, "mixed": mixed}


def plankton(mesh: Any) -> Plankton:
    built = structures.build("plankton", mesh)
    assert isinstance(built, Plankton)
    built.validate()
    return built


def rows(s: Plankton) -> dict[int, tuple[int, ...]]:
    """The faces by handle, each from its smallest corner on."""
    found = {}
    for f in s.faces().tolist():
        row = s.face_vertices(f).tolist()
        k = row.index(min(row))
        found[f] = (*row[k:], *row[:k])
    return found


def counts(s: Plankton) -> tuple[int, int, int]:
    return s.n_vertices, s.n_edges, s.n_faces


def state(s: Plankton) -> list[bytes]:
    """Everything that is live, byte by byte."""
    half_edges = s.half_edges()
    leaving = [s.outgoing_half_edge(v) for v in s.vertices().tolist()]
    first = [s.first_half_edge(f) for f in s.faces().tolist()]
    table = s.records.half_edge[half_edges]
    points = s.points[s.vertices()]
    return [np.asarray(it).tobytes() for it in (half_edges, leaving, first, table, points)]


@pytest.fixture(params=MESHES)
def mesh(request: pytest.FixtureRequest) -> hem.PolygonMesh:
    return MESHES[request.param]()


def test_polygons_come_back_as_they_were(mesh):
    back = plankton(mesh).to_polygons()
    assert np.array_equal(back.points, mesh.points)
    assert [it.tolist() for it in back.faces] == [it.tolist() for it in mesh.faces]


def test_a_triangle_mesh_is_the_same_whether_built_as_triangles_or_as_polygons():
    triangles = hem.generate("grid", 49)
    polygons = hem.PolygonMesh(triangles.points, triangles.triangles.tolist())
    assert state(plankton(triangles)) == state(plankton(polygons))


def test_merging_undoes_a_split_along_any_diagonal(mesh):
    s = plankton(mesh)
    before, n, tried = state(s), counts(s), 0
    for face in s.faces().tolist():
        corners = s.face_half_edges(face).tolist()
        for i in range(len(corners)):
            for j in range(len(corners)):
                if (i - j) % len(corners) in (0, 1, len(corners) - 1):
                    with pytest.raises(hem.TopologyError, match="joined by a side"):
                        s.split_face(corners[i], corners[j])
                    continue
                h = s.split_face(corners[i], corners[j])
                s.validate()
                assert counts(s) == (n[0], n[1] + 1, n[2] + 1)
                assert s.merge_faces(h) == face
                s.validate()
                assert state(s) == before
                tried += 1
    assert tried >= 12


def test_collapsing_undoes_a_split_of_a_vertex(mesh):
    s, tried = plankton(mesh), 0
    before, n = rows(s), counts(s)
    for v in s.vertices().tolist():
        leaving = s.vertex_half_edges(v).tolist()
        for first in leaving:
            for second in leaving:
                if first == second:
                    continue
                w = s.split_vertex(first, second).vertex
                s.validate()
                assert counts(s) == (n[0] + 1, n[1] + 1, n[2])
                assert np.array_equal(s.points[w], s.points[v])
                s.collapse_edge(s.find_edge(v, w), keep=v)
                s.validate()
                assert rows(s) == before
                tried += 1
    assert tried > 40


def test_a_vertex_put_on_an_edge_gives_its_faces_a_corner(mesh):
    for edge in plankton(mesh).edges().tolist():
        s = plankton(mesh)
        n, faces = counts(s), s.edge_faces(edge).tolist()
        sides = {f: len(row) for f, row in rows(s).items()}
        a, b = s.edge_vertices(edge).tolist()
        edit = s.split_edge(edge, (7, 7, 7), triangles=False)
        s.validate()
        assert counts(s) == (n[0] + 1, n[1] + 1, n[2])
        now = {f: len(row) for f, row in rows(s).items()}
        assert now == {f: k + (f in faces) for f, k in sides.items()}
        assert sorted(edit.changed_faces) == sorted(faces)
        assert sorted(s.vertex_vertices(edit.vertex)) == sorted((a, b))
        s.collapse_edge(s.find_edge(a, edit.vertex), keep=a)
        assert rows(s) == rows(plankton(mesh))


def test_erasing_what_stellated_a_face_restores_it(mesh):
    s = plankton(mesh)
    before, n = rows(s), counts(s)
    for face, corners in before.items():
        edit = s.stellate(face)
        k = len(corners)
        assert counts(s) == (n[0] + 1, n[1] + k, n[2] + k - 1)
        middle = mesh.points[list(corners)].mean(axis=0)
        assert np.allclose(s.points[edit.vertex], middle, atol=1e-6)
        s.validate()
        kept = s.erase_center_vertex(edit.vertex)
        s.validate()
        assert rows(s)[kept] == corners
        assert sorted(rows(s).values()) == sorted(before.values())
    assert counts(s) == n


def test_a_truncated_corner_is_a_face_of_as_many_corners():
    s = plankton(CUBE)
    for v in range(8):
        heard: list[hem.Edit] = []
        stop = s.subscribe(heard.append)
        face = s.truncate_vertex(v)
        stop()
        s.validate()
        assert len(heard) == 1
        assert len(heard[0].created_vertices) == 3
        assert len(s.face_vertices(face)) == 3
    assert counts(s) == (24, 36, 14)
    assert sorted(len(row) for row in rows(s).values()) == [3] * 8 + [8] * 6
    once = plankton(CUBE)
    once.truncate_vertex(3, 0.5)
    assert once.volume() == pytest.approx(1 - 0.5**3 / 6, abs=1e-6)


@pytest.mark.parametrize("last", ["insert_vertex", "cut_across", "erase_vertex"])
def test_what_an_interrupt_leaves_of_a_truncated_corner_is_told(last, monkeypatch):
    s, heard = structures.build("plankton", CUBE, compiled=False), []
    s.subscribe(heard.append)
    height, run = s.vertex_attribute("height"), s._operations.run
    height[s.vertices()] = s.points[:, 2]

    def interrupted(operation, *given, **more):
        found = run(operation, *given, **more)
        if operation == last:
            raise KeyboardInterrupt
        return found

    monkeypatch.setattr(s._operations, "run", interrupted)
    with pytest.raises(KeyboardInterrupt):
        s.truncate_vertex(0)
    s.validate()
    (edit,) = heard
    assert edit.created_vertices.tolist() == [8, 9, 10]
    assert edit.created_faces.tolist() == s.faces()[s.faces() >= 6].tolist()
    assert np.allclose(height[s.vertices()], s.points[s.vertices(), 2])


def test_the_dual_of_the_dual_has_the_same_faces():
    cube = plankton(CUBE)
    dual = cube.dual()
    dual.validate()
    assert counts(dual) == (6, 12, 8)
    assert sorted(len(row) for row in rows(dual).values()) == [3] * 8
    again = dual.dual()
    assert counts(again) == counts(cube)
    links = {tuple(sorted(row)) for row in rows(again).values()}
    assert links == {tuple(sorted(row)) for row in rows(cube).values()}
    assert dual.volume() == pytest.approx(1 / 6, abs=1e-6)
    assert counts(plankton(sheet(4)).dual()) == (16, 24, 9)


@pytest.mark.parametrize("reference_bytes", [4, 8])
def test_a_dual_has_references_as_large_as_the_mesh_has(reference_bytes):
    cube, built = (structures.build("plankton", it, reference_bytes) for it in (CUBE, octahedron()))
    assert cube.dual().memory() == built.memory()


@pytest.mark.parametrize("corners", [3, 4, 7, 3000])
def test_faces_of_any_number_of_corners_are_added_and_removed(corners):
    s = plankton(hem.PolygonMesh(np.zeros((0, 3)), []))
    angle = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    for x, y in zip(np.cos(angle), np.sin(angle), strict=True):
        s.add_vertex((x, y, 0))
    edit = s.add_face(*range(corners))
    s.validate()
    assert counts(s) == (corners, corners, 1)
    assert s.face_vertices(int(edit.created_faces[0])).tolist() == list(range(corners))
    center = s.stellate(0).vertex  # beyond the thousand steps that Plankton gives up after
    s.validate()
    assert s.valence(center) == corners
    assert s.vertex_half_edges(center).size == corners
    for face in s.faces().tolist()[:5]:
        if len(s.vertex_faces(center)) in (corners, 1) or face == 0:
            s.remove_face(face)
            s.validate()


@pytest.mark.parametrize("corners", [12, 13, 14, 40, 3000])
@pytest.mark.parametrize("how", ["stellate", "split_face", "split_faces", "split_all_faces"])
def test_the_first_that_is_done_to_a_large_face_may_be_to_split_it(corners, how):
    angle = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    s = plankton(hem.PolygonMesh(points, [range(corners)]))
    given = {"split_face": (0, (0, 0, 0)), "split_faces": ([0], [(0, 0, 0)]), "stellate": (0,)}
    getattr(s, how)(*given.get(how, ()))
    s.validate()
    assert counts(s) == (corners + 1, 2 * corners, corners)


def test_removing_and_adding_a_polygon_restores_the_mesh(mesh):
    s = plankton(mesh)
    before = sorted(rows(s).values())
    for face, corners in rows(s).items():
        try:
            s.remove_face(face)
        except hem.TopologyError:
            continue  # it lies between two others at a corner on the border
        s.validate()
        s.add_face(*corners)
        s.validate()
        assert sorted(rows(s).values()) == before


def test_a_triangle_with_a_polygon_beyond_two_sides_has_it_as_a_neighbor_once():
    corners = [(0, 0, 0), (4, 0, 0), (2, 4, 0), (2, 1, 0), (2, -2, 0)]
    for row in [(0, 1, 3), (1, 3, 0), (3, 0, 1)]:
        s = plankton(hem.PolygonMesh(corners, [row, (2, 0, 3, 1), (1, 0, 4)]))
        assert [sorted(s.face_faces(f).tolist()) for f in range(3)] == [[1, 2], [0], [0]]


def test_random_operations_on_polygons_leave_a_sound_mesh():
    rng = np.random.default_rng(4)
    s, done = plankton(mixed()), set()
    for _ in range(600):
        euler = s.n_vertices - s.n_edges + s.n_faces
        faces, half_edges = s.faces(), s.half_edges()
        h, f = int(rng.choice(half_edges)), int(rng.choice(faces))
        loop = s.face_half_edges(f).tolist()
        v, point = s.start_vertex(h), rng.random(3)
        leaving = s.vertex_half_edges(v).tolist()
        calls: dict[str, tuple[Any, ...]] = {
            "split_edge": (s.split_edge, h, point, False),
            "split_face": (s.split_face, loop[0], loop[2]),
            "merge_faces": (s.merge_faces, h),
            "stellate": (s.stellate, f),
            "collapse_edge": (s.collapse_edge, h),
            "flip_edge": (s.flip_edge, h),
            "split_vertex": (s.split_vertex, leaving[0], leaving[-1]),
            "erase_center_vertex": (s.erase_center_vertex, v),
            "truncate_vertex": (s.truncate_vertex, v),
            "triangles": (s.split_edge, h, point),
        }
        name = str(rng.choice(list(calls)))
        before = state(s)
        call, *given = calls[name]
        try:
            call(*given)
            done.add(name)
            assert s.n_vertices - s.n_edges + s.n_faces == euler
        except hem.TopologyError:
            assert state(s) == before
        s.validate()
        if s.n_faces > 120:
            s = plankton(mixed())
        if rng.random() < 0.05:
            kept = sorted(len(row) for row in rows(s).values())
            s.compact()
            s.validate()
            assert sorted(len(row) for row in rows(s).values()) == kept
    assert done == set(calls)


CASES = {
    "split along a side": (lambda s, h: s.split_face(h[0], h[1]), "joined by a side"),
    "split across two faces": (lambda s, h: s.split_face(h[0], h[0] ^ 1), "same face"),
    "merge at the border": (lambda s, h: s.merge_faces(0), "border"),
    "split a vertex by one half-edge": (lambda s, h: s.split_vertex(h[0], h[0]), "different ones"),
    "split a vertex by strangers": (lambda s, h: s.split_vertex(h[0], h[1]), "different ones"),
    "erase on the border": (lambda s, h: s.erase_center_vertex(0), "border"),
    "truncate on the border": (lambda s, h: s.truncate_vertex(0), "border"),
    "flip between quads": (lambda s, h: s.flip_edge(h[0]), "more than three corners"),
    "split between quads": (lambda s, h: s.split_edge(h[0], (0, 0, 0)), "more than three"),
    "a half-edge that is none": (lambda s, h: s.merge_faces(10_000), "no such edge"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_refusal_says_why_and_changes_nothing(case):
    s = plankton(sheet())
    call, words = CASES[case]
    middle = s.face_half_edges(12).tolist()
    before = state(s)
    with pytest.raises(hem.TopologyError, match=words) as refusal:
        call(s, middle)
    assert refusal.value.elements
    assert state(s) == before


OF_POLYGONS = {
    "merge_faces": lambda s, h: s.merge_faces(h),
    "split_vertex": lambda s, h: s.split_vertex(h, 9),
    "split_vertex, second": lambda s, h: s.split_vertex(9, h),
    "split_vertex at a point": lambda s, h: s.split_vertex(h, 9, (0, 0, 0)),
    "split_face": lambda s, h: s.split_face(h, 9),
    "insert_vertex": lambda s, h: s.split_edge(h, (0, 0, 0), triangles=False),
    "erase_center_vertex": lambda s, v: s.erase_center_vertex(v),
    "truncate_vertex": lambda s, v: s.truncate_vertex(v),
    "stellate": lambda s, f: s.stellate(f),
    "add_face": lambda s, v: s.add_face(1, 2, 3, v),
}
ASKED_OF_POLYGONS = {
    "vertex_half_edges": lambda s, v: s.vertex_half_edges(v),
    "face_half_edges": lambda s, f: s.face_half_edges(f),
    "vertex_naked_edges": lambda s, v: s.vertex_naked_edges(v),
    "face_naked_edges": lambda s, f: s.face_naked_edges(f),
    "find_half_edge": lambda s, v: s.find_half_edge(v, 1),
}


@pytest.mark.parametrize("call", OF_POLYGONS)
def test_what_names_nothing_is_not_operated_on(call):
    s = plankton(sheet())
    vertex, half_edge, face = 0, s.find_edge(0, 1), 24
    s.collapse_edge(half_edge, keep=1)
    s.remove_face(face)
    dead = {"stellate": face, "add_face": vertex}
    dead |= dict.fromkeys(("erase_center_vertex", "truncate_vertex"), vertex)
    before = state(s)
    for handle in (dead.get(call, half_edge), -1, 10_000, 2**40):
        with pytest.raises(hem.TopologyError, match="no such"):
            OF_POLYGONS[call](s, handle)
    for wrong in (0.5, 1.0, "1", None, True, [1], np.array([1]), 2**70):
        with pytest.raises(hem.MeshError, match=r"handle|no such"):
            OF_POLYGONS[call](s, wrong)
    assert state(s) == before


@pytest.mark.parametrize("call", ASKED_OF_POLYGONS)
@pytest.mark.parametrize("wrong", [0.5, 1.0, "1", None, True, -1, 10_000, 2**70, [1, 2], [1]])
def test_what_names_nothing_has_no_half_edges(call, wrong):
    with pytest.raises(hem.MeshError):
        ASKED_OF_POLYGONS[call](plankton(sheet()), wrong)


def test_no_half_edge_joins_a_vertex_to_itself():
    assert plankton(CUBE).find_half_edge(3, 3) is None


def test_faces_that_meet_twice_are_not_merged():
    s = plankton(octahedron())
    s.erase_center_vertex(0)
    ring = s.face_half_edges(int(max(rows(s), key=lambda f: len(rows(s)[f])))).tolist()
    s.split_edge(ring[0], (0, 0, 0), triangles=False)
    with pytest.raises(hem.TopologyError, match="other corners"):
        s.merge_faces(ring[0])


TOUCHING = [(0, 1, 4, 3, 5, 2), (0, 2, 6, 3, 7, 1), (3, 4, 1, 7), (3, 6, 2, 5)]
"""Closed; the two faces around vertex 0 meet in vertex 3 as well."""


@pytest.mark.parametrize("compiled", [True, False])
def test_a_refusal_and_a_check_leave_the_bound_on_corners(compiled):
    mesh = hem.PolygonMesh(np.random.default_rng(0).random((8, 3)), TOUCHING)
    s = structures.build("plankton", mesh, compiled=compiled)
    before, most = state(s), s.most_corners
    for _ in range(2):
        with pytest.raises(hem.TopologyError, match="other corners"):
            s.erase_center_vertex(0)
        assert not s.prepare("erase_vertex", [0]).check().any()
        assert (state(s), s.most_corners) == (before, most)
    s.validate()
    s = structures.build("plankton", mixed_fan(), compiled=compiled)
    before, most = state(s), s.most_corners
    assert s.prepare("erase_vertex", [0]).check().all()
    assert (state(s), s.most_corners) == (before, most)
    s.erase_center_vertex(0)
    assert s.most_corners == max(len(row) for row in rows(s).values()) > most
    s.validate()


def mixed_fan(faces: int = 9, corners: int = 30) -> hem.PolygonMesh:
    """Faces of many corners around vertex 0, which makes one of many more."""
    n = faces * (corners - 2)
    points = [(0, 0, 0), *[(np.cos(i), np.sin(i), 0) for i in np.arange(n) * 2 * np.pi / n]]
    step = corners - 2
    rings = [[1 + (k * step + i) % n for i in range(corners - 1)] for k in range(faces)]
    return hem.PolygonMesh(points, [[0, *ring] for ring in rings])


@pytest.mark.parametrize(
    ("method", "do"),
    [
        ("stellate", lambda s: s.stellate(7)),
        ("split_face", lambda s: s.split_face(*s.face_half_edges(7)[[0, 2]].tolist())),
        ("split_edge", lambda s: s.split_edge(s.find_edge(0, 1), (0, 0, 0), triangles=False)),
        ("merge_faces", lambda s: s.merge_faces(s.find_half_edge(7, 8))),
        ("split_vertex", lambda s: s.split_vertex(*s.vertex_half_edges(7)[:2].tolist())),
        ("erase_center_vertex", lambda s: s.erase_center_vertex(7)),
        ("truncate_vertex", lambda s: s.truncate_vertex(7)),
    ],
)
def test_an_edit_is_called_as_the_method_that_did_it(method, do):
    s, heard = plankton(sheet()), []
    s.subscribe(heard.append)
    do(s)
    assert [edit.kind for edit in heard] == [method]
    s.validate()


def test_what_is_no_polygon_operation_is_an_error_that_says_so():
    s = plankton(sheet())
    with pytest.raises(hem.MeshError, match="three corners or more"):
        s.add_face(0, 1)
    for fraction in (1.5, None, "half", [0.5]):
        with pytest.raises(hem.MeshError, match="between 0 and 1"):
            s.truncate_vertex(14, fraction)
    for point in (None, "abc", [[0], [1, 2]], (0, 0)):
        with pytest.raises(hem.MeshError, match="split_edge takes"):
            s.split_edge(0, point, triangles=False)
    with pytest.raises(hem.MeshError, match="no such half-edge"):
        s.next_half_edge(10_000)
    with pytest.raises(hem.MeshError, match="encloses no volume"):
        s.volume()


def test_what_a_mesh_is_like_agrees_with_what_its_faces_say(mesh):
    s = plankton(mesh)
    sides = [pair for row in rows(s).values() for pair in zip(row, (*row[1:], row[0]), strict=True)]
    border = [(a, b) for a, b in sides if (b, a) not in sides]
    assert s.is_closed() == (not border)
    for v in s.vertices().tolist():
        assert s.valence(v) == len({frozenset(it) for it in sides if v in it})
        assert s.vertex_naked_edges(v) == sum(v in it for it in border)
        assert [s.start_vertex(int(h)) for h in s.vertex_half_edges(v)] == [v] * s.valence(v)
    for f, row in rows(s).items():
        naked = sum(it in border for it in zip(row, (*row[1:], row[0]), strict=True))
        assert s.face_naked_edges(f) == naked
        assert {s.adjacent_face(int(h)) for h in s.face_half_edges(f)} == {f}
    for h in s.half_edges().tolist():
        assert s.previous_half_edge(s.next_half_edge(h)) == h
        assert s.end_vertex(h) == s.start_vertex(s.pair(h))
        assert s.find_half_edge(s.start_vertex(h), s.end_vertex(h)) == h
        if s.adjacent_face(h) < 0:
            assert s.outgoing_half_edge(s.start_vertex(h)) == h


def test_normals_and_volume_are_those_of_a_cube():
    s = plankton(CUBE)
    outward = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)]
    assert np.allclose(s.face_normals(), outward)
    assert np.allclose(s.vertex_normals(), (CUBE.points - 0.5) / np.sqrt(0.75))
    assert s.volume() == pytest.approx(1)


def test_the_walk_of_the_article():
    """Figures 6 to 9: faces are added around vertex 2, and its half-edge follows the border."""
    s = plankton(hem.PolygonMesh([(0, 0, 0), (1, 0, 0), (0.5, 0.5, 0)], [(0, 1, 2)]))

    def leads_to() -> int:
        return s.end_vertex(s.outgoing_half_edge(2))

    assert (leads_to(), s.vertex_naked_edges(2)) == (1, 2)  # figure 6
    s.add_vertex((1, 1, 0))
    s.add_face(2, 1, 3)
    assert (leads_to(), s.vertex_naked_edges(2)) == (3, 2)  # figure 7
    s.add_vertex((0, 1, 0))
    s.add_face(2, 3, 4)
    assert (leads_to(), s.vertex_naked_edges(2)) == (4, 2)  # figure 8
    s.add_face(0, 2, 4)
    assert (leads_to(), s.vertex_naked_edges(2)) == (4, 0)  # figure 9: closed, and as it was
    s.validate()


def fan_by_fan(mesh: hem.TriangleMesh) -> hem.TriangleMesh:
    """The faces in an order in which none meets the ones before it in a vertex alone."""
    left, order = mesh.triangles.tolist(), []
    grown = plankton(hem.PolygonMesh(mesh.points, []))
    while left:
        for face in left:
            try:
                grown.add_face(*face)
            except hem.TopologyError:
                continue
            order.append(face)
            left.remove(face)
            break
        else:
            raise AssertionError("no face fits")
    return hem.TriangleMesh(mesh.points, order)


@pytest.mark.parametrize("start", [lambda: strip(40), lambda: fan_by_fan(hem.generate("cone", 60))])
def test_building_at_once_gives_what_adding_the_faces_one_by_one_gives(start):
    mesh = start()
    added = plankton(hem.PolygonMesh(mesh.points, []))
    for face in mesh.triangles.tolist():
        added.add_face(*face)
    assert state(added) == state(plankton(mesh))


@pytest.mark.parametrize(
    "faces",
    [
        [(0, 1, 2, 3), (1, 0, 4, 5), (0, 1, 6, 7)],
        [(0, 1, 2, 3), (0, 1, 4, 5)],
        [(0, 1, 2, 3), (0, 4, 5, 6)],
    ],
)
def test_non_manifold_polygons_are_refused(faces):
    with pytest.raises(hem.NonManifoldError):
        structures.build(
            "plankton", hem.PolygonMesh(np.random.default_rng(0).random((8, 3)), faces)
        )


def test_a_render_mesh_holds_no_polygons_and_says_so():
    with pytest.raises(hem.MeshError, match="triangles only"):
        hem.RenderMesh(plankton(CUBE))
    s = plankton(octahedron())
    render = hem.RenderMesh(s)
    with pytest.raises(hem.MeshError, match="triangles only"):
        s.erase_center_vertex(0)
    s.validate()
    render.close()


def test_a_batch_reads_no_more_corners_ahead_than_its_scratch_has_room_for():
    s = structures.build("plankton", hem.generate("grid", 1_000))
    face, edge = 500, int(s.face_edges(500)[0])
    known = len(s._state.out["edge"])
    for _ in range(known + 50):  # no query is asked, so nothing makes the scratch wider
        s.split_edge(edge, s.points[0], triangles=False)
    scratch = np.full(4 * known + 400, 7, s._state.out["edge"].dtype)
    s._state.out["edge"] = scratch[: len(s._state.out["edge"])]
    behind = scratch[len(s._state.out["edge"]) :]
    s.split_faces([face, face + 1], s.points[:2])
    assert (behind == 7).all()
    s.validate()


def test_there_is_room_for_all_splits_of_polygons_that_are_prepared(mesh):
    s = plankton(mesh)
    faces, sides = s.faces(), sum(map(len, mesh.faces))
    s.prepare("split_face", faces, np.zeros((len(faces), 3))).run()
    assert (s.n_faces, s.n_vertices) == (sides, len(mesh.points) + len(faces))
    s.validate()
