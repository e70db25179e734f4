"""Meshes that a page lets one turn with the mouse: self-contained HTML that works from disk."""

from __future__ import annotations

import base64
import gzip
import json
from html import escape
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike

import hem
from experiments.report.mesh_figures import SAND
from hem.arrays import Array
from hem.fracture.show import FractureScene

_UPRIGHT = {"x": (1, 2, 0), "y": (0, 1, 2), "z": (1, 2, 0)}


def turnable_mesh(mesh: hem.TriangleMesh, caption: str, up: str = "y") -> str:
    """A mesh with its edges, to be turned with the mouse: HTML without anything from elsewhere.

    Arrow keys turn it, too, and the wheel zooms. Some 15 bytes a face. O(n).
    """
    still = np.zeros((1, 3))
    piece = np.zeros(len(mesh.points), int)
    return _figure(mesh.points, mesh.triangles, SAND, piece, still, up, caption, wires=True)


def turnable_pieces(scene: FractureScene, caption: str, up: str = "y") -> str:
    """The pieces of a fracture, to be turned with the mouse and moved apart with a slider. O(n)."""
    ways = scene.exploded(1.0) - scene.fracture.mass.centers
    return _figure(scene.points, scene.triangles, scene.colors, scene.piece, ways, up, caption)


def _figure(
    points: Array,
    triangles: Array,
    colors: ArrayLike,
    piece: Array,
    ways: Array,
    up: str,
    caption: str,
    wires: bool = False,
) -> str:
    order = list(_UPRIGHT[up])
    used = points[np.unique(triangles)]
    middle = (used.max(axis=0) + used.min(axis=0)) / 2
    reach = float(np.linalg.norm(used - middle, axis=1).max())
    placed = np.clip((points - middle) / reach, -1, 1)[:, order]
    tones = np.broadcast_to(np.asarray(colors, float), (len(triangles), 3))
    mesh = {
        "points": _packed(np.rint(placed * 32767), "<i2"),
        "triangles": _packed(triangles, "<u4"),
        "colors": _packed(np.rint(tones * 255), "<u1"),
        "piece": _packed(piece, "<u2"),
        "ways": _packed((ways / reach)[:, order], "<f4"),
        "wires": wires,
    }
    slider = '<br><label>apart <input type="range" min="0" max="100" value="0"></label>'
    script = (files("experiments.report") / "static" / "turnable.js").read_text("utf-8")
    return (
        '<figure class="turnable"><canvas tabindex="0" style="width:100%;max-width:640px;'
        'aspect-ratio:4/3;cursor:grab;touch-action:none;border-radius:8px" role="img" '
        f'aria-label="{escape(caption)}"></canvas>'
        f'<script type="application/json">{json.dumps(mesh)}</script>'
        f"{slider if len(ways) > 1 else ''}<figcaption>{escape(caption)}</figcaption></figure>"
        f"<script>{script}</script>"
    )


def _packed(numbers: ArrayLike, kind: str) -> str:
    packed = gzip.compress(np.ascontiguousarray(numbers, kind).tobytes(), mtime=0)
    return base64.b64encode(packed).decode()
