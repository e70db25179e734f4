"""Real functions of known cost that no judge was made on: data, as in `functions`.

They were written down before any judge was asked about them. Whoever changes the judge for what it
says of them makes them functions that it was tuned on, and writes others.
"""

import base64
import binascii
import bisect
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
from itertools import starmap
from operator import getitem

import numpy as np
from scipy import fft, ndimage, signal, special, stats

from experiments.validation import by_hand
from experiments.validation.functions import (
    BISECT,
    BY_SORT,
    CACHE_BOUND,
    CLRS,
    CPYTHON,
    INPUTS,
    KEYS,
    LAPACK,
    LONG,
    LOOP,
    NUMPY,
    ONE_PASS,
    PYDOC,
    SCIPY,
    SORT,
    SQUARE_BOUND,
    TWOS,
    VIEWS,
    WIKI,
    Function,
    each,
    floats,
    function,
    times,
    uniform,
)

# fmt: off
HELD_OUT: tuple[Function, ...] = tuple(starmap(function, [
    ("list slice of ten, 1,000 times", "O(1)", "floats", times(lambda s: s[3:13]), WIKI),
    ("dict.popitem and back, 1,000 times", "O(1)", "dict",
        times(lambda s: s.__setitem__(*s.popitem())), WIKI),
    ("absent in set, 1,000 times", "O(1)", "floats_set", times(lambda s: -1.0 in s), WIKI),
    ("deque[-1], 1,000 times", "O(1)", "deque", times(lambda s: s[-1]), WIKI),
    ("array.size, 1,000 times", "O(1)", "uniform", times(lambda a: a.size), NUMPY),
    ("matrix[i], 1,000 rows as views", "O(1)", "matrix asked", each(getitem), VIEWS, SQUARE_BOUND),
    ("memoryview[i], 1,000 random", "O(1)", lambda n: (memoryview(bytes(n)), INPUTS["asked"](n)),
        each(getitem), PYDOC, CACHE_BOUND),
    ("np.take of float32, 1,000 random", "O(1)",
        lambda n: (np.zeros(n, np.float32), INPUTS["picked"](n)), lambda s: np.take(*s), *ONE_PASS),
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
    ("scipy.fft.irfft, powers of two", "O(n log n)", "uniform", fft.irfft, SCIPY, *TWOS),
    ("all pairs of a list", "O(n²)", "floats", lambda s: sum(a < b for a in s for b in s), LOOP),
    ("Floyd's triangle", "O(n²)", int, by_hand.triangle, LOOP),
    ("np.add.outer", "O(n²)", "uniform", lambda a: np.add.outer(a, a), NUMPY),
    ("matrix.max(axis=1)", "O(n²)", "matrix", lambda a: a.max(axis=1), NUMPY, SQUARE_BOUND),
    ("vector @ matrix", "O(n²)", "uniform matrix", lambda s: s[0] @ s[1], LAPACK),
    ("np.linalg.det", "O(n³)", "matrix", np.linalg.det, LAPACK),
    ("three nested ranges", "O(n³)", int,
        lambda n: sum(1 for a in range(n) for b in range(n) for c in range(n)), LOOP),
    ("all bit strings", "O(2^n)", int, by_hand.bit_strings, CLRS),
]))
# fmt: on
