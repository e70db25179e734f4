"""Real functions of known cost that no judge was made on: data, as in `functions`.

They were written down before any judge was asked about them. Whoever changes the judge for what it
says of them makes them functions that it was tuned on, and writes others.
"""

import base64
import bisect
import collections
import hashlib
import itertools
import json
import marshal
import math
import pickle
import re
import statistics
from itertools import starmap
from operator import getitem
from urllib import parse

import numpy as np
from scipy import fft, ndimage, signal, spatial, special, stats
from scipy.integrate import simpson

from experiments.validation import by_hand
from experiments.validation.functions import (
    BISECT,
    BY_SORT,
    CACHE_BOUND,
    CLRS,
    CPYTHON,
    INPUTS,
    LAPACK,
    LONG,
    LOOP,
    NUMPY,
    PARTITION,
    PYDOC,
    QUICKHULL,
    SCIPY,
    SORT,
    SQUARE_BOUND,
    TIMSORT,
    TWOS,
    VIEWS,
    WIKI,
    Function,
    each,
    floats,
    function,
    looked_up,
    times,
    uniform,
)  # fmt: skip

# fmt: off
HELD_OUT: tuple[Function, ...] = tuple(starmap(function, [
    ("dict.get of an absent key, 1,000 times", "O(1)", "dict", times(lambda s: s.get(-1)), WIKI),
    ("deque.append and pop, 1,000 times", "O(1)", "deque", times(by_hand.append_and_pop), WIKI),
    ("len(set), 1,000 times", "O(1)", "floats_set", times(len), WIKI),
    ("list[i] = 0, 1,000 random", "O(1)", "numbers asked",
        each(lambda s, i: s.__setitem__(i, 0)), WIKI),
    ("ChainMap[key], 1,000 random", "O(1)",
        lambda n: looked_up(collections.ChainMap({}, dict.fromkeys(range(n)))), each(getitem),
        PYDOC),
    ("array.reshape, 1,000 views", "O(1)", "uniform", times(lambda a: a.reshape(-1, 1)), VIEWS),
    ("array.T, 1,000 views", "O(1)", "matrix", times(lambda a: a.T), VIEWS, SQUARE_BOUND),
    ("matrix[i, i], 1,000 random", "O(1)", "matrix asked", each(lambda a, i: a[i, i]), NUMPY,
        SQUARE_BOUND),
    ("bisect with a key, 1,000 random", "O(log n)", "numbers asked",
        each(lambda s, i: bisect.bisect(s, i, key=float)), PYDOC),
    ("np.searchsorted in int32, 1,000 random", "O(log n)",
        lambda n: (np.arange(n, dtype=np.int32), INPUTS["picked"](n).astype(np.int32)),
        lambda s: np.searchsorted(*s), BISECT, CACHE_BOUND),
    ("ternary search by hand, 1,000 random", "O(log n)", "numbers asked", each(by_hand.in_thirds),
        LOOP),
    ("search tree in an array, 1,000 random", "O(log n)",
        lambda n: (by_hand.search_tree(n), INPUTS["asked"](n)), each(by_hand.descend),
        CLRS + ": a balanced tree"),
    ("n as a sum of two squares", "O(√n)", int, by_hand.two_squares, LOOP),
    ("odd numbers taken off", "O(√n)", int, by_hand.odd_numbers, LOOP),
    ("list of reversed", "O(n)", "floats", lambda s: list(reversed(s)), WIKI),
    ("list.insert in the middle", "O(n)", "numbers", lambda s: s.insert(len(s) // 2, 0), WIKI),
    ("del list[::2]", "O(n)", "floats", lambda s: s.__delitem__(slice(None, None, 2)), WIKI),
    ("sorted, of reversed", "O(n)", lambda n: list(range(n, 0, -1)), sorted, TIMSORT),
    ("list of enumerate", "O(n)", "floats", lambda s: list(enumerate(s)), PYDOC),
    ("itertools.pairwise", "O(n)", "floats", lambda s: list(itertools.pairwise(s)), PYDOC),
    ("deque of a list", "O(n)", "floats", collections.deque, PYDOC),
    ("max of a dict, by value", "O(n)", lambda n: dict(enumerate(floats(n))),
        lambda s: max(s, key=s.get), PYDOC),
    ("frozenset(list)", "O(n)", "floats", frozenset, WIKI),
    ("set.isdisjoint", "O(n)", "floats_set floats_set", lambda s: s[0].isdisjoint(s[1]), CPYTHON),
    ("dict | dict", "O(n)", "dict dict", lambda s: s[0] | s[1], PYDOC),
    ("str.casefold", "O(n)", "letters", str.casefold, CPYTHON),
    ("str.rfind, absent", "O(n)", "letters", lambda s: s.rfind("é"), CPYTHON),
    ("bytes + bytes", "O(n)", "bytes bytes", lambda s: s[0] + s[1], WIKI),
    ("hashlib.sha512", "O(n)", "bytes", lambda s: hashlib.sha512(s).digest(), "FIPS 180-4"),
    ("base64.b85encode", "O(n)", "bytes", base64.b85encode, PYDOC),
    ("json.loads of floats", "O(n)", lambda n: json.dumps(floats(n)), json.loads, CPYTHON),
    ("pickle.dumps of floats", "O(n)", "floats", pickle.dumps, CPYTHON),
    ("marshal.loads", "O(n)", lambda n: marshal.dumps(floats(n)), marshal.loads, PYDOC),
    ("re.finditer", "O(n)", "letters", lambda s: sum(1 for _ in re.finditer("[xyz]", s)), CPYTHON),
    ("urllib.parse.quote", "O(n)", lambda n: "a b/c?" * (n // 6 + 1), parse.quote, PYDOC),
    ("int % 7, n bits", "O(n)", "bits", lambda a: a % 7, LONG, 10_000_000),
    ("math.hypot", "O(n)", "tuple", lambda s: math.hypot(*s), CPYTHON),
    ("statistics.linear_regression", "O(n)", "floats floats",
        lambda s: statistics.linear_regression(*s), PYDOC),
    ("counting sort", "O(n)", "few", by_hand.counting_sort, CLRS),
    ("prefix function", "O(n)", "letters", by_hand.prefixes, CLRS + ": Knuth-Morris-Pratt"),
    ("majority by votes", "O(n)", "few", by_hand.majority, "Boyer and Moore, MJRTY"),
    ("np.max", "O(n)", "uniform", np.max, NUMPY, CACHE_BOUND),
    ("np.std", "O(n)", "uniform", np.std, NUMPY, CACHE_BOUND),
    ("np.floor", "O(n)", "uniform", np.floor, NUMPY, CACHE_BOUND),
    ("np.minimum", "O(n)", "uniform uniform", lambda s: np.minimum(*s), NUMPY, CACHE_BOUND),
    ("np.log", "O(n)", "uniform", lambda a: np.log(a + 1), NUMPY, CACHE_BOUND),
    ("np.tile", "O(n)", "uniform", lambda a: np.tile(a, 2), NUMPY),
    ("np.gradient", "O(n)", "uniform", np.gradient, NUMPY, CACHE_BOUND),
    ("np.array_equal", "O(n)", "uniform", lambda a: np.array_equal(a, a.copy()), NUMPY,
        CACHE_BOUND),
    ("array.tobytes", "O(n)", "uniform", np.ndarray.tobytes, NUMPY, CACHE_BOUND),
    ("np.argpartition", "O(n)", "uniform", lambda a: np.argpartition(a, len(a) // 2), PARTITION),
    ("np.percentile, three of them", "O(n)", "uniform", lambda a: np.percentile(a, [25, 50, 75]),
        PARTITION),
    ("maximum_filter1d", "O(n)", "uniform", lambda a: ndimage.maximum_filter1d(a, 9), SCIPY),
    ("scipy.special.expit", "O(n)", "uniform", special.expit, NUMPY, CACHE_BOUND),
    ("scipy.integrate.simpson", "O(n)", "uniform", simpson, SCIPY),
    ("scipy.stats.zscore", "O(n)", "uniform", stats.zscore, SCIPY),
    ("csr_array.sum, of its rows", "O(n)", "sparse", lambda s: s.sum(axis=1), SCIPY),
    ("list.sort, descending", "O(n log n)", "floats", lambda s: s.sort(reverse=True),
        WIKI),
    ("longest increasing subsequence", "O(n log n)", "floats", by_hand.increasing, CLRS),
    ("Huffman's code", "O(n log n)", "floats", by_hand.huffman, CLRS),
    ("inversions by merging", "O(n log n)", "floats", by_hand.inversions, CLRS),
    ("hull by a monotone chain", "O(n log n)", lambda n: list(zip(floats(n), floats(n),
        strict=True)), by_hand.hull, "Andrew, Another efficient algorithm for convex hulls"),
    ("np.sort of float32", "O(n log n)", lambda n: uniform(n).astype(np.float32), np.sort, SORT,
        CACHE_BOUND),
    ("np.setdiff1d", "O(n log n)", "uniform uniform", lambda s: np.setdiff1d(*s), BY_SORT),
    ("scipy.fft.dst, powers of two", "O(n log n)", "uniform", fft.dst, SCIPY, *TWOS),
    ("scipy.signal.hilbert, powers of two", "O(n log n)", "uniform", signal.hilbert, SCIPY, *TWOS),
    ("Voronoi, 2D", "O(n log n)", lambda n: uniform(n, 2), spatial.Voronoi, QUICKHULL),
    ("palindromes counted", "O(n²)", "letters", by_hand.palindromes, CLRS),
    ("knapsack of n by n", "O(n²)", "numbers", by_hand.knapsack, CLRS),
    ("n × list.pop(0)", "O(n²)", "numbers", by_hand.pop_all, WIKI),
    ("matrix * 2", "O(n²)", "matrix", lambda a: a * 2, NUMPY, SQUARE_BOUND),
    ("np.linalg.norm of a matrix", "O(n²)", "matrix", np.linalg.norm, NUMPY, SQUARE_BOUND),
    ("cdist, city block", "O(n²)", "points",
        lambda p: spatial.distance.cdist(p, p, "cityblock"), SCIPY),
    ("np.linalg.qr", "O(n³)", "matrix", np.linalg.qr, LAPACK),
    ("transitive closure by hand", "O(n³)", lambda n: [floats(n) for _ in range(n)],
        by_hand.closure, CLRS + ": Warshall"),
    ("every subset of a list", "O(2^n)", "numbers", by_hand.subsets, CLRS),
]))
# fmt: on
