"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. The judge was tuned on these. How good it is others tell, those of
`held_out`, which were written down before any judge was asked about them. What is decided by their
answers makes them functions to tune on, as it did of `SEEN`, and asks for others.
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
import html
import io
import itertools
import json
import marshal
import math
import pickle
import random
import re
import statistics
import string
import struct
import textwrap
import tokenize
import unicodedata
import xml.etree.ElementTree as ElementTree
import zlib
from collections.abc import Callable
from itertools import starmap
from operator import contains, getitem
from typing import Any, NamedTuple
from urllib import parse

import numpy as np
from scipy import fft, interpolate, linalg, ndimage, signal, sparse, spatial, special, stats
from scipy.cluster import hierarchy
from scipy.integrate import cumulative_trapezoid, simpson
from scipy.sparse import csgraph

from experiments.validation import by_hand

WIKI = "wiki.python.org/moin/TimeComplexity"
TIMSORT = "CPython, Objects/listsort.txt"
CPYTHON = "CPython's source: one pass"
LONG = "CPython, Objects/longobject.c"
LOOP = "counted by hand"
NUMPY = "numpy.org/doc: one pass"
VIEWS = "numpy.org/doc: views"
BISECT = "numpy.org/doc: binary search"
DIRECT = "numpy.org/doc: direct sum"
PARTITION = "numpy.org/doc, numpy.partition"
SORT = "numpy.org/doc, numpy.sort"
BY_SORT = f"{SORT}: it sorts"
LAPACK = "Golub and Van Loan, Matrix Computations"
PYDOC = "docs.python.org"
QUICKHULL = "Barber et al., Quickhull"
SCIPY = "docs.scipy.org"
GRAPH = "docs.scipy.org, csgraph"
CLRS = "Cormen et al., Introduction to Algorithms"
REDOS = "owasp.org, ReDoS"

KEYS = 1_000  # asked per call of what takes less than the clock shows
CACHE_BOUND = 12_500_000  # float64 of 10^8 bytes
SQUARE_BOUND = math.isqrt(CACHE_BOUND)
ONE_PASS = NUMPY, CACHE_BOUND  # over arrays that no cache holds
TWOS = 1 << 20, True  # up to so much, powers of two alone


class Function(NamedTuple):
    """A function of known cost."""

    name: str
    growth: str
    make: Callable[[int], Any]
    call: Callable[[Any], object]
    source: str
    most: int = 1_000_000
    powers: bool = False  # sizes are powers of two


_draw = np.random.default_rng


def uniform(*shape: int) -> Any:
    """Numbers from 0 to 1 in an array."""
    return _draw().random(shape)


def floats(n: int) -> list[float]:
    """Numbers from 0 to 1 in a list."""
    return [random.random() for _ in range(n)]


def _words(n: int) -> list[str]:
    return [f"{i:x}" for i in range(n)]


def _on_sphere(n: int) -> Any:  # all on the hull: of points in a cube most are seen just once
    points = uniform(n, 3) - 0.5
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def _on_circle(n: int) -> Any:
    angles = 2 * np.pi * uniform(n)
    return np.column_stack([np.cos(angles), np.sin(angles)])


INPUTS: dict[str, Callable[[int], Any]] = {
    "numbers": lambda n: list(range(n)),
    "descending": lambda n: list(range(n, 0, -1)),
    "floats": floats,
    "heap": lambda n: sorted(floats(n)),
    "tuple": lambda n: tuple(floats(n)),
    "deque": lambda n: collections.deque(range(n)),
    "dict": lambda n: dict.fromkeys(range(n)),
    "set": lambda n: set(range(n)),
    "floats_set": lambda n: set(floats(n)),
    "floats_dict": lambda n: dict(enumerate(floats(n))),
    "pairs": lambda n: list(zip(floats(n), floats(n), strict=True)),
    "rows": lambda n: [floats(n) for _ in range(n)],
    "few": lambda n: random.choices(range(100), k=n),
    "asked": lambda n: random.choices(range(n), k=KEYS),  # indices below n
    "text": lambda n: "abcdefghij" * (n // 10) + "x" * (n % 10),
    "letters": lambda n: "".join(random.choices(string.ascii_lowercase, k=n)),
    "records": lambda n: [{"id": i, "name": f"item {i}", "x": i / 7} for i in range(n)],
    "bytes": random.randbytes,
    "doubles": lambda n: array.array("d", bytes(8 * n)),
    "ascending": lambda n: array.array("q", range(n)),
    "bits": lambda n: random.getrandbits(n) | 1 << (n - 1) | 1,
    "places": np.arange,
    "picked": lambda n: np.array(random.choices(range(n), k=KEYS)),
    "uniform": uniform,
    "points": lambda n: uniform(n, 3),
    "matrix": lambda n: uniform(n, n) + n * np.eye(n),  # far from singular
    "symmetric": lambda n: INPUTS["matrix"](n) + INPUTS["matrix"](n).T,
    "sparse": lambda n: sparse.random_array((n, n), density=min(5 / n, 1), format="csr"),
    "banded": lambda n: (np.vstack([np.ones(n), np.full(n, 4.0), np.ones(n)]), uniform(n)),
}
"""What makes an input, by name."""


def function(name: str, growth: str, given: Any, *others: Any) -> Function:
    """``given``: what makes the input, or the names of one or of several."""
    makes = [INPUTS[it] for it in given.split()] if isinstance(given, str) else [given]
    make = makes[0] if len(makes) == 1 else lambda n: tuple(it(n) for it in makes)
    return Function(name, growth, make, *others)


def looked_up(container: Any) -> tuple[Any, list[Any]]:
    """A container and keys in it to ask for."""
    return container, random.choices(list(container), k=KEYS)


def times(call: Callable[[Any], object]) -> Callable[[Any], object]:
    """The same call many times."""

    def every(it: Any) -> None:
        for _ in itertools.repeat(None, KEYS):
            call(it)

    return every


def each(call: Callable[[Any, Any], object]) -> Callable[[Any], object]:
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


# fmt: off
FUNCTIONS: tuple[Function, ...] = tuple(starmap(function, [
    ("len(list)", "O(1)", "numbers", times(len), WIKI),
    ("list[i], 1,000 random i", "O(1)", "numbers asked", each(lambda s, i: s[i]), WIKI),
    ("list.copy", "O(n)", "numbers", list.copy, WIKI),
    ("absent in list", "O(n)", "numbers", lambda s: -1 in s, WIKI),
    ("list.sort, random", "O(n log n)", "floats", list.sort, WIKI),
    ("sorted, of sorted", "O(n)", "numbers", sorted, TIMSORT),
    ("list.insert(0)", "O(n)", "numbers", lambda s: s.insert(0, 0), WIKI),
    ("n × list.append", "O(n)", int, by_hand.append, WIKI),
    ("list.reverse", "O(n)", "numbers", list.reverse, CPYTHON),
    ("sum(list)", "O(n)", "floats", sum, WIKI),
    ("min(list)", "O(n)", "floats", min, WIKI),
    ("list == list", "O(n)", "numbers numbers", lambda s: s[0] == s[1], CPYTHON),
    ("dict[key], 1,000 random", "O(1)", "dict asked", each(dict.get), WIKI),
    ("dict.fromkeys", "O(n)", "floats", dict.fromkeys, WIKI),
    ("set(list)", "O(n)", "floats", set, WIKI),
    ("key in set, 1,000 random", "O(1)", "set asked", each(set.__contains__), WIKI),
    ("set & set", "O(n)", "set set", lambda s: s[0] & s[1], WIKI),
    ("dict.copy", "O(n)", "dict", dict.copy, WIKI),
    ("deque.rotate(n // 2)", "O(n)", "deque", lambda s: s.rotate(len(s) // 2), WIKI),
    ("deque.popleft and append", "O(1)", "deque", times(lambda s: s.append(s.popleft())), WIKI),
    ("deque[n // 2]", "O(n)", "deque", lambda s: s[len(s) // 2], WIKI),
    ("heapq.heapify", "O(n)", "floats", heapq.heapify, CLRS),
    ("heapq.heapreplace, 1,000 to the bottom", "O(log n)", "heap", _sift(heapq.heapreplace), CLRS),
    ("heapq.heappop, all", "O(n log n)", "heap", by_hand.drain, CLRS),
    ("heapq.nsmallest(10)", "O(n)", "floats", lambda s: heapq.nsmallest(10, s), PYDOC),
    ("bisect, 1,000 random", "O(log n)", "numbers asked", each(bisect.bisect), PYDOC),
    ("bisect.insort at the front", "O(n)", "numbers", lambda s: bisect.insort(s, -1), PYDOC),
    ("collections.Counter", "O(n)", "few", collections.Counter, CPYTHON),
    ("str.join", "O(n)", lambda n: ["ab"] * n, "".join, PYDOC),
    ("str.replace", "O(n)", "text", lambda s: s.replace("c", "d"), CPYTHON),
    ("str.count", "O(n)", "text", lambda s: s.count("j"), CPYTHON),
    ("str.split", "O(n)", lambda n: "ab " * n, str.split, CPYTHON),
    ("str[::-1]", "O(n)", "text", lambda s: s[::-1], WIKI),
    ("a string built by prepending", "O(n²)", int, _by_adding("x"), PYDOC + ", sequence types"),
    ("re.findall", "O(n)", "text", re.compile("[ae]").findall, CPYTHON),
    ("re with nested repeats", "O(2^n)", lambda n: "a" * n + "b", re.compile("(a|a)*c").match,
        REDOS),
    ("json.dumps", "O(n)", "records", json.dumps, CPYTHON),
    ("json.loads", "O(n)", lambda n: json.dumps(INPUTS["records"](n)), json.loads, CPYTHON),
    ("pickle.dumps", "O(n)", "records", pickle.dumps, CPYTHON),
    ("pickle.loads", "O(n)", lambda n: pickle.dumps(INPUTS["records"](n)), pickle.loads, CPYTHON),
    ("hashlib.sha256", "O(n)", "bytes", lambda s: hashlib.sha256(s).digest(), "FIPS 180-4"),
    ("zlib.crc32", "O(n)", "bytes", zlib.crc32, "RFC 1952"),
    ("zlib.compress", "O(n)", lambda n: INPUTS["text"](n).encode(), zlib.compress, "RFC 1951"),
    ("base64.b64encode", "O(n)", "bytes", base64.b64encode, "RFC 4648"),
    ("int + int, n bits", "O(n)", random.getrandbits, lambda a: a + a, "Knuth 4.3.1", 10_000_000),
    ("copy.deepcopy", "O(n)", lambda n: [[i] for i in range(n)], copy.deepcopy, PYDOC),
    ("random.shuffle", "O(n)", "numbers", random.shuffle, "Knuth 3.4.2"),
    ("statistics.median", "O(n log n)", "floats", statistics.median, PYDOC + ": it sorts"),
    ("itertools.combinations, pairs", "O(n²)", range, lambda s: list(itertools.combinations(s, 2)),
        PYDOC),
    ("itertools.product, triples", "O(n³)", range,
        lambda s: sum(1 for _ in itertools.product(s, repeat=3)), PYDOC),
    ("itertools.product, all subsets", "O(2^n)", int,
        lambda n: sum(1 for _ in itertools.product((0, 1), repeat=n)), PYDOC),
    ("two loops over a list", "O(n²)", "numbers", lambda s: sum(a == b for a in s for b in s),
        LOOP),
    ("array[i], 1,000 times", "O(1)", "uniform", times(lambda a: a[0]), NUMPY),
    ("array[::2], a view", "O(1)", "uniform", times(lambda a: a[::2]), VIEWS),
    ("np.sum", "O(n)", "uniform", np.sum, *ONE_PASS),
    ("np.copy", "O(n)", "uniform", np.copy, *ONE_PASS),
    ("array + array", "O(n)", "uniform", lambda a: a + a, *ONE_PASS),
    ("np.exp", "O(n)", "uniform", np.exp, *ONE_PASS),
    ("np.cumsum", "O(n)", "uniform", np.cumsum, *ONE_PASS),
    ("np.concatenate", "O(n)", "uniform", lambda a: np.concatenate([a, a]), *ONE_PASS),
    ("np.sort, random", "O(n log n)", "uniform", np.sort, SORT, CACHE_BOUND),
    ("np.argsort", "O(n log n)", "uniform", np.argsort, SORT),
    ("np.unique", "O(n log n)", "uniform", np.unique, BY_SORT),
    ("np.partition", "O(n)", "uniform", lambda a: np.partition(a, len(a) // 2), PARTITION),
    ("np.median", "O(n)", "uniform", np.median, PARTITION),
    ("np.searchsorted, 1,000 keys", "O(log n)", "places picked", lambda s: np.searchsorted(*s),
        BISECT),
    ("array[random indices]", "O(n)", lambda n: (uniform(n), _draw().permutation(n)),
        lambda s: s[0][s[1]], *ONE_PASS),
    ("np.bincount", "O(n)", lambda n: _draw().integers(0, 100, n), np.bincount, NUMPY),
    ("np.histogram, 10 bins", "O(n)", "uniform", np.histogram, NUMPY),
    ("np.outer", "O(n²)", "uniform", lambda a: np.outer(a, a), NUMPY),
    ("np.convolve, full", "O(n²)", "uniform", lambda a: np.convolve(a, a), DIRECT),
    ("matrix @ vector", "O(n²)", "matrix uniform", lambda s: s[0] @ s[1], LAPACK),
    ("matrix @ matrix", "O(n³)", "matrix", lambda a: a @ a, LAPACK),
    ("np.linalg.inv", "O(n³)", "matrix", np.linalg.inv, LAPACK),
    ("scipy.fft.rfft, powers of two", "O(n log n)", "uniform", fft.rfft, SCIPY, *TWOS),
    ("scipy.signal.fftconvolve", "O(n log n)", "uniform", lambda a: signal.fftconvolve(a, a), SCIPY,
        *TWOS),
    ("cKDTree, built", "O(n log n)", "points", spatial.cKDTree, SCIPY),
    ("cKDTree.query, 1,000 points", "O(log n)",
        lambda n: (spatial.cKDTree(uniform(n, 3)), uniform(KEYS, 3)),
        lambda s: s[0].query(s[1]), SCIPY),
    ("cdist", "O(n²)", "points", lambda p: spatial.distance.cdist(p, p), SCIPY),
    ("ConvexHull of a sphere", "O(n log n)", _on_sphere, spatial.ConvexHull, QUICKHULL),
    ("scipy.stats.rankdata", "O(n log n)", "uniform", stats.rankdata, SCIPY + ": it sorts"),
    ("uniform_filter1d", "O(n)", "uniform", lambda a: ndimage.uniform_filter1d(a, 9), SCIPY),
    ("scipy.signal.lfilter", "O(n)", "uniform", lambda a: signal.lfilter([1.0], [1.0, -0.5], a),
        SCIPY),
    ("solve_banded, 3 diagonals", "O(n)", "banded", lambda s: linalg.solve_banded((1, 1), *s),
        LAPACK),
    ("csr_array @ vector, 5 per row", "O(n)", "sparse uniform", lambda s: s[0] @ s[1], SCIPY),
    ("CubicSpline", "O(n)", "places uniform", lambda s: interpolate.CubicSpline(*s), SCIPY),
]))

SEEN: tuple[Function, ...] = tuple(starmap(function, [
    ("dict[str], 1,000 random", "O(1)", lambda n: looked_up(dict.fromkeys(_words(n))),
        each(getitem), WIKI),
    ("OrderedDict.move_to_end, 1,000 random", "O(1)",
        lambda n: looked_up(collections.OrderedDict.fromkeys(range(n))),
        each(collections.OrderedDict.move_to_end), PYDOC),
    ("array.array[i], 1,000 random", "O(1)", "doubles asked", each(getitem), CPYTHON, CACHE_BOUND),
    ("array[1,000 random indices]", "O(1)", "uniform picked", lambda s: s[0][s[1]], *ONE_PASS),
    ("bisect in array.array, 1,000 random", "O(log n)", "ascending asked", each(bisect.bisect),
        PYDOC),
    ("binary search by hand, 1,000 random", "O(log n)", "numbers asked", each(by_hand.halve), CLRS),
    ("heapq.heappushpop, 1,000 to the bottom", "O(log n)", "heap", _sift(heapq.heappushpop), CLRS),
    ("trial division of a prime", "O(√n)",
        lambda n: next(p for p in itertools.count(n | 1, 2) if by_hand.divide(p)), by_hand.divide,
        CLRS, 100_000_000),
    ("tuple(list)", "O(n)", "numbers", tuple, WIKI),
    ("list[n // 2:]", "O(n)", "numbers", lambda s: s[len(s) // 2:], WIKI),
    ("list.pop(0)", "O(n)", "numbers", lambda s: s.pop(0), WIKI),
    ("hash(tuple)", "O(n)", "tuple", hash, CPYTHON),
    ("set <= set", "O(n)", "set set", lambda s: s[0] <= s[1], WIKI),
    ("Counter.most_common(10)", "O(n)",
        lambda n: collections.Counter(random.choices(range(n), k=n)), lambda s: s.most_common(10),
        PYDOC + ", heapq.nlargest"),
    ("itertools.accumulate", "O(n)", "floats", lambda s: list(itertools.accumulate(s)), PYDOC),
    ("itertools.groupby", "O(n)", lambda n: [i // 10 for i in range(n)],
        lambda s: [key for key, _ in itertools.groupby(s)], PYDOC),
    ("heapq.merge, two lists", "O(n)", "numbers numbers", lambda s: list(heapq.merge(*s)), CLRS),
    ("functools.reduce", "O(n)", "floats", lambda s: functools.reduce(max, s), PYDOC),
    ("statistics.fmean", "O(n)", "floats", statistics.fmean, PYDOC),
    ("statistics.mode", "O(n)", "few", statistics.mode, CPYTHON),
    ("struct.unpack", "O(n)", lambda n: random.randbytes(8 * n),
        lambda s: struct.unpack(f"{len(s) // 8}d", s), PYDOC),
    ("array.array of a list", "O(n)", "floats", lambda s: array.array("d", s), CPYTHON),
    ("bytes.hex", "O(n)", "bytes", bytes.hex, CPYTHON),
    ("hashlib.blake2b", "O(n)", "bytes", lambda s: hashlib.blake2b(s).digest(), "RFC 7693"),
    ("zlib.decompress", "O(n)", lambda n: zlib.compress(INPUTS["letters"](n).encode()),
        zlib.decompress, "RFC 1951"),
    ("str.upper", "O(n)", "letters", str.upper, CPYTHON),
    ("str.find, half as long", "O(n)", lambda n: ("a" * n, "a" * (n // 2) + "b"),
        lambda s: s[0].find(s[1]), "CPython, Objects/stringlib: two-way search"),
    ("textwrap.wrap", "O(n)", lambda n: "lorem ipsum dolor " * (n // 18 + 1), textwrap.wrap,
        CPYTHON),
    ("csv.reader", "O(n)", lambda n: [f"{i},b,{i / 7}" for i in range(n)],
        lambda s: list(csv.reader(s)), CPYTHON),
    ("ast.parse", "O(n)", lambda n: "x = y + 1\n" * n, ast.parse, "PEP 617"),
    ("ElementTree.fromstring", "O(n)", lambda n: f"<a>{'<b>text</b>' * n}</a>",
        ElementTree.fromstring, "libexpat.github.io: one pass"),
    ("sorted, by a key", "O(n log n)", "floats", lambda s: sorted(s, key=float.__neg__), WIKI),
    ("int * int, n bits", "O(n^1.585)", "bits bits", lambda s: s[0] * s[1], LONG + ": Karatsuba"),
    ("int // int, 2n by n bits", "O(n²)", lambda n: (INPUTS["bits"](2 * n), INPUTS["bits"](n)),
        lambda s: s[0] // s[1], LONG + ": Knuth 4.3.1, D"),
    ("math.gcd, n bits", "O(n²)", "bits bits", lambda s: math.gcd(*s), LONG + ": Lehmer"),
    ("pow(a, b, m), n bits", "O(n³)", "bits bits bits", lambda s: pow(*s),
        LONG + ": n products and divisions"),
    ("difflib, all alike", "O(n²)",
        lambda n: difflib.SequenceMatcher(None, "a" * n, "a" * n, autojunk=False),
        lambda s: s.find_longest_match(), PYDOC),
    ("re.search, from every place", "O(n²)", lambda n: "a" * n, re.compile("a*b").search, REDOS),
    ("re, a repeat of repeats", "O(2^n)", lambda n: "a" * n + "c", re.compile("(a+)+b").match,
        REDOS),
    ("bubble sort", "O(n²)", "floats", by_hand.bubble, CLRS),
    ("edit distance", "O(n²)", "letters letters", by_hand.edits, CLRS),
    ("towers of Hanoi", "O(2^n)", int, by_hand.hanoi, CLRS),
    ("a tuple built by adding", "O(n²)", int, _by_adding((0,)), PYDOC + ", sequence types"),
    ("bytes built by adding", "O(n²)", int, _by_adding(b"x"), PYDOC + ", sequence types"),
    ("np.dot of vectors", "O(n)", "uniform", lambda a: a @ a, LAPACK, CACHE_BOUND),
    ("np.argmax", "O(n)", "uniform", np.argmax, *ONE_PASS),
    ("np.diff", "O(n)", "uniform", np.diff, *ONE_PASS),
    ("array[array > 0.5]", "O(n)", "uniform", lambda a: a[a > 0.5], *ONE_PASS),
    ("np.roll", "O(n)", "uniform", lambda a: np.roll(a, 7), *ONE_PASS),
    ("scipy.special.erf", "O(n)", "uniform", special.erf, *ONE_PASS),
    ("array.tolist", "O(n)", "uniform", lambda a: a.tolist(), NUMPY),
    ("np.digitize, 10 bins", "O(n)", "uniform", lambda a: np.digitize(a, np.linspace(0, 1, 10)),
        NUMPY),
    ("np.polyfit, degree 3", "O(n)", lambda n: (np.linspace(0, 1, n), uniform(n)),
        lambda s: np.polyfit(s[0], s[1], 3), LAPACK),
    ("np.sort of uint16, stable", "O(n)", lambda n: _draw().integers(0, 2**16, n, np.uint16),
        lambda a: np.sort(a, kind="stable"), SORT + ": radix sort", CACHE_BOUND),
    ("np.sort of float64, stable", "O(n log n)", "uniform", lambda a: np.sort(a, kind="stable"),
        SORT, CACHE_BOUND),
    ("np.intersect1d", "O(n log n)", lambda n: (uniform(n), uniform(n + 1)),
        lambda s: np.intersect1d(*s), BY_SORT),
    ("np.searchsorted, n random keys", "O(n log n)",
        lambda n: (np.sort(uniform(n)), uniform(n + 1)[:n]), lambda s: np.searchsorted(*s),
        BISECT),
    ("np.fft.fft, powers of two", "O(n log n)", "uniform", np.fft.fft, "numpy.org/doc, numpy.fft",
        *TWOS),
    ("array.T.copy", "O(n²)", "matrix", lambda a: a.T.copy(), NUMPY, SQUARE_BOUND),
    ("np.linalg.solve", "O(n³)", "matrix", lambda a: np.linalg.solve(a, a[0]), LAPACK),
    ("np.linalg.eigvalsh", "O(n³)", "symmetric", np.linalg.eigvalsh, LAPACK),
    ("solve_triangular", "O(n²)", "matrix", lambda a: linalg.solve_triangular(a, a[0]), LAPACK),
    ("solve_toeplitz", "O(n²)", lambda n: uniform(n) + n * (np.arange(n) == 0),
        lambda a: linalg.solve_toeplitz(a, a), SCIPY + ": Levinson"),
    ("csgraph.connected_components", "O(n)", "sparse", csgraph.connected_components, GRAPH),
    ("csgraph.dijkstra, from one", "O(n log n)", "sparse",
        functools.partial(csgraph.dijkstra, indices=0), GRAPH),
    ("csgraph.minimum_spanning_tree", "O(n log n)", "sparse", csgraph.minimum_spanning_tree,
        GRAPH + ": it sorts"),
    ("csgraph.floyd_warshall", "O(n³)", "matrix", csgraph.floyd_warshall, GRAPH),
    ("Delaunay, 2D", "O(n log n)", lambda n: uniform(n, 2), spatial.Delaunay, QUICKHULL),
    ("pdist", "O(n²)", "points", spatial.distance.pdist, SCIPY),
    ("linkage, single", "O(n²)", "points", hierarchy.linkage, SCIPY),
    ("scipy.signal.find_peaks", "O(n)", "uniform", signal.find_peaks, SCIPY),
    ("savgol_filter", "O(n)", lambda n: uniform(max(n, 11)),
        lambda a: signal.savgol_filter(a, 11, 3), SCIPY),
    ("scipy.stats.kendalltau", "O(n log n)", "uniform uniform", lambda s: stats.kendalltau(*s),
        SCIPY + ": Knight's algorithm"),
    ("set.add and discard, 1,000 times", "O(1)", "set asked", each(by_hand.add_and_discard), WIKI),
    ("bytes[i], 1,000 random", "O(1)", "bytes asked", each(getitem), CPYTHON, CACHE_BOUND),
    ("tuple[i], 1,000 random", "O(1)", "tuple asked", each(getitem), WIKI),
    ("dict[float], 1,000 random", "O(1)", lambda n: looked_up(dict.fromkeys(floats(n))),
        each(getitem), WIKI),
    ("np.take, 1,000 random", "O(1)", lambda n: (np.zeros(n), INPUTS["picked"](n)),
        lambda s: np.take(*s), *ONE_PASS),
    ("bisect in floats, 1,000 random", "O(log n)", lambda n: (sorted(floats(n)), floats(KEYS)),
        each(bisect.bisect), PYDOC),
    ("power by squarings", "O(log n)", int, by_hand.squarings, CLRS),
    ("Euclid's algorithm", "O(log n)", int, by_hand.euclid, CLRS),
    ("divisors up to the root", "O(√n)", int,
        lambda n: sum(n % d == 0 for d in range(1, math.isqrt(n) + 1)), LOOP),
    ("list.extend", "O(n)", "floats", lambda s: [].extend(s), WIKI),
    ("list.count", "O(n)", "numbers", lambda s: s.count(-1), CPYTHON),
    ("set | set", "O(n)", "floats_set floats_set", lambda s: s[0] | s[1], WIKI),
    ("dict of pairs", "O(n)", lambda n: list(enumerate(floats(n))), dict, WIKI),
    ("sum(dict.values)", "O(n)", "floats_dict", lambda s: sum(s.values()), WIKI),
    ("map(str) and join", "O(n)", "floats", lambda s: ",".join(map(str, s)), PYDOC),
    ("list of a comprehension", "O(n)", "floats", lambda s: [x * x for x in s if x < 0.5], LOOP),
    ("itertools.chain", "O(n)", lambda n: [[1.5, 2.5]] * n,
        lambda s: list(itertools.chain.from_iterable(s)), PYDOC),
    ("str.splitlines", "O(n)", lambda n: "line\n" * n, str.splitlines, CPYTHON),
    ("str.translate", "O(n)", "letters", lambda s: s.translate({97: 98}), CPYTHON),
    ("re.sub", "O(n)", "letters", lambda s: re.sub("[aeiou]", "-", s), CPYTHON),
    ("zlib.adler32", "O(n)", "bytes", zlib.adler32, "RFC 1950"),
    ("hashlib.md5", "O(n)", "bytes", lambda s: hashlib.md5(s).digest(), "RFC 1321"),
    ("statistics.variance", "O(n)", "floats", statistics.variance, PYDOC),
    ("math.fsum", "O(n)", "floats", math.fsum, PYDOC),
    ("np.var", "O(n)", "uniform", np.var, *ONE_PASS),
    ("np.clip", "O(n)", "uniform", lambda a: np.clip(a, 0.2, 0.8), *ONE_PASS),
    ("np.sin", "O(n)", "uniform", np.sin, *ONE_PASS),
    ("np.where", "O(n)", "uniform", lambda a: np.where(a > 0.5, a, 0.0), *ONE_PASS),
    ("np.cumprod", "O(n)", "uniform", np.cumprod, *ONE_PASS),
    ("gaussian_filter1d", "O(n)", "uniform", lambda a: ndimage.gaussian_filter1d(a, 2), SCIPY),
    ("sorted, integers at random", "O(n log n)", lambda n: random.sample(range(2 * n), n), sorted,
        WIKI),
    ("sorted, strings at random", "O(n log n)", lambda n: random.sample(_words(2 * n), n), sorted,
        WIKI),
    ("heap sort", "O(n log n)", "floats", by_hand.heapsort, CLRS),
    ("merge sort", "O(n log n)", "floats", by_hand.merge_sort, CLRS),
    ("np.lexsort", "O(n log n)", "uniform uniform", np.lexsort, SORT),
    ("insertion sort, reversed", "O(n²)", "descending", by_hand.insertion_sort, CLRS),
    ("selection sort", "O(n²)", "floats", by_hand.selection_sort, CLRS),
    ("Pascal's triangle", "O(n²)", int, by_hand.pascal, LOOP),
    ("matrix + matrix.T", "O(n²)", "matrix", lambda a: a + a.T, NUMPY),
    ("matrix times matrix, by hand", "O(n³)", "rows", by_hand.multiply, CLRS),
    ("three loops over a list", "O(n³)", "numbers",
        lambda s: sum(a + b == c for a in s for b in s for c in s), LOOP),
    ("sums of all subsets", "O(2^n)", "numbers", by_hand.sums, CLRS),
    ("deque[0], 1,000 times", "O(1)", "deque", times(lambda s: s[0]), WIKI),
    ("str[i], 1,000 random", "O(1)", "text asked", each(getitem), CPYTHON, CACHE_BOUND),
    ("list.pop and append, 1,000 times", "O(1)", "numbers", times(lambda s: s.append(s.pop())),
        WIKI),
    ("dict.setdefault, 1,000 random", "O(1)", "dict asked", each(dict.setdefault), WIKI),
    ("memoryview[1:-1], 1,000 views", "O(1)", lambda n: memoryview(bytes(n)),
        times(lambda s: s[1:-1]), PYDOC),
    ("array[:, None], 1,000 views", "O(1)", "uniform", times(lambda a: a[:, None]), VIEWS),
    ("key in frozenset, 1,000 random", "O(1)", lambda n: looked_up(frozenset(range(n))),
        each(frozenset.__contains__), WIKI),
    ("number in range, 1,000 random", "O(1)", lambda n: (range(n), INPUTS["asked"](n)),
        each(contains), PYDOC),
    ("array.item(i), 1,000 random", "O(1)", "uniform asked", each(np.ndarray.item), *ONE_PASS),
    ("bytearray[i] = 0, 1,000 random", "O(1)", lambda n: (bytearray(n), INPUTS["asked"](n)),
        each(lambda s, i: s.__setitem__(i, 0)), CPYTHON, CACHE_BOUND),
    ("np.searchsorted in float32, 1,000 random", "O(log n)",
        lambda n: (np.sort(uniform(n).astype(np.float32)), uniform(KEYS).astype(np.float32)),
        lambda s: np.searchsorted(*s), BISECT, CACHE_BOUND),
    ("bisect in strings, 1,000 random", "O(log n)", lambda n: looked_up(sorted(_words(n))),
        each(bisect.bisect), PYDOC),
    ("an integer halved to nothing", "O(log n)", int, by_hand.halvings, LOOP),
    ("Fenwick tree, 1,000 random sums", "O(log n)", "numbers asked", each(by_hand.prefix_sum),
        "Fenwick, A New Data Structure for Cumulative Frequency Tables"),
    ("segment tree, 1,000 random changes", "O(log n)",
        lambda n: ([0.0] * 2 ** (n - 1).bit_length() * 2, INPUTS["asked"](n)),
        each(by_hand.change_leaf), CLRS + ": a balanced tree"),
    ("whole root by counting", "O(√n)", int, by_hand.counted_root, LOOP),
    ("jump search, the last", "O(√n)", "ascending", by_hand.jump_search, LOOP),
    ("n by triangular numbers", "O(√n)", int, by_hand.triangular, LOOP),
    ("list.remove, the last", "O(n)", "numbers", lambda s: s.remove(s[-1]), WIKI),
    ("list.index, the last", "O(n)", "floats", lambda s: s.index(s[-1]), WIKI),
    ("list * 2", "O(n)", "floats", lambda s: s * 2, WIKI),
    ("list of a zip", "O(n)", "floats floats", lambda s: list(zip(*s, strict=True)), PYDOC),
    ("dict of a comprehension", "O(n)", "floats", lambda s: {x: i for i, x in enumerate(s)}, LOOP),
    ("dict == dict", "O(n)", "dict dict", lambda s: s[0] == s[1], CPYTHON),
    ("set - set", "O(n)", "floats_set floats_set", lambda s: s[0] - s[1], WIKI),
    ("any of a generator", "O(n)", "floats", lambda s: any(x > 2 for x in s), PYDOC),
    ("list of a filter", "O(n)", "floats", lambda s: list(filter(None, s)), PYDOC),
    ("str.encode, utf-8", "O(n)", lambda n: "é" * n, str.encode, CPYTHON),
    ("bytes.decode, utf-8", "O(n)", lambda n: ("é" * n).encode(), bytes.decode, CPYTHON),
    ("str.strip", "O(n)", lambda n: " " * n, str.strip, CPYTHON),
    ("str.title", "O(n)", "letters", str.title, CPYTHON),
    ("hash(str + str)", "O(n)", "letters letters", lambda s: hash(s[0] + s[1]), CPYTHON),
    ("unicodedata.normalize", "O(n)", lambda n: "é" * n,
        lambda s: unicodedata.normalize("NFD", s), PYDOC),
    ("int(str, 16)", "O(n)", lambda n: "f" * n, lambda s: int(s, 16), LONG),
    ("int.bit_count, n bits", "O(n)", "bits", int.bit_count, LONG, 10_000_000),
    ("int << 1, n bits", "O(n)", "bits", lambda a: a << 1, LONG, 10_000_000),
    ("bytes.count", "O(n)", "bytes", lambda s: s.count(7), CPYTHON, CACHE_BOUND),
    ("bytes.translate", "O(n)", "bytes", lambda s: s.translate(bytes(range(255, -1, -1))), CPYTHON),
    ("hashlib.sha3_256", "O(n)", "bytes", lambda s: hashlib.sha3_256(s).digest(), "FIPS 202"),
    ("base64.b64decode", "O(n)", lambda n: base64.b64encode(random.randbytes(n)), base64.b64decode,
        "RFC 4648"),
    ("zlib.compress of noise", "O(n)", "bytes", lambda s: zlib.compress(s, 1), "RFC 1951"),
    ("json.dumps of floats", "O(n)", "floats", json.dumps, CPYTHON),
    ("marshal.dumps", "O(n)", "floats", marshal.dumps, PYDOC),
    ("struct.pack", "O(n)", "floats", lambda s: struct.pack(f"{len(s)}d", *s), PYDOC),
    ("html.escape", "O(n)", lambda n: "<p>text</p>" * (n // 11 + 1), html.escape, PYDOC),
    ("tokenize", "O(n)", lambda n: "x = y + 1\n" * n,
        lambda s: list(tokenize.generate_tokens(io.StringIO(s).readline)), PYDOC),
    ("re.split", "O(n)", "letters", re.compile("[aeiou]+").split, CPYTHON),
    ("math.dist", "O(n)", "tuple tuple", lambda s: math.dist(*s), CPYTHON),
    ("random.choices, n of n", "O(n)", "floats", lambda s: random.choices(s, k=len(s)), PYDOC),
    ("Kadane's largest sum", "O(n)", "floats", by_hand.largest_sum, CLRS),
    ("a walk round a random cycle", "O(n)", by_hand.random_cycle, by_hand.walk, LOOP),
    ("breadth first, two neighbors each", "O(n)", by_hand.random_graph, by_hand.breadth_first,
        CLRS),
    ("np.mean", "O(n)", "uniform", np.mean, *ONE_PASS),
    ("np.abs", "O(n)", "uniform", np.abs, *ONE_PASS),
    ("array * 2 + 1", "O(n)", "uniform", lambda a: a * 2 + 1, *ONE_PASS),
    ("np.sqrt", "O(n)", "uniform", np.sqrt, *ONE_PASS),
    ("np.isnan(array).any()", "O(n)", "uniform", lambda a: np.isnan(a).any(), *ONE_PASS),
    ("array.astype(float32)", "O(n)", "uniform", lambda a: a.astype(np.float32), *ONE_PASS),
    ("array[::-1].copy()", "O(n)", "uniform", lambda a: a[::-1].copy(), *ONE_PASS),
    ("np.repeat", "O(n)", "uniform", lambda a: np.repeat(a, 2), NUMPY),
    ("np.nonzero", "O(n)", "uniform", lambda a: np.nonzero(a > 0.5), NUMPY),
    ("np.interp, in 10 points", "O(n)", "uniform",
        lambda a: np.interp(a, np.linspace(0, 1, 10), np.arange(10.0)), NUMPY),
    ("np.packbits", "O(n)", lambda n: uniform(n) > 0.5, np.packbits, *ONE_PASS),
    ("normal random numbers", "O(n)", int, np.random.default_rng(0).standard_normal, NUMPY),
    ("np.add.at", "O(n)", lambda n: (np.zeros(n), _draw().integers(0, n, n)),
        lambda s: np.add.at(s[0], s[1], 1), NUMPY),
    ("median_filter, 5 wide", "O(n)", "uniform", lambda a: ndimage.median_filter(a, 5), SCIPY),
    ("scipy.special.gamma", "O(n)", "uniform", special.gamma, SCIPY),
    ("scipy.stats.skew", "O(n)", "uniform", stats.skew, SCIPY),
    ("cumulative_trapezoid", "O(n)", "uniform", cumulative_trapezoid, SCIPY),
    ("csgraph.breadth_first_order", "O(n)", "sparse",
        lambda s: csgraph.breadth_first_order(s, 0), GRAPH),
    ("sorted, pairs at random", "O(n log n)", "pairs", sorted, WIKI),
    ("quicksort by hand", "O(n log n)", "floats", by_hand.quicksort, CLRS),
    ("n × heappush, each to the top", "O(n log n)", int, by_hand.push_downward, CLRS),
    ("every divisor of all up to n", "O(n log n)", int, by_hand.divisors, LOOP + ": harmonic sum"),
    ("np.sort, heapsort", "O(n log n)", "uniform", lambda a: np.sort(a, kind="heapsort"), SORT),
    ("np.union1d", "O(n log n)", "uniform uniform", lambda s: np.union1d(*s), BY_SORT),
    ("scipy.stats.spearmanr", "O(n log n)", "uniform uniform", lambda s: stats.spearmanr(*s),
        SCIPY + ": it sorts"),
    ("scipy.fft.dct, powers of two", "O(n log n)", "uniform", fft.dct, SCIPY, *TWOS),
    ("cKDTree, the nearest of each", "O(n log n)", "points",
        lambda p: spatial.cKDTree(p).query(p, k=2), SCIPY),
    ("ConvexHull of a circle", "O(n log n)", _on_circle, spatial.ConvexHull, QUICKHULL),
    ("n times the root of n", "O(n^1.5)", int,
        lambda n: sum(1 for _ in range(n) for _ in range(math.isqrt(n))), LOOP),
    ("longest common subsequence", "O(n²)", "letters letters", by_hand.common, CLRS),
    ("product of polynomials by hand", "O(n²)", "floats floats", by_hand.product, CLRS),
    ("n × list.insert(0)", "O(n²)", int, by_hand.insert_all, WIKI),
    ("np.subtract.outer", "O(n²)", "uniform", lambda a: np.subtract.outer(a, a), NUMPY),
    ("matrix.sum(axis=0)", "O(n²)", "matrix", lambda a: a.sum(axis=0), NUMPY, SQUARE_BOUND),
    ("np.correlate, full", "O(n²)", "uniform", lambda a: np.correlate(a, a, "full"), DIRECT),
    ("np.linalg.svd", "O(n³)", "matrix", np.linalg.svd, LAPACK),
    ("np.linalg.cholesky", "O(n³)", "symmetric", np.linalg.cholesky, LAPACK),
    ("matrix chain order", "O(n³)", "numbers", by_hand.chain_order, CLRS),
    ("Gray code", "O(2^n)", int, by_hand.gray_code, "Knuth 7.2.1.1"),
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
    ("sorted, of reversed", "O(n)", "descending", sorted, TIMSORT),
    ("list of enumerate", "O(n)", "floats", lambda s: list(enumerate(s)), PYDOC),
    ("itertools.pairwise", "O(n)", "floats", lambda s: list(itertools.pairwise(s)), PYDOC),
    ("deque of a list", "O(n)", "floats", collections.deque, PYDOC),
    ("max of a dict, by value", "O(n)", "floats_dict", lambda s: max(s, key=s.get), PYDOC),
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
    ("np.max", "O(n)", "uniform", np.max, *ONE_PASS),
    ("np.std", "O(n)", "uniform", np.std, *ONE_PASS),
    ("np.floor", "O(n)", "uniform", np.floor, *ONE_PASS),
    ("np.minimum", "O(n)", "uniform uniform", lambda s: np.minimum(*s), *ONE_PASS),
    ("np.log", "O(n)", "uniform", lambda a: np.log(a + 1), *ONE_PASS),
    ("np.tile", "O(n)", "uniform", lambda a: np.tile(a, 2), NUMPY),
    ("np.gradient", "O(n)", "uniform", np.gradient, *ONE_PASS),
    ("np.array_equal", "O(n)", "uniform", lambda a: np.array_equal(a, a.copy()), *ONE_PASS),
    ("array.tobytes", "O(n)", "uniform", np.ndarray.tobytes, *ONE_PASS),
    ("np.argpartition", "O(n)", "uniform", lambda a: np.argpartition(a, len(a) // 2), PARTITION),
    ("np.percentile, three of them", "O(n)", "uniform", lambda a: np.percentile(a, [25, 50, 75]),
        PARTITION),
    ("maximum_filter1d", "O(n)", "uniform", lambda a: ndimage.maximum_filter1d(a, 9), SCIPY),
    ("scipy.special.expit", "O(n)", "uniform", special.expit, *ONE_PASS),
    ("scipy.integrate.simpson", "O(n)", "uniform", simpson, SCIPY),
    ("scipy.stats.zscore", "O(n)", "uniform", stats.zscore, SCIPY),
    ("csr_array.sum, of its rows", "O(n)", "sparse", lambda s: s.sum(axis=1), SCIPY),
    ("list.sort, descending", "O(n log n)", "floats", lambda s: s.sort(reverse=True), WIKI),
    ("longest increasing subsequence", "O(n log n)", "floats", by_hand.increasing, CLRS),
    ("Huffman's code", "O(n log n)", "floats", by_hand.huffman, CLRS),
    ("inversions by merging", "O(n log n)", "floats", by_hand.inversions, CLRS),
    ("hull by a monotone chain", "O(n log n)", "pairs", by_hand.hull,
        "Andrew, Another efficient algorithm for convex hulls"),
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
    ("transitive closure by hand", "O(n³)", "rows", by_hand.closure, CLRS + ": Warshall"),
    ("every subset of a list", "O(2^n)", "numbers", by_hand.subsets, CLRS),
]))
# fmt: on
