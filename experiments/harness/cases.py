"""What the experiments measure: cases, the meshes and structures they name, and the outcome."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import groupby
from random import Random
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import hem
import structures
from experiments.harness import own_mesh
from experiments.presets import HUBS
from hem.arrays import Array
from hem.contract import QUERIES, Query, Structure
from hem.errors import MeshError
from hem.meshes import MeshSummary, TriangleMesh

BASE = "indexed"  # the structure that the others are compared with: what a renderer stores

OF_ALIKE, OF_UNEVEN = 3, 60  # how often accesses are counted where elements are alike, and else
SHUFFLE_SEED, HANDLE_SEED = 20, 21


class NothingToMeasureError(MeshError):
    """A mesh has nothing that a case could measure, as a single triangle has no edge to flip."""


@dataclass
class Measurement:
    """One measured case, as a run keeps it.

    ``samples``: seconds per query and round (``kind`` "time"), accesses per query and handle
    ("work"), or bytes ("bytes"). ``handles``: queries per sample. ``working_set``: bytes of the
    structure's live records, or of the chased array in the latency experiment. ``valence``: that of
    the queried vertices where the experiment varies it. ``latency``: seconds per memory access in
    the working set, beside the case. ``reference``: seconds per query of constant work, see
    ``reference.py``. ``calibration``: seconds per step of the calibration loop before each round.
    ``skipped``: why nothing was measured, else empty. ``noise``: how steady the machine was
    meanwhile, and how often the case was ``measured``.
    """

    id: str
    kind: str
    subject: str | None = None
    order: str | None = None
    family: str | None = None
    vertices: int = 0
    edges: int = 0
    faces: int = 0
    valence_max: int = 0
    valence: int | None = None
    reference_bytes: int = 4
    working_set: int = 0
    handles: int = 0
    checked: bool = False
    latency: float | None = None
    reference: float | None = None
    samples: list[float] = field(default_factory=list)
    skipped: str = ""
    detail: dict[str, Any] = field(default_factory=dict)
    calibration: list[float] = field(default_factory=list)
    noise: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Case:
    """One point of an experiment, known before anything is built."""

    structure: str
    family: str
    size: int
    subject: str | None = None
    order: str | None = None
    valence: int | None = None
    reference_bytes: int = 4

    @property
    def id(self) -> str:
        """Readable and unique within an experiment and a structure."""
        valence = None if self.valence is None else f"valence {self.valence}"
        wide = None if self.reference_bytes == 4 else f"{self.reference_bytes}-byte references"
        parts = self.subject, self.family, self.size, valence, self.order, wide
        return "/".join(str(part) for part in parts if part is not None)

    @property
    def query(self) -> Query:
        """The query of a case that has one."""
        return QUERIES[str(self.subject)]

    @property
    def repetitions(self) -> int:
        """How often something is counted: more often where elements differ, unless all is read."""
        kind = structures.REGISTRY[self.structure]
        uneven = own_mesh.is_own(self.family, self.size) or kind.rebuilds  # what is found is hashed
        return OF_UNEVEN if uneven and not kind.searches else OF_ALIKE

    @property
    def searches(self) -> bool:
        """Whether its operation looks at the whole mesh each time; to split a face none does."""
        kind = structures.REGISTRY[self.structure]
        return (kind.searches or kind.rebuilds) and self.subject != "split_face"

    @property
    def vertices(self) -> int:
        """How many vertices its mesh is asked for; 0 for a sample, which has as many as it has."""
        return self.size // 2 if self.family == HUBS else self.size

    @property
    def hubs(self) -> int:
        """How many vertices, the first ones, have the valence that is varied; 0 where none is."""
        return len(hem.valence_hubs(self.valence, self.size)) if self.valence else 0

    def mesh(self) -> TriangleMesh:
        """The mesh, renumbered at random where the case says so and asks nothing."""
        renumbered = self.order == "random" and self.subject is None
        return _mesh(self.family, self.size, self.valence, renumbered)

    def build(self) -> Structure:
        """The structure on the mesh; the last one built is kept."""
        return _structure(replace(self, subject=None, order=None))

    def result(
        self, kind: str, s: Structure | None, samples: ArrayLike = (), **more: Any
    ) -> Measurement:
        """The case as measured, with the facts of its mesh and the bytes of the structure."""
        mesh = _summary(self.family, self.size, self.valence)
        counts = {it: getattr(mesh, it) for it in ("vertices", "edges", "faces", "valence_max")}
        working_set = 0 if s is None else sum(s.memory().values())
        samples = np.asarray(samples, float).tolist()
        made = {"working_set": working_set, "samples": samples, **counts, **more}
        return replace(self.not_measured(kind, ""), **made)

    def not_measured(self, kind: str, reason: str) -> Measurement:
        """The case where its mesh was not even made; its counts are about those asked for."""
        faces = self.size if self.family == HUBS else 2 * self.size
        names = "id", "subject", "order", "family", "valence", "reference_bytes", "vertices"
        known: dict[str, Any] = {name: getattr(self, name) for name in names}
        return Measurement(kind=kind, **known, faces=faces, skipped=reason)


def in_random_order(cases: Sequence[Case], seed: int | str) -> list[Case]:
    """Meshes at random, on each its cases at random, as the seed says; each mesh is built once."""
    random = Random(seed)

    def mesh(case: Case) -> tuple[str, int, int]:
        return case.family, case.size, case.valence or 0

    blocks = [list(block) for _, block in groupby(sorted(cases, key=mesh), mesh)]
    random.shuffle(blocks)
    for block in blocks:
        random.shuffle(block)
    return [case for block in blocks for case in block]


def elements_at(s: Structure, source: str, few: int) -> Array:
    """Handles of the first ``few`` vertices, or of the edges or faces at them; of all for 0."""
    every = s.handles(source)
    if not few:
        return every
    corners = every if source == "vertex" else getattr(s, f"{source}_vertices")(every).values
    return every[(corners < few).reshape(len(every), -1).any(axis=1)]


def in_order_of(case: Case, handles: Array) -> Array:
    """Handles in the order in which a case asks: as they are, ascending, or all at random."""
    random = np.random.default_rng(HANDLE_SEED)
    return random.permutation(handles) if case.order == "random" else handles


@lru_cache(maxsize=2)
def _mesh(family: str, size: int, valence: int | None, renumbered: bool) -> TriangleMesh:
    if renumbered:
        mesh, rng = _mesh(family, size, valence, False), np.random.default_rng(SHUFFLE_SEED)
        number = rng.permutation(len(mesh.points)).astype(np.int32)
        points = np.empty_like(mesh.points)
        points[number] = mesh.points
        return TriangleMesh(points, rng.permutation(number[mesh.triangles]))
    if family == HUBS:
        return hem.valence_mesh(int(valence or 0), size)
    if own_mesh.is_own(family, size):
        return own_mesh.version(family, size)
    return hem.sample(family) if family in hem.SAMPLES else hem.generate(family, size)


@lru_cache(maxsize=1)
def _structure(case: Case) -> Structure:
    return structures.build(case.structure, case.mesh(), case.reference_bytes)


@lru_cache(maxsize=4)
def _summary(family: str, size: int, valence: int | None) -> MeshSummary:
    return _mesh(family, size, valence, False).summary()
