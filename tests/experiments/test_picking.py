"""What a ray hits, against every triangle looked at by itself."""

import numpy as np
import pytest

import hem
import structures
from experiments import bench_picking
from experiments.bench_picking import NEIGHBORS, Picker, aimed, ask_compiled, ask_from_python
from experiments.harness import BASE, time_rounds
from experiments.presets import PRESETS
from experiments.report.figures import real_time
from experiments.report.session import MissingError
from experiments.runs import CaseFile, describe, load, write_meta
from tests.extent import OF_EACH_KIND, waiting_for


@pytest.fixture(scope="module", autouse=True)
def _warp():
    pytest.importorskip("warp")


def nearest(s, origin, direction):
    """The first face that a ray hits, by Cramer's rule in float64 on all triangles; or -1."""
    faces = s.faces()
    a, b, c = s.points.astype(np.float64)[s.triangles()].transpose(1, 0, 2)
    sides = np.stack([b - a, c - a, np.broadcast_to(-direction, a.shape)], axis=2)
    flat = np.abs(np.linalg.det(sides)) < 1e-14
    sides[flat] = np.eye(3)
    u, v, far = np.linalg.solve(sides, (origin - a)[:, :, None])[:, :, 0].T
    hit = ~flat & (u > 0) & (v > 0) & (u + v < 1) & (far > 0)
    return int(faces[np.where(hit, far, np.inf).argmin()]) if hit.any() else -1


def rays(s, seed):
    """To the middle of faces, and past the mesh."""
    away = np.random.default_rng(seed).normal(size=(20, 3))
    eye = aimed(s, 1)[0][0]
    return [*aimed(s, 60), *((eye, it) for it in away)]


def edit(s, rng, count):
    for _ in range(count):
        face = int(rng.choice(s.faces()))
        center = s.points[s.face_vertices(face)].mean(axis=0)
        s.split_face(face, center * rng.uniform(0.95, 1.05, 3))
        edges = s.edges()
        allowed = {"flip_edge": s.can_flip_edge, "collapse_edge": s.can_collapse_edge}
        for operation, may in allowed.items():
            edge = int(rng.choice(edges))
            if edge in s.edges() and may(edge):
                s.operate(operation, edge)
        s.move_vertex(int(rng.choice(s.vertices())), rng.uniform(-1, 1, 3))


@pytest.mark.parametrize("follow", [Picker.refit, Picker.rebuild])
@pytest.mark.parametrize("name", ["half_edge", "directed_edge", "indexed"])
def test_a_ray_hits_the_nearest_face_whatever_was_done_before(name, follow):
    s, rng = structures.build(name, hem.generate("torus", 400)), np.random.default_rng(5)
    picker = Picker(hem.RenderMesh(s), room=20)
    for edits in (0, 1, 5, 10, 40, 5):  # more than there is room for, in the end
        edit(s, rng, edits)
        if edits == 10:
            s.compact()
        follow(picker)
        every = rays(s, edits)
        hits = [picker.face(*ray) for ray in every]
        assert hits == [nearest(s, *ray) for ray in every]
        assert -1 in hits
        assert len(set(hits)) > 30


def test_without_the_package_no_ray_is_cast_and_the_chapter_says_why(monkeypatch, tmp_path):
    monkeypatch.setattr(bench_picking, "find_spec", lambda name: None)
    preset = PRESETS["smoke"]
    every = bench_picking.cases(preset, BASE)
    measured = [bench_picking.measure(it, preset, time_rounds) for it in every]
    assert {it.subject for it in measured if not it.skipped} == {NEIGHBORS}
    write_meta(tmp_path, describe("smoke"))
    CaseFile(tmp_path, "bench_picking", BASE).add(*measured)
    with pytest.raises(MissingError, match="warp-lang, which is not installed"):
        real_time.picks_in_words(load(tmp_path))


@pytest.mark.parametrize("name", waiting_for(OF_EACH_KIND, structures.NAMES))
def test_as_many_are_found_around_picked_faces_as_the_triangles_say(name):
    mesh = hem.generate("grid", 100)
    s = structures.build(name, mesh)
    faces = s.faces()[:: len(s.faces()) // 7]
    shared = (mesh.triangles[:, :, None] == mesh.triangles[faces].reshape(-1)).any(axis=1)
    shared = shared.reshape(len(mesh.triangles), len(faces), 3)  # faces, picks, corners
    expected = int(shared.sum() + (shared.sum(axis=2) == 2).sum())
    for ask in (ask_from_python, *([ask_compiled] if s.compiled else [])):
        assert ask(s, faces) == expected
