"""What the file of a library declares of it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from typing import Any

from experiments.harness import OPERATIONS
from hem import algorithms
from hem.arrays import Array
from hem.contract import QUERIES

Mesh = Any
"""A library's own mesh, whatever that is."""
Rows = Any
"""What a library answers for every element: an array with a row for each, padded with −1, or all
answers and where each begins, or a list of lists."""
Ask = Callable[[Any], Any]
"""What asks of one handle."""

SINGLE, BULK, LOOPED = "one by one", "all at once", "in a loop"
"""Ways to ask and to operate, the order of a case: by calls of Python, or in a compiled loop."""
BUILD, BYTES = "build", "bytes"
"""Subjects of cases beside queries, operations and algorithms."""
ALGORITHMS = {
    "vertex_normals": "Vertex normals",
    "smooth": "A step of smoothing",
    "simplify": "Simplified to a tenth",
}
"""What whole meshes are given to, and how a table calls it."""
SIX = {name: name.capitalize() for name in algorithms.SIX}
"""The algorithms of Sieger & Botsch, which are timed in compiled loops."""

BATCHED = "split_face", "split_edge", "collapse_edge"
"""What our structures operate on many elements with at once."""


class Lazy:
    """A module of a library, imported when something of it is first asked for."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        value = self.__dict__[name] = getattr(import_module(self._name), name)
        return value


def row_of(rows: Callable[[Mesh], Any]) -> Callable[[Mesh], Ask]:
    """What reads the row of one element, of an array that was asked for once."""
    return lambda m: rows(m).__getitem__


@dataclass(frozen=True)
class Peer:
    """One library. What it has no call for is left out, and N/A in the tables.

    Vertices and faces are numbered as in the arrays a mesh is built of, edges as in ``ends``.

    ``build(points, triangles)``: float64 (n, 3), int32 (k, 3). ``faces``: how many a mesh has;
    ``arrays``: positions and triangles as they are left, which may end its use otherwise;
    ``ends``: (k, 2) the vertices of its edges. ``handles(m, element, numbers)``: what its calls
    take for vertices, edges or faces; ``named``: (k, 2) the vertices of edges that it answers,
    where these are neither numbers in ``ends`` nor pairs. ``single``: by query, what asks one
    handle, given the mesh; ``bulk``: what asks all at once, but not to hand out the triangles that
    it was given, which takes as long of any mesh. ``fresh``: without what it keeps of answers.
    ``operations``: by name and way, what operates at these handles -> how many were done.
    ``make_room``: for so many operations, before these are timed.
    ``algorithms``: given the mesh, and for ``simplify`` a number of faces -> the outcome.
    ``looped``: what tells how long compiled loops take, see ``program.tell``, and ``loops`` the
    subjects that it tells of. ``weigh``: the bytes of a mesh that knows them; ``collapse``:
    collapses its first edge, or refuses to. ``told_version``: where no distribution of Python
    tells it. ``objects``: its meshes are Python's objects, and smaller ones are measured.
    ``module``: where its name is not that of the distribution.
    ``site``: where its manual is; ``manual``: how that has it used, here too; ``more``: what it
    does that ours does not.
    """

    title: str
    distribution: str
    site: str
    manual: str
    more: str
    build: Callable[[Array, Array], Mesh]
    faces: Callable[[Mesh], int]
    arrays: Callable[[Mesh], tuple[Any, Any]] | None = None
    ends: Callable[[Mesh], Any] | None = None
    handles: Callable[[Mesh, str, list[int]], Sequence[Any]] = lambda m, element, numbers: numbers
    named: Callable[[Mesh, Array], Array] | None = None
    single: Mapping[str, Callable[[Mesh], Ask]] = field(default_factory=dict)
    bulk: Mapping[str, Callable[[Mesh], Rows]] = field(default_factory=dict)
    fresh: Callable[[Mesh], Mesh] = lambda m: m
    operations: Mapping[str, Callable[[Mesh, Any, Array], int]] = field(default_factory=dict)
    batches: Mapping[str, Callable[[Mesh, Any, Array], int]] = field(default_factory=dict)
    make_room: Callable[[Mesh, int], object] | None = None
    algorithms: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    looped: Callable[..., dict[str, Any]] | None = None
    loops: tuple[str, ...] = ()
    weigh: Callable[[Mesh], int] | None = None
    collapse: Callable[[Mesh], int] | None = None
    told_version: Callable[[], str] | None = None
    objects: bool = False
    module: str = ""

    def __post_init__(self) -> None:
        """Raises ValueError for what is measured of nobody."""
        if not (self.arrays or self.looped):
            raise ValueError(f"{self.title}: arrays is missing, by which what it does is checked")
        for given, known in (
            ({*self.single, *self.bulk}, QUERIES),
            ({*self.operations, *self.batches}, OPERATIONS),
            (set(self.algorithms), ALGORITHMS),
            (set(self.loops), (*QUERIES, *BATCHED, *SIX, BUILD)),
        ):
            if strange := given - set(known):
                raise ValueError(f"{self.title}: {min(strange)!r} is none of {', '.join(known)}")

    @property
    def version(self) -> str:
        """The installed version; empty if it is not installed."""
        if self.told_version:
            return self.told_version()
        try:
            found = version(self.distribution)
        except PackageNotFoundError:
            return ""
        return found if find_spec(self.module or self.distribution) else ""
