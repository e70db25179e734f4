"""Real functions whose cost is known, with the source that tells it: data, to try judges on.

A cost is that of what a call does, the making of its input left out. n is the length of the input
unless the name says otherwise. They were written down before any judge was asked about them; the
judge was tuned on some 1,010 others, which the history of this file has. Whoever changes the judge
for what it says of these writes others.
"""

import array
import base64
import bisect
import collections
import copy
import csv
import datetime
import functools
import hashlib
import ipaddress
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
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple
from xml.dom import minidom

import numpy as np
from scipy import (
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
CPYTHON = "CPython's source: one pass"
LONG = "CPython, Objects/longobject.c"
LOOP = "counted by hand"
NUMPY = "numpy.org/doc: one pass"
VIEWS = "numpy.org/doc: views"
BISECT = "numpy.org/doc: binary search"
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
    "tuple": lambda n: tuple(floats(n)),
    "deque": lambda n: collections.deque(range(n)),
    "set": lambda n: set(range(n)),
    "floats_dict": lambda n: dict(enumerate(floats(n))),
    "pairs": lambda n: list(zip(floats(n), floats(n), strict=True)),
    "rows": lambda n: [floats(n) for _ in range(n)],
    "asked": lambda n: random.choices(range(n), k=KEYS),  # indices below n
    "letters": lambda n: "".join(random.choices(string.ascii_lowercase, k=n)),
    "bytes": random.randbytes,
    "bits": lambda n: random.getrandbits(n) | 1 << (n - 1) | 1,
    "places": np.arange,
    "picked": lambda n: np.array(random.choices(range(n), k=KEYS)),
    "uniform": uniform,
    "points": lambda n: uniform(n, 3),
    "matrix": lambda n: uniform(n, n) + n * np.eye(n),  # far from singular
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
HELD_OUT = functions({"O(1)": [
    ("deque[1], 1,000 times", "deque", times(lambda s: s[1]), WIKI),
    ("item in dict.items(), 1,000 random", lambda n: looked_up(dict.fromkeys(floats(n))),
        each(lambda s, key: (key, None) in s.items()), WIKI),
    ("struct.pack_into, at 1,000 random places", lambda n: (bytearray(n + 8), INPUTS["asked"](n)),
        each(lambda s, i: struct.pack_into("<d", s, i, 1.5)), PYDOC),
    ("array.real, 1,000 views", "uniform", times(lambda a: a.real), VIEWS, CACHE_BOUND),
    ("memoryview[i:i + 8], 1,000 random", lambda n: (memoryview(random.randbytes(n)),
        INPUTS["asked"](n)), each(lambda s, i: s[i:i + 8]), PYDOC),
    ("np.moveaxis, 1,000 views", "matrix", times(lambda a: np.moveaxis(a, 0, 1)), VIEWS,
        SQUARE_BOUND),
    ("array[1,000 random indices] *= 2", "uniform picked", by_hand.doubled_at, *ONE_PASS),
], "O(log n)": [
    ("bisect in lists, 1,000 random", lambda n: looked_up([[x] for x in sorted(floats(n))]),
        each(bisect.bisect), PYDOC),
    ("np.searchsorted in complex numbers, 1,000 random",
        lambda n: (np.sort(uniform(n)) + 0j, uniform(KEYS)), lambda s: s[0].searchsorted(s[1]),
        BISECT),
    ("digits of n, added", int, lambda n: sum(map(int, str(n))), LOOP),
    ("bisect in dates, 1,000 random",
        lambda n: looked_up(list(map(datetime.date.fromordinal, range(1, n + 1)))),
        each(bisect.bisect), PYDOC),
], "O(√n)": [
    ("the diagonal of a square of n numbers", lambda n: INPUTS["rows"](math.isqrt(n)),
        lambda s: sum(row[i] for i, row in enumerate(s)), LOOP),
], "O(n)": [
    ("list.extend of a generator", "floats", lambda s: [].extend(x + 1 for x in s), PYDOC),
    ("tuple[::2]", "tuple", lambda s: s[::2], WIKI),
    ("max(dict.values)", "floats_dict", lambda s: max(s.values()), WIKI),
    ("set of the firsts of pairs", "pairs", lambda s: {a for a, _ in s}, WIKI),
    ("itertools.zip_longest of three", "floats floats floats",
        lambda s: list(itertools.zip_longest(*s)), PYDOC),
    ("math.hypot of each", "floats floats", lambda s: list(map(math.hypot, *s)), PYDOC),
    ("float.hex of each", "floats", lambda s: list(map(float.hex, s)), PYDOC),
    ("int.to_bytes of each", "numbers", lambda s: [x.to_bytes(8, "big") for x in s], PYDOC),
    ("timedelta of each", "numbers", lambda s: list(map(datetime.timedelta, s)), PYDOC),
    ("functools.reduce of max", "floats", lambda s: functools.reduce(max, s), PYDOC),
    ("bin of each", "numbers", lambda s: list(map(bin, s)), PYDOC),
    ("ip_address of each", "numbers", lambda s: list(map(ipaddress.ip_address, s)), PYDOC),
    ("statistics.stdev", "floats", statistics.stdev, PYDOC),
    ("random.triangular, n times", int, lambda n: [random.triangular() for _ in range(n)], PYDOC),
    ("str.isidentifier", "letters", str.isidentifier, CPYTHON),
    ("str.removesuffix", "letters", lambda s: s.removesuffix(s[-3:]), CPYTHON),
    ("str.ljust", int, lambda n: "7".ljust(n), CPYTHON),
    ("str % tuple", "tuple", lambda s: "%.3f " * len(s) % s, CPYTHON),
    ("bytes.strip", lambda n: b" " * n + b"x", bytes.strip, CPYTHON),
    ("bytes.partition, absent", lambda n: b"ab" * n, lambda s: s.partition(b"x"), CPYTHON),
    ("bytearray * 2", lambda n: bytearray(random.randbytes(n)), lambda s: s * 2, CPYTHON),
    ("int - int, n bits", "bits bits", lambda s: s[0] - s[1], LONG, 10_000_000),
    ("oct of an int, n bits", "bits", oct, LONG),
    ("base64.a85decode", lambda n: base64.a85encode(random.randbytes(n)), base64.a85decode, PYDOC),
    ("hashlib.sha3_224", "bytes", lambda s: hashlib.sha3_224(s).digest(), "FIPS 202"),
    ("json.dumps of booleans", lambda n: [i % 3 == 0 for i in range(n)], json.dumps, CPYTHON),
    ("pickle.loads of a dict", lambda n: pickle.dumps(dict(enumerate(floats(n)))), pickle.loads,
        CPYTHON),
    ("minidom.parseString", lambda n: f"<a>{'<b/>' * n}</a>", minidom.parseString, CPYTHON),
    ("csv.reader of quotes", lambda n: ['"a, b",c'] * n, lambda s: list(csv.reader(s)), PYDOC),
    ("re.split with groups", lambda n: "ab, cd;" * (n // 7 + 1), re.compile("([,;])").split,
        CPYTHON),
    ("struct.pack_into", "floats",
        lambda s: struct.pack_into(f"{len(s)}d", bytearray(8 * len(s)), 0, *s), PYDOC),
    ("array.array.frombytes", "bytes", lambda s: array.array("B").frombytes(s), PYDOC),
    ("marshal.dumps of pairs", "pairs", marshal.dumps, CPYTHON),
    ("copy.deepcopy of a dict", "floats_dict", copy.deepcopy, PYDOC),
    ("the best day to buy and to sell", "floats", by_hand.best_gain, LOOP),
    ("depth of nested brackets", lambda n: "(" * (n // 2) + ")" * (n // 2), by_hand.depth, LOOP),
    ("np.trunc", "uniform", np.trunc, *ONE_PASS),
    ("np.arctan", "uniform", np.arctan, *ONE_PASS),
    ("np.exp2", "uniform", np.exp2, *ONE_PASS),
    ("np.deg2rad", "uniform", np.deg2rad, *ONE_PASS),
    ("np.not_equal", "uniform uniform", lambda s: np.not_equal(*s), *ONE_PASS),
    ("np.frexp", "uniform", np.frexp, *ONE_PASS),
    ("np.nanmin", "uniform", np.nanmin, *ONE_PASS),
    ("np.heaviside", "uniform uniform", lambda s: np.heaviside(*s), *ONE_PASS),
    ("np.right_shift", "places", lambda a: np.right_shift(a, 3), *ONE_PASS),
    ("np.conj", lambda n: uniform(n) + 1j, np.conj, NUMPY),
    ("np.nextafter", "uniform uniform", lambda s: np.nextafter(*s), *ONE_PASS),
    ("np.nancumsum", "uniform", np.nancumsum, *ONE_PASS),
    ("np.hstack of three", "uniform uniform uniform", np.hstack, NUMPY),
    ("np.extract", "uniform", lambda a: np.extract(a > 0.5, a), NUMPY),
    ("np.choose of two", "places", lambda a: np.choose(a % 2, [a, -a]), NUMPY),
    ("np.piecewise", "uniform", lambda a: np.piecewise(a, [a < 0.5], [np.sin, np.cos]), NUMPY),
    ("np.histogram2d, ten by ten", "uniform uniform", lambda s: np.histogram2d(*s), NUMPY),
    ("np.linalg.inv of n matrices", lambda n: uniform(n, 2, 2) + 2 * np.eye(2), np.linalg.inv,
        NUMPY),
    ("scipy.special.y0", "uniform", special.y0, SCIPY),
    ("scipy.special.beta", "uniform uniform", lambda s: special.beta(*s), SCIPY),
    ("scipy.special.loggamma", "uniform", special.loggamma, SCIPY),
    ("scipy.stats.norm.pdf", "uniform", stats.norm.pdf, SCIPY),
    ("scipy.stats.sem", "uniform", stats.sem, SCIPY),
    ("scipy.stats.variation", "uniform", stats.variation, SCIPY),
    ("scipy.stats.chisquare", "uniform", stats.chisquare, SCIPY),
    ("scipy.stats.jarque_bera", "uniform", stats.jarque_bera, SCIPY),
    ("ndimage.gaussian_laplace", "uniform", lambda a: ndimage.gaussian_laplace(a, 1.0), SCIPY),
    ("scipy.signal.cspline1d", "uniform", signal.cspline1d, SCIPY),
    ("scipy.signal.square", "uniform", signal.square, SCIPY),
    ("scipy.signal.windows.hann", int, signal.windows.hann, SCIPY),
    ("sparse.kron with a pair", lambda n: sparse.diags_array(np.ones(n)).tocsr(),
        lambda a: sparse.kron(a, np.ones((1, 2))), SCIPY),
    ("distance.canberra", "uniform uniform", lambda s: spatial.distance.canberra(*s), SCIPY),
], "O(n log n)": [
    ("sorted, by two keys", "pairs", lambda s: sorted(s, key=lambda it: (it[1], it[0])), WIKI),
    ("statistics.median_grouped", "floats", statistics.median_grouped, PYDOC + ": it sorts"),
    ("intervals joined", "pairs", by_hand.joined, CLRS + ": it sorts"),
    ("np.argsort, heapsort", "uniform", lambda a: np.argsort(a, kind="heapsort"), SORT),
    ("np.unique of int64", lambda n: np.random.default_rng().integers(0, 2**60, n), np.unique,
        BY_SORT),
    ("np.intersect1d of float32", lambda n: uniform(n).astype(np.float32),
        lambda a: np.intersect1d(a, a[::-1]), BY_SORT),
    ("scipy.stats.ecdf", "uniform", stats.ecdf, SCIPY + ": it sorts"),
    ("scipy.stats.wilcoxon", "uniform uniform",
        lambda s: stats.wilcoxon(s[0], s[1], method="approx"), SCIPY + ": it sorts"),
    ("np.fft.ihfft, powers of two", "uniform", np.fft.ihfft, NUMPY, *TWOS),
], "O(n^1.5)": [
    ("sums of every root n-th value, from each on", "numbers",
        lambda s: [sum(s[i::math.isqrt(len(s))]) for i in range(len(s))], LOOP),
], "O(n²)": [
    ("itertools.permutations, pairs", "numbers",
        lambda s: sum(1 for _ in itertools.permutations(s, 2)), PYDOC),
    ("cocktail sort, reversed", lambda n: list(range(n, 0, -1)), by_hand.cocktail_sort, LOOP),
    ("np.fliplr, copied", "matrix", lambda a: np.fliplr(a).copy(), NUMPY, SQUARE_BOUND),
    ("np.tri", int, np.tri, NUMPY, SQUARE_BOUND),
    ("scipy.linalg.hilbert", int, linalg.hilbert, SCIPY, SQUARE_BOUND),
    ("matrix.clip", "matrix", lambda a: a.clip(0, 1), NUMPY, SQUARE_BOUND),
    ("cdist, squares", "points", lambda p: spatial.distance.cdist(p, p, "sqeuclidean"), SCIPY),
], "O(n² log n)": [
    ("np.argsort of each row", "matrix", lambda a: np.argsort(a, axis=1), SORT),
], "O(n³)": [
    ("np.linalg.pinv", "matrix", np.linalg.pinv, LAPACK),
    ("np.linalg.matrix_power, cubed", "matrix", lambda a: np.linalg.matrix_power(a, 3), LAPACK),
    ("determinant by hand", "matrix", by_hand.determinant, CLRS),
], "O(2^n)": [
    ("numbers below 2^n, added", int, lambda n: sum(range(1 << n)), LOOP),
]})
# fmt: on
