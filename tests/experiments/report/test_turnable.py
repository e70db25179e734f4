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
    assert "<noscript>" in html, "without scripts there is an empty box"
    np.testing.assert_array_equal(packed(html, "triangles", "<u4"), mesh.triangles.ravel())
    placed = packed(html, "points", "<i2").reshape(-1, 3) / 32767
    heights = placed[:, 1] - placed[:, 1].min()
    scale = np.ptp(mesh.points[:, 2]) / np.ptp(placed[:, 1])
    np.testing.assert_allclose(
        heights * scale, mesh.points[:, 2] - mesh.points[:, 2].min(), atol=1e-3
    )


NO_CARD = """
var seen = {};
const nothing = new Proxy({}, { get: (_, name) => (...its) => {
    if (name === "getUniformLocation") return its[1];
    if (name.startsWith("uniform")) seen[its[0]] = [...its.slice(1)].flat();
} });
HTMLCanvasElement.prototype.getContext = () => nothing;
"""
"""Instead of a graphics card: ``seen`` is what it is told last."""


def test_a_mesh_is_turned_and_approached_by_the_keyboard_and_stays_upright(chromium, tmp_path):
    page = tmp_path / "mesh.html"
    html = turnable(hem.sample("teapot"), "The teapot", up="z")
    page.write_text(f"<meta charset=utf-8><script>{NO_CARD}</script>{html}", "utf-8")
    chromium.errors.clear()
    chromium.open(page.as_uri())
    chromium.run("new Promise(done => setInterval(() => seen.zoom && done(1), 20))")
    chromium.run("document.querySelector('canvas').focus()")
    turned = []
    for key in (["ArrowUp"] * 40, ["ArrowDown"] * 80, ["ArrowLeft"]):
        for it in key:
            chromium.call("Input.dispatchKeyEvent", type="keyDown", key=it)
        turned.append(chromium.run("seen.turn.slice(-9)"))
        assert turned[-1][4] > 0, "the mesh stands on its head"  # what is left of its height
    assert len({tuple(it) for it in turned}) == 3
    zooms = [chromium.run("seen.zoom[0]")]
    for key in "+-":
        chromium.call("Input.dispatchKeyEvent", type="keyDown", key=key)
        zooms.append(chromium.run("seen.zoom[0]"))
    assert zooms[0] < zooms[1] > zooms[2]
    assert chromium.errors == []


def test_pieces_are_moved_apart_by_a_slider():
    require_pictures()
    (broken,) = broken_by_force("sphere:162", "stone", 2.0, method="tetra")
    html = turnable_pieces(broken)
    assert '<input type="range"' in html
    pieces = len(broken.fracture.pieces)
    assert len(packed(html, "ways", "<f4")) == 3 * pieces
    assert set(packed(html, "piece", "<u2").tolist()) == set(range(pieces))
    assert len(html) < 1_000_000
