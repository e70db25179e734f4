"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. The judge was tuned on these, and on some 580 that are no longer
kept. How good it is others tell, those of `held_out`, which were written down before any judge was
asked about them. What is decided by their answers makes them functions to tune on, and asks for
others.
"""

import array
import base64
import binascii
import bisect
import collections
import copy
import functools
import hashlib
import heapq
import itertools
import json
import marshal
import math
import operator
import pickle
import random
import re
import statistics
import string
import struct
import textwrap
from collections.abc import Callable
from itertools import starmap
from operator import getitem
from typing import Any, NamedTuple
from urllib import parse

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
    ("list[n // 2], 1,000 times", "O(1)", "floats", times(lambda s: s[len(s) // 2]), WIKI),
    ("tuple[1:5], 1,000 times", "O(1)", "tuple", times(lambda s: s[1:5]), WIKI),
    ("dict.keys, 1,000 views", "O(1)", "floats_dict", times(dict.keys), PYDOC),
    ("set.pop and add, 1,000 times", "O(1)", "set", times(lambda s: s.add(s.pop())), WIKI),
    ("str[-3:], 1,000 times", "O(1)", "letters", times(lambda s: s[-3:]), WIKI),
    ("range[i], 1,000 random", "O(1)", lambda n: (range(n), INPUTS["asked"](n)), each(getitem),
        CPYTHON + " of arithmetic"),
    ("array.append and pop, 1,000 times", "O(1)", "doubles",
        times(lambda s: (s.append(1.5), s.pop())), PYDOC),
    ("matrix.transpose, 1,000 views", "O(1)", "matrix", times(np.ndarray.transpose), VIEWS,
        SQUARE_BOUND),
    ("array.view, 1,000 times", "O(1)", "uniform", times(lambda a: a.view(np.int64)), VIEWS,
        CACHE_BOUND),
    ("array[1,000 random indices] = 0", "O(1)", "uniform picked",
        lambda s: s[0].__setitem__(s[1], 0), *ONE_PASS),
    ("Counter[key], 1,000 random", "O(1)", lambda n: looked_up(collections.Counter(floats(n))),
        each(getitem), PYDOC),
    ("insort at the end and pop, 1,000 times", "O(log n)", "heap",
        times(lambda s: (bisect.insort(s, 2.0), s.pop())), PYDOC),
    ("bisect in pairs, 1,000 random", "O(log n)", lambda n: looked_up(sorted(INPUTS["pairs"](n))),
        each(bisect.bisect), PYDOC),
    ("np.searchsorted by a sorter, 1,000 random", "O(log n)",
        lambda n: (*by_hand.with_order(uniform(n)), uniform(KEYS)),
        lambda s: s[0].searchsorted(s[2], sorter=s[1]), BISECT),
    ("union by size, 1,000 random roots", "O(log n)",
        lambda n: ([i & (i - 1) for i in range(n)], INPUTS["asked"](n)), each(by_hand.root_of),
        CLRS + ": a binomial tree"),
    ("Fibonacci by doubling, modulo", "O(log n)", int, by_hand.fibonacci, LOOP),
    ("whole root by halving", "O(log n)", int, by_hand.whole_root, LOOP),
    ("sum of divisors to the root", "O(√n)", int,
        lambda n: sum(i for i in range(1, math.isqrt(n) + 1) if n % i == 0), LOOP),
    ("baby steps and giant steps", "O(√n)", int, by_hand.discrete_logarithm,
        "Shanks, Class number, a theory of factorization, and genera"),
    ("list of a range", "O(n)", range, list, PYDOC),
    ("list.sort, two runs", "O(n)", lambda n: [*range(n // 2), *range(n)], list.sort, TIMSORT),
    ("del list[0]", "O(n)", "floats", lambda s: s.__delitem__(0), WIKI),
    ("absent in tuple", "O(n)", "tuple", lambda s: 2.0 in s, WIKI),
    ("list += list", "O(n)", "floats floats", lambda s: s[0].__iadd__(s[1]), WIKI),
    ("all of a list", "O(n)", lambda n: [True] * n, all, PYDOC),
    ("list of a set", "O(n)", "floats_set", list, WIKI),
    ("tuple of a generator", "O(n)", "floats", lambda s: tuple(x + 1 for x in s), PYDOC),
    ("list of every third", "O(n)", "floats", lambda s: s[::3], WIKI),
    ("set of a comprehension", "O(n)", "few", lambda s: {x * 2 for x in s}, WIKI),
    ("dict turned round", "O(n)", "floats_dict", lambda s: {b: a for a, b in s.items()}, WIKI),
    ("lists by a key, in a defaultdict", "O(n)", "few", by_hand.grouped, PYDOC),
    ("Counter.total", "O(n)", lambda n: collections.Counter(range(n)), collections.Counter.total,
        PYDOC),
    ("deque.extendleft", "O(n)", "floats", lambda s: collections.deque().extendleft(s), PYDOC),
    ("deque.copy", "O(n)", "deque", collections.deque.copy, PYDOC),
    ("deque.index, the last", "O(n)", "deque", lambda s: s.index(len(s) - 1), PYDOC),
    ("itertools.dropwhile", "O(n)", "floats",
        lambda s: list(itertools.dropwhile(lambda x: x < 2, s)), PYDOC),
    ("itertools.filterfalse", "O(n)", "numbers",
        lambda s: list(itertools.filterfalse(lambda x: x % 3, s)), PYDOC),
    ("itertools.accumulate, the largest", "O(n)", "floats",
        lambda s: list(itertools.accumulate(s, max)), PYDOC),
    ("itertools.chain of tens", "O(n)", lambda n: [range(10)] * (n // 10 + 1),
        lambda s: list(itertools.chain.from_iterable(s)), PYDOC),
    ("functools.cache, n new", "O(n)", int,
        lambda n: list(map(functools.cache(float), range(n))), PYDOC),
    ("itemgetter of each", "O(n)", "pairs", lambda s: list(map(operator.itemgetter(1), s)), PYDOC),
    ("pairs turned into columns", "O(n)", "pairs", lambda s: list(zip(*s, strict=True)), PYDOC),
    ("heapq.nlargest(10)", "O(n)", "floats", lambda s: heapq.nlargest(10, s), PYDOC),
    ("divmod of each by 7", "O(n)", "numbers", lambda s: [divmod(x, 7) for x in s], PYDOC),
    ("statistics.geometric_mean", "O(n)", "floats", statistics.geometric_mean, PYDOC),
    ("statistics.covariance", "O(n)", "floats floats", lambda s: statistics.covariance(*s), PYDOC),
    ("random.random, n times", "O(n)", int, lambda n: [random.random() for _ in range(n)], PYDOC),
    ("random.randbytes", "O(n)", int, random.randbytes, PYDOC),
    ("copy.copy of a list", "O(n)", "floats", copy.copy, PYDOC),
    ("repr of a list", "O(n)", "numbers", repr, CPYTHON),
    ("float of each word", "O(n)", lambda n: [f"{i / 7}" for i in range(n)],
        lambda s: list(map(float, s)), PYDOC),
    ("ord of each", "O(n)", "letters", lambda s: [ord(c) for c in s], PYDOC),
    ("str.partition, absent", "O(n)", "letters", lambda s: s.partition("-"), CPYTHON),
    ("str.zfill", "O(n)", int, lambda n: "7".zfill(n), CPYTHON),
    ("str.capitalize", "O(n)", "letters", str.capitalize, CPYTHON),
    ("str.isalnum", "O(n)", "letters", str.isalnum, CPYTHON),
    ("str.removeprefix", "O(n)", "letters", lambda s: s.removeprefix(s[:3]), CPYTHON),
    ("string.capwords", "O(n)", lambda n: "ab cd " * (n // 6 + 1), string.capwords, PYDOC),
    ("textwrap.indent", "O(n)", lambda n: "ab\n" * (n // 3 + 1),
        lambda s: textwrap.indent(s, "  "), PYDOC),
    ("str.encode, utf-16", "O(n)", "letters", lambda s: s.encode("utf-16"), CPYTHON),
    ("bytes.decode, latin-1", "O(n)", "bytes", lambda s: s.decode("latin-1"), CPYTHON),
    ("bytes.find, absent", "O(n)", lambda n: b"ab" * n, lambda s: s.find(b"x"), CPYTHON),
    ("bytes.join", "O(n)", lambda n: [b"ab"] * n, b",".join, CPYTHON),
    ("bytearray.extend", "O(n)", "bytes bytes", lambda s: bytearray(s[0]).extend(s[1]), CPYTHON),
    ("memoryview.tolist", "O(n)", lambda n: memoryview(random.randbytes(n)), memoryview.tolist,
        PYDOC),
    ("int.from_bytes", "O(n)", "bytes", lambda s: int.from_bytes(s, "little"), LONG),
    ("int >> 3, n bits", "O(n)", "bits", lambda a: a >> 3, LONG, 10_000_000),
    ("base64.a85encode", "O(n)", "bytes", base64.a85encode, PYDOC),
    ("binascii.b2a_qp", "O(n)", "letters", lambda s: binascii.b2a_qp(s.encode()), "RFC 2045"),
    ("parse.unquote", "O(n)", lambda n: "a%20b" * (n // 5 + 1), parse.unquote, PYDOC),
    ("hashlib.sha224", "O(n)", "bytes", lambda s: hashlib.sha224(s).digest(), "FIPS 180-4"),
    ("hashlib.blake2s", "O(n)", "bytes", lambda s: hashlib.blake2s(s).digest(), "RFC 7693"),
    ("json.dumps, indented", "O(n)", "numbers", lambda s: json.dumps(s, indent=1), CPYTHON),
    ("json.loads of lists", "O(n)", lambda n: json.dumps([[i, i] for i in range(n)]), json.loads,
        CPYTHON),
    ("pickle.loads of words", "O(n)", lambda n: pickle.dumps([f"{i:x}" for i in range(n)]),
        pickle.loads, CPYTHON),
    ("marshal.dumps of words", "O(n)", lambda n: [f"{i:x}" for i in range(n)], marshal.dumps,
        CPYTHON),
    ("struct.iter_unpack", "O(n)", lambda n: random.randbytes(16 * n),
        lambda s: list(struct.iter_unpack("<qi4x", s)), PYDOC),
    ("array.array.byteswap", "O(n)", "doubles", array.array.byteswap, PYDOC, CACHE_BOUND),
    ("re.sub by a function", "O(n)", lambda n: "ab 12 " * (n // 6 + 1),
        lambda s: re.sub(r"\d+", lambda m: m[0][::-1], s), CPYTHON),
    ("re.fullmatch of alternatives", "O(n)", lambda n: "ab" * n, re.compile("(?:ab|cd)*").fullmatch,
        CPYTHON),
    ("linear sieve of primes", "O(n)", int, by_hand.primes,
        "Gries and Misra, A linear sieve algorithm for finding prime numbers"),
    ("longest palindrome", "O(n)", lambda n: "ab" * (n // 2 + 1), by_hand.longest_palindrome,
        "Manacher, A New Linear-Time On-Line Algorithm"),
    ("the last of n in a ring", "O(n)", int,
        lambda n: functools.reduce(lambda at, k: (at + 7) % k, range(2, n + 1), 0),
        LOOP + ": Josephus"),
    ("postfix expression", "O(n)", lambda n: [1, *[2, "+"] * n], by_hand.postfix,
        CLRS + ": a stack"),
    ("radix sort by hand", "O(n)", lambda n: random.choices(range(1 << 16), k=n),
        by_hand.radix_sort, CLRS),
    ("np.sign", "O(n)", "uniform", np.sign, *ONE_PASS),
    ("np.log1p", "O(n)", "uniform", np.log1p, *ONE_PASS),
    ("np.arctan2", "O(n)", "uniform uniform", lambda s: np.arctan2(*s), *ONE_PASS),
    ("np.greater", "O(n)", "uniform uniform", lambda s: np.greater(*s), *ONE_PASS),
    ("np.bitwise_xor", "O(n)", "places places", lambda s: np.bitwise_xor(*s), *ONE_PASS),
    ("np.all", "O(n)", lambda n: np.ones(n, bool), np.all, NUMPY, 8 * CACHE_BOUND),
    ("np.argmin", "O(n)", "uniform", np.argmin, *ONE_PASS),
    ("np.ptp", "O(n)", "uniform", np.ptp, *ONE_PASS),
    ("np.divide of float32", "O(n)", lambda n: uniform(n).astype(np.float32) + 1,
        lambda a: np.divide(1, a), *ONE_PASS),
    ("np.compress", "O(n)", lambda n: (np.arange(n) % 2 == 0, uniform(n)),
        lambda s: np.compress(*s), *ONE_PASS),
    ("np.insert, one", "O(n)", "uniform", lambda a: np.insert(a, len(a) // 2, 0), NUMPY),
    ("np.fromiter", "O(n)", "floats", lambda s: np.fromiter(s, float), NUMPY),
    ("np.arange", "O(n)", int, lambda n: np.arange(n, dtype=float), *ONE_PASS),
    ("np.nanmax", "O(n)", "uniform", np.nanmax, *ONE_PASS),
    ("np.vdot", "O(n)", "uniform uniform", lambda s: np.vdot(*s), *ONE_PASS),
    ("np.linalg.norm of each point", "O(n)", "points", lambda p: np.linalg.norm(p, axis=1), NUMPY),
    ("n products of 3 by 3", "O(n)", lambda n: uniform(n, 3, 3), lambda a: a @ a, NUMPY),
    ("uniform random numbers", "O(n)", int, np.random.default_rng().random, *ONE_PASS),
    ("np.unravel_index", "O(n)", "places", lambda a: np.unravel_index(a, (len(a), 1)), NUMPY),
    ("np.isclose", "O(n)", "uniform uniform", lambda s: np.isclose(*s), NUMPY),
    ("scipy.special.erfc", "O(n)", "uniform", special.erfc, *ONE_PASS),
    ("scipy.special.logsumexp", "O(n)", "uniform", special.logsumexp, SCIPY),
    ("scipy.stats.kurtosis", "O(n)", "uniform", stats.kurtosis, SCIPY),
    ("scipy.stats.trim_mean", "O(n)", "uniform", lambda a: stats.trim_mean(a, 0.1), PARTITION),
    ("scipy.signal.medfilt, 5 wide", "O(n)", "uniform", lambda a: signal.medfilt(a, 5), SCIPY),
    ("scipy.signal.welch", "O(n)", "uniform",
        lambda a: signal.welch(a, nperseg=min(len(a), 64)), SCIPY + ": parts of one length"),
    ("ndimage.binary_erosion, of a row", "O(n)", lambda n: uniform(n) > 0.2,
        ndimage.binary_erosion, SCIPY),
    ("ndimage.map_coordinates, linear", "O(n)", lambda n: (uniform(n), uniform(1, n) * (n - 1)),
        lambda s: ndimage.map_coordinates(s[0], s[1], order=1), SCIPY),
    ("Akima1DInterpolator", "O(n)", "places uniform",
        lambda s: interpolate.Akima1DInterpolator(*s), SCIPY),
    ("scipy.integrate.trapezoid", "O(n)", "uniform", integrate.trapezoid, SCIPY),
    ("csc_array of a diagonal csr_array", "O(n)", lambda n: sparse.diags_array(np.ones(n)).tocsr(),
        lambda a: a.tocsc(), SCIPY),
    ("csgraph.depth_first_order, of a path", "O(n)",
        lambda n: sparse.diags_array(np.ones(n - 1), offsets=1).tocsr(),
        lambda a: sparse.csgraph.depth_first_order(a, 0), GRAPH),
    ("list.sort, reversed", "O(n log n)", "floats", lambda s: s.sort(reverse=True), WIKI),
    ("Counter.most_common", "O(n log n)", lambda n: collections.Counter(dict(enumerate(floats(n)))),
        collections.Counter.most_common, PYDOC + ": it sorts"),
    ("statistics.median_high", "O(n log n)", "floats", statistics.median_high,
        PYDOC + ": it sorts"),
    ("smaller to the right, in a Fenwick tree", "O(n log n)",
        lambda n: random.sample(range(n), n), by_hand.smaller_behind, CLRS),
    ("most intervals at a time", "O(n log n)", "pairs", by_hand.most_at_a_time,
        CLRS + ": it sorts"),
    ("np.sort of int64", "O(n log n)", lambda n: np.random.default_rng().integers(0, 2**60, n),
        np.sort, SORT, CACHE_BOUND),
    ("np.setxor1d", "O(n log n)", "uniform uniform", lambda s: np.setxor1d(*s), BY_SORT),
    ("scipy.stats.ks_2samp", "O(n log n)", "uniform uniform",
        lambda s: stats.ks_2samp(s[0], s[1], method="asymp"), SCIPY + ": it sorts"),
    ("scipy.stats.energy_distance", "O(n log n)", "uniform uniform",
        lambda s: stats.energy_distance(*s), SCIPY + ": it sorts"),
    ("np.fft.ifft, powers of two", "O(n log n)", "uniform", np.fft.ifft, NUMPY, *TWOS),
    ("scipy.fft.idct, powers of two", "O(n log n)", "uniform", fft.idct, SCIPY, *TWOS),
    ("Fourier transform by hand, powers of two", "O(n log n)",
        lambda n: [1 + 2j] * (1 << (n - 1).bit_length()), by_hand.fourier, CLRS, *TWOS),
    ("roots of all to n, by steps", "O(n^1.5)", int,
        lambda n: sum(1 for i in range(n) for _ in range(math.isqrt(i))), LOOP),
    ("list.count of each", "O(n²)", "numbers", lambda s: [s.count(x) for x in s], WIKI),
    ("palindromes from every center", "O(n²)", lambda n: "a" * n, by_hand.palindromes, LOOP),
    ("cutting a rod", "O(n²)", "floats", by_hand.best_cuts, CLRS),
    ("rows turned into columns", "O(n²)", "rows", lambda s: list(zip(*s, strict=True)), PYDOC),
    ("nearest neighbors grown to a tree", "O(n²)", "rows", by_hand.least_tree, CLRS + ": Prim"),
    ("np.equal.outer", "O(n²)", "places", lambda a: np.equal.outer(a, a), NUMPY),
    ("np.diag of a vector", "O(n²)", "uniform", lambda a: np.diag(a) + 1, NUMPY),
    ("matrix.cumsum(axis=1)", "O(n²)", "matrix", lambda a: a.cumsum(axis=1), NUMPY, SQUARE_BOUND),
    ("matrix.sum()", "O(n²)", "matrix", np.sum, NUMPY, SQUARE_BOUND),
    ("np.poly of roots", "O(n²)", "uniform", np.poly, "numpy.org/doc: by convolutions"),
    ("cdist, chebyshev", "O(n²)", "points", lambda p: spatial.distance.cdist(p, p, "chebyshev"),
        SCIPY),
    ("ndimage.uniform_filter of a matrix", "O(n²)", "matrix",
        lambda a: ndimage.uniform_filter(a, 5), SCIPY),
    ("each row sorted", "O(n² log n)", "rows", lambda s: list(map(sorted, s)), WIKI),
    ("np.sort of each row", "O(n² log n)", "matrix", lambda a: np.sort(a, axis=1), SORT),
    ("scipy.linalg.solve", "O(n³)", "matrix uniform", lambda s: linalg.solve(*s), LAPACK),
    ("np.cov of n variables", "O(n³)", "matrix", np.cov, NUMPY + " of products"),
    ("Floyd and Warshall by hand", "O(n³)", "rows", by_hand.all_distances, CLRS),
    ("three to a sum", "O(n³)", "floats",
        lambda s: sum(a + b + c < 1 for a in s for b in s for c in s), LOOP),
    ("sums to a target, by trying all", "O(2^n)", floats, by_hand.tried, CLRS),
    ("bits of every mask, by a table", "O(2^n)", int, by_hand.bit_counts, LOOP),
]))
# fmt: on
