"""Values of elements follow every edit: what they must be is told by positions and charts."""

from __future__ import annotations

import contextlib
import copy
import gc
import pickle
import weakref
from collections.abc import Callable

import numpy as np
import pytest

import hem
import structures
from hem.contract import Attribute, Navigable, Structure
from tests.extent import apart
from tests.structures.conftest import octahedron, shuffled
from tests.structures.test_polygons import mixed

COPIES: dict[str, Callable[[Structure], Structure]] = {
    "copy": lambda s: s.copy(),
    "copy.copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda s: pickle.loads(pickle.dumps(s)),
}
WITH_EDGES = [it for it in structures.NAMES if not structures.REGISTRY[it].emulated]
NAVIGABLE = [it for it in structures.NAMES if issubclass(structures.REGISTRY[it], Navigable)]


SURFACES = {
    "closed": lambda: shuffled(hem.generate("torus", 48)),
    "open": lambda: shuffled(hem.generate("grid", 49)),
}


@pytest.fixture(params=SURFACES)
def s(request: pytest.FixtureRequest, name: str) -> Structure:
    return structures.build(name, SURFACES[request.param]())


def plain(points: np.ndarray) -> np.ndarray:
    """Something that is linear in the position."""
    return points.astype(float) @ [[1, 2], [-3, 0.5], [0.25, 1]] + [5, -7]


def begin(s: Structure) -> None:
    """Give every vertex, and every corner, what is linear in its position."""
    s.vertex_attribute("plain", np.float64, 2)[s.vertices()] = plain(s.points[s.vertices()])
    corners = s.face_vertices().values
    s.corner_attribute("plain", np.float64, 2)[s.faces()] = plain(s.points[corners])


def assert_plain(s: Structure) -> None:
    at = s.vertices()
    assert np.allclose(s.vertex_attribute("plain")[at], plain(s.points[at]), atol=1e-4)
    corners = s.face_vertices().values
    assert np.allclose(s.corner_attribute("plain")[s.faces()], plain(s.points[corners]), atol=1e-4)


def between(s: Structure, vertices: np.ndarray, seed: int) -> np.ndarray:
    """A point somewhere between vertices."""
    share = np.random.default_rng(seed).dirichlet(np.ones(len(vertices)))
    return share @ s.points[vertices]


def edit_much(s: Structure) -> None:
    """Splits, singly and in batches, flips and collapses; points lie on what is split."""
    for turn in range(4):
        edge, face = int(s.edges()[3 * turn + 1]), int(s.faces()[turn + 2])
        s.split_edge(edge, between(s, s.edge_vertices(edge), turn))
        s.split_face(face, between(s, s.face_vertices(face), turn))
    edges = s.edges()[::5]
    s.split_edges(edges, [between(s, row, 1) for row in s.edge_vertices(edges)])
    faces = s.faces()[::4]
    s.split_faces(faces, [between(s, row, 2) for row in s.face_vertices(faces)])
    s.split_all_faces()
    for edge in s.edges()[:: apart(6)].tolist():
        with contextlib.suppress(hem.TopologyError):
            s.flip_edge(edge)
    s.collapse_edges(s.edges()[:: apart(7)])
    with contextlib.suppress(hem.TopologyError):
        s.remove_vertex(int(s.vertices()[-1]))


def test_what_is_linear_in_the_position_stays_so(s):
    begin(s)
    edit_much(s)
    assert_plain(s)
    s.compact()
    assert_plain(s)
    edit_much(s)
    assert_plain(s)


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_has_attributes_of_its_own(name: str, how: str):
    s = structures.build(name, SURFACES["open"]())
    begin(s)
    s.collapse_edges(s.edges()[::9])
    made = COPIES[how](s)
    edit_much(made)
    assert_plain(made)
    assert_plain(s)
    made.vertex_attribute("plain")[made.vertices()] = 0
    assert_plain(s)
    assert [repr(it).split(",")[0] for it in made.attributes()] == [
        repr(it).split(",")[0] for it in s.attributes()
    ]


def of_each_kind(s: Structure) -> list[Attribute]:
    """An attribute for each kind of elements that may have one."""
    kinds = ["vertex", "face", "corner"]
    kinds += ["edge"] if s.name in WITH_EDGES else []
    kinds += ["half_edge"] if s.name in NAVIGABLE else []
    return [getattr(s, f"{it}_attribute")("kind", default=1) for it in kinds]


def handles_of(s: Structure, attribute: Attribute) -> np.ndarray:
    """The handles of all that has a value."""
    if isinstance(s, Navigable) and attribute.element == "half_edge":
        return s.half_edges()
    return s.handles("face" if attribute.element == "corner" else attribute.element)


@pytest.mark.parametrize("how", ["deepcopy", "pickle"])
@pytest.mark.parametrize("compiled", [True, False])
def test_what_is_copied_with_its_mesh_is_the_attribute_of_the_copy(
    name: str, how: str, compiled: bool
):
    s = structures.build(name, SURFACES["closed"](), compiled=compiled)
    s.vertex_faces(3)  # what was asked once is kept in the mesh
    many = of_each_kind(s)
    for it in many:
        it.subscribe(pytest.fail)
    for whole in ([s, *many], [*many, s], [many[0], s, *many]):
        found = COPIES[how](whole)
        (other,) = (it for it in found if isinstance(it, Structure))
        copied = [it for it in found if isinstance(it, Attribute)]
        assert all(it.mesh is other for it in copied)
        assert {id(it) for it in copied} == {id(it) for it in other.attributes()}
        for it in copied:
            it[handles_of(other, it)] = 5
        other.split_face(int(other.faces()[0]), (0, 0, 0))
        for it in copied[-len(many) :]:
            values = it[handles_of(other, it)]
            assert 5 in values
            assert (values == 5).all() == (it.element in ("vertex", "face", "corner"))
        assert all((it[handles_of(s, it)] == 1).all() for it in many)


@pytest.mark.parametrize("how", ["deepcopy", "pickle"])
def test_an_attribute_that_is_copied_alone_has_its_values(name: str, how: str):
    s = structures.build(name, SURFACES["open"]())
    for it in of_each_kind(s):
        it[handles_of(s, it)] = 4
        alone = COPIES[how](it)
        assert alone is not it
        assert repr(alone) == repr(it)
        assert np.array_equal(alone.values, it.values)
        assert copy.copy(it) is it


@pytest.mark.parametrize("how", ["copy.copy", "deepcopy", "pickle"])
def test_what_was_removed_from_its_mesh_is_not_copied(name: str, how: str):
    s = structures.build(name, octahedron())
    for it in of_each_kind(s):
        s.remove_attribute(it)
        with pytest.raises(hem.MeshError, match="was removed"):
            COPIES[how](it)
        again = getattr(s, f"{it.element}_attribute")("kind", default=2)
        with pytest.raises(hem.MeshError, match="was removed"):
            COPIES[how](it)
        assert len(COPIES[how](again).values) == len(again.values)
    left = s.vertex_attribute("kind")
    del s
    with pytest.raises(hem.MeshError, match="outlived its mesh"):
        COPIES[how](left)


def test_a_mesh_with_attributes_that_is_dropped_is_freed_at_once(name: str):
    s = structures.build(name, SURFACES["closed"]())
    many = of_each_kind(s)
    for it in many:
        it[handles_of(s, it)] = 2
    edit_much(s)
    s.compact()
    gone = [weakref.ref(it) for it in (s, *s.arrays, *many)]
    gc.disable()  # reference cycles would wait for it, and large meshes with them
    try:
        del s, many, it
        assert all(it() is None for it in gone)
    finally:
        gc.enable()


def test_an_attribute_that_is_held_works_without_its_mesh(name: str):
    for place in range(len(of_each_kind(structures.build(name, octahedron())))):
        s = structures.build(name, SURFACES["open"]())
        edit_much(s)
        attribute = of_each_kind(s)[place]
        handles, end = handles_of(s, attribute), len(attribute.values)
        assert attribute.mesh is s
        gone, heard = weakref.ref(s), []
        del s
        assert gone() is None
        attribute.subscribe(heard.append)
        attribute[handles] = 3
        attribute[int(handles[0])] = 5
        assert {3, 5} == set(np.ravel(attribute[handles]).tolist())
        assert (attribute[int(handles[0])] == 5).all()
        assert len(heard) == 2
        assert len(attribute.values) == len(np.asarray(attribute)) == end
        with pytest.raises(hem.MeshError, match="no such"):
            attribute[10**6]
        with pytest.raises(hem.MeshError, match="outlived its mesh"):
            _ = attribute.mesh


def test_it_is_so_on_polygons_too():
    s = structures.build("plankton", mixed())
    begin(s)
    edge, face = int(s.edges()[4]), int(s.faces()[0])
    s.split_edge(edge, between(s, s.edge_vertices(edge), 0), triangles=False)
    s.stellate(face)
    assert_plain(s)
    h = int(s.face_half_edges(7)[0])
    kept = s.split_face(h, int(s.next(s.next(h))))
    assert_plain(s)
    s.merge_faces(kept)
    assert_plain(s)
    s.truncate_vertex(int(next(v for v in s.vertices().tolist() if not s.is_border(v))))
    assert_plain(s)
    s.split_all_faces()
    assert_plain(s)
    s.compact()
    assert_plain(s)


def test_corners_take_room_for_the_largest_face_that_is_left_by_compact():
    s = structures.build("plankton", hem.generate("torus", 100))
    begin(s)
    uv = s.corner_attribute("plain")
    narrow = uv.values.nbytes
    s.compact()
    s.remove_vertex(7)
    (hole,) = s.border_loops()
    face = int(s.add_face(*hole[::-1].tolist()).created_faces[0])
    uv[face] = plain(s.points[s.face_vertices(face)])
    assert_plain(s)
    assert uv.values.shape[1] == len(hole) == 6
    s.stellate(face)
    s.flip_edge(next(int(it) for it in s.edges() if s.can_flip_edge(int(it))))
    assert uv.values.shape[1] == 6
    s.compact()
    assert uv.values.shape == (s.n_faces, 3, 2)
    assert uv.values.nbytes == narrow
    assert_plain(s)
    edit_much(s)
    assert_plain(s)


def test_a_seam_is_never_torn_or_mended(s):
    """Every face lies in a chart; so do all its corners, whatever is done beside it."""
    faces = s.faces()
    middle = s.points[s.triangles()].mean(axis=1)
    charts = (middle[:, 0] > 0).astype(np.int32) + (middle[:, 1] > 0.3)
    chart, uv = s.face_attribute("chart", np.int32), s.corner_attribute("chart", np.float64)
    chart[faces] = charts
    uv[faces] = np.repeat(charts, 3)
    assert len(set(charts.tolist())) > 1
    edges = s.edges()[::3]
    s.split_edges(edges, [between(s, row, 1) for row in s.edge_vertices(edges)])
    s.split_faces(s.faces()[::3], np.zeros((len(s.faces()[::3]), 3)))
    for edge in s.edges()[::4].tolist():
        with contextlib.suppress(hem.TopologyError, hem.MeshError):
            if len({int(chart[f]) for f in s.edge_faces(edge)}) == 1:
                s.flip_edge(edge)
    assert s.collapse_edges(s.edges()[::5]).sum() > 10
    own = chart[s.faces()].astype(float)
    assert np.allclose(uv[s.faces()].reshape(-1, 3), own[:, None])
    assert {0.0, 1.0} <= set(own.tolist())


def test_what_a_follower_refuses_is_no_collapse_that_was_refused(s):
    s.corner_attribute("seam", np.float64)  # so that edges collapse one by one

    def refuse(edit):
        s.collapse_edge(-1)

    s.subscribe(refuse)
    before = s.n_vertices
    with pytest.raises(hem.TopologyError):
        s.collapse_edges([int(it) for it in s.edges() if s.can_collapse_edge(int(it))][:3])
    assert s.n_vertices == before - 1


@pytest.mark.parametrize("rule", ["copy", "default"])
def test_what_is_not_interpolated_is_copied_or_the_default(s, rule: str):
    kind = s.vertex_attribute("kind", np.int32, default=-1, on_split=rule)
    kind[s.vertices()] = s.vertices()
    edge = int(s.edges()[7])
    ends, corners = s.edge_vertices(edge).tolist(), s.face_vertices(int(s.faces()[0])).tolist()
    of_face = s.split_face(int(s.faces()[0]), (0, 0, 0)).vertex
    of_edge = s.split_edge(s.find_edge(*ends), (0, 0, 0)).vertex
    alone = s.add_vertex((1, 1, 1)).vertex
    assert kind[of_edge] == (-1 if rule == "default" else ends[0])
    assert kind[of_face] in ([-1] if rule == "default" else corners)
    assert kind[alone] == -1


def test_the_parts_of_a_face_have_what_it_had(s):
    number = s.face_attribute("number", np.int64)
    number[s.faces()] = 100 + s.faces()
    place = {f: sorted(s.face_vertices(f).tolist()) for f in s.faces().tolist()}
    made = s.split_faces(s.faces()[::2], np.zeros((len(s.faces()[::2]), 3)))
    for v in made.tolist():
        around = s.vertex_faces(v)
        (whole,) = {int(it) - 100 for it in number[around]}
        corners = {*s.face_vertices(around).values.tolist()} - {v}
        assert corners == set(place[whole])
    edge = int(s.edges()[0])
    before = sorted(number[s.edge_faces(edge)].tolist())
    v = s.split_edge(edge, (0, 0, 0)).vertex
    assert sorted(number[s.vertex_faces(v)].tolist()) == sorted(2 * before)


def remove_one(s: Structure) -> int:
    """Take away the first face that may be."""
    for face in s.faces().tolist():
        with contextlib.suppress(hem.TopologyError):
            s.remove_face(face)
            return face
    raise AssertionError("no face can be taken away")


def where(s: Structure, edge: int) -> frozenset:
    """The positions of the ends of an edge."""
    return frozenset(map(tuple, s.points[s.edge_vertices(edge)].tolist()))


@pytest.mark.parametrize("toward", [0, 1, "the last one"])
@pytest.mark.parametrize("name", WITH_EDGES)
def test_all_parts_of_an_edge_that_one_edit_splits_again_and_again_have_what_it_had(name, toward):
    s = structures.build(name, octahedron())
    if not s.stable_edge_handles:
        return  # every split is an edit of its own
    ends, values = s.edge_array().tolist()[0], s.edge_attribute("crease", np.int64)
    a, b = s.points[ends].astype(float)
    values[s.edges()[0]] = 7
    other, edges, points, log = s.copy(), [int(s.edges()[0])], [(a + b) / 2], []
    for _ in range(5):  # toward one end, or on either side of the last one in turn
        edit = other.split_edge(edges[-1], points[-1])
        log += np.asarray(edit.touched).tolist()
        near = other.vertex_vertices(edit.vertex).tolist()
        on_it = [v for v in near if np.allclose(np.cross(other.points[v] - a, b - a), 0)]
        end = max(on_it) if toward == "the last one" else min(on_it, key=lambda v: abs(
            other.points[v] - (a, b)[toward]).sum())  # fmt: skip
        edges.append(other.find_edge(edit.vertex, end))
        points.append((other.points[edit.vertex] + other.points[end]) / 2)
    s.prepare("split_edge", edges[:-1], points[:-1]).run()
    s.tell("splits", log)
    assert s.same_as(other)
    at = s.points[s.edge_array()].astype(float)
    parts = np.isclose(np.cross(at - a, b - a), 0).all(axis=(1, 2))
    assert parts.sum() == 6
    assert values[s.edges()].tolist() == (7 * parts).tolist()


@pytest.mark.parametrize("name", WITH_EDGES)
def test_an_end_of_a_split_edge_may_go_in_the_same_edit(name):
    s = structures.build(name, octahedron())
    if not s.stable_edge_handles:
        return  # every operation is an edit of its own
    edges = s.edges()
    values = s.edge_attribute("crease", np.int64)
    values[edges] = edges
    other, edge = s.copy(), int(edges[0])
    split = other.split_edge(edge, (0, 0, 0))
    part = other.find_edge(split.vertex, int(other.edge_vertices(edge)[0]))
    merged = other.collapse_edge(part, split.vertex)
    s.prepare("split_edge", [edge], [(0, 0, 0)]).run()
    s.prepare("collapse_edge", [(part, split.vertex, -1)]).run()
    s.tell("both", np.concatenate([split.touched, merged.touched]))
    assert s.same_as(other)
    kept = np.intersect1d(edges, s.edges())
    assert len(kept) > len(edges) / 2
    assert np.array_equal(values[kept], kept)


@pytest.mark.parametrize("name", WITH_EDGES)
@pytest.mark.parametrize("source", SURFACES)
def test_both_parts_of_an_edge_have_what_it_had(name: str, source: str):
    s = structures.build(name, SURFACES[source]())
    ends = s.edge_attribute("ends", np.int64, default=-1)
    names = {}
    for edge in s.edges().tolist():
        a, b = s.edge_vertices(edge).tolist()
        names[a, b] = 1000 * a + b
        ends[edge] = 1000 * a + b
    chosen = s.edges()[::3]
    rows = [tuple(row.tolist()) for row in s.edge_vertices(chosen)]
    made = s.split_edges(chosen, [s.points[list(row)].mean(axis=0) for row in rows])
    for v, (a, b) in zip(made.tolist(), rows, strict=True):
        assert [ends[s.find_edge(v, w)] for w in (a, b)] == [names.pop((a, b))] * 2
    for (a, b), value in names.items():
        assert ends[s.find_edge(a, b)] == value
    new = {s.find_edge(int(v), int(w)) for v in made for w in s.vertex_vertices(int(v))}
    assert sum(ends[e] == -1 for e in new) == len(new) - 2 * len(made)
    before = {where(s, e): ends[e] for e in s.edges().tolist()}
    remove_one(s)
    s.compact()
    for e in s.edges().tolist():
        assert ends[e] == before[where(s, e)]


@pytest.mark.parametrize("name", WITH_EDGES)
@pytest.mark.parametrize("source", SURFACES)
@pytest.mark.parametrize("at_once", [False, True])
def test_by_default_the_first_part_of_an_edge_alone_has_what_it_had(
    name: str, source: str, at_once: bool
):
    s = structures.build(name, SURFACES[source]())
    values = s.edge_attribute("ends", np.int64, default=-1, on_split="default")
    expected = {tuple(row): 1000 * row[0] + row[1] for row in s.edge_array().tolist()}
    values[s.edges()] = [*expected.values()]
    for edit in split_some(s, at_once):
        for v, (first, other) in zip(
            edit.created_vertices.tolist(), edit.vertex_parents.to_list(), strict=True
        ):
            expected[first, v] = expected.pop((min(first, other), max(first, other)))
    found = zip(map(tuple, s.edge_array().tolist()), values[s.edges()].tolist(), strict=True)
    assert dict(found) == {it: expected.get(it, -1) for it in map(tuple, s.edge_array().tolist())}
    assert len(expected) == len({*expected} & {*map(tuple, s.edge_array().tolist())})


@pytest.mark.parametrize("name", NAVIGABLE)
@pytest.mark.parametrize("source", SURFACES)
@pytest.mark.parametrize("at_once", [False, True])
def test_by_default_so_have_the_half_edges_of_the_first_part(name: str, source: str, at_once: bool):
    s = structures.build(name, SURFACES[source]())
    values = s.half_edge_attribute("way", np.int64, default=-1, on_split="default")
    expected = {it: 1000 * it[0] + it[1] for it in ways(s)}
    values[s.half_edges()] = [*expected.values()]
    for edit in split_some(s, at_once):
        for v, (first, other) in zip(
            edit.created_vertices.tolist(), edit.vertex_parents.to_list(), strict=True
        ):
            for old, new in (((first, other), (first, v)), ((other, first), (v, first))):
                if old in expected:
                    expected[new] = expected.pop(old)
    found = dict(zip(ways(s), values[s.half_edges()].tolist(), strict=True))
    assert found == {it: expected.get(it, -1) for it in found}
    assert {*expected} <= {*found}


def split_some(s: Structure, at_once: bool) -> list[hem.Edit]:
    """Split every third edge at its middle, one by one or all at once -> the edits."""
    edits: list[hem.Edit] = []
    stop = s.subscribe(edits.append)
    ends = s.edge_array()[::3]
    middles = s.points[ends].mean(axis=1)
    if at_once:
        s.split_edges(s.edges()[::3], middles)
    else:
        for (a, b), middle in zip(ends.tolist(), middles, strict=True):
            s.split_edge(s.find_edge(a, b), middle)
    stop()
    return edits


def ways(s: Structure) -> list[tuple[int, int]]:
    """Where each half-edge starts and ends."""
    h = s.half_edges()
    return [*zip(s.origin(h).tolist(), s.tip(h).tolist(), strict=True)]


@pytest.mark.parametrize("name", NAVIGABLE)
def test_half_edges_keep_their_direction_when_they_are_split(name: str):
    s = structures.build(name, SURFACES["open"]())
    way = s.half_edge_attribute("way", np.int64, default=-1)
    for h in s.half_edges().tolist():
        way[h] = 1000 * s.origin(h) + s.tip(h)
    for a, b in s.edge_array()[::4].tolist():
        v = s.split_edge(s.find_edge(a, b), (0, 0, 0)).vertex
        around = {(s.origin(h), s.tip(h)): way[h] for h in s.half_edges().tolist()}
        for first, second in ((a, b), (b, a)):
            for part in ((first, v), (v, second)):
                assert around.get(part, 1000 * first + second) == 1000 * first + second


@pytest.mark.parametrize("name", NAVIGABLE)
@pytest.mark.parametrize("source", SURFACES)
def test_half_edges_keep_their_values_when_the_faces_beyond_go(name: str, source: str):
    s = structures.build(name, SURFACES[source]())
    values = s.half_edge_attribute("way", np.int64)
    values[s.half_edges()] = 1000 * s.origin(s.half_edges()) + s.tip(s.half_edges())
    number = {tuple(at): v for v, at in enumerate(s.points.tolist())}
    for turn in range(3):
        for v in s.vertices()[turn::9].tolist():
            with contextlib.suppress(hem.TopologyError):
                s.remove_vertex(v)
        for face in s.faces()[turn::5].tolist():
            with contextlib.suppress(hem.TopologyError):
                s.remove_face(face)
        if turn == 1:
            s.compact()
        for h in s.half_edges().tolist():
            a, b = (number[tuple(s.points[v].tolist())] for v in (s.origin(h), s.tip(h)))
            assert values[h] == 1000 * a + b


@pytest.mark.parametrize("name", NAVIGABLE)
def test_batches_of_collapses_leave_half_edges_the_values_they_had(name: str):
    many = [structures.build(name, SURFACES["open"]()) for _ in range(2)]
    for s in many:
        way = s.half_edge_attribute("way", np.int64)
        way[s.half_edges()] = 1000 * s.origin(s.half_edges()) + s.tip(s.half_edges())
    one, batch = many
    edges = one.edges()[::3]
    lasting = one.edge_vertices(edges).to_list()
    for edge, ends in zip(edges.tolist(), lasting, strict=True):
        with contextlib.suppress(hem.TopologyError, hem.MeshError):
            one.collapse_edge(edge if one.stable_edge_handles else one.find_edge(*ends))
    assert batch.collapse_edges(edges).sum() > 10
    found = [
        dict(
            zip(s.half_edges().tolist(), s.half_edge_attribute("way")[s.half_edges()], strict=True)
        )
        for s in many
    ]
    assert found[0] == found[1]


def test_what_differs_by_rounding_is_no_seam(name: str):
    """Three corners of a vertex that is merged into a neighbor."""
    s = structures.build(name, SURFACES["closed"]())
    begin(s)
    uv, rng = s.corner_attribute("plain"), np.random.default_rng(4)
    uv[s.faces()] = uv[s.faces()] * (1 + 1e-15 * rng.standard_normal((3 * s.n_faces, 1)))
    assert s.collapse_edges(s.edges()[::5]).sum() > 5
    assert_plain(s)


def test_an_edit_names_the_parents_of_what_it_made(s):
    edge, face = int(s.edges()[9]), int(s.faces()[1])
    ends, beside = s.edge_vertices(edge).tolist(), s.edge_faces(edge).tolist()
    corners = s.face_vertices(face).tolist()
    edit = s.split_edge(edge, (0, 0, 0))
    assert edit.vertex_parents.to_list() == [ends]
    assert sorted(edit.face_parents.tolist()) == sorted(beside)
    face = next(f for f in s.faces().tolist() if f not in beside)
    corners = s.face_vertices(face).tolist()
    edit = s.split_face(face, (0, 0, 0))
    assert sorted(edit.vertex_parents[0].tolist()) == sorted(corners)
    assert edit.face_parents.tolist() == [face, face]
    assert s.add_vertex((0, 0, 0)).vertex_parents.to_list() == [[]]
    assert len(s.flip_edge(next(e for e in s.edges() if s.can_flip_edge(e))).face_parents) == 0


def test_a_mesh_without_elements_has_attributes(name: str):
    s = structures.build(name, hem.TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int)))
    weight, uv = s.vertex_attribute("weight", default=2), s.corner_attribute("uv", shape=2)
    assert weight[s.vertices()].shape == (0,)
    assert uv[s.faces()].shape == (0, 2)
    made = [s.add_vertex(p).vertex for p in np.eye(3)]
    face = s.add_face(*made).created_faces[0]
    assert weight[made].tolist() == [2, 2, 2]
    uv[face] = [(0, 0), (1, 0), (0, 1)]
    assert uv[face].tolist() == [[0, 0], [1, 0], [0, 1]]
    s.compact()
    assert uv[0].shape == (3, 2)


def test_a_name_is_one_attribute(s):
    weight = s.vertex_attribute("weight", np.float32, shape=(3,))
    assert s.vertex_attribute("weight") is weight
    assert s.vertex_attribute("weight", np.float32, shape=3) is weight
    assert s.face_attribute("weight") is not weight
    with pytest.raises(hem.MeshError, match="already"):
        s.vertex_attribute("weight", np.int8)
    s.remove_attribute(weight)
    with pytest.raises(hem.MeshError, match="no attribute of this mesh"):
        s.remove_attribute(weight)
    with pytest.raises(hem.MeshError, match="'weight' is no attribute of this mesh, such as"):
        s.remove_attribute("weight")
    s.split_face(int(s.faces()[0]), (0, 0, 0))
    assert s.vertex_attribute("weight", np.int8) is not weight


def test_what_is_said_of_an_attribute_that_is_there_must_be_so(name: str):
    s = structures.build(name, octahedron())
    for it in of_each_kind(s):
        find = getattr(s, f"{it.element}_attribute")
        rule = it.on_split
        for said in ({}, {"default": 1}, {"default": 1.0, "on_split": rule}, {"on_split": rule}):
            assert find("kind", **said) is it
            assert find("kind", np.float32, **said) is it
        for said in ({"default": 0}, {"default": 7}, {"on_split": "default"}):
            for more in ({}, {"dtype": np.float32}):
                with pytest.raises(hem.MeshError, match=r"'kind' .* already, .* default 1\.0"):
                    find("kind", **said, **more)
        assert it.default == 1
    color = s.face_attribute("color", shape=3, default=(1, np.nan, 0))
    assert s.face_attribute("color", default=[1, np.nan, 0]) is color
    for wrong in ((1, np.nan, 2), 1, (1, 2)):
        with pytest.raises(hem.MeshError, match="face attribute 'color'"):
            s.face_attribute("color", default=wrong)
    assert s.copy().face_attribute("color", default=(1, np.nan, 0)).on_split == "copy"


@pytest.mark.parametrize(
    ("dtype", "default"),
    [
        (np.float32, 0.1),
        (np.float32, 2**24 + 1),
        (np.float32, np.inf),
        (np.float64, np.nan),
        (np.int32, 2.0),
        (np.uint8, 255),
        (np.int64, -(2**63)),
        (np.uint64, 2**64 - 1),
        (bool, True),
        (bool, 0),
        (np.complex64, 1j),
        (np.complex64, 0.1 - 0.2j),
        ("U3", "abc"),
    ],
)
def test_a_default_that_fits_is_the_value(dtype, default):
    s = structures.build("half_edge", octahedron())
    found = s.vertex_attribute("weight", dtype, default=default)[0]
    assert np.array_equal(found, np.array(default, dtype), equal_nan=dtype == np.float64)


UNFIT = [300], np.array([300]), 1.5, np.nan, "abc", [1, 2, 3], [[1, 2], [3]], 10**30


@pytest.mark.parametrize("wrong", UNFIT)
def test_a_value_that_does_not_fit_is_refused_and_none_changes(wrong):
    s = structures.build("half_edge", octahedron())
    for kind in ("vertex", "face", "corner", "edge", "half_edge"):
        attribute = getattr(s, f"{kind}_attribute")("weight", np.int8, default=7)
        with pytest.raises(hem.MeshError, match=f"{kind} attribute 'weight'"):
            attribute[[0, 2]] = wrong
        assert (attribute.values == 7).all()


@pytest.mark.parametrize("wrong", [-1, 10**6, [0, 10**6], 1.5, [[0]], None, "a"])
def test_what_names_no_live_element_has_no_value(s, wrong):
    for attribute in (s.vertex_attribute("a"), s.face_attribute("a"), s.corner_attribute("a")):
        with pytest.raises(hem.MeshError):
            attribute[wrong]
        with pytest.raises(hem.MeshError):
            attribute[wrong] = 1
    face = remove_one(s)
    with pytest.raises(hem.MeshError, match="face"):
        s.face_attribute("a")[face]


@pytest.mark.parametrize(
    ("made", "words"),
    [
        ({"dtype": np.int32, "on_split": "interpolate"}, "cannot be interpolated"),
        ({"on_split": "mean"}, "on_split is one of"),
        ({"shape": (2,), "default": (1, 2, 3)}, "vertex attribute"),
        ({"dtype": "nonsense"}, "vertex attribute"),
        ({"dtype": np.ones(6)}, "vertex attribute"),
        ({"dtype": np.int32, "default": 1.7}, "int32 cannot hold the default 1.7"),
        ({"dtype": np.int8, "default": [1, np.nan], "shape": 2}, "vertex attribute"),
        ({"dtype": np.int8, "default": np.array([1, np.nan]), "shape": 2}, "cannot hold"),
        ({"dtype": np.uint8, "default": -1}, "vertex attribute"),
        ({"dtype": bool, "default": 2}, "bool cannot hold the default 2"),
        ({"default": 1e40}, "float32 cannot hold"),
        ({"dtype": np.float16, "default": 100_000}, "float16 cannot hold"),
    ],
)
def test_what_cannot_be_an_attribute_is_refused(name: str, made: dict, words: str):
    s = structures.build(name, octahedron())
    with pytest.raises(hem.MeshError, match=words):
        s.vertex_attribute("weight", **made)
    with pytest.raises(hem.MeshError, match="its name"):
        s.vertex_attribute([1, 2], **made)
    assert not s.attributes()


def test_edges_that_are_not_recorded_have_none():
    for name in set(structures.NAMES) - set(WITH_EDGES):
        with pytest.raises(hem.MeshError, match="records no edges"):
            structures.build(name, octahedron()).edge_attribute("crease")


def test_what_is_restored_has_its_values_again(s):
    begin(s)
    s.reserve(50)
    before = s.snapshot()
    late = s.face_attribute("late", default=3)
    late[s.faces()] = 4
    edge = int(s.edges()[0])
    s.split_edge(edge, between(s, s.edge_vertices(edge), 0))
    s.vertex_attribute("plain")[s.vertices()] = 0
    s.restore(before)
    assert_plain(s)
    assert set(late[s.faces()].tolist()) == {3}
    s.split_face(int(s.faces()[0]), between(s, s.face_vertices(int(s.faces()[0])), 0))
    assert_plain(s)


def test_what_was_made_anew_under_a_name_is_not_what_was_kept_of_it(s):
    weight = s.vertex_attribute("weight")
    weight[s.vertices()] = 7
    s.reserve(50)
    before = s.snapshot()
    s.remove_attribute(weight)
    other = s.vertex_attribute("weight", np.int32, 3, default=2)
    s.restore(before)
    assert set(other[s.vertices()].ravel().tolist()) == {2}
    s.split_face(int(s.faces()[0]), between(s, s.face_vertices(int(s.faces()[0])), 0))
    assert other.values.shape == (s.n_vertices, 3)
    for wrong in ({"shape": 0}, {"dtype": object}, {"dtype": np.uint8, "default": 300}):
        with pytest.raises(hem.MeshError, match="vertex attribute 'wrong'"):
            s.vertex_attribute("wrong", **wrong)


def test_what_was_made_anew_with_another_default_has_that_when_restored(s):
    s.vertex_attribute("weight")[s.vertices()] = 7
    before = s.snapshot()
    s.remove_attribute(s.vertex_attribute("weight"))
    other = s.vertex_attribute("weight", default=2)
    s.restore(before)
    assert (other[s.vertices()] == 2).all()


def test_values_are_uploaded_where_it_is_asked(s):
    color = s.vertex_attribute("color", shape=3)
    uploads: list[hem.Upload] = []
    render = hem.RenderMesh(s, [color])
    render.subscribe(uploads.append)
    color[[3, 47]] = (1, 0, 0)
    assert uploads[-1].attributes["color"].tolist() == [[3, 4], [47, 48]]
    assert not len(uploads[-1].vertices)
    v = s.split_face(int(s.faces()[0]), (0, 0, 0)).vertex
    (begin, end), *_ = uploads[-1].attributes["color"].tolist()
    assert begin <= v < end
    with render.transaction():
        color[3] = (0, 1, 0)
        color[4] = (0, 1, 0)
    assert uploads[-1].attributes["color"].tolist() == [[3, 5]]
    assert len(render.attributes["color"].values) == len(render.points) // 3
    count = len(uploads)
    render.close()
    color[5] = (1, 1, 1)
    assert len(uploads) == count
    with pytest.raises(hem.MeshError, match="no attribute of vertices"):
        hem.RenderMesh(s, [s.face_attribute("color")])


def test_seams_survive_the_way_to_a_renderer_and_back(s):
    uv = s.corner_attribute("uv", np.float64, 2)
    rng = np.random.default_rng(3)
    uv[s.faces()] = rng.integers(0, 2, (s.n_faces, 3, 2))
    s.collapse_edges(s.edges()[::9])
    points, indices, values = hem.split_at_seams(uv)
    assert len(points) == 3 * len(values)
    mesh, corners = hem.mesh_from_render(points, indices, values=values)
    back = structures.build(s.name, mesh)
    again = back.corner_attribute("uv", np.float64, 2)
    again[back.faces()] = corners
    assert told(back, again) == told(s, uv)
    assert len(values) > len(mesh.points)
    with pytest.raises(hem.MeshError, match="values for"):
        hem.mesh_from_render(points, indices, values=values[1:])


def told(s: Structure, uv) -> list:
    """Every face as positions and values of its corners, from the smallest on."""
    found = []
    for row, values in zip(s.triangles(), uv[s.faces()].reshape(-1, 3, 2), strict=True):
        corners = [(*s.points[v].tolist(), *at.tolist()) for v, at in zip(row, values, strict=True)]
        k = corners.index(min(corners))
        found.append(corners[k:] + corners[:k])
    return sorted(found)


def test_removing_a_vertex_removes_its_faces_and_no_other(s):
    for v in s.vertices()[::9].tolist():
        before = {f: s.face_vertices(f).tolist() for f in s.faces().tolist()}
        kept = {f: row for f, row in before.items() if v not in row}
        try:
            edit = s.remove_vertex(v)
        except hem.TopologyError:
            assert {f: s.face_vertices(f).tolist() for f in s.faces().tolist()} == before
            continue
        assert edit.removed_vertices.tolist() == [v]
        assert edit.removed_faces.tolist() == sorted(set(before) - set(kept))
        assert {f: s.face_vertices(f).tolist() for f in s.faces().tolist()} == kept
        assert v not in s.vertices()
        s.validate()
    alone = s.add_vertex((0, 0, 0)).vertex
    assert s.remove_vertex(alone).removed_vertices.tolist() == [alone]
    with pytest.raises(hem.TopologyError, match="no such vertex"):
        s.remove_vertex(alone)
    s.validate()


def test_an_interrupted_edit_leaves_rows_for_all(name: str):
    s = structures.build(name, shuffled(hem.generate("torus", 100)))
    weight = s.vertex_attribute("weight", default=1)

    def interrupt(edit: hem.Edit) -> None:
        raise KeyboardInterrupt

    weight.follow = interrupt
    with pytest.raises(KeyboardInterrupt):
        s.split_face(0, (0, 0, 0))
    assert weight[s.vertices()].tolist() == [1] * s.n_vertices
    assert len(weight.values) == len(s.points)


def test_what_an_interrupted_edit_made_has_the_default_after_compact(name: str):
    s = structures.build(name, SURFACES["open"]())
    many = of_each_kind(s)
    for it in many:
        it[handles_of(s, it)] = 2
    s.remove_face(int(s.faces()[0]))

    def interrupt(edit: hem.Edit) -> None:
        raise KeyboardInterrupt

    for it in many:
        it.follow = interrupt
    with pytest.raises(KeyboardInterrupt):
        s.split_face(int(s.faces()[-1]), (0, 0, 0))
    for it in many:
        del it.follow
    s.compact()
    for it in many:
        values = it[handles_of(s, it)]
        assert {*np.ravel(values).tolist()} == {1, 2}
        assert (values == 1).sum() < len(values) / 10
    s.split_all_faces()
    s.validate()


def test_values_grow_where_they_are(name):
    s = structures.build(name, hem.generate("torus", 1_600))
    of = [s.vertex_attribute("w", default=7), s.face_attribute("m"), s.corner_attribute("uv")]
    s.split_face(0, (0, 0, 0))  # makes room
    places = [it.values.ctypes.data for it in of]
    s.split_faces(range(1, 300), np.zeros((299, 3)))
    assert [it.values.ctypes.data for it in of] == places
    assert [len(it.values) for it in of] == [1_900, 3_800, 3_800]
    assert (of[0].values == 7).all()


def test_a_default_is_a_value_and_no_view(s):
    given = np.zeros(3, np.float32)
    color = s.face_attribute("color", shape=(3,), default=given, on_split="default")
    given[:] = 7
    made = s.split_face(int(s.faces()[0]), (0, 0, 0)).created_faces
    assert not color[made].any()


def test_another_shape_is_another_attribute(s):
    weight = s.vertex_attribute("weight", np.float64, shape=3)
    assert s.vertex_attribute("weight", shape=3) is weight
    with pytest.raises(hem.MeshError, match="already"):
        s.vertex_attribute("weight", shape=2)
