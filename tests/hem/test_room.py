"""Arrays that grow where they are."""

import os
import pickle
import sys

import numpy as np
import psutil
import pytest

from hem import room

ADDRESSES = pytest.mark.skipif(room.ADDRESSES == 1, reason="here addresses count as memory")


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


def test_a_small_array_has_room_for_as_many_rows_again():
    for n in (1, 10, 10_000):
        array = room.roomy(np.arange(n))
        longer = room.longer(array, n, 2 * n)
        assert longer.ctypes.data == array.ctypes.data
        assert np.array_equal(longer[:n], np.arange(n))
        assert room.behind(array) == array.nbytes
        assert array.dtype == np.arange(n).dtype


@ADDRESSES
@pytest.mark.parametrize("n", [200_000, 3_000_000])
def test_a_large_array_grows_to_eight_times_its_size_in_its_place(n):
    array = room.roomy(np.arange(n))
    longer = room.longer(array, n, 8 * n)
    assert longer.ctypes.data == array.ctypes.data
    assert np.array_equal(longer[:n], np.arange(n))
    assert room.behind(array) == max(7 * array.nbytes, room.FRESH - array.nbytes)


@ADDRESSES
def test_a_smaller_one_does_so_once_it_was_moved():
    array = room.longer(np.arange(100_000), 100_000, 100_001)
    assert len(array) == 200_000
    assert room.longer(array, 200_000, 1_600_000).ctypes.data == array.ctypes.data


@ADDRESSES
def test_memory_is_used_again_once_nobody_views_it_and_not_before():
    room.give_back()
    array = room.roomy(np.arange(1 << 20))
    view, place = array[5:7], array.ctypes.data
    del array
    other = room.roomy(np.zeros(1 << 20, np.int64))
    assert other.ctypes.data != place
    assert view.tolist() == [5, 6]
    del view
    assert room.rows(1 << 20, 2, dtype=np.int32).ctypes.data == place


@ADDRESSES
def test_zeros_are_zeros_whatever_was_there_before():
    room.roomy(np.full(1 << 20, 7))
    array = room.rows(1 << 20, dtype=np.int64, zeros=True)
    assert not room.longer(array, 1 << 20, 1 << 22, zeros=True).any()


@ADDRESSES
def test_so_much_is_kept_at_most_and_all_of_it_is_given_back(monkeypatch):
    monkeypatch.setattr(room, "KEPT", 32 << 20)
    room.give_back()
    for n in (1, 2, 3, 4):
        room.roomy(np.ones(n << 20))
    assert [used for used, _ in room._kept.values()] == [32 << 20]
    process = psutil.Process()
    before = process.memory_info().rss
    room.give_back()
    assert before - process.memory_info().rss > 30 << 20


@ADDRESSES
def test_what_is_given_back_and_was_never_written_is_what_lay_behind():
    room.give_back()
    array = room.longer(room.roomy(np.ones(1 << 20)), 1 << 20, (1 << 20) + 1)
    unwritten = room.behind(array)
    del array
    assert room.give_back() == unwritten > 0


@ADDRESSES
def test_memory_of_which_much_more_was_in_use_is_left_to_others():
    room.give_back()
    place = room.roomy(np.ones(8 << 20)).ctypes.data
    assert room.roomy(np.ones(1 << 20)).ctypes.data != place
    assert room.roomy(np.ones(7 << 20)).ctypes.data == place


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
    room.give_back()
    before = psutil.Process().memory_info().rss
    array = room.longer(np.ones(1 << 20), 1 << 20, (1 << 20) + 1)
    assert os.name == "nt" or room.behind(array) >= 7 * array.nbytes
    assert psutil.Process().memory_info().rss - before < 3 * 8 << 20


def test_without_addresses_an_array_grows_by_moving(monkeypatch):
    def refused(size, used):
        raise MemoryError

    monkeypatch.setattr(room, "_block", refused)
    array = room.longer(np.arange(200_000), 200_000, 200_001)
    assert len(array) == 400_000
    assert np.array_equal(array[:200_000], np.arange(200_000))
    moved = room.longer(array, 400_000, 400_001)
    assert np.array_equal(moved[:200_000], np.arange(200_000))
    with pytest.raises(MemoryError):
        room.rows(8 << 20, dtype=np.int64)


def test_arrays_that_outlive_the_names_of_the_module_end_in_silence(monkeypatch):
    said = []
    monkeypatch.setattr(sys, "unraisablehook", said.append)
    array = room.rows(1 << 20, dtype=np.int64)
    for name in ("_kept", "KEPT"):  # as Python does at exit
        monkeypatch.setattr(room, name, None)
    del array
    assert not said
