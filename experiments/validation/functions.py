"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. The judge was tuned on these, and on some 440 that are no longer
kept. How good it is others tell, those of `held_out`, which were written down before any judge was
asked about them. What is decided by their answers makes them functions to tune on, and asks for
others.
"""

import array
import binascii
import bisect
import codecs
import collections
import copy
import csv
import functools
import hashlib
import heapq
import hmac
import io
import itertools
import json
import math
import operator
import pickle
import random
import re
import shlex
import statistics
import string
import textwrap
from collections.abc import Callable
from itertools import starmap
from operator import getitem
from typing import Any, NamedTuple
from urllib import parse
from xml.sax import saxutils

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
SCIPY = "docs.scipy.org"
GRAPH = "docs.scipy.org, csgraph"
CLRS = "Cormen et al., Introduction to Algorithms"

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


INPUTS: dict[str, Callable[[int], Any]] = {
    "numbers": lambda n: list(range(n)),
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
    "letters": lambda n: "".join(random.choices(string.ascii_lowercase, k=n)),
    "bytes": random.randbytes,
    "doubles": lambda n: array.array("d", bytes(8 * n)),
    "bits": lambda n: random.getrandbits(n) | 1 << (n - 1) | 1,
    "places": np.arange,
    "picked": lambda n: np.array(random.choices(range(n), k=KEYS)),
    "uniform": uniform,
    "points": lambda n: uniform(n, 3),
    "matrix": lambda n: uniform(n, n) + n * np.eye(n),  # far from singular
    "symmetric": lambda n: INPUTS["matrix"](n) + INPUTS["matrix"](n).T,
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


# fmt: off
FUNCTIONS: tuple[Function, ...] = tuple(starmap(function, [
    ("list[-1], 1,000 times", "O(1)", "floats", times(lambda s: s[-1]), WIKI),
    ("len(dict), 1,000 times", "O(1)", "dict", times(len), WIKI),
    ("str.startswith, 1,000 times", "O(1)", "letters", times(lambda s: s.startswith("ab")),
        CPYTHON),
    ("bytes[2:12], 1,000 times", "O(1)", "bytes", times(lambda s: s[2:12]), WIKI),
    ("deque.appendleft and popleft, 1,000 times", "O(1)", "deque",
        times(lambda s: (s.appendleft(0), s.popleft())), WIKI),
    ("defaultdict[key], 1,000 random", "O(1)",
        lambda n: looked_up(collections.defaultdict(int, enumerate(floats(n)))), each(getitem),
        PYDOC),
    ("range.index, 1,000 random", "O(1)", lambda n: (range(n), INPUTS["asked"](n)),
        each(range.index), CPYTHON + " of arithmetic"),
    ("array.ravel, 1,000 views", "O(1)", "matrix", times(np.ndarray.ravel), VIEWS, SQUARE_BOUND),
    ("np.take of int64, 1,000 random", "O(1)", "places picked", lambda s: np.take(*s), *ONE_PASS),
    ("array[i] of float32, 1,000 random", "O(1)",
        lambda n: (uniform(n).astype(np.float32), INPUTS["asked"](n)), each(getitem), *ONE_PASS),
    ("bisect_left in a range, 1,000 random", "O(log n)",
        lambda n: (range(n), INPUTS["asked"](n)), each(bisect.bisect_left), PYDOC),
    ("np.interp, 1,000 places among n", "O(log n)",
        lambda n: (uniform(1_000), np.linspace(0, 1, n), uniform(n)), lambda s: np.interp(*s),
        BISECT, CACHE_BOUND),
    ("heappush to the top and heappop, 1,000 times", "O(log n)", "heap",
        times(by_hand.push_and_pop), CLRS),
    ("tree of tuples, 1,000 random", "O(log n)",
        lambda n: (by_hand.balanced_tree(0, n), INPUTS["asked"](n)), each(by_hand.find_in_tree),
        CLRS + ": a balanced tree"),
    ("Fenwick tree, 1,000 ranks", "O(log n)",
        lambda n: ([i & -i for i in range(n + 1)], INPUTS["asked"](n)), each(by_hand.place_of_rank),
        "Fenwick, A New Data Structure for Cumulative Frequency Tables"),
    ("product by doubling", "O(log n)", int, by_hand.doubled, LOOP),
    ("sum of all n // i", "O(√n)", int, by_hand.sum_of_quotients, LOOP + ": by equal quotients"),
    ("sum of a range by blocks", "O(√n)", by_hand.in_blocks, by_hand.sum_by_blocks, LOOP),
    ("list.sort, all alike", "O(n)", lambda n: [1.5] * n, list.sort, TIMSORT),
    ("list(str)", "O(n)", "letters", list, CPYTHON),
    ("list + list", "O(n)", "floats floats", lambda s: s[0] + s[1], WIKI),
    ("tuple.index, the last", "O(n)", "tuple", lambda s: s.index(s[-1]), WIKI),
    ("list[:] = list", "O(n)", "floats floats", lambda s: s[0].__setitem__(slice(None), s[1]),
        WIKI),
    ("set.copy", "O(n)", "floats_set", set.copy, WIKI),
    ("set >= set", "O(n)", "floats_set", lambda s: s >= s.copy(), WIKI),
    ("dict.update", "O(n)", "floats_dict", lambda s: {}.update(s), WIKI),
    ("list of dict.values, reversed", "O(n)", "floats_dict", lambda s: list(reversed(s.values())),
        WIKI),
    ("Counter + Counter", "O(n)", lambda n: collections.Counter(range(n)), lambda s: s + s, PYDOC),
    ("deque.reverse", "O(n)", "deque", collections.deque.reverse, PYDOC),
    ("deque.count", "O(n)", "deque", lambda s: s.count(-1), PYDOC),
    ("itertools.compress", "O(n)", "floats few", lambda s: list(itertools.compress(*s)), PYDOC),
    ("itertools.zip_longest", "O(n)", "floats floats",
        lambda s: list(itertools.zip_longest(*s)), PYDOC),
    ("itertools.starmap", "O(n)", "pairs", lambda s: list(starmap(pow, s)), PYDOC),
    ("sum of a generator", "O(n)", "floats", lambda s: sum(x * x for x in s), PYDOC),
    ("min by a key", "O(n)", "floats", lambda s: min(s, key=lambda x: -x), WIKI),
    ("functools.reduce of products", "O(n)", "floats",
        lambda s: functools.reduce(operator.mul, s), PYDOC),
    ("copy.copy of a dict", "O(n)", "floats_dict", copy.copy, PYDOC),
    ("random.sample, n of n", "O(n)", "floats", lambda s: random.sample(s, len(s)), PYDOC),
    ("random.gauss, n times", "O(n)", int, lambda n: [random.gauss() for _ in range(n)], PYDOC),
    ("math.sin of each", "O(n)", "floats", lambda s: list(map(math.sin, s)), PYDOC),
    ("statistics.harmonic_mean", "O(n)", "floats", statistics.harmonic_mean, PYDOC),
    ("statistics.correlation", "O(n)", "floats floats", lambda s: statistics.correlation(*s),
        PYDOC),
    ("str.swapcase", "O(n)", "letters", str.swapcase, CPYTHON),
    ("str.isdigit", "O(n)", lambda n: "7" * n, str.isdigit, CPYTHON),
    ("str.rsplit", "O(n)", lambda n: "ab " * n, str.rsplit, CPYTHON),
    ("str.expandtabs", "O(n)", lambda n: "a\tb\n" * (n // 4 + 1), str.expandtabs, CPYTHON),
    ("str in str, absent", "O(n)", "letters", lambda s: "é" in s, CPYTHON),
    ("bytes.replace", "O(n)", "bytes", lambda s: s.replace(b"\x07", b"\x08"), CPYTHON),
    ("bytes.split", "O(n)", lambda n: b"ab " * n, bytes.split, CPYTHON),
    ("bytearray.reverse", "O(n)", lambda n: bytearray(random.randbytes(n)), bytearray.reverse,
        CPYTHON, CACHE_BOUND),
    ("binascii.crc32", "O(n)", "bytes", binascii.crc32, "RFC 1952", CACHE_BOUND),
    ("binascii.a2b_base64", "O(n)", lambda n: binascii.b2a_base64(random.randbytes(n)),
        binascii.a2b_base64, "RFC 4648"),
    ("codecs, rot13", "O(n)", "letters", lambda s: codecs.encode(s, "rot13"), CPYTHON),
    ("hashlib.sha3_512", "O(n)", "bytes", lambda s: hashlib.sha3_512(s).digest(), "FIPS 202"),
    ("hmac.digest", "O(n)", "bytes", lambda s: hmac.digest(b"key", s, "sha256"), "RFC 2104"),
    ("json.loads of words", "O(n)", lambda n: json.dumps([f"{i:x}" for i in range(n)]), json.loads,
        CPYTHON),
    ("json.dumps of pairs", "O(n)", "pairs", json.dumps, CPYTHON),
    ("pickle.dumps of integers", "O(n)", "numbers", pickle.dumps, CPYTHON),
    ("csv.DictReader", "O(n)", lambda n: ["a,b", *(f"{i},{i / 7}" for i in range(n))],
        lambda s: list(csv.DictReader(s)), CPYTHON),
    ("shlex.split", "O(n)", lambda n: "ab 'c d' " * (n // 9 + 1), shlex.split, CPYTHON),
    ("textwrap.dedent", "O(n)", lambda n: "    ab\n" * (n // 7 + 1), textwrap.dedent, CPYTHON),
    ("re.escape", "O(n)", lambda n: "a.b" * (n // 3 + 1), re.escape, CPYTHON),
    ("re.subn of words", "O(n)", lambda n: "ab cd " * (n // 6 + 1),
        lambda s: re.subn(r"\w+", "x", s), CPYTHON),
    ("saxutils.escape", "O(n)", lambda n: "a<b&c " * (n // 6 + 1), saxutils.escape, PYDOC),
    ("parse.parse_qsl", "O(n)", lambda n: "&".join(f"a{i}={i}" for i in range(n)),
        parse.parse_qsl, PYDOC),
    ("StringIO, n lines written", "O(n)", lambda n: ["line\n"] * n,
        lambda s: io.StringIO().writelines(s), PYDOC),
    ("~int, n bits", "O(n)", "bits", operator.invert, LONG, 10_000_000),
    ("Horner's rule", "O(n)", "floats", by_hand.horner, CLRS),
    ("runs and their lengths", "O(n)", "few", by_hand.run_lengths, LOOP),
    ("the largest of each window", "O(n)", "floats", by_hand.window_maxima, LOOP + ": a deque"),
    ("Z function", "O(n)", lambda n: "ab" * (n // 2 + 1), by_hand.z_function,
        "Gusfield, Algorithms on Strings, Trees, and Sequences"),
    ("topological order", "O(n)", by_hand.random_dag, by_hand.topological, CLRS),
    ("Dutch national flag", "O(n)", "floats", by_hand.three_ways, "Dijkstra"),
    ("np.add of float32", "O(n)", lambda n: uniform(n).astype(np.float32), lambda a: a + a,
        *ONE_PASS),
    ("np.cos", "O(n)", "uniform", np.cos, *ONE_PASS),
    ("np.reciprocal", "O(n)", lambda n: uniform(n) + 1, np.reciprocal, *ONE_PASS),
    ("np.logical_and", "O(n)", lambda n: uniform(n) > 0.5, lambda a: np.logical_and(a, a),
        *ONE_PASS),
    ("np.prod", "O(n)", "uniform", np.prod, *ONE_PASS),
    ("np.full", "O(n)", int, lambda n: np.full(n, 1.5), *ONE_PASS),
    ("np.maximum.accumulate", "O(n)", "uniform", np.maximum.accumulate, *ONE_PASS),
    ("np.delete, one", "O(n)", "uniform", lambda a: np.delete(a, len(a) // 2), *ONE_PASS),
    ("np.pad", "O(n)", "uniform", lambda a: np.pad(a, 5), NUMPY),
    ("np.nansum", "O(n)", "uniform", np.nansum, *ONE_PASS),
    ("np.hypot", "O(n)", "uniform uniform", lambda s: np.hypot(*s), *ONE_PASS),
    ("np.average, weighted", "O(n)", "uniform uniform",
        lambda s: np.average(s[0], weights=s[1]), NUMPY),
    ("np.corrcoef", "O(n)", "uniform uniform", lambda s: np.corrcoef(*s), NUMPY),
    ("np.cross of points", "O(n)", "points points", lambda s: np.cross(*s), NUMPY),
    ("np.array of a list", "O(n)", "floats", np.array, NUMPY),
    ("np.polyval, degree 3", "O(n)", "uniform", lambda a: np.polyval([1.0, 2, 3, 4], a), NUMPY),
    ("np.sort of uint8, stable", "O(n)", lambda n: np.frombuffer(random.randbytes(n), np.uint8),
        lambda a: np.sort(a, kind="stable"), SORT + ": radix sort", CACHE_BOUND),
    ("np.quantile", "O(n)", "uniform", lambda a: np.quantile(a, 0.9), PARTITION),
    ("convolve1d, 7 wide", "O(n)", "uniform", lambda a: ndimage.convolve1d(a, np.ones(7)), SCIPY),
    ("ndimage.label, of a row", "O(n)", lambda n: uniform(n) > 0.5, ndimage.label, SCIPY),
    ("scipy.signal.detrend, constant", "O(n)", "uniform",
        lambda a: signal.detrend(a, type="constant"), SCIPY),
    ("scipy.signal.upfirdn", "O(n)", "uniform",
        lambda a: signal.upfirdn([1.0, 2, 1], a, up=2), SCIPY),
    ("scipy.stats.describe", "O(n)", "uniform", stats.describe, SCIPY),
    ("scipy.stats.norm.cdf", "O(n)", "uniform", stats.norm.cdf, SCIPY),
    ("scipy.special.gammaln", "O(n)", "uniform", special.gammaln, *ONE_PASS),
    ("scipy.special.softmax", "O(n)", "uniform", special.softmax, SCIPY),
    ("PchipInterpolator", "O(n)", "places uniform", lambda s: interpolate.PchipInterpolator(*s),
        SCIPY),
    ("dia_array @ vector", "O(n)",
        lambda n: (sparse.diags_array(np.ones(n)).todia(), uniform(n)), lambda s: s[0] @ s[1],
        SCIPY),
    ("Rotation.apply to points", "O(n)", "points",
        spatial.transform.Rotation.from_euler("x", 1.0).apply, SCIPY),
    ("sorted, with a comparison", "O(n log n)", "floats",
        lambda s: sorted(s, key=functools.cmp_to_key(by_hand.compared)), WIKI),
    ("heapq.nlargest of all", "O(n log n)", "floats", lambda s: heapq.nlargest(len(s), s), PYDOC),
    ("statistics.quantiles", "O(n log n)", "floats", statistics.quantiles, PYDOC + ": it sorts"),
    ("merge sort from below", "O(n log n)", "floats", by_hand.merge_from_below, CLRS),
    ("union of random intervals", "O(n log n)", "pairs", by_hand.covered, CLRS + ": it sorts"),
    ("search tree of random keys, built", "O(n log n)", "floats", by_hand.grown_tree,
        CLRS + ": expected"),
    ("np.argsort of int64", "O(n log n)",
        lambda n: np.random.default_rng().integers(0, 2**60, n), np.argsort, SORT),
    ("np.sort of strings", "O(n log n)",
        lambda n: np.array(random.sample([f"{i:08x}" for i in range(n)], n)), np.sort, SORT),
    ("scipy.stats.wasserstein_distance", "O(n log n)", "uniform uniform",
        lambda s: stats.wasserstein_distance(*s), SCIPY + ": it sorts"),
    ("np.union1d of float32", "O(n log n)",
        lambda n: (uniform(n).astype(np.float32), uniform(n).astype(np.float32)),
        lambda s: np.union1d(*s), BY_SORT),
    ("scipy.fft.fft of complex numbers, powers of two", "O(n log n)", lambda n: uniform(n) + 1j,
        fft.fft, SCIPY, *TWOS),
    ("scipy.signal.resample to half, powers of two", "O(n log n)", "uniform",
        lambda a: signal.resample(a, len(a) // 2), SCIPY, *TWOS),
    ("n random walks of root n steps", "O(n^1.5)", int, by_hand.walks, LOOP),
    ("pairs closer than a tenth", "O(n²)", "floats",
        lambda s: sum(1 for i, a in enumerate(s) for b in s[:i] if abs(a - b) < 0.1), LOOP),
    ("dynamic time warping", "O(n²)", "floats floats", by_hand.warped, CLRS + ": a table"),
    ("coins for n, n of them", "O(n²)", int, by_hand.change, CLRS),
    ("n × list.remove, the last", "O(n²)", "numbers", by_hand.remove_all, WIKI),
    ("np.multiply.outer", "O(n²)", "uniform", lambda a: np.multiply.outer(a, a), NUMPY),
    ("np.polymul", "O(n²)", "uniform", lambda a: np.polymul(a, a), DIRECT),
    ("np.tril", "O(n²)", "matrix", np.tril, NUMPY, SQUARE_BOUND),
    ("matrix.mean(axis=1)", "O(n²)", "matrix", lambda a: a.mean(axis=1), NUMPY, SQUARE_BOUND),
    ("scipy.linalg.toeplitz", "O(n²)", "uniform", linalg.toeplitz, SCIPY),
    ("squareform", "O(n²)", lambda n: uniform(n * (n - 1) // 2), spatial.distance.squareform,
        SCIPY),
    ("scipy.linalg.lu", "O(n³)", "matrix", linalg.lu, LAPACK),
    ("np.linalg.eigh", "O(n³)", "symmetric", np.linalg.eigh, LAPACK),
    ("Gauss' elimination by hand", "O(n³)", "rows", by_hand.eliminate, CLRS),
    ("triangles in a table of neighbors", "O(n³)", "rows", by_hand.triangles, LOOP),
    ("every mask of n bits", "O(2^n)", int, lambda n: sum(mask & 1 for mask in range(1 << n)),
        LOOP),
    ("nodes of a full tree, by recursion", "O(2^n)", int, by_hand.full_tree, CLRS),
]))
# fmt: on
