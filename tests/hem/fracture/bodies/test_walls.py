import numpy as np
import pytest
from manifold3d import Manifold
from scipy.spatial import cKDTree

import hem
from hem.fracture.bodies.solid import require_body
from hem.fracture.bodies.voronoi import voronoi
from hem.fracture.bodies.walls import touching
from tests.extent import waiting_for
from tests.hem.fracture.solids import (
    body,
    box,
    dumbbell,
    holders,
    hollow_sphere,
    require_pieces,
    spot,
)


def probed(pieces, size):
    """The pairs of pieces that face each other across some triangle, by looking what is there."""
    pairs, step = set(), 2e-6 * size
    for i, piece in enumerate(pieces):
        corners = piece.points.astype(float)[piece.triangles]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        double = np.linalg.norm(normal, axis=1)
        large = double > 1e-6 * size**2
        at = corners[large].mean(axis=1) + step * normal[large] / double[large, None]
        held = holders(pieces, at)
        pairs |= {(min(i, j), max(i, j)) for j in np.flatnonzero(held.any(axis=0)).tolist()}
    return {pair for pair in pairs if pair[0] != pair[1]}


@pytest.mark.parametrize(
    "name", waiting_for(["plate", "dumbbell"], ["plate", "sphere", "dumbbell", "hollow"])
)
def test_neighbors_are_those_that_face_each_other(name):
    made = {"dumbbell": dumbbell, "hollow": hollow_sphere}
    it = require_body(made[name]()) if name in made else body(name)
    found = voronoi(it, spot(it.mesh, 3), "stone", 4.0, 3)
    neighbors = {tuple(pair) for pair in found.neighbors.tolist()}
    assert found.neighbors.tolist() == sorted(map(list, neighbors))
    truth = probed(found.pieces, it.diagonal)
    assert truth <= neighbors
    # What is missed among the probes touches along too little for them, but does touch.
    assert len(neighbors - truth) <= 0.05 * len(neighbors)
    for a, b in neighbors - truth:
        apart, _ = cKDTree(found.pieces[a].points).query(found.pieces[b].points)
        assert apart.min() < 1e-5 * it.diagonal


@pytest.mark.parametrize("axis", range(3))
def test_cells_in_several_parts_have_neighbors_of_their_own(axis):
    # A frame with a larger and a smaller arm: the cells of the middle have a part in each.
    hole = Manifold.cube((2.5, 1, 3), True).translate((0, 0.2, 0))
    made = (Manifold.cube((3, 3, 1), True) - hole).to_mesh64()
    points = np.roll(np.asarray(made.vert_properties)[:, :3], axis, axis=1)
    frame = hem.TriangleMesh(points, np.asarray(made.tri_verts))
    sites = np.roll([(x, 0, 0) for x in (-1.2, -0.4, 0.4, 1.2)], axis, axis=1)
    found = voronoi(frame, np.roll((0, 1.5, 0), axis), "wood", sites=sites)
    require_pieces(found, require_body(frame))
    # left | two of either arm | right
    assert len(found.shards) == 6
    assert found.neighbors.tolist() == [[0, 1], [0, 2], [1, 3], [2, 4], [3, 5], [4, 5]]


@pytest.mark.parametrize("wall", [0, 7])
def test_boxes_on_either_side_of_a_wall_touch_where_they_have_enough_of_it_in_common(wall):
    boxes = [box(1, 1, 1), box(1, 1, 1, at=(1, 0, 0))]
    between = [(it.points[it.triangles][:, :, 0] == 0.5).all(axis=1) for it in boxes]
    labels = [np.where(it, wall, -1) for it in between]
    assert touching(boxes, labels, 0.9).tolist() == [[0, 1]]
    assert touching(boxes, labels, 1.1).tolist() == []


@pytest.mark.parametrize("axis", range(3))
def test_of_many_boxes_at_a_wall_those_touch_that_are_opposite(axis):
    made = [box(1, 1, 1, at=(x, y, z)) for x in (-0.5, 0.5) for y in (0, 1, 2) for z in (0, 1)]
    labels = [np.where((it.points[it.triangles][:, :, 0] == 0).all(axis=1), 1, -1) for it in made]
    turned = [hem.TriangleMesh(np.roll(it.points, axis, axis=1), it.triangles) for it in made]
    assert touching(turned, labels, 0.9).tolist() == [[i, i + 6] for i in range(6)]


def test_a_body_in_one_piece_has_no_neighbors():
    assert voronoi(body("plate"), (0, 0, 1), sites=[(0, 0, 0)]).neighbors.shape == (0, 2)
