"""What is published beside what is sound: meshes of both, and what a run of them gave."""

from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import hem
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh

POINTS = np.vstack([np.eye(3), -np.eye(3)])
OCTAHEDRON = hem.TriangleMesh(
    POINTS, [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
)
TETRAHEDRON = hem.TriangleMesh(POINTS[:4], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
PAIR = hem.TriangleMesh(POINTS[:4], [(0, 1, 2), (1, 3, 2)])  # has outer edges that may collapse
TRIANGLE = hem.TriangleMesh(POINTS[:3], [(0, 1, 2)])
BOOK = hem.TriangleMesh(POINTS[:5], [(0, 1, 2), (1, 0, 3), (0, 1, 4)])  # three faces at one edge

MIDDLE = (0.25, 0.25, 0.5)  # a position in the octahedron where nothing is yet

SMALLER, LARGER = 100, 400  # vertices of the two tori whose work is compared: four times as many


class Shown(NamedTuple):
    """What a run gave: of what is published, of the sound version; whether it is an erratum."""

    printed: str
    sound: str
    confirmed: bool


def printed(mesh: hem.TriangleMesh = OCTAHEDRON, whole: bool = True) -> AsPrinted:
    """The mesh as the listings build it."""
    built = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=whole)
    built.generate_render_mesh()
    return built


def sound(mesh: hem.TriangleMesh = OCTAHEDRON) -> HalfEdgeMesh:
    """The same mesh as the sound version builds it."""
    return HalfEdgeMesh.build(mesh)


def faults_of(m: AsPrinted, about: str = "") -> tuple[Counter[str], str]:
    """What does not hold together, of what has ``about`` in its name; and the same in words."""
    faults = Counter({what: often for what, often in m.faults().items() if about in what})
    words = (f"{what}: {often}" for what, often in faults.items())
    return faults, "; ".join(words) or "nothing wrong"


def require_valid(s: HalfEdgeMesh) -> str:
    """What a mesh has; raises MeshError if it is not sound."""
    s.validate()
    return f"valid; faces: {s.n_faces}, edges: {s.n_edges}"


def attempt(call: Callable[[], object]) -> str:
    """What becomes of a call that should be refused."""
    try:
        call()
    except (hem.MeshError, hem.TopologyError) as error:
        return f"refused: {error.reason}"
    except AttributeError as error:
        return f"a null reference: {error}"
    return "done"
