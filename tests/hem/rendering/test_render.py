"""The render mesh: what a renderer is given, in step with every structure."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import hem
import structures
from hem.engine import Uses
from tests.extent import OF_EACH_KIND, waiting_for
from tests.structures.conftest import octahedron, shuffled
from tests.structures.histories.actions import KINDS, Action, aim, perform, surface_of


@pytest.fixture(params=waiting_for(OF_EACH_KIND, structures.NAMES))
def s(request: pytest.FixtureRequest) -> structures.Structure:
    return structures.build(request.param, shuffled(hem.generate("torus", 100)))


def afresh(s: structures.Structure) -> tuple[list[float], list[int]]:
    """Flat points and clockwise indices, from the contract's queries one by one."""
    points = np.where(np.isnan(s.points), 0, s.points)
    indices = np.zeros((s.face_end, 3), int)
    for f in s.faces().tolist():
        indices[f] = s.face_vertices(f)[[0, 2, 1]]
    return points.ravel().tolist(), indices.ravel().tolist()


def assert_in_step(render: hem.RenderMesh) -> None:
    points, indices = afresh(render.structure)
    assert render.points.tolist() == points
    assert render.indices.tolist() == indices


def some_edits(s: structures.Structure, count: int, seed: int = 0) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        numbers = rng.integers(0, 5040, 3).tolist()
        aimed = aim(surface_of(s), Action(str(rng.choice(KINDS)), *numbers))
        if aimed:
            perform(s, aimed)


def test_it_is_flat_clockwise_and_of_the_renderers_types():
    mesh = octahedron()
    render = hem.RenderMesh(structures.build("half_edge", mesh))
    assert render.points.dtype == np.float32
    assert render.indices.dtype == np.int32
    assert render.points.shape == (18,)
    assert render.indices.shape == (24,)
    corners = mesh.points[render.indices.reshape(-1, 3)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((normals * corners.mean(axis=1)).sum(axis=1) < 0).all()


def test_after_any_edits_it_equals_one_made_afresh(s):
    render = hem.RenderMesh(s)
    for seed in range(8):
        some_edits(s, 25, seed)
        assert_in_step(render)
        assert_in_step(hem.RenderMesh(s))


def test_batches_moves_and_compaction_are_followed(s):
    render, rng = hem.RenderMesh(s), np.random.default_rng(1)
    s.split_faces(s.faces()[::5], rng.random((40, 3)))
    assert_in_step(render)
    s.split_edges(s.edges()[::9], rng.random((len(s.edges()[::9]), 3)))
    assert_in_step(render)
    s.collapse_edges(rng.permutation(s.edges()))
    assert_in_step(render)
    s.move_vertices(s.vertices()[:9], rng.random((9, 3)))
    assert_in_step(render)
    s.move_vertex(int(s.vertices()[0]), (7, 8, 9))
    assert_in_step(render)
    s.compact()
    assert_in_step(render)
    s.split_all_faces()
    assert_in_step(render)


def test_what_is_told_to_upload_is_all_that_changed(s):
    render = hem.RenderMesh(s)
    uploaded = [render.points.reshape(-1, 3).copy(), render.indices.reshape(-1, 3).copy()]

    def upload(told: hem.Upload) -> None:
        now = render.points.reshape(-1, 3), render.indices.reshape(-1, 3)
        for i, ranges in enumerate((told.vertices, told.triangles)):
            larger = np.zeros_like(now[i])
            kept = min(len(larger), len(uploaded[i]))
            larger[:kept] = uploaded[i][:kept]
            for begin, end in ranges.tolist():
                larger[begin:end] = now[i][begin:end]
            uploaded[i] = larger

    render.subscribe(upload)
    for seed in range(5):
        some_edits(s, 10, seed)
        with render.transaction():
            some_edits(s, 20, seed + 100)
        s.split_faces(s.faces()[:3], np.ones((3, 3)))
        if seed == 3:
            s.compact()
        assert uploaded[0].ravel().tolist() == render.points.tolist()
        assert uploaded[1].ravel().tolist() == render.indices.tolist()


@pytest.mark.parametrize(
    "name", [it for it in structures.NAMES if not structures.REGISTRY[it].compiled]
)
def test_an_edit_is_followed_without_gathering_the_positions_of_all(name, monkeypatch):
    s = structures.build(name, hem.generate("torus", 100))
    render = hem.RenderMesh(s)
    heat = s.vertex_attribute("heat", on_split="interpolate")
    corners = s.edge_vertices(int(s.edges()[0])).tolist()
    heat[corners] = [1.0, 3.0]
    middle = s.points[corners].mean(axis=0)

    def gathered(_):
        raise AssertionError("all positions were gathered")

    with monkeypatch.context() as patched:
        patched.setattr(type(s), "points", property(gathered))
        made = s.split_edge(int(s.edges()[0]), middle)
        s.split_face(7, (0.0, 0.0, 0.0))
    assert heat[made.vertex] == pytest.approx(2.0)
    assert_in_step(render)


def test_an_edit_uploads_a_handful_of_elements_of_a_large_mesh(s):
    s = structures.build(s.name, hem.generate("torus", 10_000))
    s.reserve(100)
    s.split_face(5, (0, 0, 0))
    render, told = hem.RenderMesh(s), []
    s.split_face(9, (0, 0, 0))  # the first takes more room
    render.subscribe(told.append)
    s.split_face(12_000, (0, 0, 0))
    (upload,) = told
    assert not upload.resized
    assert np.diff(upload.vertices).sum() <= 2
    assert np.diff(upload.triangles).sum() <= 4


def test_a_transaction_commits_once_whatever_happens_in_it(s):
    render, told = hem.RenderMesh(s), []
    render.subscribe(told.append)
    s.split_face(0, (0, 0, 0))
    s.split_face(0, (0, 0, 0))
    assert render.commits == len(told) == 2
    with render.transaction(), render.transaction():
        some_edits(s, 30)
        assert render.commits == 2
        assert_in_step(render)
    assert render.commits == len(told) == 3
    with render.transaction():
        pass
    assert render.commits == 3
    with pytest.raises(hem.TopologyError), render.transaction():
        s.split_edge(s.split_face(1, (0, 0, 0)).vertex + 10**6, (0, 0, 0))
    assert render.commits == 4
    assert_in_step(render)


def test_refused_operations_are_not_heard_of(s):
    render = hem.RenderMesh(s)
    with pytest.raises(hem.TopologyError):
        s.split_face(10_000, (0, 0, 0))
    assert render.commits == 0


def test_closed_it_follows_no_more(s):
    render = hem.RenderMesh(s)
    before = render.indices.tolist()
    render.close()
    s.split_face(0, (0, 0, 0))
    assert render.indices.tolist() == before


def test_arrays_that_lie_elsewhere_than_before_are_told_with_all_they_hold():
    render, told = hem.RenderMesh(structures.build("half_edge", hem.generate("torus", 100))), []
    render.subscribe(told.append)
    before = render.points, render.indices
    render.reserve(10)
    assert not told  # there was room
    render.reserve(5_000_000)
    for now, was in zip((render.points, render.indices), before, strict=True):
        assert now.ctypes.data != was.ctypes.data
        assert np.array_equal(now, was)
    assert [it.resized for it in told] == [True]
    assert (told[0].vertices.tolist(), told[0].triangles.tolist()) == ([[0, 100]], [[0, 200]])


def test_every_subscriber_hears_of_an_edit_even_if_another_raises(s):
    heard = []

    def failing(edit: hem.Edit) -> None:
        raise RuntimeError("a listener of the user's")

    end = s.subscribe(failing)
    s.subscribe(heard.append)
    with pytest.raises(RuntimeError, match="listener"):
        s.split_face(0, (0, 0, 0))
    assert len(heard) == 1
    end()
    end()
    assert s.split_face(0, (0, 0, 0)) is heard[1]


@pytest.mark.parametrize("interrupted", ["attribute", "subscriber", "render mesh"])
def test_an_interrupt_while_an_edit_is_followed_leaves_all_others_in_step(
    s, interrupted, monkeypatch
):
    def stop(*given):
        raise KeyboardInterrupt

    heat, ids = s.vertex_attribute("heat"), s.vertex_attribute("id", int, default=7)
    end = s.subscribe(stop if interrupted == "subscriber" else str)
    render, told = hem.RenderMesh(s), []
    render.subscribe(told.append)
    if interrupted == "attribute":
        monkeypatch.setattr(heat, "follow", stop)
    elif interrupted == "render mesh":
        monkeypatch.setattr(s, "copy_touched", stop)
    with pytest.raises(KeyboardInterrupt):
        s.split_face(0, (0, 0, 0))
    end()
    monkeypatch.undo()
    assert_in_step(render)
    new = s.split_face(0, (0, 0, 0)).vertex
    assert ids.values[[new - 1, new]].tolist() == [7, 7]
    assert_in_step(render)
    assert len(told) == 2 or told[-1].resized


def test_an_interrupt_while_a_compaction_is_followed_leaves_the_arrays_in_step(s, monkeypatch):
    def stop_once(*given):
        monkeypatch.undo()
        raise KeyboardInterrupt

    s.remove_faces([0, 3])
    render, told = hem.RenderMesh(s), []
    render.subscribe(told.append)
    monkeypatch.setattr(s, "face_vertices", stop_once)
    with pytest.raises(KeyboardInterrupt):
        s.compact()
    assert_in_step(render)
    s.move_vertices([0], [(5, 5, 5)])
    assert_in_step(render)
    assert told[-1].resized


BATCHES = {
    "split_faces": lambda s: s.split_faces([3, 50], np.zeros((2, 3))),
    "split_edges": lambda s: s.split_edges(s.edges()[:40:20], np.zeros((2, 3))),
    "collapse_edges": lambda s: s.collapse_edges(s.edges()[::9]),
    "move_vertices": lambda s: s.move_vertices([3, 50], np.zeros((2, 3))),
    "remove_faces": lambda s: s.remove_faces([3, 50]),
    "remove_vertex": lambda s: s.remove_vertex(3),
}


@pytest.mark.parametrize("batch", BATCHES)
def test_what_a_batch_has_done_before_an_interrupt_is_told(s, batch, monkeypatch):
    """It comes as soon as compiled code has ended; edges are only checked the first time."""
    ids, render, heard = s.vertex_attribute("id", int, default=7), hem.RenderMesh(s), []
    s.subscribe(heard.append)
    left = [2 if batch == "split_edges" else 1]

    def then_stop(run):
        def running(*given):
            result = run(*given)
            left[0] -= 1
            if not left[0]:
                raise KeyboardInterrupt
            return result

        return running

    perform = Uses.perform
    monkeypatch.setattr(Uses, "perform", lambda *given: then_stop(perform(*given)))
    monkeypatch.setattr(Uses, "run", then_stop(Uses.run))
    with pytest.raises(KeyboardInterrupt):
        BATCHES[batch](s)
    monkeypatch.undo()
    assert [edit.kind for edit in heard] == [batch]
    assert_in_step(render)
    assert (ids[s.vertices()] == 7).all()
    s.validate()


def seamed(mesh: hem.TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
    """As Unity stores it: positions repeated for every face, clockwise, flat."""
    corners = mesh.triangles[:, [0, 2, 1]].ravel()
    return mesh.points[corners].ravel(), np.arange(len(corners))


@pytest.mark.parametrize("name", structures.NAMES)
@pytest.mark.parametrize("source", ["torus", "sphere", "grid", "cone"])
def test_a_render_mesh_with_seams_comes_back_as_the_surface_it_was(name, source):
    mesh = shuffled(hem.generate(source, 200))
    back = hem.mesh_from_render(*seamed(mesh))
    s = structures.build(name, back)
    assert (s.n_vertices, s.n_faces) == (len(mesh.points), len(mesh.triangles))
    turned = [np.roll(row, -int(row.argmin())).tolist() for row in back.triangles]
    assert len({*map(tuple, turned)}) == len(mesh.triangles)
    assert np.array_equal(back.points[back.triangles], mesh.points[mesh.triangles]) or (
        sorted(map(tuple, np.sort(back.points[back.triangles].sum(axis=2), axis=1).tolist()))
        == sorted(map(tuple, np.sort(mesh.points[mesh.triangles].sum(axis=2), axis=1).tolist()))
    )
    before = mesh.points[mesh.triangles].astype(float)
    after = back.points[back.triangles].astype(float)
    volume = [np.linalg.det(it).sum() for it in (before, after)]
    assert volume[0] == pytest.approx(volume[1])


def test_there_and_back_keeps_the_mesh_even_after_edits(s):
    render = hem.RenderMesh(s)
    s.collapse_edges(s.edges()[::7])
    s.move_vertices(s.vertices(), np.random.default_rng(0).random((s.n_vertices, 3)))
    back, now = render.to_triangles(), s.to_triangles()
    assert len(back.points) == len(now.points)
    triples = [sorted(it.points[it.triangles].sum(axis=(1, 2)).tolist()) for it in (back, now)]
    assert triples[0] == triples[1]


@pytest.mark.parametrize("given", [hem.generate("torus", 100), None, "model.ply"])
def test_what_is_no_structure_is_not_followed(given):
    with pytest.raises(hem.MeshError, match="follows a structure, not"):
        hem.RenderMesh(given)


@pytest.mark.parametrize(
    ("points", "indices"),
    [
        ([0, 0, 0, 1], [0, 0, 0]),
        ([0.0] * 9, [0, 1]),
        ([0.0] * 9, [0, 1, 3]),
        ([np.nan] * 9, [0, 1, 2]),
        (np.zeros((3, 2)), [0, 1, 2]),
        ([[0, 0, 0], [1, 0], [0, 1, 0]], [0, 1, 2]),
        (np.eye(3), [[0, 1, 2], [0, 2]]),
    ],
)
def test_what_is_no_render_mesh_is_refused(points, indices):
    with pytest.raises(hem.MeshError):
        hem.mesh_from_render(points, indices)
    with pytest.raises(hem.MeshError, match="values"):
        hem.mesh_from_render(np.eye(3), [0, 1, 2], values=[[1], [2, 3], [4]])


def test_welding_equals_a_search_through_all_positions():
    rng = np.random.default_rng(5)
    points = rng.integers(-2, 3, (300, 3)) * np.array([1.0, -0.0, 1e30])
    mesh = hem.TriangleMesh(points, rng.permutation(300).reshape(-1, 3)).welded()
    first = list(dict.fromkeys(map(tuple, (points + 0.0).astype(np.float32).tolist())))
    assert mesh.points.tolist() == [list(it) for it in first]


@pytest.mark.parametrize("made", [
    copy.copy, copy.deepcopy, lambda render: pickle.loads(pickle.dumps(render)),
])  # fmt: skip
def test_a_copy_follows_its_own_structure_and_ends_alone(s, made):
    heat = s.vertex_attribute("heat")
    render = hem.RenderMesh(s, [heat])
    twin = made(render)
    assert list(twin.attributes) == ["heat"]
    assert (twin.structure is s) == (made is copy.copy)
    some_edits(twin.structure, 5)
    assert_in_step(twin)
    twin.close()
    some_edits(s, 5)
    assert_in_step(render)


@pytest.mark.parametrize("name", structures.NAMES)
def test_a_mesh_without_faces_has_no_seams(name):
    s = structures.build(name, hem.TriangleMesh(np.eye(3), []))
    points, indices, values = hem.split_at_seams(s.corner_attribute("uv", shape=(2,)))
    assert (len(points), len(indices), values.shape) == (0, 0, (0, 2))


def test_corners_of_no_number_are_of_one_value() -> None:
    s = structures.build("half_edge", hem.generate("grid", 16))
    points, _, values = hem.split_at_seams(s.corner_attribute("uv", shape=2, default=np.nan))
    assert len(points) == 3 * s.n_vertices
    assert np.isnan(values).all()


def test_an_attribute_that_is_removed_is_no_longer_rendered_nor_brought_back(s):
    kept, gone = s.vertex_attribute("kept"), s.vertex_attribute("gone", dtype="i4", default=7)
    render, told = hem.RenderMesh(s, [kept, gone]), []
    render.subscribe(told.append)
    s.split_face(0, (0, 0, 0))
    assert list(told[-1].attributes) == ["kept", "gone"]
    s.remove_attribute(gone)
    s.split_face(0, (0, 0, 0))
    assert list(told[-1].attributes) == list(render.attributes) == ["kept"]
    commits = render.commits
    gone[0] = 3
    assert render.commits == commits
    for made in (copy.copy, copy.deepcopy):
        twin = made(render)
        assert list(twin.attributes) == ["kept"]
        assert [it.name for it in twin.structure.attributes()] == ["kept"]
    again = s.vertex_attribute("gone")
    assert list(render.attributes) == ["kept"]
    assert list(hem.RenderMesh(s, [again]).attributes) == ["gone"]


def test_closed_by_who_is_told_first_it_follows_no_more(s):
    s.subscribe(lambda edit: render.close())
    render = hem.RenderMesh(s)
    before = render.to_triangles()
    s.split_face(3, (1, 2, 3))
    assert np.array_equal(render.to_triangles().triangles, before.triangles)


def test_a_copy_of_what_was_closed_follows_again(s):
    render = hem.RenderMesh(s)
    render.close()
    s.split_face(0, (0, 0, 0))
    twin = copy.copy(render)
    s.split_face(0, (0, 0, 0))
    assert_in_step(twin)


def test_polygons_are_refused_in_words_that_say_what_to_do():
    quad = hem.PolygonMesh(np.eye(3)[[0, 1, 2, 0]] + [[0], [0], [0], [1]], [[0, 1, 2, 3]])
    s = structures.build("plankton", quad)
    for make in (hem.RenderMesh, lambda it: hem.split_at_seams(it.corner_attribute("uv"))):
        with pytest.raises(hem.MeshError, match=r"mesh has larger faces; .* of to_triangles\(\)"):
            make(s)


def test_odd_arguments_are_refused_in_words(s):
    heat = s.vertex_attribute("heat")
    for given in (heat, "heat", 3):
        with pytest.raises(hem.MeshError, match="takes a list of attributes"):
            hem.RenderMesh(s, given)
    other = copy.copy(s)
    for given in (["heat"], [None], [s.face_attribute("heat")], [other.vertex_attribute("heat")]):
        with pytest.raises(hem.MeshError, match="no attribute of vertices of this mesh"):
            hem.RenderMesh(s, given)
    for given in (heat, "uv", None):
        with pytest.raises(hem.MeshError, match="no attribute of corners"):
            hem.split_at_seams(given)
    render = hem.RenderMesh(s, iter([heat]))
    assert list(render.attributes) == ["heat"]
    for splits in ("a", -5, 1.5, True, None, 2**31, 2**70):
        with pytest.raises(hem.MeshError, match="reserve takes a number from 0 to 2,147,483,647"):
            render.reserve(splits)
    with pytest.raises(hem.MeshError, match="more than handles can name"):
        render.reserve(2**30)
    arrays = render.points, render.indices
    with pytest.raises(hem.MeshError, match="one value for 100 positions"):
        hem.mesh_from_render(*arrays, values=3)
    with pytest.raises(hem.MeshError, match="a weld tolerance is finite"):
        hem.mesh_from_render(*arrays, tolerance="a")
