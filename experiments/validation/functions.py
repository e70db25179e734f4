"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise.
"""

import base64
import bisect
import collections
import copy
import hashlib
import heapq
import itertools
import json
import pickle
import random
import re
import statistics
import zlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import scipy
import scipy.fft
import scipy.interpolate
import scipy.linalg
import scipy.ndimage
import scipy.optimize
import scipy.signal
import scipy.sparse
import scipy.spatial
import scipy.stats

WIKI = "wiki.python.org/moin/TimeComplexity"
TIMSORT = "CPython, Objects/listsort.txt"
CPYTHON = "CPython's source: one pass"
LOOP = "counted by hand"
NUMPY = "numpy.org/doc: one pass"
SORT = "numpy.org/doc, numpy.sort"
LAPACK = "Golub and Van Loan, Matrix Computations"
PYDOC = "docs.python.org"
SCIPY = "docs.scipy.org"
CLRS = "Cormen et al., Introduction to Algorithms"

KEYS = 1_000  # asked per call of what takes less than the clock shows
CACHE_BOUND = 12_500_000  # float64 of 10^8 bytes


class Function(NamedTuple):
    """A function of known cost."""

    name: str
    growth: str
    make: Callable[[int], Any]
    call: Callable[[Any], object]
    source: str
    most: int = 1_000_000
    powers: bool = False  # sizes are powers of two


def floats(n: int) -> list[float]:
    """A list of n numbers, uniform in 0 … 1."""
    return [random.random() for _ in range(n)]


def _numbers(n: int) -> list[int]:
    return list(range(n))


def _text(n: int) -> str:
    return "abcdefghij" * (n // 10) + "x" * (n % 10)


def _bytes(n: int) -> bytes:
    return random.randbytes(n)


def uniform(n: int) -> Any:
    """The same as an array."""
    return np.random.default_rng().random(n)


def matrix(n: int) -> Any:
    """(n, n), far from singular."""
    return np.random.default_rng().random((n, n)) + n * np.eye(n)


def sparse_matrix(n: int) -> Any:
    """(n, n), some five entries in a row."""
    return scipy.sparse.random_array((n, n), density=min(5 / n, 1), format="csr")


def _points(n: int) -> Any:
    return np.random.default_rng().random((n, 3))


def _sphere(n: int) -> Any:  # all on the hull: of points in a cube most are seen just once
    points = _points(n) - 0.5
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def asked(n: int) -> list[int]:
    """``KEYS`` integers below n."""
    return random.choices(range(n), k=KEYS)


def _records(n: int) -> list[dict[str, Any]]:
    return [{"id": i, "name": f"item {i}", "x": i / 7} for i in range(n)]


def _prepend(n: int) -> str:
    text = ""
    for _ in range(n):
        text = "x" + text
    return text


def _times(call: Callable[[Any], object]) -> Callable[[Any], object]:
    """The same call many times."""

    def every(it: Any) -> None:
        for _ in itertools.repeat(None, KEYS):
            call(it)

    return every


def _each(call: Callable[[Any, Any], object]) -> Callable[[Any], object]:
    """Call with a container and each of the keys beside it."""

    def every(given: Any) -> None:
        held, keys = given
        for key in keys:
            call(held, key)

    return every


def _append(n: int) -> list[int]:
    made: list[int] = []
    for i in range(n):
        made.append(i)
    return made


def _sift(heap: list[float]) -> None:
    for value in range(KEYS):
        heapq.heapreplace(heap, 1.0 + value)


def _drain(heap: list[float]) -> None:
    while heap:
        heapq.heappop(heap)


def itself(n: int) -> int:
    """The size, where it is the input."""
    return n


def _subsets(n: int) -> int:
    return sum(1 for _ in itertools.product((0, 1), repeat=n))


def _pairs_that_match(it: list[int]) -> int:
    return sum(a == b for a in it for b in it)


def _banded(n: int) -> Any:
    return np.vstack([np.ones(n), np.full(n, 4.0), np.ones(n)]), uniform(n)


# fmt: off
FUNCTIONS: tuple[Function, ...] = (
    Function("len(list)", "O(1)", _numbers, _times(len), WIKI),
    Function("list[i], 1,000 random i", "O(1)", lambda n: (_numbers(n), asked(n)),
        _each(lambda s, i: s[i]), WIKI),
    Function("list.copy", "O(n)", _numbers, list.copy, WIKI),
    Function("absent in list", "O(n)", _numbers, lambda s: -1 in s, WIKI),
    Function("list.sort, random", "O(n log n)", floats, list.sort, WIKI),
    Function("sorted, of sorted", "O(n)", _numbers, sorted, TIMSORT),
    Function("list.insert(0)", "O(n)", _numbers, lambda s: s.insert(0, 0), WIKI),
    Function("n × list.append", "O(n)", itself, _append, WIKI),
    Function("list.reverse", "O(n)", _numbers, list.reverse, CPYTHON),
    Function("sum(list)", "O(n)", floats, sum, WIKI),
    Function("min(list)", "O(n)", floats, min, WIKI),
    Function("list == list", "O(n)", lambda n: (_numbers(n), _numbers(n)), lambda s: s[0] == s[1],
        CPYTHON),
    Function("dict[key], 1,000 random", "O(1)", lambda n: (dict.fromkeys(range(n)), asked(n)),
        _each(dict.get), WIKI),
    Function("dict.fromkeys", "O(n)", floats, dict.fromkeys, WIKI),
    Function("set(list)", "O(n)", floats, set, WIKI),
    Function("key in set, 1,000 random", "O(1)", lambda n: (set(range(n)), asked(n)),
        _each(set.__contains__), WIKI),
    Function("set & set", "O(n)", lambda n: (set(range(n)), set(range(n))), lambda s: s[0] & s[1],
        WIKI),
    Function("dict.copy", "O(n)", lambda n: dict.fromkeys(range(n)), dict.copy, WIKI),
    Function("deque.rotate(n // 2)", "O(n)", lambda n: collections.deque(range(n)),
        lambda s: s.rotate(len(s) // 2), WIKI),
    Function("deque.popleft and append", "O(1)", lambda n: collections.deque(range(n)),
        _times(lambda s: s.append(s.popleft())), WIKI),
    Function("deque[n // 2]", "O(n)", lambda n: collections.deque(range(n)),
        lambda s: s[len(s) // 2], WIKI),
    Function("heapq.heapify", "O(n)", floats, heapq.heapify, CLRS),
    Function("heapq.heapreplace, 1,000 to the bottom", "O(log n)", lambda n: sorted(floats(n)),
        _sift, CLRS),
    Function("heapq.heappop, all", "O(n log n)", lambda n: sorted(floats(n)), _drain, CLRS),
    Function("heapq.nsmallest(10)", "O(n)", floats, lambda s: heapq.nsmallest(10, s), PYDOC),
    Function("bisect, 1,000 random", "O(log n)", lambda n: (_numbers(n), asked(n)),
        _each(bisect.bisect), PYDOC),
    Function("bisect.insort at the front", "O(n)", _numbers, lambda s: bisect.insort(s, -1), PYDOC),
    Function("collections.Counter", "O(n)", lambda n: random.choices(range(100), k=n),
        collections.Counter, CPYTHON),
    Function("str.join", "O(n)", lambda n: ["ab"] * n, "".join, PYDOC),
    Function("str.replace", "O(n)", _text, lambda s: s.replace("c", "d"), CPYTHON),
    Function("str.count", "O(n)", _text, lambda s: s.count("j"), CPYTHON),
    Function("str.split", "O(n)", lambda n: "ab " * n, str.split, CPYTHON),
    Function("str[::-1]", "O(n)", _text, lambda s: s[::-1], WIKI),
    Function("a string built by prepending", "O(n²)", itself, _prepend, PYDOC + ", sequence types"),
    Function("re.findall", "O(n)", _text, re.compile("[ae]").findall, CPYTHON),
    Function("re with nested repeats", "O(2^n)", lambda n: "a" * n + "b",
        re.compile("(a|a)*c").match, "owasp.org, ReDoS"),
    Function("json.dumps", "O(n)", _records, json.dumps, CPYTHON),
    Function("json.loads", "O(n)", lambda n: json.dumps(_records(n)), json.loads, CPYTHON),
    Function("pickle.dumps", "O(n)", _records, pickle.dumps, CPYTHON),
    Function("pickle.loads", "O(n)", lambda n: pickle.dumps(_records(n)), pickle.loads, CPYTHON),
    Function("hashlib.sha256", "O(n)", _bytes, lambda s: hashlib.sha256(s).digest(), "FIPS 180-4"),
    Function("zlib.crc32", "O(n)", _bytes, zlib.crc32, "RFC 1952"),
    Function("zlib.compress", "O(n)", lambda n: _text(n).encode(), zlib.compress, "RFC 1951"),
    Function("base64.b64encode", "O(n)", _bytes, base64.b64encode, "RFC 4648"),
    Function("int + int, n bits", "O(n)", random.getrandbits, lambda a: a + a, "Knuth 4.3.1",
        most=10_000_000),
    Function("copy.deepcopy", "O(n)", lambda n: [[i] for i in range(n)], copy.deepcopy, PYDOC),
    Function("random.shuffle", "O(n)", _numbers, random.shuffle, "Knuth 3.4.2"),
    Function("statistics.median", "O(n log n)", floats, statistics.median, PYDOC + ": it sorts"),
    Function("itertools.combinations, pairs", "O(n²)", range,
        lambda s: list(itertools.combinations(s, 2)), PYDOC),
    Function("itertools.product, triples", "O(n³)", range,
        lambda s: sum(1 for _ in itertools.product(s, repeat=3)), PYDOC),
    Function("itertools.product, all subsets", "O(2^n)", itself, _subsets, PYDOC),
    Function("two loops over a list", "O(n²)", _numbers, _pairs_that_match, LOOP),
    Function("array[i], 1,000 times", "O(1)", uniform, _times(lambda a: a[0]), NUMPY),
    Function("array[::2], a view", "O(1)", uniform, _times(lambda a: a[::2]),
        "numpy.org/doc: views"),
    Function("np.sum", "O(n)", uniform, np.sum, NUMPY, most=CACHE_BOUND),
    Function("np.copy", "O(n)", uniform, np.copy, NUMPY, most=CACHE_BOUND),
    Function("array + array", "O(n)", uniform, lambda a: a + a, NUMPY, most=CACHE_BOUND),
    Function("np.exp", "O(n)", uniform, np.exp, NUMPY, most=CACHE_BOUND),
    Function("np.cumsum", "O(n)", uniform, np.cumsum, NUMPY, most=CACHE_BOUND),
    Function("np.concatenate", "O(n)", uniform, lambda a: np.concatenate([a, a]), NUMPY,
        most=CACHE_BOUND),
    Function("np.sort, random", "O(n log n)", uniform, np.sort, SORT, most=CACHE_BOUND),
    Function("np.argsort", "O(n log n)", uniform, np.argsort, SORT),
    Function("np.unique", "O(n log n)", uniform, np.unique, SORT + ": it sorts"),
    Function("np.partition", "O(n)", uniform, lambda a: np.partition(a, len(a) // 2),
        "numpy.org/doc, numpy.partition"),
    Function("np.median", "O(n)", uniform, np.median, "numpy.org/doc, numpy.partition"),
    Function("np.searchsorted, 1,000 keys", "O(log n)",
        lambda n: (np.arange(n), np.array(asked(n))), lambda s: np.searchsorted(*s),
        "numpy.org/doc: binary search"),
    Function("array[random indices]", "O(n)",
        lambda n: (uniform(n), np.random.default_rng().permutation(n)), lambda s: s[0][s[1]], NUMPY,
        most=CACHE_BOUND),
    Function("np.bincount", "O(n)", lambda n: np.random.default_rng().integers(0, 100, n),
        np.bincount, NUMPY),
    Function("np.histogram, 10 bins", "O(n)", uniform, np.histogram, NUMPY),
    Function("np.outer", "O(n²)", uniform, lambda a: np.outer(a, a), NUMPY),
    Function("np.convolve, full", "O(n²)", uniform, lambda a: np.convolve(a, a),
        "numpy.org/doc: direct sum"),
    Function("matrix @ vector", "O(n²)", lambda n: (matrix(n), uniform(n)), lambda s: s[0] @ s[1],
        LAPACK),
    Function("matrix @ matrix", "O(n³)", matrix, lambda a: a @ a, LAPACK),
    Function("np.linalg.inv", "O(n³)", matrix, np.linalg.inv, LAPACK),
    Function("scipy.fft.rfft, powers of two", "O(n log n)", uniform, scipy.fft.rfft, SCIPY,
        powers=True),
    Function("scipy.signal.fftconvolve", "O(n log n)", uniform,
        lambda a: scipy.signal.fftconvolve(a, a), SCIPY, powers=True),
    Function("cKDTree, built", "O(n log n)", _points, scipy.spatial.cKDTree, SCIPY),
    Function("cKDTree.query, 1,000 points", "O(log n)",
        lambda n: (scipy.spatial.cKDTree(_points(n)), _points(KEYS)), lambda s: s[0].query(s[1]),
        SCIPY),
    Function("cdist", "O(n²)", _points, lambda p: scipy.spatial.distance.cdist(p, p), SCIPY),
    Function("ConvexHull of a sphere", "O(n log n)", _sphere, scipy.spatial.ConvexHull,
        "Barber et al., Quickhull"),
    Function("scipy.stats.rankdata", "O(n log n)", uniform, scipy.stats.rankdata,
        SCIPY + ": it sorts"),
    Function("uniform_filter1d", "O(n)", uniform, lambda a: scipy.ndimage.uniform_filter1d(a, 9),
        SCIPY),
    Function("scipy.signal.lfilter", "O(n)", uniform,
        lambda a: scipy.signal.lfilter([1.0], [1.0, -0.5], a), SCIPY),
    Function("solve_banded, 3 diagonals", "O(n)", _banded,
        lambda s: scipy.linalg.solve_banded((1, 1), *s), LAPACK),
    Function("csr_array @ vector, 5 per row", "O(n)",
        lambda n: (sparse_matrix(n), uniform(n)),
        lambda s: s[0] @ s[1], SCIPY),
    Function("CubicSpline", "O(n)", lambda n: (np.arange(n), uniform(n)),
        lambda s: scipy.interpolate.CubicSpline(*s), SCIPY),
)
# fmt: on
