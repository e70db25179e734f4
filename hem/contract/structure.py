"""What every mesh data structure has in common: the contract, derived from its kernels.

A structure is a subclass that declares its records (a ``NamedTuple`` of arrays), their fields, its
kernels, how it is built and how it is validated. Its queries are derived in ``queryable``, its
operations in ``editable``.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from hem.authoring.kernels import (
    Kernel,
    anchor,
    bury,
    coordinate,
    isolate,
    named,
    place,
    sides,
    vertex_exists,
)
from hem.authoring.operations import operations
from hem.authoring.records import copied
from hem.contract.editable import Editable
from hem.contract.queries import QUERIES
from hem.meshes.triangles import TriangleMesh

Array = NDArray[Any]

OF_ARRAYS = named(coordinate, place, bury, isolate, anchor, sides, vertex_exists)
"""Kernels that are the same wherever vertices are rows of an array and faces triangles."""

REFERENCE_TYPES = {4: np.int32, 8: np.int64}
"""Bytes of a stored reference to the type that holds it. The thesis counts 8 (section 7)."""


class Structure(Editable):
    """A triangle mesh held in one data structure, interchangeable behind one contract."""

    name: ClassVar[str]
    title: ClassVar[str]
    abbreviation: ClassVar[str]
    holds_polygons: ClassVar[bool] = False
    """Whether faces may have more than three corners, and ``build`` takes a ``PolygonMesh``."""

    compiled: ClassVar[bool] = True
    """Whether kernels are compiled; what is not is slow, and measured on smaller meshes."""

    searches: ClassVar[bool] = False
    """Whether nothing is recorded of neighbors, so that they are searched for in the whole mesh."""

    def __init_subclass__(cls) -> None:
        """Derive the four uses of every kernel; abstract intermediates declare none."""
        super().__init_subclass__()
        if hasattr(cls, "kernels"):
            cls.kernels = {**OF_ARRAYS, **cls.kernels}
            derive, records = cls.uses_type, cls.records_type
            cls._algorithms = {}
            cls._uses = {name: derive(cls.kernels[name], records) for name in QUERIES}
            cls._operation_uses = {
                name: derive(kernel, records) for name, kernel in cls.operation_kernels().items()
            }

    @classmethod
    def operation_kernels(cls) -> dict[str, Kernel]:
        """The kernels of ``operations`` by name, see ``hem.authoring.operations``."""
        return operations(cls.kernels)

    @classmethod
    @abstractmethod
    def build(cls, mesh: TriangleMesh, reference_bytes: int = 4) -> Self:
        """The structure of ``mesh``, with stored references of 4 or 8 bytes.

        Cost O(n_v + n_t). Raises NonManifoldError, with the elements, for what the structure
        cannot represent.
        """

    @abstractmethod
    def validate(self) -> None:
        """Check every invariant on the raw arrays; no query is used. Cost O(n_v + n_t).

        Raises MeshError that names the broken invariant and the elements that break it.
        """

    def to_triangles(self) -> TriangleMesh:
        """The same mesh as points and counterclockwise triangles. Cost O(n_v + n_t)."""
        corners, alive = self.face_vertices(self.faces()).values, self.vertices()
        if len(alive) < len(self.points):
            number = np.zeros(len(self.points), np.int32)
            number[alive] = np.arange(len(alive), dtype=np.int32)
            corners = number[corners]
        return TriangleMesh(self.points[alive], corners.reshape(-1, 3))

    def copy(self) -> Self:
        """The same mesh in arrays of its own, with the same handles and no subscribers."""
        return type(self)(copied(self.records))

    def memory(self) -> dict[str, int]:
        """Bytes per field of live elements, such as ``{"vertex.point": 12 * n_vertices, …}``."""
        counts = {
            "vertex": self.n_vertices,
            "edge": self.n_edges,
            "half_edge": self.n_half_edges,
            "face": self.n_faces,
            "triangle": self.n_faces,
        }
        return {
            field.name: counts[field.element]
            * field.width
            * int(getattr(self.records, field.array).itemsize)
            for field in self.fields
        }

    @property
    def n_half_edges(self) -> int:
        """Number of live half-edges, one for each corner of a face; recorded or not."""
        return 3 * self.n_faces

    def snapshot(self) -> Any:
        """What ``restore`` needs to make the mesh what it is now. Cost O(n_v + n_t)."""
        return copied(self.records)

    def restore(self, snapshot: Any) -> None:
        """Make the mesh what it was, in the same place; there must be as much room. For measuring.

        Subscribers are not told. Cost O(n_v + n_t).
        """
        for array, fresh in zip(self.records, snapshot, strict=True):
            np.copyto(array, fresh)

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays of the records, room for more included, without the count of them."""
        *arrays, _ = self.records
        return tuple(arrays)
