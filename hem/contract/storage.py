"""How the records of a structure are held: what follows from its fields, whatever the mesh."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from hem import authoring
from hem.arrays import Array, Bools, Indices
from hem.authoring import ELEMENTS, ENDS, FACE_END, FACES, VERTEX_END, VERTICES, Field
from hem.engine import Held, Pinned, UncompiledUses, Uses
from hem.errors import MeshError

HANDLE_TYPES = {"vertex": np.int32, "edge": np.int64, "face": np.int32}
"""The type of the handles by kind of element."""


Step = Callable[[str, Any, Array], Indices]
"""``step(name, records, handles)``: where a step along half-edges leads from each, all live."""


class Storage:
    """Records in arrays, a row for each. Another way to hold them is a subclass."""

    uses: ClassVar[type[Uses]] = Uses  # how kernels become what is called
    pinned: ClassVar[type[Any]] = Pinned  # how records and scratch are handed to kernels

    def __init__(self, fields: Sequence[Field], step: Step | None) -> None:
        self.fields, self._step = fields, step

    def columns(self, records: type[Any]) -> tuple[int, ...]:
        """How many columns each array of such records has; 0 where its fields do not say."""
        counts = Counter[str]()
        for field in self.fields:
            counts[field.array] += field.width
        return tuple(counts[name] for name in records._fields)

    def wrong_fields(self, arrays: Sequence[str]) -> str:
        """What does not fit in the fields, of records of these arrays; empty where all does."""
        kinds = {it.element for it in self.fields}
        for it in self.fields:
            if it.name.count(".") != 1:
                return f"field {it.name!r} has no name such as half_edge.twin"
            known = (it.element, ENDS), (it.array, arrays[:-1]), (it.target, {"", *kinds})
            for named, among in known:
                if named not in among:
                    there_are = ", ".join(sorted(filter(None, among)))
                    return f"field {it.name} names {named!r}, and there are {there_are}"
        for kind in kinds:
            if not any(it.marks and ENDS[it.element] == ENDS[kind] for it in self.fields):
                return f"no field of {kind} says marks=True, which tells the dead"
        lacking = set(arrays[:-1]) - {it.array for it in self.fields}
        if lacking and type(self).compacted is Storage.compacted:  # which knows no other arrays
            return f"arrays of its records have no field: {', '.join(sorted(lacking))}"
        return "" if arrays[-1] == "counts" else "the last array of its records is not counts"

    def require_columns(self, records: Any) -> None:
        """Raise TypeError if an array has another number of columns, as kernels rely on it.

        MeshError for positions of eight bytes, of which they would read the halves.
        """
        for name, array, count in zip(
            records._fields, records, self.columns(type(records)), strict=True
        ):
            if count and array.dtype == np.float64:
                raise MeshError("a structure holds float32; structures.build(name, mesh) rounds")
            columns = array.shape[1] if count and array.ndim == 2 else 1
            if count and columns != count:
                raise TypeError(
                    f"{type(records).__name__}.{name} has {columns} columns, and its fields {count}"
                )

    def alive(self, records: Any, element: str, rows: Any = slice(None)) -> Bools:
        """(end,) bool: which of the records of a kind are live, or which of ``rows``. O(rows)."""
        return authoring.live(records, self.fields, element, rows)

    def live(self, records: Any, element: str) -> Array:
        """(k,): the handles of all live elements of a kind that is recorded, ascending."""
        handle = HANDLE_TYPES.get(element, np.int64)
        if _any_dead(records, element):
            return np.flatnonzero(self.alive(records, element)).astype(handle, copy=False)
        return np.arange(records.counts[ENDS[element]], dtype=handle)

    def edges(self, records: Any) -> Indices | None:
        """(n_edges,): the handles of all live edges, ascending; None if none is recorded."""
        if self._step is not None:
            h = self.live(records, "half_edge")
            return h[np.flatnonzero(self._step("edge", records, h) == h)]
        recorded = any(it.element == "edge" for it in self.fields)
        return self.live(records, "edge") if recorded else None

    def edge_names(self, records: Any, edges: Indices) -> Indices:
        """(n,): the one name of each live edge, where an edge has two handles."""
        return edges if self._step is None else self._step("edge", records, edges)

    def lasting_names(self, records: Any, edges: Indices) -> Indices:
        """(n,): names of edges that last whatever is done to others; -1 for what is no edge."""
        return edges

    def require(self, records: Any, element: str, handles: Array) -> None:
        """Raise MeshError if any of ``handles`` (n,) names no live element of the mesh. O(n)."""
        if not handles.size:
            return
        end = records.counts[ENDS[element]]
        if handles.min() < 0 or handles.max() >= end:
            refuse_handles(element, handles[(handles < 0) | (handles >= end)])
        if _any_dead(records, element):
            dead = ~self.alive(records, element, handles)
            if dead.any():
                refuse_handles(element, handles[dead])

    def prepare(self, records: Any, kernels: Iterable[str]) -> None:
        """Find what is found when it is first asked for, before several threads may ask at once.

        What these ``kernels`` take. Compiled code that asks no other thread to wait comes after.
        """

    def row(self, n: int, dtype: Any) -> Any:
        """Scratch for n numbers, which kernels write and read."""
        return np.zeros(n, dtype)

    def with_room(self, records: Any, vertices: int, faces: int) -> Any:
        """The records with room for so many more elements, in arrays of their own if need be."""
        return authoring.grown(records, self.fields, vertices, faces)

    def compacted(self, records: Any) -> tuple[Any, dict[str, Array]]:
        """The live records without gaps, and the new number of each old one by kind."""
        return authoring.compacted(records, self.fields)

    def renumbered(self, edges: ArrayLike, number: Mapping[str, Array]) -> Indices:
        """(k,): the new handles of old edges (k,) after ``compacted``, -1 for those that went."""
        recorded = next(it for it in ("half_edge", "edge") if it in number)
        old, numbers = np.asarray(edges, np.int64), np.append(number[recorded], -1)
        known = (old >= 0) & (old < len(numbers))
        return numbers[np.where(known, old, -1)].astype(np.int64)

    def saved(self, records: Any) -> Any:
        """What ``loaded`` and ``put_back`` need, in arrays of its own."""
        return authoring.copied(records)

    def loaded(self, saved: Any) -> Any:
        """The records of what was ``saved``, which is theirs from here on."""
        return saved

    def put_back(self, records: Any, saved: Any) -> None:
        """Have the records say again what was ``saved``, in their place. MeshError if they grew."""
        pairs = list(zip(records, saved, strict=True))
        if any(array.shape != fresh.shape for array, fresh in pairs):
            raise MeshError(
                "the mesh has grown since the snapshot, for which reserve makes room before it; "
                "or it was compacted"
            )
        for array, fresh in pairs:
            np.copyto(array, fresh)

    def arrays(self, records: Any) -> tuple[Array, ...]:
        """The arrays, room for more included, without the count of them."""
        *arrays, _ = records
        return tuple(arrays)

    def spare(self, records: Any, taken: int) -> int:
        """Bytes of dead elements and of room to grow, beside those ``taken`` by live ones."""
        return sum(it.nbytes for it in records) - taken


def _any_dead(records: Any, element: str) -> bool:
    """Whether any element of a kind may be dead."""
    if "edge" in element:  # how many records of them are live is not counted
        return True
    alive, end = (VERTICES, VERTEX_END) if element == "vertex" else (FACES, FACE_END)
    return bool(records.counts[alive] < records.counts[end])


def refuse_handles(element: str, handles: Array) -> None:
    """Raise the MeshError for ``handles`` that name no element of the mesh."""
    words = f"no such {element.replace('_', '-')} in this mesh"
    raise MeshError(words, **{ELEMENTS.get(element, f"{element}s"): handles})


class UncompiledStorage(Storage):
    """Records whose kernels Python itself runs."""

    uses, pinned = UncompiledUses, Held

    def row(self, n: int, dtype: Any) -> memoryview:
        """See ``Storage.row``; faster than an array, and its numbers are Python's."""
        return memoryview(np.zeros(n, dtype).data)
