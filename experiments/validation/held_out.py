"""Real functions of known cost that no judge was tuned on: they tell how good one is.

Written down before any judge was asked about them. What is decided by their answers makes them
functions to tune on, as it did of `SEEN`, and asks for others. See
`experiments.validation.functions`.
"""

import array
import ast
import bisect
import collections
import csv
import difflib
import functools
import hashlib
import heapq
import itertools
import math
import operator
import random
import re
import statistics
import string
import struct
import textwrap
import xml.etree.ElementTree as ElementTree
import zlib
from typing import Any

import numpy as np
import scipy
import scipy.cluster.hierarchy
import scipy.linalg
import scipy.ndimage
import scipy.signal
import scipy.sparse.csgraph
import scipy.spatial
import scipy.special
import scipy.stats

from experiments.validation.functions import (
    CACHE_BOUND,
    CLRS,
    CPYTHON,
    KEYS,
    LAPACK,
    LOOP,
    NUMPY,
    PYDOC,
    SCIPY,
    SORT,
    WIKI,
    Function,
    asked,
    floats,
    itself,
    matrix,
    sparse_matrix,
    uniform,
)

LONG = "CPython, Objects/longobject.c"
GRAPH = "docs.scipy.org, csgraph"
SQUARE_BOUND = math.isqrt(CACHE_BOUND)


def _symmetric(n: int) -> Any:
    return matrix(n) + matrix(n).T


def _bits(n: int) -> int:
    return random.getrandbits(n) | 1 << (n - 1) | 1


def _words(n: int) -> list[str]:
    return [f"{i:x}" for i in range(n)]


def _looked_up(container: Any) -> tuple[Any, list[Any]]:
    """A container and keys in it to ask for."""
    return container, random.choices(list(container), k=KEYS)


def _ask(given: tuple[Any, list[Any]]) -> None:
    held, keys = given
    for key in keys:
        held[key]


def _move_to_end(given: tuple[Any, list[Any]]) -> None:
    held, keys = given
    for key in keys:
        held.move_to_end(key)


def _bisect(given: tuple[Any, list[Any]]) -> None:
    held, keys = given
    for key in keys:
        bisect.bisect(held, key)


def _halve(given: tuple[list[int], list[int]]) -> None:
    held, keys = given
    for key in keys:
        low, high = 0, len(held)
        while low < high:
            middle = (low + high) // 2
            if held[middle] < key:
                low = middle + 1
            else:
                high = middle


def _push_and_pop(heap: list[float]) -> None:
    for value in range(KEYS):
        heapq.heappushpop(heap, 1.0 + value)


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


def _letters(n: int) -> str:
    return "".join(random.choices(string.ascii_lowercase, k=n))


def _tuple_by_adding(n: int) -> tuple[int, ...]:
    made: tuple[int, ...] = ()
    for i in range(n):
        made += (i,)
    return made


def _bytes_by_adding(n: int) -> bytes:
    made = b""
    for _ in range(n):
        made += b"x"
    return made


def _add_and_discard(given: tuple[set[int], list[int]]) -> None:
    held, keys = given
    for key in keys:
        held.add(-key)
        held.discard(-key)


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
    return [floats(n) for _ in range(n)]


def _multiply(a: list[list[float]]) -> list[list[float]]:
    columns = list(zip(*a, strict=True))
    return [[sum(map(operator.mul, row, column)) for column in columns] for row in a]


def _triples(it: list[int]) -> int:
    return sum(a + b == c for a in it for b in it for c in it)


def _sums(it: list[int], total: int = 0) -> int:
    return _sums(it[1:], total) + _sums(it[1:], total + it[0]) if it else total


# fmt: off
SEEN: tuple[Function, ...] = (
    Function("dict[str], 1,000 random", "O(1)",
        lambda n: _looked_up(dict.fromkeys(_words(n))), _ask, WIKI),
    Function("OrderedDict.move_to_end, 1,000 random", "O(1)",
        lambda n: _looked_up(collections.OrderedDict.fromkeys(range(n))), _move_to_end, PYDOC),
    Function("array.array[i], 1,000 random", "O(1)",
        lambda n: (array.array("d", bytes(8 * n)), asked(n)), _ask, CPYTHON, most=CACHE_BOUND),
    Function("array[1,000 random indices]", "O(1)",
        lambda n: (uniform(n), np.array(asked(n))), lambda s: s[0][s[1]], NUMPY, most=CACHE_BOUND),
    Function("bisect in array.array, 1,000 random", "O(log n)",
        lambda n: (array.array("q", range(n)), asked(n)), _bisect, PYDOC),
    Function("binary search by hand, 1,000 random", "O(log n)",
        lambda n: (list(range(n)), asked(n)), _halve, CLRS),
    Function("heapq.heappushpop, 1,000 to the bottom", "O(log n)", lambda n: sorted(floats(n)),
        _push_and_pop, CLRS),
    Function("trial division of a prime", "O(√n)", _prime, _divide, CLRS, most=100_000_000),
    Function("tuple(list)", "O(n)", lambda n: list(range(n)), tuple, WIKI),
    Function("list[n // 2:]", "O(n)", lambda n: list(range(n)), lambda s: s[len(s) // 2:], WIKI),
    Function("list.pop(0)", "O(n)", lambda n: list(range(n)), lambda s: s.pop(0), WIKI),
    Function("hash(tuple)", "O(n)", lambda n: tuple(floats(n)), hash, CPYTHON),
    Function("set <= set", "O(n)", lambda n: (set(range(n)), set(range(n))),
        lambda s: s[0] <= s[1], WIKI),
    Function("Counter.most_common(10)", "O(n)",
        lambda n: collections.Counter(random.choices(range(n), k=n)),
        lambda s: s.most_common(10), PYDOC + ", heapq.nlargest"),
    Function("itertools.accumulate", "O(n)", floats, lambda s: list(itertools.accumulate(s)),
        PYDOC),
    Function("itertools.groupby", "O(n)", lambda n: [i // 10 for i in range(n)],
        lambda s: [key for key, _ in itertools.groupby(s)], PYDOC),
    Function("heapq.merge, two lists", "O(n)", lambda n: (list(range(n)), list(range(n))),
        lambda s: list(heapq.merge(*s)), CLRS),
    Function("functools.reduce", "O(n)", floats, lambda s: functools.reduce(max, s), PYDOC),
    Function("statistics.fmean", "O(n)", floats, statistics.fmean, PYDOC),
    Function("statistics.mode", "O(n)", lambda n: random.choices(range(100), k=n),
        statistics.mode, CPYTHON),
    Function("struct.unpack", "O(n)", lambda n: random.randbytes(8 * n),
        lambda s: struct.unpack(f"{len(s) // 8}d", s), PYDOC),
    Function("array.array of a list", "O(n)", floats, lambda s: array.array("d", s), CPYTHON),
    Function("bytes.hex", "O(n)", random.randbytes, bytes.hex, CPYTHON),
    Function("hashlib.blake2b", "O(n)", random.randbytes, lambda s: hashlib.blake2b(s).digest(),
        "RFC 7693"),
    Function("zlib.decompress", "O(n)", lambda n: zlib.compress(_letters(n).encode()),
        zlib.decompress, "RFC 1951"),
    Function("str.upper", "O(n)", _letters, str.upper, CPYTHON),
    Function("str.find, half as long", "O(n)", lambda n: ("a" * n, "a" * (n // 2) + "b"),
        lambda s: s[0].find(s[1]), "CPython, Objects/stringlib: two-way search"),
    Function("textwrap.wrap", "O(n)", lambda n: "lorem ipsum dolor " * (n // 18 + 1),
        textwrap.wrap, CPYTHON),
    Function("csv.reader", "O(n)", lambda n: [f"{i},b,{i / 7}" for i in range(n)],
        lambda s: list(csv.reader(s)), CPYTHON),
    Function("ast.parse", "O(n)", lambda n: "x = y + 1\n" * n, ast.parse, "PEP 617"),
    Function("ElementTree.fromstring", "O(n)", lambda n: f"<a>{'<b>text</b>' * n}</a>",
        ElementTree.fromstring, "libexpat.github.io: one pass"),
    Function("sorted, by a key", "O(n log n)", floats, lambda s: sorted(s, key=float.__neg__),
        WIKI),
    Function("int * int, n bits", "O(n^1.585)", lambda n: (_bits(n), _bits(n)),
        lambda s: s[0] * s[1], LONG + ": Karatsuba"),
    Function("int // int, 2n by n bits", "O(n²)", lambda n: (_bits(2 * n), _bits(n)),
        lambda s: s[0] // s[1], LONG + ": Knuth 4.3.1, D"),
    Function("math.gcd, n bits", "O(n²)", lambda n: (_bits(n), _bits(n)),
        lambda s: math.gcd(*s), LONG + ": Lehmer"),
    Function("pow(a, b, m), n bits", "O(n³)", lambda n: (_bits(n), _bits(n), _bits(n)),
        lambda s: pow(*s), LONG + ": n products and divisions"),
    Function("difflib, all alike", "O(n²)",
        lambda n: difflib.SequenceMatcher(None, "a" * n, "a" * n, autojunk=False),
        lambda s: s.find_longest_match(), PYDOC),
    Function("re.search, from every place", "O(n²)", lambda n: "a" * n, re.compile("a*b").search,
        "owasp.org, ReDoS"),
    Function("re, a repeat of repeats", "O(2^n)", lambda n: "a" * n + "c",
        re.compile("(a+)+b").match, "owasp.org, ReDoS"),
    Function("bubble sort", "O(n²)", floats, _bubble, CLRS),
    Function("edit distance", "O(n²)", lambda n: (_letters(n), _letters(n)), _edits, CLRS),
    Function("towers of Hanoi", "O(2^n)", itself, _hanoi, CLRS),
    Function("a tuple built by adding", "O(n²)", itself, _tuple_by_adding,
        PYDOC + ", sequence types"),
    Function("bytes built by adding", "O(n²)", itself, _bytes_by_adding,
        PYDOC + ", sequence types"),
    Function("np.dot of vectors", "O(n)", uniform, lambda a: a @ a, LAPACK, most=CACHE_BOUND),
    Function("np.argmax", "O(n)", uniform, np.argmax, NUMPY, most=CACHE_BOUND),
    Function("np.diff", "O(n)", uniform, np.diff, NUMPY, most=CACHE_BOUND),
    Function("array[array > 0.5]", "O(n)", uniform, lambda a: a[a > 0.5], NUMPY, most=CACHE_BOUND),
    Function("np.roll", "O(n)", uniform, lambda a: np.roll(a, 7), NUMPY, most=CACHE_BOUND),
    Function("scipy.special.erf", "O(n)", uniform, scipy.special.erf, NUMPY, most=CACHE_BOUND),
    Function("array.tolist", "O(n)", uniform, lambda a: a.tolist(), NUMPY),
    Function("np.digitize, 10 bins", "O(n)", uniform,
        lambda a: np.digitize(a, np.linspace(0, 1, 10)), NUMPY),
    Function("np.polyfit, degree 3", "O(n)", lambda n: (np.linspace(0, 1, n), uniform(n)),
        lambda s: np.polyfit(s[0], s[1], 3), LAPACK),
    Function("np.sort of uint16, stable", "O(n)",
        lambda n: np.random.default_rng().integers(0, 2**16, n, np.uint16),
        lambda a: np.sort(a, kind="stable"), SORT + ": radix sort", most=CACHE_BOUND),
    Function("np.sort of float64, stable", "O(n log n)", uniform,
        lambda a: np.sort(a, kind="stable"), SORT, most=CACHE_BOUND),
    Function("np.intersect1d", "O(n log n)", lambda n: (uniform(n), uniform(n + 1)),
        lambda s: np.intersect1d(*s), SORT + ": it sorts"),
    Function("np.searchsorted, n random keys", "O(n log n)",
        lambda n: (np.sort(uniform(n)), uniform(n + 1)[:n]), lambda s: np.searchsorted(*s),
        "numpy.org/doc: binary search"),
    Function("np.fft.fft, powers of two", "O(n log n)", uniform, np.fft.fft,
        "numpy.org/doc, numpy.fft", powers=True),
    Function("array.T.copy", "O(n²)", matrix, lambda a: a.T.copy(), NUMPY, most=SQUARE_BOUND),
    Function("np.linalg.solve", "O(n³)", matrix, lambda a: np.linalg.solve(a, a[0]), LAPACK),
    Function("np.linalg.eigvalsh", "O(n³)", _symmetric, np.linalg.eigvalsh, LAPACK),
    Function("solve_triangular", "O(n²)", matrix,
        lambda a: scipy.linalg.solve_triangular(a, a[0]), LAPACK),
    Function("solve_toeplitz", "O(n²)", lambda n: uniform(n) + n * (np.arange(n) == 0),
        lambda a: scipy.linalg.solve_toeplitz(a, a), SCIPY + ": Levinson"),
    Function("csgraph.connected_components", "O(n)", sparse_matrix,
        scipy.sparse.csgraph.connected_components, GRAPH),
    Function("csgraph.dijkstra, from one", "O(n log n)", sparse_matrix,
        functools.partial(scipy.sparse.csgraph.dijkstra, indices=0), GRAPH),
    Function("csgraph.minimum_spanning_tree", "O(n log n)", sparse_matrix,
        scipy.sparse.csgraph.minimum_spanning_tree, GRAPH + ": it sorts"),
    Function("csgraph.floyd_warshall", "O(n³)", matrix, scipy.sparse.csgraph.floyd_warshall,
        GRAPH),
    Function("Delaunay, 2D", "O(n log n)", lambda n: np.random.default_rng().random((n, 2)),
        scipy.spatial.Delaunay, "Barber et al., Quickhull"),
    Function("pdist", "O(n²)", lambda n: np.random.default_rng().random((n, 3)),
        scipy.spatial.distance.pdist, SCIPY),
    Function("linkage, single", "O(n²)", lambda n: np.random.default_rng().random((n, 3)),
        scipy.cluster.hierarchy.linkage, SCIPY),
    Function("scipy.signal.find_peaks", "O(n)", uniform, scipy.signal.find_peaks, SCIPY),
    Function("savgol_filter", "O(n)", lambda n: uniform(max(n, 11)),
        lambda a: scipy.signal.savgol_filter(a, 11, 3), SCIPY),
    Function("scipy.stats.kendalltau", "O(n log n)", lambda n: (uniform(n), uniform(n + 1)[:n]),
        lambda s: scipy.stats.kendalltau(*s), SCIPY + ": Knight's algorithm"),
)

HELD_OUT: tuple[Function, ...] = (
    Function("set.add and discard, 1,000 times", "O(1)", lambda n: (set(range(n)), asked(n)),
        _add_and_discard, WIKI),
    Function("bytes[i], 1,000 random", "O(1)", lambda n: (random.randbytes(n), asked(n)), _ask,
        CPYTHON, most=CACHE_BOUND),
    Function("tuple[i], 1,000 random", "O(1)", lambda n: (tuple(floats(n)), asked(n)), _ask,
        WIKI),
    Function("dict[float], 1,000 random", "O(1)",
        lambda n: _looked_up(dict.fromkeys(floats(n))), _ask, WIKI),
    Function("np.take, 1,000 random", "O(1)",
        lambda n: (np.zeros(n), np.array(asked(n))), lambda s: np.take(*s), NUMPY,
        most=CACHE_BOUND),
    Function("bisect in floats, 1,000 random", "O(log n)", lambda n: (sorted(floats(n)),
        floats(KEYS)), _bisect, PYDOC),
    Function("power by squarings", "O(log n)", itself, _squarings, CLRS),
    Function("Euclid's algorithm", "O(log n)", itself, _euclid, CLRS),
    Function("divisors up to the root", "O(√n)", itself, _divisors, LOOP),
    Function("list.extend", "O(n)", floats, lambda s: [].extend(s), WIKI),
    Function("list.count", "O(n)", lambda n: list(range(n)), lambda s: s.count(-1), CPYTHON),
    Function("set | set", "O(n)", lambda n: (set(floats(n)), set(floats(n))),
        lambda s: s[0] | s[1], WIKI),
    Function("dict of pairs", "O(n)", lambda n: list(enumerate(floats(n))), dict, WIKI),
    Function("sum(dict.values)", "O(n)", lambda n: dict(enumerate(floats(n))),
        lambda s: sum(s.values()), WIKI),
    Function("map(str) and join", "O(n)", floats, lambda s: ",".join(map(str, s)), PYDOC),
    Function("list of a comprehension", "O(n)", floats, lambda s: [x * x for x in s if x < 0.5],
        LOOP),
    Function("itertools.chain", "O(n)", lambda n: [[1.5, 2.5]] * n,
        lambda s: list(itertools.chain.from_iterable(s)), PYDOC),
    Function("str.splitlines", "O(n)", lambda n: "line\n" * n, str.splitlines, CPYTHON),
    Function("str.translate", "O(n)", _letters, lambda s: s.translate({97: 98}), CPYTHON),
    Function("re.sub", "O(n)", _letters, lambda s: re.sub("[aeiou]", "-", s), CPYTHON),
    Function("zlib.adler32", "O(n)", random.randbytes, zlib.adler32, "RFC 1950"),
    Function("hashlib.md5", "O(n)", random.randbytes, lambda s: hashlib.md5(s).digest(),
        "RFC 1321"),
    Function("statistics.variance", "O(n)", floats, statistics.variance, PYDOC),
    Function("math.fsum", "O(n)", floats, math.fsum, PYDOC),
    Function("np.var", "O(n)", uniform, np.var, NUMPY, most=CACHE_BOUND),
    Function("np.clip", "O(n)", uniform, lambda a: np.clip(a, 0.2, 0.8), NUMPY, most=CACHE_BOUND),
    Function("np.sin", "O(n)", uniform, np.sin, NUMPY, most=CACHE_BOUND),
    Function("np.where", "O(n)", uniform, lambda a: np.where(a > 0.5, a, 0.0), NUMPY,
        most=CACHE_BOUND),
    Function("np.cumprod", "O(n)", uniform, np.cumprod, NUMPY, most=CACHE_BOUND),
    Function("gaussian_filter1d", "O(n)", uniform,
        lambda a: scipy.ndimage.gaussian_filter1d(a, 2), SCIPY),
    Function("sorted, integers at random", "O(n log n)",
        lambda n: random.sample(range(2 * n), n), sorted, WIKI),
    Function("sorted, strings at random", "O(n log n)",
        lambda n: random.sample(_words(2 * n), n), sorted, WIKI),
    Function("heap sort", "O(n log n)", floats, _heapsort, CLRS),
    Function("merge sort", "O(n log n)", floats, _merge_sort, CLRS),
    Function("np.lexsort", "O(n log n)", lambda n: (uniform(n), uniform(n)), np.lexsort, SORT),
    Function("insertion sort, reversed", "O(n²)", lambda n: list(range(n, 0, -1)),
        _insertion_sort, CLRS),
    Function("selection sort", "O(n²)", floats, _selection_sort, CLRS),
    Function("Pascal's triangle", "O(n²)", itself, _pascal, LOOP),
    Function("matrix + matrix.T", "O(n²)", matrix, lambda a: a + a.T, NUMPY),
    Function("matrix times matrix, by hand", "O(n³)", _matrix_of_lists, _multiply, CLRS),
    Function("three loops over a list", "O(n³)", lambda n: list(range(n)), _triples,
        LOOP),
    Function("sums of all subsets", "O(2^n)", lambda n: list(range(n)), _sums, CLRS),
)
# fmt: on
