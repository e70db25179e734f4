"""Rows of different lengths in two flat arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Ragged:
    """The answers to many queries: ``values[offsets[i]:offsets[i + 1]]`` belong to the i-th.

    ``offsets``: (n + 1,) int64, from 0. ``values``: (offsets[n],) integers.
    """

    offsets: NDArray[np.int64]
    values: NDArray[Any]

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, i: int) -> NDArray[Any]:
        """The i-th row, a view. Cost O(1). Raises IndexError outside ``-len … len - 1``."""
        n = len(self)
        if not -n <= i < n:
            raise IndexError(f"row {i} of a Ragged of {n} rows")
        i %= n
        return self.values[self.offsets[i] : self.offsets[i + 1]]

    def __iter__(self) -> Iterator[NDArray[Any]]:
        return (self[i] for i in range(len(self)))

    @property
    def counts(self) -> NDArray[np.int64]:
        """(n,) int64: the length of every row."""
        return np.diff(self.offsets)
