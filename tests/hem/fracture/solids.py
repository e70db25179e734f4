"""Bodies to break, and truths about pieces that owe nothing to the code under test."""

from functools import cache

import numpy as np
import pytest
import trimesh

import hem
from hem.fracture.bodies.solid import Body, require_body, wrapped
from hem.meshes.edges import undirected_edges
from hem.meshes.manifold import same_way_edges


def box(*size, at=(0.0, 0.0, 0.0)):
    made = trimesh.creation.box(size)
    return hem.TriangleMesh(made.vertices + at, made.faces)


def together(*meshes):
    starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    return hem.TriangleMesh(
        np.concatenate([mesh.points for mesh in meshes]),
        np.concatenate([m.triangles + s for m, s in zip(meshes, starts, strict=False)]),
    )


def hollow_sphere():
    outer = hem.generate("sphere", 400)
    return together(outer, hem.TriangleMesh(outer.points * 0.6, outer.triangles).flipped())


def dumbbell():
    """Two cubes that a bar of 0.2 × 0.2 holds together, along x."""
    from manifold3d import Manifold

    ends = [Manifold.cube((1, 1, 1), True).translate((x, 0, 0)) for x in (-1.5, 1.5)]
    made = (ends[0] + ends[1] + Manifold.cube((3, 0.2, 0.2), True)).to_mesh64()
    return hem.TriangleMesh(np.asarray(made.vert_properties)[:, :3], np.asarray(made.tri_verts))


_MAKE = {
    "plate": lambda: box(4, 4, 0.3),
    "sphere": lambda: hem.generate("sphere", 400),
    "bunny": lambda: hem.sample("bunny"),
    "teapot": lambda: wrapped(hem.sample("teapot"), detail=0.03),
}
NAMES = tuple(_MAKE)


@cache
def body(name) -> Body:
    return require_body(_MAKE[name]())


def spot(mesh, seed):
    """Somewhere on the surface."""
    random = np.random.default_rng(seed)
    corners = mesh.points.astype(float)[mesh.triangles]
    return random.dirichlet(np.ones(3)) @ corners[random.integers(len(corners))]


def as_trimesh(mesh, density=1.0):
    made = trimesh.Trimesh(mesh.points.astype(float), mesh.triangles, process=False)
    made.density = density
    return made


def solid_angles(mesh, at):
    """How often a surface winds around positions, as the solid angle it fills (van Oosterom)."""
    found = np.zeros(len(at))
    corners = mesh.points.astype(float)[mesh.triangles]
    for i, p in enumerate(at):
        a, b, c = (corners - p).transpose(1, 0, 2)
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        triple = np.einsum("ij,ij->i", a, np.cross(b, c))
        dots = (
            la * lb * lc
            + np.einsum("ij,ij->i", a, b) * lc
            + np.einsum("ij,ij->i", b, c) * la
            + np.einsum("ij,ij->i", c, a) * lb
        )
        found[i] = np.arctan2(triple, dots).sum() / (2 * np.pi)
    return found


def holders(pieces, at):
    """(k, n) bool: which pieces hold which positions."""
    found = np.zeros((len(at), len(pieces)), bool)
    for j, piece in enumerate(pieces):
        near = ((at >= piece.points.min(axis=0)) & (at <= piece.points.max(axis=0))).all(axis=1)
        found[near, j] = solid_angles(piece, at[near]) > 0.5
    return found


def inside(body, count, seed):
    """Positions evenly inside a body, (count, 3)."""
    random, found = np.random.default_rng(seed), np.zeros((0, 3))
    low, high = body.mesh.points.min(axis=0), body.mesh.points.max(axis=0)
    while len(found) < count:
        at = low + (high - low) * random.random((count, 3))
        found = np.concatenate([found, at[solid_angles(body.mesh, at) > 0.5]])
    return found[:count]


def require_pieces(fracture, it):
    """Every piece is a closed, outward body, and together they weigh what the body does."""
    volumes = []
    for piece in fracture.pieces:
        assert (undirected_edges(piece.triangles)[1] == 2).all()
        assert not len(same_way_edges(piece.triangles))
        truth = as_trimesh(piece)
        assert truth.is_watertight
        assert truth.is_winding_consistent
        volumes.append(truth.volume)
    assert min(volumes) > 0
    assert sum(volumes) == pytest.approx(it.volume, rel=1e-6)
    np.testing.assert_allclose(fracture.mass.volumes, volumes, rtol=1e-6)
    of_rest = volumes[len(fracture.shards) :]
    assert of_rest == sorted(of_rest, reverse=True)
