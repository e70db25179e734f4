"""How often a program asks a mesh and operates on it: what ``hem.record`` counts.

Calls from Python are counted where they enter. What algorithms do is counted by running them
uncompiled, with kernels that count, so that the table of a workload is found and not typed.
"""

import csv
import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, partial
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hem.authoring import ELEMENTS, NEEDS_ROOM, OPERATIONS, QUERIES, Kernel, Kernels
from hem.contract.description import Algorithm
from hem.contract.structure import Structure
from hem.engine import CountingArray, interpreted, of_pythons_numbers
from hem.errors import MeshError, TopologyError
from hem.naming import look_up
from hem.whole_files import write_whole

COMPILED, PYTHON = "compiled", "python"
"""Where a question comes from: a compiled loop or a batch, or a single call from Python."""

ANEW = "neighbors_anew"  # a row: how often neighbors were needed for the first time after an edit
CHECKED = "can_"  # before an operation: tried and not done, being refused or only to be checked
BESIDE = ("face_left_of", "diamond", "are_joined")
"""Kernels that answer what takes looking at neighbors, beside the queries."""

EDITING = {"set_point": "move_vertex", "flip_records": "flip_edge"}
"""Kernels by which algorithms edit without an operation, and what they count as."""

APART = ("move_vertex", "add_vertex", "split_face")
"""Operations that ask for no neighbors."""

NEAR = 16  # handles no farther apart lie in the same or the next lines of a cache
BITS = 31  # a handle of an edge that takes more bits than these holds a second number in them


class Counted(NamedTuple):
    """How often something was asked or done; ``in_order``: the share that was next to the last."""

    what: str
    caller: str
    times: float
    in_order: float


class Recording:
    """What was counted on one mesh, see ``record``."""

    def __init__(self, s: Structure) -> None:
        self.vertices, self.faces = s.n_vertices, s.n_faces
        self._counts = {(ANEW, COMPILED): [0, 0]}  # said also where it never was so
        self._last: dict[str, int] = {}
        self._edited = False

    def __repr__(self) -> str:
        counted = (f"{it.times:,} × {it.what}" for it in self.rows if it.times)
        return f"<Recording of {', '.join(counted) or 'nothing'}>"

    def add(self, what: str, handles: Any, caller: str = PYTHON) -> None:
        """Count what was asked or done for one handle, or for an array of them."""
        if np.ndim(handles):
            wide = np.asarray(handles).astype(np.int64)
            near = np.abs(np.diff(np.where(wide >> BITS, wide >> BITS, wide))) <= NEAR
            if len(wide):  # nothing was asked, so no neighbors are needed anew
                self._add(what, COMPILED, len(wide), int(near.sum()))
        else:
            place = int(handles) >> BITS or int(handles)
            near_last = abs(place - self._last.get(what, place - NEAR - 1)) <= NEAR
            self._last[what] = place
            self._add(what, caller, 1, int(near_last))

    def _add(self, what: str, caller: str, times: int, near: int) -> None:
        if needs_neighbors(what):
            # Of a batch of edges each is looked at after the one before was edited.
            of_edges = is_edit(what) and OPERATIONS[what].element == "edge"
            if anew := self._edited + (times - 1) * of_edges:
                self._add(ANEW, COMPILED, anew, 0)
            self._edited = False
        self._edited |= is_edit(what)
        row = self._counts.setdefault((what, caller), [0, 0])
        row[0] += times
        row[1] += near

    @property
    def rows(self) -> list[Counted]:
        """What was counted, the most frequent first."""
        counts = sorted(self._counts.items(), key=lambda it: -it[1][0])
        return [
            Counted(what, caller, times, round(near / max(times, 1), 3))
            for (what, caller), (times, near) in counts
        ]

    def many(self, each: str) -> int:
        """How many elements of a kind the mesh had at first, 1 for none; MeshError for no kind."""
        known = {"vertex": self.vertices, "face": self.faces}
        return max(look_up(each, known, "element"), 1) if each else 1

    def text(self, each: str = "") -> str:
        """The rows as CSV, which ``hem advise`` reads: per mesh, or per ``vertex`` or ``face``.

        MeshError for another element.
        """
        many = self.many(each)
        lines = io.StringIO()
        out = csv.writer(lines, lineterminator="\n")
        out.writerow(("what", "times", "each", "in_order", "caller"))
        for it in self.rows:
            out.writerow((it.what, f"{it.times / many:.6g}", each, it.in_order, it.caller))
        return lines.getvalue()

    def save(self, path: str | Path, each: str = "") -> None:
        """Write ``text``. Raises OSError."""
        write_whole(Path(path), self.text(each))


def needs_neighbors(what: str) -> bool:
    """Whether an answer takes more than what an element is made of."""
    if what in QUERIES:
        source, target = map(list(ELEMENTS).index, QUERIES[what])
        return target >= source
    name = what.removeprefix(CHECKED)
    return name in BESIDE or (name in OPERATIONS and name not in APART)


def is_edit(what: str) -> bool:
    """Whether it is an operation that is done, after which neighbors are found anew."""
    return what in OPERATIONS and what != "move_vertex"


@contextmanager
def record(s: Structure) -> Iterator[Recording]:
    """Count what is asked of a mesh and done to it in the block -> a ``Recording``.

    >>> import hem, structures
    >>> s = structures.build("half_edge", hem.generate("torus", 100))
    >>> with hem.record(s) as workload:
    ...     hem.algorithms.smooth(s)

    ``workload.save("workload.csv", each="vertex")`` writes the table that ``hem advise`` reads.
    Algorithms run uncompiled meanwhile, some hundred times slower, with the same outcome: take a
    mesh of some hundred vertices. ``find_edge`` counts as the query that it searches by, and
    ``remove_vertex`` as the removal of its faces. What is read of the whole mesh at once
    (``edges()``, ``points``), steps along half-edges, and operations that polygons alone have are
    not counted. From one thread, and of one structure's meshes one at a time. Raises MeshError
    where the mesh is recorded already, and for what is no structure.
    """
    if not isinstance(s, Structure):
        raise MeshError(f"what is recorded is a structure, not {type(s).__name__}; build one")
    if "run" in vars(s):
        raise MeshError("this mesh is recorded already: end that recording first")
    found, before = Recording(s), dict(vars(s))
    own = {called: _counting(s, called, what, found) for called, what in _called(s)}
    own["run"] = partial(_run_counting, s, found)
    vars(s).update(own)
    try:
        yield found
    finally:
        for called in own:
            del vars(s)[called]
        vars(s).update({called: it for called, it in before.items() if called in own})


def _called(s: Structure) -> Iterator[tuple[str, str]]:
    """The methods that are counted, and as what."""
    named: dict[str, str] = {name: name for name in (*QUERIES, *OPERATIONS)}
    for name, it in OPERATIONS.items():
        named[CHECKED + name] = CHECKED + name
        named[f"{name.removesuffix(it.element)}{ELEMENTS[it.element]}"] = name  # split_edges
    named |= {"find_edge": "vertex_edges", "split_all_faces": "split_face", "operate": ""}
    named |= {"remove_vertex": "remove_face"}
    return ((called, what) for called, what in named.items() if hasattr(s, called))


def _counting(s: Structure, called: str, what: str, found: Recording) -> Callable[..., Any]:
    """A method that is counted as ``what``, or as what its first argument names."""
    method = getattr(s, called)
    known = signature(method)

    def counted(*args: Any, **more: Any) -> Any:
        bound = known.bind(*args, **more)  # in the method's order, what is named as well
        name, *given = (what, *bound.args) if what else bound.args
        if not what and name not in OPERATIONS:  # of polygons alone
            return method(*args, **more)
        try:
            result = method(*args, **more)
        except TopologyError:
            found.add(CHECKED + name.removeprefix(CHECKED), 0)
            raise
        handles = next(iter((*given, *bound.kwargs.values())), None)
        if handles is None:  # all there are
            handles = range(len(result))
        if called == "collapse_edges":  # those that were refused were looked at, and no more
            handles = np.asarray(handles)
            found.add(CHECKED + name, handles[~result])
            handles = handles[result]
        if called == "remove_vertex":
            handles = result.removed_faces
        single = called in OPERATIONS or called == "operate"  # of a point, if of no handle
        found.add(name, 0 if single and np.ndim(handles) else handles)
        return result

    return counted


# Algorithms ---------------------------------------------------------------------------------------


@cache
def _kernels(kind: type[Structure]) -> tuple[Kernels, Kernels, list[Recording | None]]:
    """Queries and operations, uncompiled, those that are counted telling ``found[0]``; and that.

    Made once, as algorithms keep what they make of kernels.
    """
    found: list[Recording | None] = [None]

    def counted(name: str, kernel: Kernel) -> Kernel:
        answer = interpreted(kernel)

        def ask(m: Any, handle: Any, *more: Any) -> Any:
            if found[0] is not None:
                found[0].add(name, int(handle), COMPILED)
            return answer(m, int(handle), *more)

        return ask

    def operated(name: str, kernel: Kernel) -> Kernel:
        perform = interpreted(kernel)

        def do(m: Any, args: Any, point: Any, at: Any, out: Any, log: Any, dry: bool) -> int:
            result = int(perform(m, args, point, at, out, log, dry))
            if found[0] is not None and result != NEEDS_ROOM:
                done = result >= 0 and not dry
                found[0].add(name if done else CHECKED + name, int(args[0]), COMPILED)
            return result

        return do

    kernels = kind.declared.kernels
    named = {it: it for it in (*QUERIES, *BESIDE)} | EDITING
    own = {it: counted(what, kernels[it]) for it, what in named.items() if it in kernels}
    done = {it: operated(it, uses.kernel) for it, uses in kind.declared.operating.items()}
    return {**kernels, **own}, done, found


@cache
def _algorithm(kind: type[Structure], make: Algorithm) -> Kernel:
    queries, operations, _ = _kernels(kind)
    return interpreted(make(queries, operations))


def _run_counting(s: Structure, recording: Recording, make: Algorithm, plan: Any) -> int:
    """``Structure.run``, uncompiled and counted."""
    (*_, found), algorithm = _kernels(type(s)), _algorithm(type(s), make)
    *arrays, counts = s.records
    seen = (CountingArray(it) if isinstance(it, np.ndarray) else it for it in arrays)
    found[0] = recording
    try:
        return int(algorithm(type(s.records)(*seen, counts), of_pythons_numbers(plan)))
    finally:
        found[0] = None
