"""Rows of different lengths in two flat arrays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Array, Indices

SHOWN = 3  # rows that ``repr`` shows


@dataclass(frozen=True, eq=False)
class Ragged:
    """The answers to many queries: ``values[offsets[i]:offsets[i + 1]]`` belong to the i-th.

    ``offsets``: (n + 1,) int64, from 0. ``values``: (offsets[n],) integers.
    """

    offsets: Indices
    values: Array

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @staticmethod
    def from_lists(rows: Iterable[ArrayLike], dtype: Any = np.int64) -> Ragged:
        """The rows in one array. Cost O(values)."""
        arrays = [np.asarray(row, dtype) for row in rows]
        offsets = np.concatenate([[0], np.cumsum([len(row) for row in arrays])])
        values = np.concatenate(arrays) if arrays else np.zeros(0, dtype)
        return Ragged(offsets.astype(np.int64), values)

    def to_list(self) -> list[list[int]]:
        """The rows as lists. Cost O(values)."""
        values, ends = self.values.tolist(), self.offsets.tolist()
        return [values[start:end] for start, end in pairwise(ends)]

    @overload
    def __getitem__(self, i: int) -> Array: ...
    @overload
    def __getitem__(self, i: slice | list[int] | Array) -> Ragged: ...
    def __getitem__(self, i: int | slice | list[int] | Array) -> Array | Ragged:
        """The i-th row, a view, in O(1); of a slice or an array of places a ``Ragged`` of theirs.

        Raises IndexError outside ``-len … len - 1``.
        """
        n = len(self)
        if isinstance(i, (slice, list)) or (isinstance(i, np.ndarray) and i.ndim):
            rows = np.arange(n)[i]
            counts = self.counts[rows]
            offsets = np.concatenate([[0], np.cumsum(counts)])
            places = np.repeat(self.offsets[rows] - offsets[:-1], counts) + np.arange(offsets[-1])
            return Ragged(offsets, self.values[places])
        if not -n <= i < n:
            raise IndexError(f"row {i} of a Ragged of {n} rows")
        i = i % n  # anew, as it may be the caller's array
        return self.values[self.offsets[i] : self.offsets[i + 1]]

    def __iter__(self) -> Iterator[Array]:
        return (self.values[start:end] for start, end in pairwise(self.offsets.tolist()))

    def __repr__(self) -> str:
        shown = ", ".join(str(row.tolist()) for row in self[:SHOWN])
        return f"Ragged({len(self):,} rows: {shown}{', …' if len(self) > SHOWN else ''})"

    @property
    def following(self) -> Indices:
        """(offsets[n],) int64: where the next value of the row stands, behind the last the first.

        So the sides of faces follow from their corners.
        """
        places, rows = np.arange(1, len(self.values) + 1), self.counts > 0
        places[self.offsets[1:][rows] - 1] = self.offsets[:-1][rows]
        return places

    @property
    def counts(self) -> Indices:
        """(n,) int64: the length of every row."""
        return np.diff(self.offsets)
