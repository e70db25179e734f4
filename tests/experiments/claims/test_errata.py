"""Every erratum is shown by a run of what is printed, beside one of what is sound."""

import re

import numpy as np
import pytest

import hem
import structures
from experiments.claims.beside import OCTAHEDRON, printed, sound
from experiments.claims.errata import ERRATA, KNOWN
from structures.as_printed import AsPrinted, render_arrays
from structures.printed_breaking import (
    breaking_points,
    face_containing,
    find_edges,
    quad,
    quoted_circulator,
    simulate_breaking,
)


@pytest.mark.parametrize("number", range(len(ERRATA)))
def test_an_erratum_shows_when_the_listing_is_run(number):
    shown = ERRATA[number].show()
    assert not re.match(r"1 [\w-]+s ", shown.printed), "one of several"
    assert shown.confirmed, f"{ERRATA[number].title}: {shown.printed} beside {shown.sound}"


# The numbers of what is shown, as the listings and as sound versions give them by hand: of an
# octahedron of 6 vertices, 12 edges and 8 faces, of tori of 100 and 400 vertices, of a grid.
COUNTED = {
    "The builder loses the last triangle": ([8 - 1, 3], [8, 0]),
    "A split moves a half-edge into a face that it does not know of": ([2 * 2], [8 + 2, 12 + 3]),
    "A collapse clears the very pairs it has just made": ([2 * 2], [8 - 2, 12 - 3]),
    "Split face commits when it should not": ([0, 1], [1, 0]),
    "A border edge cannot be collapsed": ([], [2 - 1, 5 - 2]),
    "A split at an existing position welds": ([6], [6 + 1]),
    "Every split hands over the whole render mesh": ([3 * 202, 3 * 802], [15, 15]),
    "Indices collide after a removal": ([3 + 1], [7 + 2, 12 + 3]),
    "After a collapse the render mesh shows other points": ([3 * 6, 3 * 6], [6]),
    "Vertices without faces are never removed": ([3], [3]),
    "Plankton's circulator takes many edges for a runaway": ([1001, 2000], [2000]),
    "Plankton's circulator does not need a closed mesh": ([], [4 * 19]),
    "Breaking leaves a part of every split face behind": ([2 + 2 * 3, 1], [0]),
    "Twice as many vertices as triangles": ([2], [2]),
    "The bytes leave out what the classes have": ([228], [48 + 6 * 56 + 2 * 32 + 9 * 8]),
    "The text promises of winged edges what table 1 does not": ([2, 8, 2, 64], [18, 130, 1]),
    "Break points keep the height of the impact": ([88, 88, 0], [88, 88, 88]),
    "A guard lets the count itself through": ([24, 23], []),
    "The bytes are those of closed meshes": (
        [1083, 20 * 400 + 8 * 722 + 64 * 1083, 7, 3, 400], [1121, 83_088 + 64 * 38, 214, 228]
    ),
    "Points may coincide in a half-edge mesh": ([1], [0]),
}  # fmt: skip


@pytest.mark.parametrize("title", COUNTED)
def test_an_erratum_tells_what_counting_by_hand_gives(title):
    shown = next(it.show() for it in ERRATA if it.title == title)
    told = [re.findall(r"\d[\d,]*", it) for it in (shown.printed, shown.sound)]
    assert tuple([int(it.replace(",", "")) for it in row] for row in told) == COUNTED[title]


def test_as_many_points_of_a_disc_lie_in_a_smaller_one_as_its_area_has_a_share():
    shown = next(it.show() for it in ERRATA if it.title == "Circles are discs")
    share = (3.5 / 4.5) ** 2  # the last two of glass
    for told in (shown.printed, shown.sound):
        inside, count = map(int, re.findall(r"\d+", told))
        assert count == 24
        assert abs(inside - 24 * share) < 2.5 * (24 * share * (1 - share)) ** 0.5


def test_a_walk_is_shown_to_come_round_by_running_the_one_that_is_quoted(monkeypatch):
    def giving_up(s, half_edge):
        yield half_edge

    monkeypatch.setattr("structures.printed_breaking.quoted_circulator", giving_up)
    shown = next(it.show() for it in ERRATA if "does not need a closed mesh" in it.title)
    assert not shown.confirmed


def test_vertices_that_lose_their_half_edge_are_told_as_the_listing_leaves_them():
    sides = [[(a, c), (c, b), (b, a)] for a, b, c in OCTAHEDRON.triangles.tolist()]  # clockwise
    kept = {h[0]: k for k, face in enumerate(sides) for h in face}  # the face of its last half-edge
    face_of = {h: k for k, face in enumerate(sides) for h in face}
    gone = (({face_of[a, b], face_of[b, a]}, a) for a, b in face_of)
    keep = sum(any(kept[v] in faces for v in kept if v != end) for faces, end in gone)
    shown = next(it.show() for it in ERRATA if "keeps a half-edge that is gone" in it.title)
    assert shown.printed.startswith(f"after {keep} of {len(face_of)} collapses")


def test_the_known_ones_come_first_and_each_has_a_source():
    assert len(ERRATA) > KNOWN == 9
    assert len({it.title for it in ERRATA}) == len(ERRATA)
    assert all(it.source.startswith(("thesis", "quoted in thesis", "article")) for it in ERRATA)


def test_what_the_listings_build_is_sound_but_for_the_last_triangle():
    m = printed()
    assert not m.faults()
    corners = {frozenset(h.origin.index for h in m.face_circulator(f)) for f in m.faces}
    s = sound()
    assert corners == {frozenset(s.face_vertices(f).tolist()) for f in s.faces().tolist()}


def test_the_builder_welds_as_the_sound_one_does():
    mesh = OCTAHEDRON
    apart = np.arange(24).reshape(8, 3)  # every face has corners of its own
    soup = AsPrinted.build(*render_arrays(mesh.points[mesh.triangles.ravel()], apart), whole=True)
    assert (len(soup.vertices), len(soup.faces)) == (6, 8)
    soup.generate_render_mesh()
    assert not soup.faults()


def test_splitting_a_face_as_printed_keeps_the_references():
    m = printed()
    m.split_face(m.faces[0], (9.0, 9.0, 9.0))
    assert not m.faults()
    assert (len(m.vertices), len(m.half_edges), len(m.faces)) == (7, 30, 10)


def test_the_counter_of_faults_finds_none_in_a_mesh_without_any():
    assert printed(hem.generate("grid", 49)).faults() == {}


def test_a_triangle_that_is_created_is_that_of_its_corners_and_is_rendered():
    corners = [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)]
    m = AsPrinted()
    m.create_mesh(*corners)
    assert not m.faults()
    assert (len(m.vertices), len(m.half_edges), len(m.faces)) == (3, 3, 1)
    assert [m.render.points[it] for it in m.render.committed] == corners


def test_the_square_that_is_created_is_two_triangles_that_face_one_way():
    mesh = hem.mesh_from_render(*quad())
    sides = mesh.points[mesh.triangles[:, 1:]] - mesh.points[mesh.triangles[:, :1]]
    normals = np.cross(sides[:, 0], sides[:, 1])
    assert normals.tolist() == [[0, 0, 1]] * 2
    assert not printed(mesh).faults()


@pytest.mark.parametrize("family", ["torus", "grid"])
def test_the_search_finds_the_faces_that_have_both_corners(family):
    triangles = hem.generate(family, 49).triangles
    for a, b in [(0, 1), (5, 6), (1, 8), (3, 3 + 20)]:
        both = np.flatnonzero((triangles == a).any(axis=1) & (triangles == b).any(axis=1))
        assert find_edges(triangles.reshape(-1), a, b) == (3 * both).tolist()


def flat(n: int = 100) -> hem.TriangleMesh:
    """A square of ten units, level."""
    mesh = hem.generate("grid", n)
    points = np.zeros_like(mesh.points)
    points[:, [0, 2]] = 10 * mesh.points[:, :2]
    return hem.TriangleMesh(points, mesh.triangles)


def area_of(triangles) -> float:
    corners = np.array(triangles)
    sides = corners[:, 1:] - corners[:, :1]
    return float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2)


def test_the_shards_and_the_rest_are_the_surface_that_was_broken():
    m = printed(flat())
    shards = simulate_breaking(m, (-4.7, 0.0, 5.2), (5, 6))
    pieces = [[it.render.points[k] for k in it.render.committed] for it in shards]
    rest = [[h.origin.point for h in m.face_circulator(face)] for face in m.faces]
    assert len(shards) == 8 + 2 * 11
    assert area_of([*pieces, *rest]) == pytest.approx(100)


def test_break_points_lie_in_their_circles_at_the_height_of_the_impact():
    circles = (5, 60, 7)
    points = np.array(breaking_points((1.0, 2.0, 3.0), circles, seed=4))
    far = np.linalg.norm(points - (1, 2, 3), axis=1)
    assert np.allclose(points[:, 1], 2)
    assert (far <= np.repeat([0.5, 1.5, 2.5], circles)).all()
    assert points.tolist() != np.array(breaking_points((1.0, 2.0, 3.0), circles, seed=5)).tolist()


def test_a_face_contains_what_lies_between_its_corners_and_nothing_beside_it():
    m = printed(flat())
    rng = np.random.default_rng(5)
    for face in m.faces[::7]:
        corners = np.array([h.origin.point for h in m.face_circulator(face)])
        inside = rng.dirichlet((2, 2, 2)) @ corners
        assert face_containing(m, tuple(inside)) is face
        assert face_containing(m, tuple(inside + np.array([0, 0.1, 0]))) is None
    assert face_containing(m, (5.0, 0.0, 5.0)) is None


def test_the_quoted_circulator_meets_every_half_edge_that_leaves_a_vertex():
    s = structures.build("plankton", OCTAHEDRON)
    for v in s.vertices().tolist():
        met = list(quoted_circulator(s, s.outgoing_half_edge(v)))
        starts = [h for h in s.half_edges().tolist() if s.start_vertex(h) == v]
        assert sorted(met) == starts
