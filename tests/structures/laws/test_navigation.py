"""Walking by half-edges: against the faces alone, singly and in batches, after operations."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

import hem
import structures
from hem.contract import STEPS, Navigable
from hem.errors import MeshError, TopologyError
from tests.structures.test_polygons import CUBE, mixed

WALKED = [name for name, it in structures.REGISTRY.items() if issubclass(it, Navigable)]
POLYGONS = [name for name in WALKED if structures.REGISTRY[name].holds_polygons]
MESHES = {
    "torus": lambda: hem.generate("torus", 49),
    "grid": lambda: hem.generate("grid", 25),
    "cube": lambda: CUBE,
    "mixed": mixed,
}


@pytest.fixture(
    params=[
        *((name, mesh) for name in WALKED for mesh in ("torus", "grid")),
        *((name, mesh) for name in POLYGONS for mesh in ("cube", "mixed")),
    ],
    ids="-".join,
)
def walked(request: pytest.FixtureRequest) -> Navigable:
    name, mesh = request.param
    s = structures.build(name, MESHES[mesh]())
    assert isinstance(s, Navigable)
    if mesh in ("torus", "grid"):
        s.collapse_edge(next(e for e in s.edges().tolist() if s.can_collapse_edge(e)))
        for face in s.faces()[::-1].tolist():
            with suppress(TopologyError):
                s.remove_face(face)
                break
        s.split_edge(int(s.edges()[0]), (0, 0, 0))
    return s


def sides_of(s: Navigable) -> dict[tuple[int, int], int]:
    """The face of every directed side of a face."""
    rows = {f: s.face_vertices(f).tolist() for f in s.faces().tolist()}
    return {(row[i - 1], row[i]): f for f, row in rows.items() for i in range(len(row))}


def test_half_edges_are_the_sides_of_the_faces(walked: Navigable) -> None:
    s, sides = walked, sides_of(walked)
    inner = {}
    for h in s.half_edges().tolist():
        ends = s.origin(h), s.tip(h)
        if s.face(h) >= 0:
            inner[ends] = s.face(h)
            following = s.face_vertices(s.face(h)).tolist()
            after = following[(following.index(ends[1]) + 1) % len(following)]
            assert (s.origin(s.next(h)), s.tip(s.next(h))) == (ends[1], after)
            assert s.face(s.next(h)) == s.face(h)
        else:
            assert ends not in sides
        assert s.previous(s.next(h)) == h
        twin = s.twin(h)
        if twin >= 0:
            assert (s.tip(twin), s.origin(twin)) == ends
            assert s.twin(twin) == h
            assert s.edge(twin) == s.edge(h)
        else:
            assert ends[::-1] not in sides
        assert s.edge_vertices(s.edge(h)).tolist() == sorted(ends)
    assert inner == sides


def test_elements_lead_to_half_edges_of_theirs(walked: Navigable) -> None:
    s = walked
    for v in s.vertices().tolist():
        h = s.vertex_half_edge(v)
        assert (h < 0) == (not len(s.vertex_faces(v)))
        assert h < 0 or s.origin(h) == v
    for f in s.faces().tolist():
        assert s.face(s.face_half_edge(f)) == f


@pytest.mark.parametrize("name", STEPS)
def test_a_batch_is_its_single_steps(walked: Navigable, name: str) -> None:
    s, source = walked, STEPS[name].source
    handles = s.half_edges() if source == "half_edge" else s.handles(source)
    step = getattr(s, name)
    assert step(handles).tolist() == [step(int(it)) for it in handles]
    assert step(handles[:3].tolist()).tolist() == [step(it) for it in handles[:3]]
    assert step(handles[:0]).tolist() == step([]).tolist() == []


@pytest.mark.parametrize("name", STEPS)
def test_slices_of_a_batch_side_by_side_are_the_batch(walked: Navigable, name: str, monkeypatch):
    step, source = getattr(walked, name), STEPS[name].source
    handles = walked.half_edges() if source == "half_edge" else walked.handles(source)
    alone = step(handles)
    monkeypatch.setattr("hem.authoring.slices.slice_count", lambda n: min(n, 3) or 1)
    handles.flags.writeable = False  # others than the loop is compiled for
    for given in (handles, handles.astype(np.uint32), np.repeat(handles, 2)[::2], handles[:1]):
        assert np.array_equal(step(given), alone[: len(given)])
    for place in (0, len(handles) // 2, len(handles) - 1):
        with pytest.raises(MeshError, match="no such"):
            step(np.concatenate([handles[:place], [10**6], handles[place + 1 :]]))


@pytest.mark.parametrize("name", STEPS)
def test_what_is_no_half_edge_is_refused(walked: Navigable, name: str) -> None:
    s, step = walked, getattr(walked, name)
    for wrong in (-1, 10**6, 1 << 70, [0, -1], [10**6], 0.5, "0", None, [[0]]):
        with pytest.raises(MeshError):
            step(wrong)
    if STEPS[name].source == "half_edge":
        dead = np.setdiff1d(np.arange(s.half_edges()[-1]), s.half_edges())
        for h in dead[:3].tolist():
            with pytest.raises(MeshError, match="no such half-edge"):
                step(h)
