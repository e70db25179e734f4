"""Quantities that no run has to measure: something is built and looked at, or counted in code.

A kernel's code is its own and that of all parts that it calls, each once, without docstrings.
"""

import ast
import inspect
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from typing import Any, NamedTuple

import numpy as np

import hem
import structures
from experiments.claims.beside import BOOK, MIDDLE, printed
from hem.authoring import Kernel
from hem.contract import QUERIES
from hem.engine import parts_of
from structures.object_tools import HalfEdgeMeshBuilder
from structures.plankton import Plankton

HALF, WINGED = "half_edge", "winged_edge"
HALF_EDGES = (HALF, "half_edge_objects", "plankton")

TOUCHING = hem.TriangleMesh(
    [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (1, 0, 0)],
    [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)],
)
"""A sheet of triangles around a vertex whose first and last side are at the same place."""


def books_built() -> Iterable[float]:
    """How many half-edge meshes accept three faces at one edge."""
    built = 0
    for name in HALF_EDGES:
        with suppress(hem.NonManifoldError):
            built += bool(structures.build(name, BOOK))
    yield built


def polygon_corners() -> Iterable[float]:
    """The corners of a face of a hundred that is built, asked for and taken away again."""
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    s = Plankton.uncompiled().build(hem.PolygonMesh(points, [list(range(100))]))
    s.validate()
    yield len(s.face_vertices(0))
    s.remove_face(0)
    s.validate()


def article_invariants() -> Iterable[float]:
    """The share of half-edges for which what the article says of them holds."""
    s = Plankton.uncompiled().build(hem.generate("grid", 100))
    for _ in range(2):
        holds = [
            s.start_vertex(h ^ 1) == s.start_vertex(s.next_half_edge(h))
            and (s.adjacent_face(h) >= 0 or s.outgoing_half_edge(s.start_vertex(h)) == h)
            for h in s.half_edges().tolist()
        ]
        yield float(np.mean(holds))
        s.collapse_edges(s.edges()[::5])
        s.split_all_faces()


def cube_vertices() -> Iterable[float]:
    """The vertices that the builder makes of a render mesh with a seam at every edge."""
    corner = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    indices = [4 * i + k for i in range(6) for k in (0, 2, 1, 0, 3, 2)]  # clockwise
    mesh = HalfEdgeMeshBuilder.from_render_mesh(corner[np.array(sides).ravel()], indices)
    yield mesh.n_vertices


def coincident_vertices(mesh: hem.TriangleMesh = TOUCHING) -> Iterable[float]:
    """The vertices at the position of another in a half-edge mesh that is built, and valid."""
    s = Plankton.uncompiled().build(mesh)
    s.validate()
    yield len(s.points) - len(np.unique(s.points, axis=0))


def outgoing_kept() -> Iterable[float]:
    """The share of vertices whose half-edge stays the same as a face closes the ring at them."""
    side = 6
    points = [(x, y, 0) for y in range(side) for x in range(side)]
    corners = [(i, i + 1, i + side) for i in range(side * (side - 1)) if (i + 1) % side]
    corners = [it for a, b, c in corners for it in ((a, b, c), (b, c + 1, c))]
    s, kept = Plankton.uncompiled().build(hem.PolygonMesh(points, corners[:1])), []
    for face in corners[1:]:
        before = {v: s.outgoing_half_edge(v) for v in face}
        s.add_face(*face)
        closed = [v for v in face if not s.vertex_naked_edges(v)]
        kept += [s.outgoing_half_edge(v) == before[v] for v in closed]
    yield float(np.mean(kept))


def half_edges_per_face(m: Any = None) -> Iterable[float]:
    """How many half-edges name each face of a mesh of objects, after a published split of one."""
    if m is None:
        m = printed()
        m.split_half_edge(m.half_edges[0], MIDDLE)
    naming = Counter(id(h.face) for h in m.half_edges)
    return [naming[id(face)] for face in m.faces]


def two_steps_back(mesh: Any = None) -> Iterable[float]:
    """The share of half-edges whose previous one, where it is recorded, is next of next."""
    s = Plankton.uncompiled().build(mesh or hem.generate("torus", 400))
    h = s.half_edges()
    yield float(np.mean(s.previous_half_edge(h) == s.next_half_edge(s.next_half_edge(h))))


def walks_without_test() -> Iterable[float]:
    """The edge-based structures whose walk around a vertex never asks whether it came round."""
    edge_based = (structures.REGISTRY[it] for it in (*HALF_EDGES, WINGED))
    walks = [it.kernels["vertex_faces"] for it in edge_based if it.compiled]
    yield sum(come_round_tests([walk]) == 0 for walk in walks)


@cache
def handling(*facts: str, mine: str = HALF) -> Iterable[float]:
    """Counts in the code of all queries and operations, by those of the winged-edge mesh."""
    kernels, others = (structures.REGISTRY[it].kernels for it in (mine, WINGED))
    names = [*QUERIES, *(it for it in kernels if it.endswith("_records"))]
    one, two = (code_facts(it[name] for name in names) for it in (kernels, others))
    return [getattr(one, fact) / getattr(two, fact) for fact in facts]


RECORDS = "m"  # what kernels call the records


class CodeFacts(NamedTuple):
    """Counts of what stands in the code.

    ``direction_tests``: kernels that compare what a record names with the vertex, edge or face that
    one comes from, to learn which way round the record lies. ``branches``: of ``if``, of
    conditional expressions and of loops that end by a condition. ``lines``: statements.
    """

    direction_tests: int
    branches: int
    lines: int


def code_facts(kernels: Iterable[Kernel]) -> CodeFacts:
    """The counts of some kernels together, each part once."""
    kernels = list(kernels)
    nodes, branches = list(_nodes(kernels)), (ast.If, ast.IfExp, ast.While)
    return CodeFacts(
        sum(any(map(_tests_direction, _nodes([it]))) for it in kernels),
        sum(isinstance(it, branches) for it in nodes),
        sum(isinstance(it, ast.stmt) and not _says_nothing(it) for it in nodes),
    )


def come_round_tests(kernels: Iterable[Kernel]) -> int:
    """How often a loop in some kernels asks whether it is back at where it began."""
    loops = (it for it in _nodes(kernels) if isinstance(it, ast.While))
    return sum(_compares(it, ast.Name) for loop in loops for it in ast.walk(loop))


def _nodes(kernels: Iterable[Kernel]) -> Iterator[ast.AST]:
    parts = {it.__code__: it for kernel in kernels for it in parts_of(kernel, set())}
    return (node for part in parts.values() for node in _nodes_of(part))


@cache
def _nodes_of(part: Kernel) -> list[ast.AST]:
    return [*ast.walk(ast.parse(textwrap.dedent(inspect.getsource(part))))]


def _tests_direction(it: ast.AST) -> bool:
    named = {n.id for n in ast.walk(it) if isinstance(n, ast.Name)}
    return _compares(it, ast.Subscript) and RECORDS in named


def _compares(it: ast.AST, sort: type[ast.expr]) -> bool:
    """Whether it says that something of a sort equals what has a name, or that it does not."""
    match it:
        case ast.Compare(left, [ast.Eq() | ast.NotEq()], [ast.Name()]):
            return isinstance(left, sort)
    return False


def _says_nothing(it: ast.stmt) -> bool:
    """Whether it is a docstring, or the head of a function."""
    quoted = isinstance(it, ast.Expr) and isinstance(it.value, ast.Constant)
    return quoted or isinstance(it, ast.FunctionDef)
