"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. The judge was tuned on `FUNCTIONS`, and on some 580 that are no
longer kept. How good it is `HELD_OUT` tells, written down before any judge was asked about them.
Whoever changes the judge for what it says of them makes them functions to tune on, and writes
others.
"""

import array
import ast
import base64
import binascii
import bisect
import collections
import copy
import decimal
import fnmatch
import functools
import gzip
import hashlib
import heapq
import itertools
import json
import marshal
import math
import operator
import pickle
import plistlib
import random
import re
import statistics
import string
import struct
import textwrap
import zlib
from collections.abc import Callable, Mapping, Sequence
from operator import getitem
from typing import Any, NamedTuple
from urllib import parse
from xml.etree import ElementTree

import numpy as np
from scipy import (
    fft,
    integrate,
    interpolate,
    linalg,
    ndimage,
    signal,
    sparse,
    spatial,
    special,
    stats,
)

from experiments.validation import by_hand

WIKI = "wiki.python.org/moin/TimeComplexity"
TIMSORT = "CPython, Objects/listsort.txt"
CPYTHON = "CPython's source: one pass"
LONG = "CPython, Objects/longobject.c"
LOOP = "counted by hand"
NUMPY = "numpy.org/doc: one pass"
VIEWS = "numpy.org/doc: views"
BISECT = "numpy.org/doc: binary search"
PARTITION = "numpy.org/doc, numpy.partition"
SORT = "numpy.org/doc, numpy.sort"
BY_SORT = f"{SORT}: it sorts"
LAPACK = "Golub and Van Loan, Matrix Computations"
PYDOC = "docs.python.org"
SCIPY = "docs.scipy.org"
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


def uniform(*shape: int) -> Any:
    """Numbers from 0 to 1 in an array."""
    return np.random.default_rng().random(shape)


def floats(n: int) -> list[float]:
    """Numbers from 0 to 1 in a list."""
    return [random.random() for _ in range(n)]


INPUTS: dict[str, Callable[[int], Any]] = {
    "numbers": lambda n: list(range(n)),
    "floats": floats,
    "heap": lambda n: sorted(floats(n)),
    "tuple": lambda n: tuple(floats(n)),
    "deque": lambda n: collections.deque(range(n)),
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


def functions(by_growth: Mapping[str, Sequence[tuple[Any, ...]]]) -> tuple[Function, ...]:
    """Each has a name, an input, and what ``Function`` has from ``call`` on.

    An input is given by what makes it, or by the names of one or of several.
    """
    return tuple(
        Function(name, growth, _maker(given), *others)
        for growth, rows in by_growth.items()
        for name, given, *others in rows
    )


def _maker(given: Any) -> Callable[[int], Any]:
    makes = [INPUTS[it] for it in given.split()] if isinstance(given, str) else [given]
    return makes[0] if len(makes) == 1 else lambda n: tuple(it(n) for it in makes)


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
FUNCTIONS = functions({"O(1)": [
    ("list[n // 2], 1,000 times", "floats", times(lambda s: s[len(s) // 2]), WIKI),
    ("tuple[1:5], 1,000 times", "tuple", times(lambda s: s[1:5]), WIKI),
    ("dict.keys, 1,000 views", "floats_dict", times(dict.keys), PYDOC),
    ("set.pop and add, 1,000 times", "set", times(lambda s: s.add(s.pop())), WIKI),
    ("str[-3:], 1,000 times", "letters", times(lambda s: s[-3:]), WIKI),
    ("range[i], 1,000 random", lambda n: (range(n), INPUTS["asked"](n)), each(getitem),
        CPYTHON + " of arithmetic"),
    ("array.append and pop, 1,000 times", "doubles", times(lambda s: (s.append(1.5), s.pop())),
        PYDOC),
    ("matrix.transpose, 1,000 views", "matrix", times(np.ndarray.transpose), VIEWS, SQUARE_BOUND),
    ("array.view, 1,000 times", "uniform", times(lambda a: a.view(np.int64)), VIEWS, CACHE_BOUND),
    ("array[1,000 random indices] = 0", "uniform picked", lambda s: s[0].__setitem__(s[1], 0),
        *ONE_PASS),
    ("Counter[key], 1,000 random", lambda n: looked_up(collections.Counter(floats(n))),
        each(getitem), PYDOC),
], "O(log n)": [
    ("insort at the end and pop, 1,000 times", "heap",
        times(lambda s: (bisect.insort(s, 2.0), s.pop())), PYDOC),
    ("bisect in pairs, 1,000 random", lambda n: looked_up(sorted(INPUTS["pairs"](n))),
        each(bisect.bisect), PYDOC),
    ("np.searchsorted by a sorter, 1,000 random",
        lambda n: (*by_hand.with_order(uniform(n)), uniform(KEYS)),
        lambda s: s[0].searchsorted(s[2], sorter=s[1]), BISECT),
    ("union by size, 1,000 random roots",
        lambda n: ([i & (i - 1) for i in range(n)], INPUTS["asked"](n)), each(by_hand.root_of),
        CLRS + ": a binomial tree"),
    ("Fibonacci by doubling, modulo", int, by_hand.fibonacci, LOOP),
    ("whole root by halving", int, by_hand.whole_root, LOOP),
], "O(√n)": [
    ("sum of divisors to the root", int,
        lambda n: sum(i for i in range(1, math.isqrt(n) + 1) if n % i == 0), LOOP),
    ("baby steps and giant steps", int, by_hand.discrete_logarithm,
        "Shanks, Class number, a theory of factorization, and genera"),
], "O(n)": [
    ("list of a range", range, list, PYDOC),
    ("list.sort, two runs", lambda n: [*range(n // 2), *range(n)], list.sort, TIMSORT),
    ("del list[0]", "floats", lambda s: s.__delitem__(0), WIKI),
    ("absent in tuple", "tuple", lambda s: 2.0 in s, WIKI),
    ("list += list", "floats floats", lambda s: s[0].__iadd__(s[1]), WIKI),
    ("all of a list", lambda n: [True] * n, all, PYDOC),
    ("list of a set", "floats_set", list, WIKI),
    ("tuple of a generator", "floats", lambda s: tuple(x + 1 for x in s), PYDOC),
    ("list of every third", "floats", lambda s: s[::3], WIKI),
    ("set of a comprehension", "few", lambda s: {x * 2 for x in s}, WIKI),
    ("dict turned round", "floats_dict", lambda s: {b: a for a, b in s.items()}, WIKI),
    ("lists by a key, in a defaultdict", "few", by_hand.grouped, PYDOC),
    ("Counter.total", lambda n: collections.Counter(range(n)), collections.Counter.total, PYDOC),
    ("deque.extendleft", "floats", lambda s: collections.deque().extendleft(s), PYDOC),
    ("deque.copy", "deque", collections.deque.copy, PYDOC),
    ("deque.index, the last", "deque", lambda s: s.index(len(s) - 1), PYDOC),
    ("itertools.dropwhile", "floats", lambda s: list(itertools.dropwhile(lambda x: x < 2, s)),
        PYDOC),
    ("itertools.filterfalse", "numbers", lambda s: list(itertools.filterfalse(lambda x: x % 3, s)),
        PYDOC),
    ("itertools.accumulate, the largest", "floats", lambda s: list(itertools.accumulate(s, max)),
        PYDOC),
    ("itertools.chain of tens", lambda n: [range(10)] * (n // 10 + 1),
        lambda s: list(itertools.chain.from_iterable(s)), PYDOC),
    ("functools.cache, n new", int, lambda n: list(map(functools.cache(float), range(n))), PYDOC),
    ("itemgetter of each", "pairs", lambda s: list(map(operator.itemgetter(1), s)), PYDOC),
    ("pairs turned into columns", "pairs", lambda s: list(zip(*s, strict=True)), PYDOC),
    ("heapq.nlargest(10)", "floats", lambda s: heapq.nlargest(10, s), PYDOC),
    ("divmod of each by 7", "numbers", lambda s: [divmod(x, 7) for x in s], PYDOC),
    ("statistics.geometric_mean", "floats", statistics.geometric_mean, PYDOC),
    ("statistics.covariance", "floats floats", lambda s: statistics.covariance(*s), PYDOC),
    ("random.random, n times", int, lambda n: [random.random() for _ in range(n)], PYDOC),
    ("random.randbytes", int, random.randbytes, PYDOC),
    ("copy.copy of a list", "floats", copy.copy, PYDOC),
    ("repr of a list", "numbers", repr, CPYTHON),
    ("float of each word", lambda n: [f"{i / 7}" for i in range(n)], lambda s: list(map(float, s)),
        PYDOC),
    ("ord of each", "letters", lambda s: [ord(c) for c in s], PYDOC),
    ("str.partition, absent", "letters", lambda s: s.partition("-"), CPYTHON),
    ("str.zfill", int, lambda n: "7".zfill(n), CPYTHON),
    ("str.capitalize", "letters", str.capitalize, CPYTHON),
    ("str.isalnum", "letters", str.isalnum, CPYTHON),
    ("str.removeprefix", "letters", lambda s: s.removeprefix(s[:3]), CPYTHON),
    ("string.capwords", lambda n: "ab cd " * (n // 6 + 1), string.capwords, PYDOC),
    ("textwrap.indent", lambda n: "ab\n" * (n // 3 + 1), lambda s: textwrap.indent(s, "  "), PYDOC),
    ("str.encode, utf-16", "letters", lambda s: s.encode("utf-16"), CPYTHON),
    ("bytes.decode, latin-1", "bytes", lambda s: s.decode("latin-1"), CPYTHON),
    ("bytes.find, absent", lambda n: b"ab" * n, lambda s: s.find(b"x"), CPYTHON),
    ("bytes.join", lambda n: [b"ab"] * n, b",".join, CPYTHON),
    ("bytearray.extend", "bytes bytes", lambda s: bytearray(s[0]).extend(s[1]), CPYTHON),
    ("memoryview.tolist", lambda n: memoryview(random.randbytes(n)), memoryview.tolist, PYDOC),
    ("int.from_bytes", "bytes", lambda s: int.from_bytes(s, "little"), LONG),
    ("int >> 3, n bits", "bits", lambda a: a >> 3, LONG, 10_000_000),
    ("base64.a85encode", "bytes", base64.a85encode, PYDOC),
    ("binascii.b2a_qp", "letters", lambda s: binascii.b2a_qp(s.encode()), "RFC 2045"),
    ("parse.unquote", lambda n: "a%20b" * (n // 5 + 1), parse.unquote, PYDOC),
    ("hashlib.sha224", "bytes", lambda s: hashlib.sha224(s).digest(), "FIPS 180-4"),
    ("hashlib.blake2s", "bytes", lambda s: hashlib.blake2s(s).digest(), "RFC 7693"),
    ("json.dumps, indented", "numbers", lambda s: json.dumps(s, indent=1), CPYTHON),
    ("json.loads of lists", lambda n: json.dumps([[i, i] for i in range(n)]), json.loads, CPYTHON),
    ("pickle.loads of words", lambda n: pickle.dumps([f"{i:x}" for i in range(n)]), pickle.loads,
        CPYTHON),
    ("marshal.dumps of words", lambda n: [f"{i:x}" for i in range(n)], marshal.dumps, CPYTHON),
    ("struct.iter_unpack", lambda n: random.randbytes(16 * n),
        lambda s: list(struct.iter_unpack("<qi4x", s)), PYDOC),
    ("array.array.byteswap", "doubles", array.array.byteswap, PYDOC, CACHE_BOUND),
    ("re.sub by a function", lambda n: "ab 12 " * (n // 6 + 1),
        lambda s: re.sub(r"\d+", lambda m: m[0][::-1], s), CPYTHON),
    ("re.fullmatch of alternatives", lambda n: "ab" * n, re.compile("(?:ab|cd)*").fullmatch,
        CPYTHON),
    ("linear sieve of primes", int, by_hand.primes,
        "Gries and Misra, A linear sieve algorithm for finding prime numbers"),
    ("longest palindrome", lambda n: "ab" * (n // 2 + 1), by_hand.longest_palindrome,
        "Manacher, A New Linear-Time On-Line Algorithm"),
    ("the last of n in a ring", int,
        lambda n: functools.reduce(lambda at, k: (at + 7) % k, range(2, n + 1), 0),
        LOOP + ": Josephus"),
    ("postfix expression", lambda n: [1, *[2, "+"] * n], by_hand.postfix, CLRS + ": a stack"),
    ("radix sort by hand", lambda n: random.choices(range(1 << 16), k=n), by_hand.radix_sort, CLRS),
    ("np.sign", "uniform", np.sign, *ONE_PASS),
    ("np.log1p", "uniform", np.log1p, *ONE_PASS),
    ("np.arctan2", "uniform uniform", lambda s: np.arctan2(*s), *ONE_PASS),
    ("np.greater", "uniform uniform", lambda s: np.greater(*s), *ONE_PASS),
    ("np.bitwise_xor", "places places", lambda s: np.bitwise_xor(*s), *ONE_PASS),
    ("np.all", lambda n: np.ones(n, bool), np.all, NUMPY, 8 * CACHE_BOUND),
    ("np.argmin", "uniform", np.argmin, *ONE_PASS),
    ("np.ptp", "uniform", np.ptp, *ONE_PASS),
    ("np.divide of float32", lambda n: uniform(n).astype(np.float32) + 1, lambda a: np.divide(1, a),
        *ONE_PASS),
    ("np.compress", lambda n: (np.arange(n) % 2 == 0, uniform(n)), lambda s: np.compress(*s),
        *ONE_PASS),
    ("np.insert, one", "uniform", lambda a: np.insert(a, len(a) // 2, 0), NUMPY),
    ("np.fromiter", "floats", lambda s: np.fromiter(s, float), NUMPY),
    ("np.arange", int, lambda n: np.arange(n, dtype=float), *ONE_PASS),
    ("np.nanmax", "uniform", np.nanmax, *ONE_PASS),
    ("np.vdot", "uniform uniform", lambda s: np.vdot(*s), *ONE_PASS),
    ("np.linalg.norm of each point", "points", lambda p: np.linalg.norm(p, axis=1), NUMPY),
    ("n products of 3 by 3", lambda n: uniform(n, 3, 3), lambda a: a @ a, NUMPY),
    ("uniform random numbers", int, np.random.default_rng().random, *ONE_PASS),
    ("np.unravel_index", "places", lambda a: np.unravel_index(a, (len(a), 1)), NUMPY),
    ("np.isclose", "uniform uniform", lambda s: np.isclose(*s), NUMPY),
    ("scipy.special.erfc", "uniform", special.erfc, *ONE_PASS),
    ("scipy.special.logsumexp", "uniform", special.logsumexp, SCIPY),
    ("scipy.stats.kurtosis", "uniform", stats.kurtosis, SCIPY),
    ("scipy.stats.trim_mean", "uniform", lambda a: stats.trim_mean(a, 0.1), PARTITION),
    ("scipy.signal.medfilt, 5 wide", "uniform", lambda a: signal.medfilt(a, 5), SCIPY),
    ("scipy.signal.welch", "uniform", lambda a: signal.welch(a, nperseg=min(len(a), 64)),
        SCIPY + ": parts of one length"),
    ("ndimage.binary_erosion, of a row", lambda n: uniform(n) > 0.2, ndimage.binary_erosion, SCIPY),
    ("ndimage.map_coordinates, linear", lambda n: (uniform(n), uniform(1, n) * (n - 1)),
        lambda s: ndimage.map_coordinates(s[0], s[1], order=1), SCIPY),
    ("Akima1DInterpolator", "places uniform", lambda s: interpolate.Akima1DInterpolator(*s), SCIPY),
    ("scipy.integrate.trapezoid", "uniform", integrate.trapezoid, SCIPY),
    ("csc_array of a diagonal csr_array", lambda n: sparse.diags_array(np.ones(n)).tocsr(),
        lambda a: a.tocsc(), SCIPY),
    ("csgraph.depth_first_order, of a path",
        lambda n: sparse.diags_array(np.ones(n - 1), offsets=1).tocsr(),
        lambda a: sparse.csgraph.depth_first_order(a, 0), SCIPY + ", csgraph"),
], "O(n log n)": [
    ("list.sort, reversed", "floats", lambda s: s.sort(reverse=True), WIKI),
    ("Counter.most_common", lambda n: collections.Counter(dict(enumerate(floats(n)))),
        collections.Counter.most_common, PYDOC + ": it sorts"),
    ("statistics.median_high", "floats", statistics.median_high, PYDOC + ": it sorts"),
    ("smaller to the right, in a Fenwick tree", lambda n: random.sample(range(n), n),
        by_hand.smaller_behind, CLRS),
    ("most intervals at a time", "pairs", by_hand.most_at_a_time, CLRS + ": it sorts"),
    ("np.sort of int64", lambda n: np.random.default_rng().integers(0, 2**60, n), np.sort, SORT,
        CACHE_BOUND),
    ("np.setxor1d", "uniform uniform", lambda s: np.setxor1d(*s), BY_SORT),
    ("scipy.stats.ks_2samp", "uniform uniform",
        lambda s: stats.ks_2samp(s[0], s[1], method="asymp"), SCIPY + ": it sorts"),
    ("scipy.stats.energy_distance", "uniform uniform", lambda s: stats.energy_distance(*s),
        SCIPY + ": it sorts"),
    ("np.fft.ifft, powers of two", "uniform", np.fft.ifft, NUMPY, *TWOS),
    ("scipy.fft.idct, powers of two", "uniform", fft.idct, SCIPY, *TWOS),
    ("Fourier transform by hand, powers of two", lambda n: [1 + 2j] * (1 << (n - 1).bit_length()),
        by_hand.fourier, CLRS, *TWOS),
], "O(n^1.5)": [
    ("roots of all to n, by steps", int,
        lambda n: sum(1 for i in range(n) for _ in range(math.isqrt(i))), LOOP),
], "O(n²)": [
    ("list.count of each", "numbers", lambda s: [s.count(x) for x in s], WIKI),
    ("palindromes from every center", lambda n: "a" * n, by_hand.palindromes, LOOP),
    ("cutting a rod", "floats", by_hand.best_cuts, CLRS),
    ("rows turned into columns", "rows", lambda s: list(zip(*s, strict=True)), PYDOC),
    ("nearest neighbors grown to a tree", "rows", by_hand.least_tree, CLRS + ": Prim"),
    ("np.equal.outer", "places", lambda a: np.equal.outer(a, a), NUMPY),
    ("np.diag of a vector", "uniform", lambda a: np.diag(a) + 1, NUMPY),
    ("matrix.cumsum(axis=1)", "matrix", lambda a: a.cumsum(axis=1), NUMPY, SQUARE_BOUND),
    ("matrix.sum()", "matrix", np.sum, NUMPY, SQUARE_BOUND),
    ("np.poly of roots", "uniform", np.poly, "numpy.org/doc: by convolutions"),
    ("cdist, chebyshev", "points", lambda p: spatial.distance.cdist(p, p, "chebyshev"), SCIPY),
    ("ndimage.uniform_filter of a matrix", "matrix", lambda a: ndimage.uniform_filter(a, 5), SCIPY),
], "O(n² log n)": [
    ("each row sorted", "rows", lambda s: list(map(sorted, s)), WIKI),
    ("np.sort of each row", "matrix", lambda a: np.sort(a, axis=1), SORT),
], "O(n³)": [
    ("scipy.linalg.solve", "matrix uniform", lambda s: linalg.solve(*s), LAPACK),
    ("np.cov of n variables", "matrix", np.cov, NUMPY + " of products"),
    ("Floyd and Warshall by hand", "rows", by_hand.all_distances, CLRS),
    ("three to a sum", "floats", lambda s: sum(a + b + c < 1 for a in s for b in s for c in s),
        LOOP),
], "O(2^n)": [
    ("sums to a target, by trying all", floats, by_hand.tried, CLRS),
    ("bits of every mask, by a table", int, by_hand.bit_counts, LOOP),
]})

HELD_OUT = functions({"O(1)": [
    ("tuple[-1], 1,000 times", "tuple", times(lambda s: s[-1]), WIKI),
    ("list.append and del of the last, 1,000 times", "floats",
        times(lambda s: (s.append(0.5), s.__delitem__(-1))), WIKI),
    ("pair in dict, 1,000 random", lambda n: looked_up({(i, i + 1): i for i in range(n)}),
        each(dict.__contains__), WIKI),
    ("len(str), 1,000 times", "letters", times(len), WIKI),
    ("array.flat[i], 1,000 random", "uniform asked", each(lambda a, i: a.flat[i]), NUMPY),
    ("memoryview.cast, 1,000 views", lambda n: memoryview(random.randbytes(8 * n)),
        times(lambda s: s.cast("d")), PYDOC),
    ("matrix.diagonal, 1,000 views", "matrix", times(np.ndarray.diagonal), VIEWS, SQUARE_BOUND),
    ("bytes[i:i + 8], 1,000 random", "bytes asked", each(lambda s, i: s[i:i + 8]), WIKI),
    ("array[1,000 random indices] + 1",
        lambda n: (uniform(n).astype(np.float32), INPUTS["picked"](n)), lambda s: s[0][s[1]] + 1,
        *ONE_PASS),
], "O(log n)": [
    ("heappop and heappush of the least, 1,000 times", "heap",
        times(lambda s: heapq.heappush(s, heapq.heappop(s))), CLRS),
    ("np.searchsorted in seconds, 1,000 random", by_hand.seconds, lambda s: np.searchsorted(*s),
        BISECT),
    ("segment tree, 1,000 sums from a place on",
        lambda n: (by_hand.sums_in_a_tree(n), INPUTS["asked"](n)), each(by_hand.sum_from), CLRS),
    ("least of a turned list, 1,000 times", lambda n: [*range(n // 3, n), *range(n // 3)],
        times(by_hand.turned_at), LOOP),
    ("spline of n pieces, at 1,000 random places",
        lambda n: (interpolate.PPoly(uniform(2, n), np.arange(n + 1.0)), n * uniform(KEYS)),
        lambda s: s[0](s[1]), SCIPY + ": binary search"),
], "O(√n)": [
    ("squares up to n", int,
        lambda n: list(itertools.takewhile(lambda q: q <= n, (k * k for k in itertools.count()))),
        LOOP),
    ("lattice points in a disk", int,
        lambda n: sum(math.isqrt(n - x * x) for x in range(math.isqrt(n) + 1)), LOOP),
], "O(n)": [
    ("sum of the lengths of words", lambda n: [f"{i:x}" for i in range(n)],
        lambda s: sum(map(len, s)), PYDOC),
    ("del list[n // 2]", "floats", lambda s: s.__delitem__(len(s) // 2), WIKI),
    ("the larger of two lists", "floats floats", lambda s: list(map(max, *s)), PYDOC),
    ("sums of a zip", "floats floats", lambda s: [a + b for a, b in zip(*s, strict=True)], PYDOC),
    ("tuple.count", "tuple", lambda s: s.count(2.0), WIKI),
    ("any of a map", "floats", lambda s: any(map((2.0).__lt__, s)), PYDOC),
    ("min(dict)", "floats_dict", min, WIKI),
    ("sorted, of a range backward", lambda n: range(n, 0, -1), sorted, TIMSORT),
    ("set.union of a list", "floats_set floats", lambda s: s[0].union(s[1]), WIKI),
    ("set.intersection of a generator", "set", lambda s: s.intersection(x + 1 for x in s), WIKI),
    ("sum over dict.items", "floats_dict", lambda s: sum(k + v for k, v in s.items()), WIKI),
    ("Counter of letters", "letters", collections.Counter, PYDOC),
    ("Counter.subtract", lambda n: collections.Counter(range(n)), lambda s: s.subtract(s), PYDOC),
    ("deque.extend", "floats", lambda s: collections.deque().extend(s), PYDOC),
    ("deque == deque", "deque deque", lambda s: s[0] == s[1], PYDOC),
    ("OrderedDict.fromkeys", "floats", collections.OrderedDict.fromkeys, PYDOC),
    ("itertools.cycle, n of ten", int,
        lambda n: list(itertools.islice(itertools.cycle(range(10)), n)), PYDOC),
    ("itertools.tee, both read", "floats", lambda s: [sum(it) for it in itertools.tee(iter(s))],
        PYDOC),
    ("operator.countOf", "numbers", lambda s: operator.countOf(s, -1), PYDOC),
    ("math.floor of each", "floats", lambda s: [math.floor(x) for x in s], PYDOC),
    ("hash of each", "pairs", lambda s: list(map(hash, s)), PYDOC),
    ("str of each", "floats", lambda s: list(map(str, s)), PYDOC),
    ("sum of decimals", lambda n: [decimal.Decimal(i) / 7 for i in range(n)], sum, PYDOC),
    ("statistics.pvariance", "floats", statistics.pvariance, PYDOC),
    ("random.expovariate, n times", int, lambda n: [random.expovariate(1.0) for _ in range(n)],
        PYDOC),
    ("random.getrandbits", int, random.getrandbits, PYDOC, 10_000_000),
    ("str.isupper", lambda n: "A" * n, str.isupper, CPYTHON),
    ("str.lstrip", lambda n: " " * n + "x", str.lstrip, CPYTHON),
    ("str.rpartition, absent", "letters", lambda s: s.rpartition("-"), CPYTHON),
    ("join of letters", lambda n: random.choices(string.ascii_letters, k=n), "".join, CPYTHON),
    ("str.encode, ascii", "letters", lambda s: s.encode("ascii"), CPYTHON),
    ("f-string of each", "numbers", lambda s: [f"{x:>9}" for x in s], CPYTHON),
    ("bytes.lower", "bytes", bytes.lower, CPYTHON),
    ("bytes.splitlines", lambda n: b"ab\n" * (n // 3 + 1), bytes.splitlines, CPYTHON),
    ("memoryview.tobytes", lambda n: memoryview(random.randbytes(n)), memoryview.tobytes, PYDOC,
        CACHE_BOUND),
    ("array.array.count", "doubles", lambda s: s.count(1.0), PYDOC),
    ("array.array.fromlist", "floats", lambda s: array.array("d").fromlist(s), PYDOC),
    ("int ^ int, n bits", "bits bits", lambda s: s[0] ^ s[1], LONG, 10_000_000),
    ("hex of an int, n bits", "bits", hex, LONG),
    ("int.to_bytes, n bits", "bits", lambda a: a.to_bytes(a.bit_length(), "big"), LONG),
    ("base64.b16encode", "bytes", base64.b16encode, "RFC 4648"),
    ("binascii.unhexlify", lambda n: random.randbytes(n).hex(), binascii.unhexlify, PYDOC),
    ("parse.urlencode", "pairs", parse.urlencode, PYDOC),
    ("gzip.decompress", lambda n: gzip.compress(random.randbytes(n)), gzip.decompress, "RFC 1952"),
    ("zlib.compress, stored", "bytes", lambda s: zlib.compress(s, 0), "RFC 1951"),
    ("hashlib.sha384", "bytes", lambda s: hashlib.sha384(s).digest(), "FIPS 180-4"),
    ("hashlib.shake_256", "bytes", lambda s: hashlib.shake_256(s).digest(64), "FIPS 202"),
    ("json.dumps of an object", lambda n: {f"{i:x}": i for i in range(n)}, json.dumps, CPYTHON),
    ("pickle.dumps of words", lambda n: [f"{i:x}" for i in range(n)], pickle.dumps, CPYTHON),
    ("marshal.loads of floats", lambda n: marshal.dumps(floats(n)), marshal.loads, CPYTHON),
    ("plistlib.dumps", lambda n: {f"{i:x}": i for i in range(n)},
        lambda s: plistlib.dumps(s, sort_keys=False), CPYTHON),
    ("ElementTree.tostring", lambda n: ElementTree.fromstring(f"<a>{'<b/>' * n}</a>"),
        ElementTree.tostring, CPYTHON),
    ("ast.literal_eval of a list", lambda n: repr(list(range(n))), ast.literal_eval, CPYTHON),
    ("re.findall of numbers", lambda n: "ab 12 " * (n // 6 + 1), re.compile(r"\d+").findall,
        CPYTHON),
    ("fnmatch.filter", lambda n: [f"{i}.txt" for i in range(n)],
        lambda s: fnmatch.filter(s, "*7.txt"), PYDOC),
    ("textwrap.fill", lambda n: "ab cde " * (n // 7 + 1), textwrap.fill, CPYTHON),
    ("Template.substitute", lambda n: string.Template("$a b " * (n // 5 + 1)),
        lambda s: s.substitute(a="c"), PYDOC),
    ("the next permutation, of the last", lambda n: list(range(n, 0, -1)), by_hand.next_permutation,
        LOOP),
    ("a linked list turned round", by_hand.linked, by_hand.turned, CLRS),
    ("two to a sum, by a set", "floats", by_hand.two_to_a_sum, LOOP),
    ("bits of all up to n", int, by_hand.bits_of_all, LOOP),
    ("two sorted lists merged by hand", "heap heap", by_hand.merged, CLRS),
    ("longest rising part", "floats", by_hand.longest_rise, LOOP),
    ("np.ceil", "uniform", np.ceil, *ONE_PASS),
    ("np.expm1", "uniform", np.expm1, *ONE_PASS),
    ("np.cbrt", "uniform", np.cbrt, *ONE_PASS),
    ("np.power", "uniform", lambda a: np.power(a, 2.5), *ONE_PASS),
    ("np.isfinite", "uniform", np.isfinite, *ONE_PASS),
    ("np.left_shift", "places", lambda a: np.left_shift(a, 3), *ONE_PASS),
    ("np.any", lambda n: np.zeros(n, bool) & True, np.any, NUMPY, 8 * CACHE_BOUND),
    ("np.nanmean", "uniform", np.nanmean, *ONE_PASS),
    ("np.subtract", "uniform uniform", lambda s: np.subtract(*s), *ONE_PASS),
    ("np.fmax of float32", lambda n: uniform(n).astype(np.float32), lambda a: np.fmax(a, a[::-1]),
        *ONE_PASS),
    ("np.append", "uniform", lambda a: np.append(a, 1.0), *ONE_PASS),
    ("every second of an array, copied", "uniform", lambda a: a[::2].copy(), *ONE_PASS),
    ("np.ediff1d", "uniform", np.ediff1d, NUMPY),
    ("np.unwrap", "uniform", np.unwrap, NUMPY),
    ("np.einsum of squares", "uniform", lambda a: np.einsum("i,i->", a, a), *ONE_PASS),
    ("points turned by a matrix", "points", lambda p: p @ np.eye(3), NUMPY),
    ("exponential random numbers", int, lambda n: np.random.default_rng().exponential(size=n),
        NUMPY),
    ("permuted by numpy", "uniform", np.random.default_rng().permutation, NUMPY),
    ("np.bincount, weighted", "uniform", lambda a: np.bincount((a * 50).astype(int), a), NUMPY),
    ("np.nan_to_num", "uniform", np.nan_to_num, *ONE_PASS),
    ("np.angle", lambda n: uniform(n) + 1j, np.angle, NUMPY),
    ("points.mean(axis=0)", "points", lambda p: p.mean(axis=0), NUMPY),
    ("np.convolve with five", "uniform", lambda a: np.convolve(a, np.ones(5)), NUMPY),
    ("scipy.special.digamma", "uniform", special.digamma, SCIPY),
    ("scipy.special.ndtr", "uniform", special.ndtr, *ONE_PASS),
    ("scipy.stats.gmean", "uniform", stats.gmean, SCIPY),
    ("scipy.stats.ttest_ind", "uniform uniform", lambda s: stats.ttest_ind(s[0], s[1]), SCIPY),
    ("scipy.stats.entropy", "uniform", stats.entropy, SCIPY),
    ("ndimage.sobel", "uniform", ndimage.sobel, SCIPY),
    ("ndimage.grey_dilation, 5 wide", "uniform", lambda a: ndimage.grey_dilation(a, (5,)), SCIPY),
    ("ndimage.sum_labels", lambda n: (uniform(n), np.arange(n) % 10),
        lambda s: ndimage.sum_labels(s[0], s[1], np.arange(10)), SCIPY),
    ("scipy.signal.filtfilt", lambda n: uniform(n + 20),
        lambda a: signal.filtfilt([1.0], [1.0, -0.5], a), SCIPY),
    ("scipy.signal.sawtooth", "uniform", signal.sawtooth, SCIPY),
    ("BSpline of ten knots, at n places", "uniform",
        interpolate.BSpline(np.arange(10.0), np.ones(6), 3), SCIPY),
    ("cumulative_simpson", "uniform", lambda a: integrate.cumulative_simpson(a, dx=1.0), SCIPY),
    ("solveh_banded, 2 diagonals", lambda n: (np.vstack([np.ones(n), np.full(n, 4.0)]), uniform(n)),
        lambda s: linalg.solveh_banded(*s), LAPACK),
    ("product of diagonal csr_arrays", lambda n: sparse.diags_array(np.ones(n)).tocsr(),
        lambda a: a @ a, SCIPY),
    ("distance.cosine", "uniform uniform", lambda s: spatial.distance.cosine(s[0], s[1]), SCIPY),
], "O(n log n)": [
    ("scipy.stats.iqr", "uniform", stats.iqr, SCIPY + ": it sorts"),
    ("sorted, pairs by the second", "pairs", lambda s: sorted(s, key=operator.itemgetter(1)), WIKI),
    ("random.choices by weights, n of n", "floats", lambda s: random.choices(s, s, k=len(s)),
        PYDOC + ": it bisects"),
    ("n × heappush, descending", lambda n: list(range(n, 0, -1)), by_hand.pushed, CLRS),
    ("most talks that fit", "pairs", by_hand.most_that_fit, CLRS + ": it sorts"),
    ("every ending of halves added", "floats", by_hand.halves, CLRS + ": as mergesort"),
    ("np.argsort of float32", lambda n: uniform(n).astype(np.float32), np.argsort, SORT),
    ("np.sort of uint64", lambda n: np.random.default_rng().integers(0, 2**60, n).astype(np.uint64),
        np.sort, SORT, CACHE_BOUND),
    ("np.unique, inverse", "uniform", lambda a: np.unique(a, return_inverse=True), BY_SORT),
    ("scipy.stats.mannwhitneyu", "uniform uniform",
        lambda s: stats.mannwhitneyu(s[0], s[1], method="asymptotic"), SCIPY + ": it sorts"),
    ("np.fft.rfft, powers of two", "uniform", np.fft.rfft, NUMPY, *TWOS),
    ("scipy.signal.periodogram, powers of two", "uniform", signal.periodogram, SCIPY, *TWOS),
], "O(n^1.5)": [
    ("divisors of each, below the root of n", int,
        lambda n: sum(1 for i in range(1, n) for d in range(1, math.isqrt(n)) if i % d == 0), LOOP),
], "O(n²)": [
    ("products of all pairs, added", "floats",
        lambda s: sum(itertools.starmap(operator.mul, itertools.combinations(s, 2))), PYDOC),
    ("those not met before, by a list", "numbers", by_hand.not_met, WIKI),
    ("the longest part of two texts", "letters letters", by_hand.longest_part, CLRS),
    ("hull by wrapping a circle", by_hand.on_circle, by_hand.wrapped, CLRS),
    ("np.minimum.outer", "uniform", lambda a: np.minimum.outer(a, a), NUMPY),
    ("np.triu", "matrix", np.triu, NUMPY, SQUARE_BOUND),
    ("matrix.argmax(axis=0)", "matrix", lambda a: a.argmax(axis=0), NUMPY, SQUARE_BOUND),
    ("matrix.T @ vector", "matrix uniform", lambda s: s[0].T @ s[1], LAPACK),
    ("scipy.linalg.circulant", "uniform", linalg.circulant, SCIPY),
    ("convolve2d, 3 by 3", "matrix", lambda a: signal.convolve2d(a, np.ones((3, 3)), "same"),
        SCIPY),
], "O(n² log n)": [
    ("each row's median", "rows", lambda s: list(map(statistics.median, s)), PYDOC + ": it sorts"),
], "O(n³)": [
    ("np.linalg.lstsq", "matrix uniform", lambda s: np.linalg.lstsq(s[0], s[1], rcond=None),
        LAPACK),
    ("scipy.linalg.cho_factor", "symmetric", linalg.cho_factor, LAPACK),
    ("Cholesky by hand", "symmetric", by_hand.cholesky, CLRS),
    ("the best search tree, by a table", "floats", by_hand.best_tree, CLRS),
], "O(2^n)": [
    ("every subset's sum, by a table", floats, by_hand.subset_sums, LOOP),
    ("truth table", int, lambda n: sum(map(all, itertools.product((True, False), repeat=n))),
        PYDOC),
]})
# fmt: on
