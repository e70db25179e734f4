"""What the experiments measure: cases, the meshes and structures they name, and whom they ask."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby
from random import Random
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import hem
import structures
from experiments.harness.measurement import Measurement
from experiments.harness.presets import HUBS
from hem.contract import QUERIES, Query, Structure
from hem.meshes import TriangleMesh

Array = NDArray[Any]

BASE = "indexed"
"""The structure that the others are compared with: what a renderer stores."""

SHUFFLE_SEED = 20
HANDLE_SEED = 21


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
        references = (
            None if self.reference_bytes == 4 else f"{self.reference_bytes}-byte references"
        )
        parts = self.subject, self.family, self.size, valence, self.order, references
        return "/".join(str(part) for part in parts if part is not None)

    @property
    def query(self) -> Query:
        """The query of a case that has one."""
        return QUERIES[str(self.subject)]

    def mesh(self) -> TriangleMesh:
        """The mesh, renumbered at random where the case says so and asks nothing."""
        shuffled = self.order == "random" and self.subject is None
        return _mesh(self.family, self.size, self.valence, shuffled)

    def build(self) -> Structure:
        """The structure on the mesh; the last one built is kept."""
        return _structure(
            self.structure, self.family, self.size, self.valence, self.reference_bytes
        )

    def result(self, kind: str, s: Structure, samples: ArrayLike = (), **more: Any) -> Measurement:
        """The case as measured, with the facts of its mesh."""
        return Measurement(
            id=self.id,
            kind=kind,
            subject=self.subject,
            order=self.order,
            family=self.family,
            vertices=s.n_vertices,
            edges=s.n_edges,
            faces=s.n_faces,
            valence_max=_largest_valence(self.family, self.size, self.valence),
            valence=self.valence,
            reference_bytes=self.reference_bytes,
            working_set=sum(s.memory().values()),
            samples=np.asarray(samples, float).tolist(),
            **more,
        )

    def not_measured(self, kind: str, reason: str) -> Measurement:
        """The case where its mesh was not even made; its counts are about those asked for."""
        return Measurement(
            id=self.id,
            kind=kind,
            subject=self.subject,
            order=self.order,
            family=self.family,
            vertices=self.size // 2 if self.family == HUBS else self.size,
            faces=self.size if self.family == HUBS else 2 * self.size,
            valence=self.valence,
            reference_bytes=self.reference_bytes,
            skipped=reason,
        )


def in_random_order(cases: Sequence[Case], seed: int | str) -> list[Case]:
    """The cases in an order that the seed determines: random meshes, on each its cases at random.

    What is asked of one mesh stays together, since building it anew for each question would take
    longer than the asking.
    """
    random = Random(seed)

    def mesh(case: Case) -> tuple[str, int, int]:
        return case.family, case.size, case.valence or 0

    blocks = [list(block) for _, block in groupby(sorted(cases, key=mesh), mesh)]
    random.shuffle(blocks)
    for block in blocks:
        random.shuffle(block)
    return [case for block in blocks for case in block]


def queried_handles(case: Case, s: Structure) -> Array:
    """The handles a case asks, each once: in ascending order, or all of them in random order.

    Where the valence varies they are the hubs, and the edges and faces at hubs; there are as many
    of these at every valence.
    """
    source = case.query.source
    handles = _all_handles(case.structure, case.family, case.size, case.valence, source)
    if case.valence is not None:
        if source == "vertex":
            corners = handles
        else:
            corners = (s.edge_vertices if source == "edge" else s.face_vertices)(handles).values
        hubs = hem.valence_hubs(case.valence, case.size)
        handles = handles[(corners < len(hubs)).reshape(len(handles), -1).any(axis=1)]
    if case.order == "random":
        handles = np.random.default_rng(HANDLE_SEED).permutation(handles)
    return handles


def shuffled(mesh: TriangleMesh, seed: int = SHUFFLE_SEED) -> TriangleMesh:
    """The same surface with its vertices and faces renumbered at random."""
    rng = np.random.default_rng(seed)
    number = rng.permutation(len(mesh.points)).astype(np.int32)
    points = np.empty_like(mesh.points)
    points[number] = mesh.points
    return TriangleMesh(points, rng.permutation(number[mesh.triangles]))


@lru_cache(maxsize=2)
def _mesh(family: str, size: int, valence: int | None, renumbered: bool) -> TriangleMesh:
    if renumbered:
        return shuffled(_mesh(family, size, valence, False))
    if family == HUBS:
        return hem.valence_mesh(int(valence or 0), size)
    return hem.sample(family) if family in hem.SAMPLES else hem.generate(family, size)


@lru_cache(maxsize=1)
def _structure(
    name: str, family: str, size: int, valence: int | None, reference_bytes: int
) -> Structure:
    return structures.build(name, _mesh(family, size, valence, False), reference_bytes)


@lru_cache(maxsize=3)
def _all_handles(name: str, family: str, size: int, valence: int | None, source: str) -> Array:
    return _structure(name, family, size, valence, 4).handles(source)


@lru_cache(maxsize=4)
def _largest_valence(family: str, size: int, valence: int | None) -> int:
    return _mesh(family, size, valence, False).summary().valence_max
