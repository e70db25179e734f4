"""Arrays that grow where they are."""

import os
import pickle

import numpy as np
import psutil
import pytest

from hem import room


@pytest.mark.parametrize("width", [(), (3,), (3, 2)])
@pytest.mark.parametrize("zeros", [False, True])
def test_rows_keep_their_values_and_move_seldom(width, zeros):
    array, places = room.rows(0, *width, dtype=np.int32, zeros=zeros), set()
    for used in range(50_000):
        array = room.longer(array, used, used + 1, zeros)
        assert not zeros or not array[used].any()
        array[used] = used + 1
        places.add(array.ctypes.data)
    assert len(places) <= 17
    assert (array.reshape(len(array), -1)[:50_000] == np.arange(1, 50_001)[:, None]).all()


def test_a_new_array_grows_by_a_quarter_in_its_place():
    for n in (1, 10, 10_000, 3_000_000):
        array = room.roomy(np.arange(n))
        longer = room.longer(array, n, n + max(n // 4, 1))
        assert longer.ctypes.data == array.ctypes.data
        assert np.array_equal(longer[:n], np.arange(n))
        assert room.behind(array) >= 8 * (n // 4)


def test_once_moved_it_grows_to_eight_times_its_size_in_its_place():
    array = room.longer(np.arange(100_000), 100_000, 100_001)
    assert len(array) == 200_000
    assert room.longer(array, 200_000, 1_600_000).ctypes.data == array.ctypes.data


def test_what_lies_behind_the_view_of_another_array_is_not_taken():
    others = np.arange(10)
    longer = room.longer(others[:5], 5, 6)
    longer[5] = -1
    assert others.tolist() == list(range(10))
    array = room.rows(10, dtype=np.int64)
    array[:] = others
    assert room.behind(array) > 0
    for copy in (array.copy(), array[:5].copy(), pickle.loads(pickle.dumps(array))):
        assert room.behind(copy) == 0


def test_rows_behind_take_no_memory_until_they_are_written():
    before = psutil.Process().memory_info().rss
    array = room.longer(np.ones(1 << 20), 1 << 20, (1 << 20) + 1)
    assert os.name == "nt" or room.behind(array) >= 7 * array.nbytes
    assert psutil.Process().memory_info().rss - before < 3 * 8 << 20


def test_without_addresses_an_array_grows_by_moving(monkeypatch):
    enough = room._longest

    def refused(n, *kind):
        if n > 200_000:
            raise MemoryError
        return enough(n, *kind)

    monkeypatch.setattr(room, "_longest", refused)
    array = room.longer(np.arange(100_000), 100_000, 100_001)
    assert len(array) == 200_000
    assert np.array_equal(array[:100_000], np.arange(100_000))
