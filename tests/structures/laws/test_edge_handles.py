"""A handle of an edge names that edge or nothing, and a batch works on the edges it was given."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import numpy as np
import pytest

import hem
import structures
from hem.authoring.marked import MARK, scatter
from tests.structures.conftest import octahedron, shuffled
from tests.structures.histories.actions import faces_of

NAMED_BY_ENDS = [
    name for name, it in structures.REGISTRY.items() if it.emulated or not it.stable_edge_handles
]
MOVING = [name for name, it in structures.REGISTRY.items() if not it.stable_edge_handles]
MESHES = {
    "torus": lambda: shuffled(hem.generate("torus", 100)),
    "grid": lambda: shuffled(hem.generate("grid", 64)),
}


def test_the_guide_names_the_structures_whose_edges_lose_their_handles():
    guide = (Path(__file__).parents[3] / "docs" / "choose.md").read_text("utf-8")
    named = re.search(r"Every structure but (.+?) keeps? the handle of an edge", guide)
    assert re.findall(r"`(\w+)`", named[1]) == MOVING


def test_a_batch_splits_the_edges_that_its_handles_named(s):
    ends = s.edge_array()
    middles = s.points[ends].mean(axis=1)
    new = s.split_edges(s.edges(), middles)
    for v, (a, b), middle in zip(new.tolist(), ends.tolist(), middles, strict=True):
        assert np.array_equal(s.points[v], middle)
        assert s.find_edge(a, b) is None
        assert s.find_edge(a, v) is not None
        assert s.find_edge(v, b) is not None
    s.validate()


@pytest.mark.parametrize("source", MESHES)
def test_edges_named_by_their_ends_are_collapsed_alike(source):
    """On each such structure in a batch as one by one."""
    meshes = []
    for name in NAMED_BY_ENDS:
        one, many = (structures.build(name, MESHES[source]()) for _ in range(2))
        keys = np.random.default_rng(3).permutation(np.sort(edge_keys(many)))
        pairs = [(int(key >> 32), int(key & 0xFFFFFFFF)) for key in keys]
        done = many.collapse_edges([many.find_edge(*pair) for pair in pairs])
        expected = []
        for a, b in pairs:
            edge = one.find_edge(a, b) if {a, b} <= {*one.vertices().tolist()} else None
            allowed = edge is not None and one.can_collapse_edge(edge)
            if allowed:
                one.collapse_edge(edge)
            expected.append(allowed)
        assert done.tolist() == expected
        assert sum(expected) > 10
        assert faces_of(one) == faces_of(many)
        many.validate()
        meshes.append(faces_of(many))
    assert all(mesh == meshes[0] for mesh in meshes)


def edge_keys(s: structures.Structure) -> np.ndarray:
    """The edges as ``smaller end << 32 | larger end``."""
    ends = s.edge_array().astype(np.int64)
    return ends[:, 0] << 32 | ends[:, 1]


def wild_edits(s: structures.Structure, rng: np.random.Generator) -> None:
    """Whatever moves half-edges."""
    kinds = ("split_edge", "collapse_edge", "flip_edge", "split_face", "remove_face")
    for kind in rng.choice(kinds, 40):
        element = s.edges() if kind.endswith("edge") else s.faces()
        with contextlib.suppress(hem.TopologyError):
            s.operate(kind, int(rng.choice(element)), point=(0, 0, 0))


@pytest.mark.parametrize("name", MOVING)
@pytest.mark.parametrize("source", MESHES)
def test_a_handle_that_has_moved_is_refused_and_no_other_edge(name, source):
    s, rng = structures.build(name, MESHES[source]()), np.random.default_rng(7)
    handles = s.edges().tolist()
    ends = dict(zip(handles, s.edge_vertices().to_list(), strict=True))
    wild_edits(s, rng)
    refused = set()
    for handle in handles:
        try:
            assert s.edge_vertices(handle).tolist() == ends[handle]
            assert s.find_edge(*ends[handle]) is not None
        except hem.MeshError:
            refused.add(handle)
    assert 10 < len(refused) < len(handles)
    for handle in refused:
        with pytest.raises(hem.TopologyError, match="no such edge"):
            s.split_edge(handle, (0, 0, 0))
        for query in ("edge_vertices", "edge_faces", "edge_edges"):
            with pytest.raises(hem.MeshError, match="no such edge"):
                getattr(s, query)([handle])
    assert not s.collapse_edges(sorted(refused)).any()
    s.validate()


@pytest.mark.parametrize("name", MOVING)
@pytest.mark.parametrize("source", MESHES)
def test_what_a_remapping_says_of_edges_stays_said_after_more_edits(name, source):
    s, rng = structures.build(name, MESHES[source]()), np.random.default_rng(5)
    gone = int(s.edges()[0])
    s.split_edge(gone, (0, 0, 0))
    wild_edits(s, rng)
    before, ends = s.edges(), s.edge_array()
    remapping = s.compact()
    assert np.array_equal(np.sort(remapping.edges(before)), np.sort(s.edges()))
    new = s.edge_vertices(remapping.edges(before)).values.reshape(-1, 2)
    assert np.array_equal(new, np.sort(remapping.vertices[ends]))
    assert remapping.edges([gone, -1, 1 << 62]).tolist() == [-1, -1, -1]
    told = remapping.edges(before)
    wild_edits(s, rng)
    assert np.array_equal(remapping.edges(before), told)


@pytest.mark.parametrize("name", MOVING)
def test_values_of_edges_are_written_to_by_either_handle_of_theirs(name):
    """A half-edge keeps its place, and its handle, where its twin moves before it."""
    s = structures.build(name, octahedron())
    crease = s.edge_attribute("crease", np.int64)
    crease[s.edges()] = 1 + np.arange(s.n_edges)
    heard = []
    crease.subscribe(lambda handles: heard.extend(handles.tolist()))
    edge = int(s.edges()[4])
    crease[edge] = 50
    assert heard == [edge]
    assert crease[[edge]].tolist() == [crease[edge]] == [50]
    faces = s.faces()
    s.remove_face(int(s.edge_faces(edge)[0]))
    again = s.find_edge(*s.edge_array()[np.flatnonzero(crease[s.edges()] == 50)[0]].tolist())
    assert crease[again] == 50
    assert len(faces) == s.n_faces + 1


def test_no_two_vertices_are_scattered_alike():
    """By taking the steps back, and so edges with a common end have different marks."""
    v = np.append(np.arange(100_000), MARK - np.arange(100_000))
    found = scatter(v.astype(np.int64))
    assert len(np.unique(found)) == len(np.unique(v))
    assert found.min() >= 0
    assert found.max() <= MARK
    back = found ^ (found >> 16)
    back = (back * pow(0x119DE1F3, -1, MARK + 1)) & MARK
    back = back ^ (back >> 15) ^ (back >> 30)
    back = (back * pow(0x45D9F3B, -1, MARK + 1)) & MARK
    assert np.array_equal(back, v)
