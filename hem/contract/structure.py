"""What every mesh data structure has in common: the contract, derived from its kernels."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Self

import numpy as np

from hem.authoring import (
    OF_ARRAYS,
    OPERATIONS,
    QUERIES,
    Kernel,
    kernels_of,
    require_records,
)
from hem.authoring.marked import named_by_ends
from hem.contract.description import place_of
from hem.contract.measuring import Measuring
from hem.meshes import TriangleMesh
from hem.ragged import Ragged


class Structure(Measuring, ABC, abstract=True):
    """A triangle mesh held in one data structure, interchangeable behind one contract.

    A subclass declares how it is called and looks (``Described``), its records (a ``NamedTuple`` of
    arrays) and their fields, how it is built and what must hold; its kernels are those of the
    module that it stands in. What it forgets is a TypeError that names the class and the part.
    """

    holds_polygons: ClassVar[bool] = False
    """Whether faces may have more than three corners, and ``build`` takes a ``PolygonMesh``."""

    compiled: ClassVar[bool] = True
    """Whether kernels are compiled; what is not is slow, and measured on smaller meshes."""

    searches: ClassVar[bool] = False
    """Whether nothing is recorded of neighbors, so that they are searched for in the whole mesh."""

    def __init_subclass__(cls, abstract: bool = False) -> None:
        """Derive the uses of every kernel."""
        super().__init_subclass__(abstract)
        if abstract:
            return
        missing = [it for it in ("records_type", "fields") if not hasattr(cls, it)]
        methods = ("build", "_require_invariants")
        missing += [
            it for it in methods if getattr(getattr(cls, it), "__isabstractmethod__", False)
        ]
        if missing:
            raise TypeError(f"{place_of(cls)} does not say: {', '.join(missing)}")
        if "records_type" in cls.__dict__:
            own = cls.__dict__.get("kernels") or kernels_of(cls.__module__)
            cls.kernels = {**OF_ARRAYS, **own}
        _require_claims(cls)
        derive, records = cls.uses_type, cls.records_type
        cls._algorithms = {}
        cls._uses = {name: derive(_query(cls, name), records) for name in QUERIES}
        cls._operation_uses = {
            name: derive(_operation(cls, name), records) for name in cls.operations
        }
        if not cls.stable_edge_handles:
            cls._lasting_uses = {
                name: derive(_of_lasting_names(cls, name), records)
                for name in cls.operations
                if cls.operations[name].element == "edge"
            }

    @classmethod
    @abstractmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """The structure of ``mesh``, with stored references of 4 or 8 bytes.

        Cost O(n_v + n_t). Raises NonManifoldError, with the elements, for what the structure
        cannot represent.
        """

    def validate(self) -> None:
        """Check every invariant on the raw arrays; no query is used. Cost O(n_v + n_t).

        Raises MeshError that names the broken invariant and the elements that break it.
        """
        require_records(self.records, self.fields)
        self._require_invariants()

    @abstractmethod
    def _require_invariants(self) -> None:
        """Check what must hold beside what follows from the fields (``require_records``)."""

    def to_triangles(self) -> TriangleMesh:
        """The same mesh as points and counterclockwise triangles. Cost O(n_v + n_t)."""
        corners, alive = self.face_vertices(self.faces()).values, self.vertices()
        if len(alive) < len(self.points):
            number = np.zeros(len(self.points), np.int32)
            number[alive] = np.arange(len(alive), dtype=np.int32)
            corners = number[corners]
        return TriangleMesh(self.points[alive], corners.reshape(-1, 3))

    def __repr__(self) -> str:
        return (
            f"<{self.title}: {self.n_vertices:,} vertices, {self.n_edges:,} edges, "
            f"{self.n_faces:,} faces>"
        )

    def same_as(self, other: Structure) -> bool:
        """Whether another structure holds the same mesh: positions and faces by the same handles.

        Whatever corner a face begins at. Cost O(n_v + n_t).
        """
        return (
            np.array_equal(self.points, other.points, equal_nan=True)
            and np.array_equal(self.faces(), other.faces())
            and _from_smallest(self.face_vertices()) == _from_smallest(other.face_vertices())
        )

    def copy(self) -> Self:
        """The same mesh in arrays of its own: same handles, same attributes, no subscribers."""
        return self._of(self._portable(), self._attribute_states())

    def __reduce__(self) -> tuple[Any, ...]:
        """How ``copy.copy``, ``copy.deepcopy`` and ``pickle`` make a copy: as ``copy`` does."""
        return self._of, (self._portable(), self._attribute_states())

    @classmethod
    def _of(cls, records: Any, attributes: Any) -> Self:
        """The structure of what is its own from here on."""
        made = cls(cls._records_of(records))
        made._adopt(attributes)
        return made

    def memory(self, room: bool = False) -> dict[str, int]:
        """Bytes per field of live elements, such as ``{"vertex.point": 12 * n_vertices, …}``.

        With ``room`` also what is taken beside them: ``dead and room to grow`` is what the arrays
        hold besides, up to as much again after they grew; ``scratch`` is where queries and
        operations work, nothing before the first of them.
        """
        counts = {
            "vertex": self.n_vertices,
            "edge": self.n_edges,
            "half_edge": self.n_half_edges,
            "face": self.n_faces,
            "triangle": self.n_faces,
        }
        live = {
            field.name: counts[field.element]
            * field.width
            * int(getattr(self.records, field.array).itemsize)
            for field in self.fields
        }
        return live | self._beside(sum(live.values())) if room else live

    def _beside(self, live: int) -> dict[str, int]:
        """Bytes taken beside those of live elements."""
        scratch = self.__dict__.get("_out", {}).values()
        return {
            "dead and room to grow": sum(getattr(it, "nbytes", 0) for it in self.records) - live,
            "scratch": sum(it.nbytes for it in scratch) + self._log.nbytes,
        }

    @property
    def n_half_edges(self) -> int:
        """Number of live half-edges, one for each corner of a face; recorded or not."""
        return 3 * self.n_faces


def _from_smallest(rows: Ragged) -> list[list[int]]:
    """The corners of every face, from the smallest on."""
    found = [row.tolist() for row in rows]
    return [row[(k := row.index(min(row))) :] + row[:k] for row in found]


def _query(cls: type[Structure], name: str) -> Kernel:
    if name not in cls.kernels:
        raise TypeError(f"{place_of(cls)} has no kernel {name}(m, {name[0]}, out) -> count")
    return cls.kernels[name]


def _operation(cls: type[Structure], name: str) -> Kernel:
    operation = cls.operations[name]
    try:
        return operation.make(cls.kernels)
    except KeyError as missing:
        raise TypeError(
            f"{place_of(cls)} has no kernel {missing.args[0]}, which {name} takes; see "
            f"{operation.make.__module__}"
        ) from None


def _of_lasting_names(cls: type[Structure], name: str) -> Kernel:
    if "edge_between" not in cls.kernels:
        raise TypeError(f"{place_of(cls)} has no kernel edge_between(m, a, b) -> edge or -1")
    return named_by_ends(cls._operation_uses[name].kernel, cls.kernels["edge_between"])


def _require_claims(cls: type[Structure]) -> None:
    claimed = cls.claims.costs if hasattr(cls, "claims") else {}
    unknown = set(claimed) - {*QUERIES, *OPERATIONS}
    if unknown:
        raise TypeError(
            f"{place_of(cls)}: claims of what is no query and no operation: {sorted(unknown)}"
        )
