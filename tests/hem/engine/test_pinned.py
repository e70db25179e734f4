"""Arrays that compiled code finds by one address: what it finds there."""

from __future__ import annotations

import numpy as np
from numba import typeof, types

from hem.engine.pinned import Pinned

FIRST = np.arange(12, dtype=np.int32).reshape(3, 4), np.ones(5, np.float32), np.zeros(2, np.int64)
ALIKE = (FIRST[0] + 1)[:2], np.arange(7, dtype=np.float32), np.ones(9, np.int64)
READ_ONLY = np.broadcast_to(np.int32(1), (3, 4)), FIRST[0].T, FIRST[0][:, 1]


def test_what_takes_a_place_is_described_as_what_was_there_first():
    for k in range(1 << len(FIRST)):
        now = [(b if k >> i & 1 else a) for i, (a, b) in enumerate(zip(FIRST, ALIKE, strict=True))]
        pinned = Pinned(*FIRST)
        address = pinned.address
        pinned.replace(*now)
        assert pinned.address == address
        assert np.array_equal(pinned._image, Pinned(*now)._image)


def test_the_types_are_those_that_the_compiler_finds_whatever_was_pinned_before():
    for arrays in (FIRST, READ_ONLY, ALIKE, FIRST[::-1], READ_ONLY[1:], FIRST[:1]):
        assert Pinned(*arrays).kind == types.Tuple([typeof(it) for it in arrays])
