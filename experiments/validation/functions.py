"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. The judge was tuned on these, and on some 280 that are no longer
kept. How good it is others tell, those of `held_out`, which were written down before any judge was
asked about them. What is decided by their answers makes them functions to tune on, as it did of
`SEEN`, and asks for others.
"""

import array
import base64
import binascii
import bisect
import collections
import copy
import csv
import hashlib
import heapq
import html
import io
import itertools
import json
import math
import pickle
import random
import re
import statistics
import string
import zlib
from collections.abc import Callable
from itertools import starmap
from operator import getitem
from typing import Any, NamedTuple

import numpy as np
from scipy import fft, interpolate, linalg, ndimage, signal, sparse, spatial, special, stats

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
    ("list slice of ten, 1,000 times", "O(1)", "floats", times(lambda s: s[3:13]), WIKI),
    ("dict.popitem and back, 1,000 times", "O(1)", "dict",
        times(lambda s: s.__setitem__(*s.popitem())), WIKI),
    ("absent in set, 1,000 times", "O(1)", "floats_set", times(lambda s: -1.0 in s), WIKI),
    ("deque[-1], 1,000 times", "O(1)", "deque", times(lambda s: s[-1]), WIKI),
    ("array.size, 1,000 times", "O(1)", "uniform", times(lambda a: a.size), NUMPY),
    ("matrix[i], 1,000 rows as views", "O(1)", "matrix asked", each(getitem), VIEWS, SQUARE_BOUND),
    ("memoryview[i], 1,000 random", "O(1)",
        lambda n: (memoryview(random.randbytes(n)), INPUTS["asked"](n)),
        each(getitem), PYDOC, CACHE_BOUND),
    ("np.take of float32, 1,000 random", "O(1)",
        lambda n: (uniform(n).astype(np.float32), INPUTS["picked"](n)),
        lambda s: np.take(*s), *ONE_PASS),
    ("bisect_right in a tuple, 1,000 random", "O(log n)",
        lambda n: (tuple(range(n)), INPUTS["asked"](n)), each(bisect.bisect_right), PYDOC),
    ("np.searchsorted from the right, 1,000 random", "O(log n)",
        lambda n: (np.sort(uniform(n)), uniform(KEYS)),
        lambda s: np.searchsorted(s[0], s[1], "right"), BISECT, CACHE_BOUND),
    ("exponential search by hand, 1,000 random", "O(log n)", "numbers asked",
        each(by_hand.gallop), LOOP),
    ("sums of a binary number's digits", "O(log n)", int, by_hand.digit_sum, LOOP),
    ("numbers below the root, by steps", "O(√n)", int, by_hand.steps_to_root, LOOP),
    ("list == its copy", "O(n)", "floats", lambda s: s == s[:], CPYTHON),
    ("max(list)", "O(n)", "floats", max, WIKI),
    ("all of a generator", "O(n)", "floats", lambda s: all(x < 2 for x in s), PYDOC),
    ("list of a map", "O(n)", "floats", lambda s: list(map(abs, s)), PYDOC),
    ("tuple + tuple", "O(n)", "tuple tuple", lambda s: s[0] + s[1], WIKI),
    ("list.clear of a copy", "O(n)", "floats", lambda s: s[:].clear(), CPYTHON),
    ("dict of a zip", "O(n)", "numbers floats", lambda s: dict(zip(*s, strict=True)), PYDOC),
    ("list of dict.items", "O(n)", "dict", lambda s: list(s.items()), WIKI),
    ("set ^ set", "O(n)", "floats_set floats_set", lambda s: s[0] ^ s[1], CPYTHON),
    ("itertools.islice, every second", "O(n)", "floats",
        lambda s: list(itertools.islice(s, 0, None, 2)), PYDOC),
    ("itertools.takewhile", "O(n)", "floats",
        lambda s: sum(1 for _ in itertools.takewhile(lambda x: x < 2, s)), PYDOC),
    ("sum of squares by a loop", "O(n)", "floats", by_hand.squared, LOOP),
    ("balanced brackets", "O(n)", lambda n: "()" * (n // 2 + 1), by_hand.balanced, CLRS),
    ("the nearest smaller to the left", "O(n)", "floats", by_hand.nearest_smaller, CLRS),
    ("two pointers to a sum", "O(n)", "heap", by_hand.pairs_of_sum, CLRS),
    ("str.lower", "O(n)", lambda n: "ABCDEFGHIJ" * (n // 10 + 1), str.lower, CPYTHON),
    ("str.isalpha", "O(n)", "letters", str.isalpha, CPYTHON),
    ("str * 2", "O(n)", "letters", lambda s: s * 2, WIKI),
    ("bytes.upper", "O(n)", "bytes", bytes.upper, CPYTHON),
    ("binascii.hexlify", "O(n)", "bytes", binascii.hexlify, PYDOC),
    ("bytes.fromhex", "O(n)", lambda n: random.randbytes(n).hex(), bytes.fromhex, CPYTHON),
    ("hashlib.sha1", "O(n)", "bytes", lambda s: hashlib.sha1(s).digest(), "FIPS 180-4"),
    ("base64.b32encode", "O(n)", "bytes", base64.b32encode, "RFC 4648"),
    ("json.dumps of words", "O(n)", lambda n: [f"{i:x}" for i in range(n)], json.dumps, CPYTHON),
    ("pickle.loads of floats", "O(n)", lambda n: pickle.dumps(floats(n)), pickle.loads, CPYTHON),
    ("csv.writer", "O(n)", lambda n: [(i, "b", i / 7) for i in range(n)],
        lambda s: csv.writer(io.StringIO()).writerows(s), CPYTHON),
    ("re.match of a run", "O(n)", lambda n: "a" * n, re.compile("[a-z]+").match, CPYTHON),
    ("html.unescape", "O(n)", lambda n: "a &lt; b " * (n // 9 + 1), html.unescape, PYDOC),
    ("int | int, n bits", "O(n)", "bits bits", lambda s: s[0] | s[1], LONG, 10_000_000),
    ("math.prod", "O(n)", "floats", math.prod, CPYTHON),
    ("statistics.mean of fractions", "O(n)", "floats", statistics.mean, PYDOC),
    ("np.min", "O(n)", "uniform", np.min, *ONE_PASS),
    ("np.square", "O(n)", "uniform", np.square, *ONE_PASS),
    ("np.negative", "O(n)", "uniform", np.negative, *ONE_PASS),
    ("np.multiply of two", "O(n)", "uniform uniform", lambda s: np.multiply(*s), *ONE_PASS),
    ("np.flip, copied", "O(n)", "uniform", lambda a: np.flip(a).copy(), *ONE_PASS),
    ("np.tanh", "O(n)", "uniform", np.tanh, *ONE_PASS),
    ("np.linspace", "O(n)", int, lambda n: np.linspace(0, 1, n), *ONE_PASS),
    ("np.count_nonzero", "O(n)", lambda n: uniform(n) > 0.5, np.count_nonzero, *ONE_PASS),
    ("np.stack of two", "O(n)", "uniform uniform", np.stack, NUMPY),
    ("np.trapezoid", "O(n)", "uniform", np.trapezoid, NUMPY),
    ("np.unpackbits", "O(n)", lambda n: np.zeros(n, np.uint8), np.unpackbits, NUMPY),
    ("minimum_filter1d", "O(n)", "uniform", lambda a: ndimage.minimum_filter1d(a, 5), SCIPY),
    ("scipy.special.j0", "O(n)", "uniform", special.j0, *ONE_PASS),
    ("scipy.signal.sosfilt", "O(n)", "uniform",
        lambda a: signal.sosfilt([[1.0, 0, 0, 1, -0.5, 0]], a), SCIPY),
    ("scipy.stats.linregress", "O(n)", "uniform uniform", lambda s: stats.linregress(*s), SCIPY),
    ("csr_array * 2", "O(n)", "sparse", lambda s: s * 2, SCIPY),
    ("sorted, integers by a key", "O(n log n)", lambda n: random.sample(range(n), n),
        lambda s: sorted(s, key=float), WIKI),
    ("sorted, of a set", "O(n log n)", "floats_set", sorted, WIKI),
    ("heapq.nsmallest of all", "O(n log n)", "floats", lambda s: heapq.nsmallest(len(s), s), PYDOC),
    ("a median by halves kept in heaps", "O(n log n)", "floats", by_hand.running_median, CLRS),
    ("closest pair by halving", "O(n log n)", "pairs", by_hand.closest_pair, CLRS),
    ("np.sort of complex numbers", "O(n log n)", lambda n: uniform(n) + 1j, np.sort, SORT),
    ("np.argsort, stable", "O(n log n)", "uniform", lambda a: np.argsort(a, kind="stable"), SORT),
    ("np.isin of floats", "O(n log n)", "uniform uniform", lambda s: np.isin(*s), BY_SORT),
    ("scipy.fft.irfft, powers of two", "O(n log n)", "uniform",
        lambda a: fft.irfft(a, len(a)), SCIPY, *TWOS),
    ("all pairs of a list", "O(n²)", "floats", lambda s: sum(a < b for a in s for b in s), LOOP),
    ("Floyd's triangle", "O(n²)", int, by_hand.triangle, LOOP),
    ("np.add.outer", "O(n²)", "uniform", lambda a: np.add.outer(a, a), NUMPY),
    ("matrix.max(axis=1)", "O(n²)", "matrix", lambda a: a.max(axis=1), NUMPY, SQUARE_BOUND),
    ("vector @ matrix", "O(n²)", "uniform matrix", lambda s: s[0] @ s[1], LAPACK),
    ("np.linalg.det", "O(n³)", "matrix", np.linalg.det, LAPACK),
    ("three nested ranges", "O(n³)", int,
        lambda n: sum(1 for a in range(n) for b in range(n) for c in range(n)), LOOP),
]))
# fmt: on
