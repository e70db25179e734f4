"""Our own half-edge mesh, asked as the libraries are: through calls of Python."""

from functools import partial
from operator import attrgetter, methodcaller
from time import process_time
from typing import Any

import numpy as np

import hem
import structures
from experiments.harness import elements_at, time_rounds, took
from experiments.peers.peer import BATCHED, SIX, Mesh, Peer, Rows
from hem import algorithms
from hem.arrays import Array
from hem.contract import QUERIES

STRUCTURE = "half_edge"
"""Most of the libraries hold half-edges, too."""


def build(points: Array, triangles: Array, structure: str = STRUCTURE) -> Mesh:
    """One of our structures."""
    return structures.build(structure, hem.TriangleMesh(points, triangles))


def _handles(m: Mesh, element: str, numbers: list[int]) -> list[int]:
    """An edge is named by one of its half-edges."""
    return m.edges()[numbers].tolist() if element == "edge" else numbers


def _ask_all(query: str, m: Mesh) -> Rows:
    answer = getattr(m, query)()
    return answer.values, answer.offsets


def _one_by_one(operation: str, m: Mesh, handles: list[int], places: Array) -> int:
    edits = map(getattr(m, operation), handles, *([places] if operation in SPLIT else []))
    done = 0
    while True:
        try:
            for _ in edits:
                done += 1
            return done
        except hem.TopologyError:  # the next one is tried all the same
            continue


def _make_room(m: Mesh, many: int) -> None:
    m.reserve(many)
    m.split_face(0, m.points[0])  # compiles, and has the operations ready


def _all_at_once(operation: str, m: Mesh, handles: Any, places: Array) -> int:
    operate = getattr(m, f"{operation}s")
    return len(operate(handles, places)) if operation in SPLIT else int(operate(handles).sum())


def _simplify(m: Mesh, faces: int) -> int:
    algorithms.simplify(m, faces=faces)
    return int(m.n_faces)


def looped(
    points: Array, triangles: Array, few: int = 0, rounds: int = 0, whole: int = 0,
    structure: str = STRUCTURE,
) -> dict[str, Any]:  # fmt: skip
    """What compiled loops take, as ``program.cpp`` tells it of others."""
    s = build(points, triangles, structure)
    times = _times(s, few, rounds, whole)
    return {"times": times, "answers": {}, "operated": {}, "bytes": sum(s.memory().values())}


def _times(s: Mesh, few: int, rounds: int, whole: int) -> dict[str, list[float]]:
    """Algorithms and batches by all threads' time of the processor, as ``program.cpp`` takes it:
    other programs make little difference.
    """
    times = {}
    for query, it in QUERIES.items() if rounds else ():
        handles = np.random.default_rng(7).permutation(elements_at(s, it.source, few))[:ASKED]
        timed = time_rounds(s.prepare_sweep(query, handles).run, rounds=rounds)
        times[query] = (timed.samples / len(handles)).tolist()
    for name, algorithm in algorithms.SIX.items() if whole else ():
        copies = (s.copy() for _ in range(1 + whole))
        times[name] = [took(algorithm, it, clock=process_time)[1] for it in copies][1:]
    for name in BATCHED if whole else ():
        times[name] = [_seconds_each(name, s.copy()) for _ in range(1 + whole)][1:]
    return times


def _seconds_each(operation: str, s: Mesh) -> float:
    """Of a batch in random order, where there is room; those that are refused do not count."""
    every = s.handles(operation.split("_")[1])
    handles = np.random.default_rng(7).permutation(every)[:ASKED]
    places = np.broadcast_to(s.points[:1], (len(handles), 3)).copy()
    s.reserve(len(handles))
    done, seconds = took(_all_at_once, operation, s, handles, places, clock=process_time)
    return seconds / done


ASKED = 20_000
"""Elements in a round of a compiled loop, as in ``program.cpp``."""
SPLIT = "split_edge", "split_face"
PEER = Peer(
    title="Half-edge (ours)",
    distribution="hem-mesh",
    module="hem",
    site="",  # the one at hand
    manual="A call with one handle, or with all: the same method.",
    more="",
    build=build,
    faces=attrgetter("n_faces"),
    arrays=lambda m: attrgetter("points", "triangles")(m.to_triangles()),
    ends=methodcaller("edge_array"),
    handles=_handles,
    named=lambda m, edges: m.edge_vertices(edges).values.reshape(-1, 2),
    single={query: attrgetter(query) for query in QUERIES},
    bulk={query: partial(_ask_all, query) for query in QUERIES},
    operations={it: partial(_one_by_one, it) for it in (*SPLIT, "collapse_edge", "flip_edge")},
    batches={it: partial(_all_at_once, it) for it in BATCHED},
    make_room=_make_room,
    algorithms={
        "vertex_normals": algorithms.vertex_normals,
        "smooth": algorithms.smooth,
        "simplify": _simplify,
    },
    looped=looped,
    loops=(*QUERIES, *BATCHED, *SIX),
)
