"""Meshes to be turned with the mouse: self-contained, and all of the mesh is there."""

import base64
import gzip
import json
import re

import numpy as np

import hem
from experiments.report.figures.fracture import broken_by_force, turnable_pieces
from experiments.report.figures.meshes import turnable
from tests.pictures import require_pictures


def packed(html: str, name: str, kind: str) -> np.ndarray:
    told = json.loads(re.search(r'json">(.*?)</script>', html).group(1))
    return np.frombuffer(gzip.decompress(base64.b64decode(told[name])), kind)


def test_a_page_holds_the_whole_mesh_upright_and_asks_for_nothing_else():
    mesh = hem.sample("teapot")
    html = turnable(mesh, "A <teapot>", up="z")
    assert "://" not in html
    assert "src=" not in html
    assert "A &lt;teapot&gt;" in html
    assert "<input" not in html
    np.testing.assert_array_equal(packed(html, "triangles", "<u4"), mesh.triangles.ravel())
    placed = packed(html, "points", "<i2").reshape(-1, 3) / 32767
    heights = placed[:, 1] - placed[:, 1].min()
    scale = np.ptp(mesh.points[:, 2]) / np.ptp(placed[:, 1])
    np.testing.assert_allclose(
        heights * scale, mesh.points[:, 2] - mesh.points[:, 2].min(), atol=1e-3
    )


def test_pieces_are_moved_apart_by_a_slider():
    require_pictures()
    (broken,) = broken_by_force("sphere:162", "stone", 2.0, method="tetra")
    html = turnable_pieces(broken)
    assert '<input type="range"' in html
    pieces = len(broken.fracture.pieces)
    assert len(packed(html, "ways", "<f4")) == 3 * pieces
    assert set(packed(html, "piece", "<u2").tolist()) == set(range(pieces))
    assert len(html) < 1_000_000
