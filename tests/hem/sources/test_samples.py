"""The real models are what they are said to be."""

from pathlib import Path

import numpy as np
import pytest

import hem
from hem.sources import samples

# vertices, faces, vertices without faces, border edges
KNOWN = {
    "bunny": (28_088, 56_172, 0, 0),
    "cow": (2_904, 5_804, 0, 0),
    "airplane": (7_017, 10_796, 1_617, 0),
    "bone": (1_872, 3_022, 359, 0),
    "face": (85_849, 166_259, 667, 4_117),
    "teapot": (3_242, 6_320, 0, 160),
}
SPLIT_IN_FACE = [1850, 11626, 34458, 61324, 69976, 73855]


@pytest.mark.parametrize("name", hem.SAMPLES)
def test_a_model_has_its_known_counts(name: str) -> None:
    summary = hem.sample(name).summary()
    counts = summary.vertices, summary.faces, summary.unreferenced, summary.border_edges
    assert counts == KNOWN[name]


@pytest.mark.parametrize("name", sorted(set(hem.SAMPLES) - {"face"}))
def test_all_but_the_scanned_face_are_surfaces(name: str) -> None:
    hem.require_manifold(hem.sample(name))


def test_the_scanned_face_is_refused_with_exactly_its_six_vertices() -> None:
    with pytest.raises(hem.NonManifoldError) as refusal:
        hem.require_manifold(hem.sample("face"))
    assert refusal.value.elements["vertices"].tolist() == SPLIT_IN_FACE
    assert "edges" not in refusal.value.elements


def test_the_repaired_face_gains_one_vertex_for_each_of_the_six() -> None:
    face, mended = hem.sample("face"), hem.sample("face", repair=True)
    hem.require_manifold(mended)
    assert np.array_equal(mended.points[: len(face.points)], face.points)
    assert np.array_equal(mended.points[len(face.points) :], face.points[SPLIT_IN_FACE])
    assert np.array_equal(mended.points[mended.triangles], face.points[face.triangles])


def test_repairing_a_surface_changes_nothing() -> None:
    whole, mended = hem.sample("airplane"), hem.sample("airplane", repair=True)
    assert np.array_equal(whole.points, mended.points)
    assert np.array_equal(whole.triangles, mended.triangles)


def test_an_unknown_model_names_those_there_are() -> None:
    with pytest.raises(hem.MeshError, match=r"bunny, cow, .*did you mean 'bunny'"):
        hem.sample("bunnny")


def test_a_pymeshlab_without_models_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Elsewhere:
        origin = str(tmp_path / "__init__.py")

    monkeypatch.setattr(samples, "find_spec", lambda name: Elsewhere)
    with pytest.raises(hem.MeshError, match="without its sample meshes"):
        hem.sample("cow")
