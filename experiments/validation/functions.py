"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. The judge was tuned on the first two tables; the last one was
written down before any judge was asked about it, and tells how good one is. What is decided by its
answers makes it functions to tune on, as it did of `SEEN`, and asks for others.
"""

import array
import ast
import base64
import bisect
import collections
import copy
import csv
import difflib
import functools
import hashlib
import heapq
import itertools
import json
import math
import operator
import pickle
import random
import re
import statistics
import string
import struct
import textwrap
import xml.etree.ElementTree as ElementTree
import zlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy import fft, interpolate, linalg, ndimage, signal, sparse, spatial, special, stats
from scipy.cluster import hierarchy
from scipy.sparse import csgraph

WIKI = "wiki.python.org/moin/TimeComplexity"
TIMSORT = "CPython, Objects/listsort.txt"
CPYTHON = "CPython's source: one pass"
LONG = "CPython, Objects/longobject.c"
LOOP = "counted by hand"
NUMPY = "numpy.org/doc: one pass"
SORT = "numpy.org/doc, numpy.sort"
LAPACK = "Golub and Van Loan, Matrix Computations"
PYDOC = "docs.python.org"
SCIPY = "docs.scipy.org"
GRAPH = "docs.scipy.org, csgraph"
CLRS = "Cormen et al., Introduction to Algorithms"

KEYS = 1_000  # asked per call of what takes less than the clock shows
CACHE_BOUND = 12_500_000  # float64 of 10^8 bytes
SQUARE_BOUND = math.isqrt(CACHE_BOUND)


class Function(NamedTuple):
    """A function of known cost."""

    name: str
    growth: str
    make: Callable[[int], Any]
    call: Callable[[Any], object]
    source: str
    most: int = 1_000_000
    powers: bool = False  # sizes are powers of two


def _itself(n: int) -> int:
    return n


def _numbers(n: int) -> list[int]:
    return list(range(n))


def _floats(n: int) -> list[float]:
    return [random.random() for _ in range(n)]


def _text(n: int) -> str:
    return "abcdefghij" * (n // 10) + "x" * (n % 10)


def _letters(n: int) -> str:
    return "".join(random.choices(string.ascii_lowercase, k=n))


def _words(n: int) -> list[str]:
    return [f"{i:x}" for i in range(n)]


def _bits(n: int) -> int:
    return random.getrandbits(n) | 1 << (n - 1) | 1


def _records(n: int) -> list[dict[str, Any]]:
    return [{"id": i, "name": f"item {i}", "x": i / 7} for i in range(n)]


def _uniform(*shape: int) -> Any:
    return np.random.default_rng().random(shape)


def _matrix(n: int) -> Any:  # far from singular
    return _uniform(n, n) + n * np.eye(n)


def _symmetric(n: int) -> Any:
    return _matrix(n) + _matrix(n).T


def _sparse_matrix(n: int) -> Any:  # some five entries in a row
    return sparse.random_array((n, n), density=min(5 / n, 1), format="csr")


def _points(n: int) -> Any:
    return _uniform(n, 3)


def _sphere(n: int) -> Any:  # all on the hull: of points in a cube most are seen just once
    points = _points(n) - 0.5
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def _banded(n: int) -> Any:
    return np.vstack([np.ones(n), np.full(n, 4.0), np.ones(n)]), _uniform(n)


def _asked(n: int) -> list[int]:
    """``KEYS`` integers below n."""
    return random.choices(range(n), k=KEYS)


def _looked_up(container: Any) -> tuple[Any, list[Any]]:
    """A container and keys in it to ask for."""
    return container, random.choices(list(container), k=KEYS)


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


def _sift(call: Callable[[list[float], float], object]) -> Callable[[list[float]], object]:
    """Call with a heap and what sinks to its bottom, many times."""

    def every(heap: list[float]) -> None:
        for value in range(KEYS):
            call(heap, 1.0 + value)

    return every


def _by_adding(item: Any) -> Callable[[int], object]:
    """Add an item at the front n times."""

    def build(n: int) -> object:
        made = item[:0]
        for _ in range(n):
            made = item + made
        return made

    return build


def _append(n: int) -> list[int]:
    made: list[int] = []
    for i in range(n):
        made.append(i)
    return made


def _drain(heap: list[float]) -> None:
    while heap:
        heapq.heappop(heap)


def _subsets(n: int) -> int:
    return sum(1 for _ in itertools.product((0, 1), repeat=n))


def _pairs_that_match(it: list[int]) -> int:
    return sum(a == b for a in it for b in it)


def _add_and_discard(held: set[int], key: int) -> None:
    held.add(-key)
    held.discard(-key)


def _halve(held: list[int], key: int) -> None:
    low, high = 0, len(held)
    while low < high:
        middle = (low + high) // 2
        if held[middle] < key:
            low = middle + 1
        else:
            high = middle


def _prime(n: int) -> int:
    return next(p for p in itertools.count(n | 1, 2) if _divide(p))


def _divide(p: int) -> bool:
    divisor = 2
    while divisor * divisor <= p:
        if p % divisor == 0:
            return False
        divisor += 1
    return True


def _bubble(it: list[float]) -> None:
    for end in range(len(it) - 1, 0, -1):
        for i in range(end):
            if it[i] > it[i + 1]:
                it[i], it[i + 1] = it[i + 1], it[i]


def _hanoi(n: int) -> int:
    return _hanoi(n - 1) + 1 + _hanoi(n - 1) if n else 0


def _edits(texts: tuple[str, str]) -> int:
    a, b = texts
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        before, row = row, [i]
        for j, y in enumerate(b, 1):
            row.append(min(before[j] + 1, row[-1] + 1, before[j - 1] + (x != y)))
    return row[-1]


def _squarings(n: int) -> float:
    power, base = 1.0, 1.0000001
    while n:
        power, base, n = power * base if n & 1 else power, base * base, n >> 1
    return power


def _euclid(n: int) -> int:
    a, b = n, round(n * 0.6180339887)
    while b:
        a, b = b, a % b
    return a


def _divisors(n: int) -> int:
    return sum(n % d == 0 for d in range(1, math.isqrt(n) + 1))


def _heapsort(it: list[float]) -> list[float]:
    heap: list[float] = []
    for value in it:
        heapq.heappush(heap, value)
    return [heapq.heappop(heap) for _ in it]


def _merge_sort(it: list[float]) -> list[float]:
    if len(it) < 2:
        return it
    half = len(it) // 2
    return list(heapq.merge(_merge_sort(it[:half]), _merge_sort(it[half:])))


def _insertion_sort(it: list[int]) -> None:
    for i in range(1, len(it)):
        value, place = it[i], i
        while place and it[place - 1] > value:
            it[place] = it[place - 1]
            place -= 1
        it[place] = value


def _selection_sort(it: list[float]) -> None:
    for i in range(len(it)):
        least = min(range(i, len(it)), key=it.__getitem__)
        it[i], it[least] = it[least], it[i]


def _pascal(n: int) -> list[float]:
    row = [1.0]
    for _ in range(n):
        row = [a + b for a, b in zip([0.0, *row], [*row, 0.0], strict=True)]
    return row


def _matrix_of_lists(n: int) -> list[list[float]]:
    return [_floats(n) for _ in range(n)]


def _multiply(a: list[list[float]]) -> list[list[float]]:
    columns = list(zip(*a, strict=True))
    return [[sum(map(operator.mul, row, column)) for column in columns] for row in a]


def _triples(it: list[int]) -> int:
    return sum(a + b == c for a in it for b in it for c in it)


def _sums(it: list[int], total: int = 0) -> int:
    return _sums(it[1:], total) + _sums(it[1:], total + it[0]) if it else total


# fmt: off
FUNCTIONS: tuple[Function, ...] = (
    Function("len(list)", "O(1)", _numbers, _times(len), WIKI),
    Function("list[i], 1,000 random i", "O(1)", lambda n: (_numbers(n), _asked(n)),
        _each(lambda s, i: s[i]), WIKI),
    Function("list.copy", "O(n)", _numbers, list.copy, WIKI),
    Function("absent in list", "O(n)", _numbers, lambda s: -1 in s, WIKI),
    Function("list.sort, random", "O(n log n)", _floats, list.sort, WIKI),
    Function("sorted, of sorted", "O(n)", _numbers, sorted, TIMSORT),
    Function("list.insert(0)", "O(n)", _numbers, lambda s: s.insert(0, 0), WIKI),
    Function("n × list.append", "O(n)", _itself, _append, WIKI),
    Function("list.reverse", "O(n)", _numbers, list.reverse, CPYTHON),
    Function("sum(list)", "O(n)", _floats, sum, WIKI),
    Function("min(list)", "O(n)", _floats, min, WIKI),
    Function("list == list", "O(n)", lambda n: (_numbers(n), _numbers(n)), lambda s: s[0] == s[1],
        CPYTHON),
    Function("dict[key], 1,000 random", "O(1)", lambda n: (dict.fromkeys(range(n)), _asked(n)),
        _each(dict.get), WIKI),
    Function("dict.fromkeys", "O(n)", _floats, dict.fromkeys, WIKI),
    Function("set(list)", "O(n)", _floats, set, WIKI),
    Function("key in set, 1,000 random", "O(1)", lambda n: (set(range(n)), _asked(n)),
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
    Function("heapq.heapify", "O(n)", _floats, heapq.heapify, CLRS),
    Function("heapq.heapreplace, 1,000 to the bottom", "O(log n)", lambda n: sorted(_floats(n)),
        _sift(heapq.heapreplace), CLRS),
    Function("heapq.heappop, all", "O(n log n)", lambda n: sorted(_floats(n)), _drain, CLRS),
    Function("heapq.nsmallest(10)", "O(n)", _floats, lambda s: heapq.nsmallest(10, s), PYDOC),
    Function("bisect, 1,000 random", "O(log n)", lambda n: (_numbers(n), _asked(n)),
        _each(bisect.bisect), PYDOC),
    Function("bisect.insort at the front", "O(n)", _numbers, lambda s: bisect.insort(s, -1), PYDOC),
    Function("collections.Counter", "O(n)", lambda n: random.choices(range(100), k=n),
        collections.Counter, CPYTHON),
    Function("str.join", "O(n)", lambda n: ["ab"] * n, "".join, PYDOC),
    Function("str.replace", "O(n)", _text, lambda s: s.replace("c", "d"), CPYTHON),
    Function("str.count", "O(n)", _text, lambda s: s.count("j"), CPYTHON),
    Function("str.split", "O(n)", lambda n: "ab " * n, str.split, CPYTHON),
    Function("str[::-1]", "O(n)", _text, lambda s: s[::-1], WIKI),
    Function("a string built by prepending", "O(n²)", _itself, _by_adding("x"),
        PYDOC + ", sequence types"),
    Function("re.findall", "O(n)", _text, re.compile("[ae]").findall, CPYTHON),
    Function("re with nested repeats", "O(2^n)", lambda n: "a" * n + "b",
        re.compile("(a|a)*c").match, "owasp.org, ReDoS"),
    Function("json.dumps", "O(n)", _records, json.dumps, CPYTHON),
    Function("json.loads", "O(n)", lambda n: json.dumps(_records(n)), json.loads, CPYTHON),
    Function("pickle.dumps", "O(n)", _records, pickle.dumps, CPYTHON),
    Function("pickle.loads", "O(n)", lambda n: pickle.dumps(_records(n)), pickle.loads, CPYTHON),
    Function("hashlib.sha256", "O(n)", random.randbytes, lambda s: hashlib.sha256(s).digest(),
        "FIPS 180-4"),
    Function("zlib.crc32", "O(n)", random.randbytes, zlib.crc32, "RFC 1952"),
    Function("zlib.compress", "O(n)", lambda n: _text(n).encode(), zlib.compress, "RFC 1951"),
    Function("base64.b64encode", "O(n)", random.randbytes, base64.b64encode, "RFC 4648"),
    Function("int + int, n bits", "O(n)", random.getrandbits, lambda a: a + a, "Knuth 4.3.1",
        most=10_000_000),
    Function("copy.deepcopy", "O(n)", lambda n: [[i] for i in range(n)], copy.deepcopy, PYDOC),
    Function("random.shuffle", "O(n)", _numbers, random.shuffle, "Knuth 3.4.2"),
    Function("statistics.median", "O(n log n)", _floats, statistics.median, PYDOC + ": it sorts"),
    Function("itertools.combinations, pairs", "O(n²)", range,
        lambda s: list(itertools.combinations(s, 2)), PYDOC),
    Function("itertools.product, triples", "O(n³)", range,
        lambda s: sum(1 for _ in itertools.product(s, repeat=3)), PYDOC),
    Function("itertools.product, all subsets", "O(2^n)", _itself, _subsets, PYDOC),
    Function("two loops over a list", "O(n²)", _numbers, _pairs_that_match, LOOP),
    Function("array[i], 1,000 times", "O(1)", _uniform, _times(lambda a: a[0]), NUMPY),
    Function("array[::2], a view", "O(1)", _uniform, _times(lambda a: a[::2]),
        "numpy.org/doc: views"),
    Function("np.sum", "O(n)", _uniform, np.sum, NUMPY, most=CACHE_BOUND),
    Function("np.copy", "O(n)", _uniform, np.copy, NUMPY, most=CACHE_BOUND),
    Function("array + array", "O(n)", _uniform, lambda a: a + a, NUMPY, most=CACHE_BOUND),
    Function("np.exp", "O(n)", _uniform, np.exp, NUMPY, most=CACHE_BOUND),
    Function("np.cumsum", "O(n)", _uniform, np.cumsum, NUMPY, most=CACHE_BOUND),
    Function("np.concatenate", "O(n)", _uniform, lambda a: np.concatenate([a, a]), NUMPY,
        most=CACHE_BOUND),
    Function("np.sort, random", "O(n log n)", _uniform, np.sort, SORT, most=CACHE_BOUND),
    Function("np.argsort", "O(n log n)", _uniform, np.argsort, SORT),
    Function("np.unique", "O(n log n)", _uniform, np.unique, SORT + ": it sorts"),
    Function("np.partition", "O(n)", _uniform, lambda a: np.partition(a, len(a) // 2),
        "numpy.org/doc, numpy.partition"),
    Function("np.median", "O(n)", _uniform, np.median, "numpy.org/doc, numpy.partition"),
    Function("np.searchsorted, 1,000 keys", "O(log n)",
        lambda n: (np.arange(n), np.array(_asked(n))), lambda s: np.searchsorted(*s),
        "numpy.org/doc: binary search"),
    Function("array[random indices]", "O(n)",
        lambda n: (_uniform(n), np.random.default_rng().permutation(n)), lambda s: s[0][s[1]],
        NUMPY, most=CACHE_BOUND),
    Function("np.bincount", "O(n)", lambda n: np.random.default_rng().integers(0, 100, n),
        np.bincount, NUMPY),
    Function("np.histogram, 10 bins", "O(n)", _uniform, np.histogram, NUMPY),
    Function("np.outer", "O(n²)", _uniform, lambda a: np.outer(a, a), NUMPY),
    Function("np.convolve, full", "O(n²)", _uniform, lambda a: np.convolve(a, a),
        "numpy.org/doc: direct sum"),
    Function("matrix @ vector", "O(n²)", lambda n: (_matrix(n), _uniform(n)), lambda s: s[0] @ s[1],
        LAPACK),
    Function("matrix @ matrix", "O(n³)", _matrix, lambda a: a @ a, LAPACK),
    Function("np.linalg.inv", "O(n³)", _matrix, np.linalg.inv, LAPACK),
    Function("scipy.fft.rfft, powers of two", "O(n log n)", _uniform, fft.rfft, SCIPY, powers=True),
    Function("scipy.signal.fftconvolve", "O(n log n)", _uniform, lambda a: signal.fftconvolve(a, a),
        SCIPY, powers=True),
    Function("cKDTree, built", "O(n log n)", _points, spatial.cKDTree, SCIPY),
    Function("cKDTree.query, 1,000 points", "O(log n)",
        lambda n: (spatial.cKDTree(_points(n)), _points(KEYS)), lambda s: s[0].query(s[1]), SCIPY),
    Function("cdist", "O(n²)", _points, lambda p: spatial.distance.cdist(p, p), SCIPY),
    Function("ConvexHull of a sphere", "O(n log n)", _sphere, spatial.ConvexHull,
        "Barber et al., Quickhull"),
    Function("scipy.stats.rankdata", "O(n log n)", _uniform, stats.rankdata, SCIPY + ": it sorts"),
    Function("uniform_filter1d", "O(n)", _uniform, lambda a: ndimage.uniform_filter1d(a, 9), SCIPY),
    Function("scipy.signal.lfilter", "O(n)", _uniform,
        lambda a: signal.lfilter([1.0], [1.0, -0.5], a), SCIPY),
    Function("solve_banded, 3 diagonals", "O(n)", _banded,
        lambda s: linalg.solve_banded((1, 1), *s), LAPACK),
    Function("csr_array @ vector, 5 per row", "O(n)", lambda n: (_sparse_matrix(n), _uniform(n)),
        lambda s: s[0] @ s[1], SCIPY),
    Function("CubicSpline", "O(n)", lambda n: (np.arange(n), _uniform(n)),
        lambda s: interpolate.CubicSpline(*s), SCIPY),
)

SEEN: tuple[Function, ...] = (
    Function("dict[str], 1,000 random", "O(1)", lambda n: _looked_up(dict.fromkeys(_words(n))),
        _each(operator.getitem), WIKI),
    Function("OrderedDict.move_to_end, 1,000 random", "O(1)",
        lambda n: _looked_up(collections.OrderedDict.fromkeys(range(n))),
        _each(collections.OrderedDict.move_to_end), PYDOC),
    Function("array.array[i], 1,000 random", "O(1)",
        lambda n: (array.array("d", bytes(8 * n)), _asked(n)), _each(operator.getitem), CPYTHON,
        most=CACHE_BOUND),
    Function("array[1,000 random indices]", "O(1)", lambda n: (_uniform(n), np.array(_asked(n))),
        lambda s: s[0][s[1]], NUMPY, most=CACHE_BOUND),
    Function("bisect in array.array, 1,000 random", "O(log n)",
        lambda n: (array.array("q", range(n)), _asked(n)), _each(bisect.bisect), PYDOC),
    Function("binary search by hand, 1,000 random", "O(log n)",
        lambda n: (list(range(n)), _asked(n)), _each(_halve), CLRS),
    Function("heapq.heappushpop, 1,000 to the bottom", "O(log n)", lambda n: sorted(_floats(n)),
        _sift(heapq.heappushpop), CLRS),
    Function("trial division of a prime", "O(√n)", _prime, _divide, CLRS, most=100_000_000),
    Function("tuple(list)", "O(n)", _numbers, tuple, WIKI),
    Function("list[n // 2:]", "O(n)", _numbers, lambda s: s[len(s) // 2:], WIKI),
    Function("list.pop(0)", "O(n)", _numbers, lambda s: s.pop(0), WIKI),
    Function("hash(tuple)", "O(n)", lambda n: tuple(_floats(n)), hash, CPYTHON),
    Function("set <= set", "O(n)", lambda n: (set(range(n)), set(range(n))), lambda s: s[0] <= s[1],
        WIKI),
    Function("Counter.most_common(10)", "O(n)",
        lambda n: collections.Counter(random.choices(range(n), k=n)), lambda s: s.most_common(10),
        PYDOC + ", heapq.nlargest"),
    Function("itertools.accumulate", "O(n)", _floats, lambda s: list(itertools.accumulate(s)),
        PYDOC),
    Function("itertools.groupby", "O(n)", lambda n: [i // 10 for i in range(n)],
        lambda s: [key for key, _ in itertools.groupby(s)], PYDOC),
    Function("heapq.merge, two lists", "O(n)", lambda n: (list(range(n)), list(range(n))),
        lambda s: list(heapq.merge(*s)), CLRS),
    Function("functools.reduce", "O(n)", _floats, lambda s: functools.reduce(max, s), PYDOC),
    Function("statistics.fmean", "O(n)", _floats, statistics.fmean, PYDOC),
    Function("statistics.mode", "O(n)", lambda n: random.choices(range(100), k=n), statistics.mode,
        CPYTHON),
    Function("struct.unpack", "O(n)", lambda n: random.randbytes(8 * n),
        lambda s: struct.unpack(f"{len(s) // 8}d", s), PYDOC),
    Function("array.array of a list", "O(n)", _floats, lambda s: array.array("d", s), CPYTHON),
    Function("bytes.hex", "O(n)", random.randbytes, bytes.hex, CPYTHON),
    Function("hashlib.blake2b", "O(n)", random.randbytes, lambda s: hashlib.blake2b(s).digest(),
        "RFC 7693"),
    Function("zlib.decompress", "O(n)", lambda n: zlib.compress(_letters(n).encode()),
        zlib.decompress, "RFC 1951"),
    Function("str.upper", "O(n)", _letters, str.upper, CPYTHON),
    Function("str.find, half as long", "O(n)", lambda n: ("a" * n, "a" * (n // 2) + "b"),
        lambda s: s[0].find(s[1]), "CPython, Objects/stringlib: two-way search"),
    Function("textwrap.wrap", "O(n)", lambda n: "lorem ipsum dolor " * (n // 18 + 1), textwrap.wrap,
        CPYTHON),
    Function("csv.reader", "O(n)", lambda n: [f"{i},b,{i / 7}" for i in range(n)],
        lambda s: list(csv.reader(s)), CPYTHON),
    Function("ast.parse", "O(n)", lambda n: "x = y + 1\n" * n, ast.parse, "PEP 617"),
    Function("ElementTree.fromstring", "O(n)", lambda n: f"<a>{'<b>text</b>' * n}</a>",
        ElementTree.fromstring, "libexpat.github.io: one pass"),
    Function("sorted, by a key", "O(n log n)", _floats, lambda s: sorted(s, key=float.__neg__),
        WIKI),
    Function("int * int, n bits", "O(n^1.585)", lambda n: (_bits(n), _bits(n)),
        lambda s: s[0] * s[1], LONG + ": Karatsuba"),
    Function("int // int, 2n by n bits", "O(n²)", lambda n: (_bits(2 * n), _bits(n)),
        lambda s: s[0] // s[1], LONG + ": Knuth 4.3.1, D"),
    Function("math.gcd, n bits", "O(n²)", lambda n: (_bits(n), _bits(n)), lambda s: math.gcd(*s),
        LONG + ": Lehmer"),
    Function("pow(a, b, m), n bits", "O(n³)", lambda n: (_bits(n), _bits(n), _bits(n)),
        lambda s: pow(*s), LONG + ": n products and divisions"),
    Function("difflib, all alike", "O(n²)",
        lambda n: difflib.SequenceMatcher(None, "a" * n, "a" * n, autojunk=False),
        lambda s: s.find_longest_match(), PYDOC),
    Function("re.search, from every place", "O(n²)", lambda n: "a" * n, re.compile("a*b").search,
        "owasp.org, ReDoS"),
    Function("re, a repeat of repeats", "O(2^n)", lambda n: "a" * n + "c",
        re.compile("(a+)+b").match, "owasp.org, ReDoS"),
    Function("bubble sort", "O(n²)", _floats, _bubble, CLRS),
    Function("edit distance", "O(n²)", lambda n: (_letters(n), _letters(n)), _edits, CLRS),
    Function("towers of Hanoi", "O(2^n)", _itself, _hanoi, CLRS),
    Function("a tuple built by adding", "O(n²)", _itself, _by_adding((0,)),
        PYDOC + ", sequence types"),
    Function("bytes built by adding", "O(n²)", _itself, _by_adding(b"x"),
        PYDOC + ", sequence types"),
    Function("np.dot of vectors", "O(n)", _uniform, lambda a: a @ a, LAPACK, most=CACHE_BOUND),
    Function("np.argmax", "O(n)", _uniform, np.argmax, NUMPY, most=CACHE_BOUND),
    Function("np.diff", "O(n)", _uniform, np.diff, NUMPY, most=CACHE_BOUND),
    Function("array[array > 0.5]", "O(n)", _uniform, lambda a: a[a > 0.5], NUMPY, most=CACHE_BOUND),
    Function("np.roll", "O(n)", _uniform, lambda a: np.roll(a, 7), NUMPY, most=CACHE_BOUND),
    Function("scipy.special.erf", "O(n)", _uniform, special.erf, NUMPY, most=CACHE_BOUND),
    Function("array.tolist", "O(n)", _uniform, lambda a: a.tolist(), NUMPY),
    Function("np.digitize, 10 bins", "O(n)", _uniform,
        lambda a: np.digitize(a, np.linspace(0, 1, 10)), NUMPY),
    Function("np.polyfit, degree 3", "O(n)", lambda n: (np.linspace(0, 1, n), _uniform(n)),
        lambda s: np.polyfit(s[0], s[1], 3), LAPACK),
    Function("np.sort of uint16, stable", "O(n)",
        lambda n: np.random.default_rng().integers(0, 2**16, n, np.uint16),
        lambda a: np.sort(a, kind="stable"), SORT + ": radix sort", most=CACHE_BOUND),
    Function("np.sort of float64, stable", "O(n log n)", _uniform,
        lambda a: np.sort(a, kind="stable"), SORT, most=CACHE_BOUND),
    Function("np.intersect1d", "O(n log n)", lambda n: (_uniform(n), _uniform(n + 1)),
        lambda s: np.intersect1d(*s), SORT + ": it sorts"),
    Function("np.searchsorted, n random keys", "O(n log n)",
        lambda n: (np.sort(_uniform(n)), _uniform(n + 1)[:n]), lambda s: np.searchsorted(*s),
        "numpy.org/doc: binary search"),
    Function("np.fft.fft, powers of two", "O(n log n)", _uniform, np.fft.fft,
        "numpy.org/doc, numpy.fft", powers=True),
    Function("array.T.copy", "O(n²)", _matrix, lambda a: a.T.copy(), NUMPY, most=SQUARE_BOUND),
    Function("np.linalg.solve", "O(n³)", _matrix, lambda a: np.linalg.solve(a, a[0]), LAPACK),
    Function("np.linalg.eigvalsh", "O(n³)", _symmetric, np.linalg.eigvalsh, LAPACK),
    Function("solve_triangular", "O(n²)", _matrix, lambda a: linalg.solve_triangular(a, a[0]),
        LAPACK),
    Function("solve_toeplitz", "O(n²)", lambda n: _uniform(n) + n * (np.arange(n) == 0),
        lambda a: linalg.solve_toeplitz(a, a), SCIPY + ": Levinson"),
    Function("csgraph.connected_components", "O(n)", _sparse_matrix, csgraph.connected_components,
        GRAPH),
    Function("csgraph.dijkstra, from one", "O(n log n)", _sparse_matrix,
        functools.partial(csgraph.dijkstra, indices=0), GRAPH),
    Function("csgraph.minimum_spanning_tree", "O(n log n)", _sparse_matrix,
        csgraph.minimum_spanning_tree, GRAPH + ": it sorts"),
    Function("csgraph.floyd_warshall", "O(n³)", _matrix, csgraph.floyd_warshall, GRAPH),
    Function("Delaunay, 2D", "O(n log n)", lambda n: _uniform(n, 2), spatial.Delaunay,
        "Barber et al., Quickhull"),
    Function("pdist", "O(n²)", _points, spatial.distance.pdist, SCIPY),
    Function("linkage, single", "O(n²)", _points, hierarchy.linkage, SCIPY),
    Function("scipy.signal.find_peaks", "O(n)", _uniform, signal.find_peaks, SCIPY),
    Function("savgol_filter", "O(n)", lambda n: _uniform(max(n, 11)),
        lambda a: signal.savgol_filter(a, 11, 3), SCIPY),
    Function("scipy.stats.kendalltau", "O(n log n)", lambda n: (_uniform(n), _uniform(n + 1)[:n]),
        lambda s: stats.kendalltau(*s), SCIPY + ": Knight's algorithm"),
)

HELD_OUT: tuple[Function, ...] = (
    Function("set.add and discard, 1,000 times", "O(1)", lambda n: (set(range(n)), _asked(n)),
        _each(_add_and_discard), WIKI),
    Function("bytes[i], 1,000 random", "O(1)", lambda n: (random.randbytes(n), _asked(n)),
        _each(operator.getitem), CPYTHON, most=CACHE_BOUND),
    Function("tuple[i], 1,000 random", "O(1)", lambda n: (tuple(_floats(n)), _asked(n)),
        _each(operator.getitem), WIKI),
    Function("dict[float], 1,000 random", "O(1)", lambda n: _looked_up(dict.fromkeys(_floats(n))),
        _each(operator.getitem), WIKI),
    Function("np.take, 1,000 random", "O(1)", lambda n: (np.zeros(n), np.array(_asked(n))),
        lambda s: np.take(*s), NUMPY, most=CACHE_BOUND),
    Function("bisect in floats, 1,000 random", "O(log n)",
        lambda n: (sorted(_floats(n)), _floats(KEYS)), _each(bisect.bisect), PYDOC),
    Function("power by squarings", "O(log n)", _itself, _squarings, CLRS),
    Function("Euclid's algorithm", "O(log n)", _itself, _euclid, CLRS),
    Function("divisors up to the root", "O(√n)", _itself, _divisors, LOOP),
    Function("list.extend", "O(n)", _floats, lambda s: [].extend(s), WIKI),
    Function("list.count", "O(n)", _numbers, lambda s: s.count(-1), CPYTHON),
    Function("set | set", "O(n)", lambda n: (set(_floats(n)), set(_floats(n))),
        lambda s: s[0] | s[1], WIKI),
    Function("dict of pairs", "O(n)", lambda n: list(enumerate(_floats(n))), dict, WIKI),
    Function("sum(dict.values)", "O(n)", lambda n: dict(enumerate(_floats(n))),
        lambda s: sum(s.values()), WIKI),
    Function("map(str) and join", "O(n)", _floats, lambda s: ",".join(map(str, s)), PYDOC),
    Function("list of a comprehension", "O(n)", _floats, lambda s: [x * x for x in s if x < 0.5],
        LOOP),
    Function("itertools.chain", "O(n)", lambda n: [[1.5, 2.5]] * n,
        lambda s: list(itertools.chain.from_iterable(s)), PYDOC),
    Function("str.splitlines", "O(n)", lambda n: "line\n" * n, str.splitlines, CPYTHON),
    Function("str.translate", "O(n)", _letters, lambda s: s.translate({97: 98}), CPYTHON),
    Function("re.sub", "O(n)", _letters, lambda s: re.sub("[aeiou]", "-", s), CPYTHON),
    Function("zlib.adler32", "O(n)", random.randbytes, zlib.adler32, "RFC 1950"),
    Function("hashlib.md5", "O(n)", random.randbytes, lambda s: hashlib.md5(s).digest(),
        "RFC 1321"),
    Function("statistics.variance", "O(n)", _floats, statistics.variance, PYDOC),
    Function("math.fsum", "O(n)", _floats, math.fsum, PYDOC),
    Function("np.var", "O(n)", _uniform, np.var, NUMPY, most=CACHE_BOUND),
    Function("np.clip", "O(n)", _uniform, lambda a: np.clip(a, 0.2, 0.8), NUMPY, most=CACHE_BOUND),
    Function("np.sin", "O(n)", _uniform, np.sin, NUMPY, most=CACHE_BOUND),
    Function("np.where", "O(n)", _uniform, lambda a: np.where(a > 0.5, a, 0.0), NUMPY,
        most=CACHE_BOUND),
    Function("np.cumprod", "O(n)", _uniform, np.cumprod, NUMPY, most=CACHE_BOUND),
    Function("gaussian_filter1d", "O(n)", _uniform, lambda a: ndimage.gaussian_filter1d(a, 2),
        SCIPY),
    Function("sorted, integers at random", "O(n log n)", lambda n: random.sample(range(2 * n), n),
        sorted, WIKI),
    Function("sorted, strings at random", "O(n log n)", lambda n: random.sample(_words(2 * n), n),
        sorted, WIKI),
    Function("heap sort", "O(n log n)", _floats, _heapsort, CLRS),
    Function("merge sort", "O(n log n)", _floats, _merge_sort, CLRS),
    Function("np.lexsort", "O(n log n)", lambda n: (_uniform(n), _uniform(n)), np.lexsort, SORT),
    Function("insertion sort, reversed", "O(n²)", lambda n: list(range(n, 0, -1)), _insertion_sort,
        CLRS),
    Function("selection sort", "O(n²)", _floats, _selection_sort, CLRS),
    Function("Pascal's triangle", "O(n²)", _itself, _pascal, LOOP),
    Function("matrix + matrix.T", "O(n²)", _matrix, lambda a: a + a.T, NUMPY),
    Function("matrix times matrix, by hand", "O(n³)", _matrix_of_lists, _multiply, CLRS),
    Function("three loops over a list", "O(n³)", _numbers, _triples, LOOP),
    Function("sums of all subsets", "O(2^n)", _numbers, _sums, CLRS),
)
# fmt: on
