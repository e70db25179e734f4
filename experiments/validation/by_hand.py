"""Functions of known cost that no library has: written as textbooks do, to try judges on."""

import cmath
import collections
import heapq
import itertools
import math
import operator
import random
from typing import Any

import numpy as np


def with_order(it: Any) -> tuple[Any, Any]:
    return it, it.argsort()


def root_of(parents: list[int], item: int) -> int:
    while parents[item] != item:
        item = parents[item]
    return item


def fibonacci(n: int) -> int:
    one, two = 0, 1
    for bit in f"{n:b}":
        one, two = one * (2 * two - one) % 1_000_003, (one * one + two * two) % 1_000_003
        if bit == "1":
            one, two = two, (one + two) % 1_000_003
    return one


def whole_root(n: int) -> int:
    low, high = 0, n + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if middle * middle <= n else (low, middle)
    return low


def discrete_logarithm(n: int) -> int:
    """Of 7 to the power of n - 1, modulo a prime whose every remainder is a power of 7."""
    prime, step = (1 << 31) - 1, math.isqrt(n) + 1
    sought, small, power = pow(7, n - 1, prime), dict[int, int](), 1
    for k in range(step):
        small[power] = k
        power = power * 7 % prime
    giant = pow(power, -1, prime)
    for k in range(step):
        if sought in small:
            return k * step + small[sought]
        sought = sought * giant % prime
    return -1


def grouped(it: list[int]) -> dict[int, list[int]]:
    groups = collections.defaultdict(list)
    for value in it:
        groups[value % 10].append(value)
    return groups


def primes(n: int) -> list[int]:
    least, found = [0] * (n + 1), list[int]()
    for i in range(2, n + 1):
        if not least[i]:
            least[i] = i
            found.append(i)
        for p in found:
            if p > least[i] or p * i > n:
                break
            least[p * i] = p
    return found


def longest_palindrome(text: str) -> int:
    padded = f"^{'|'.join(f' {text} ')}$"
    reach, center, right = [0] * len(padded), 0, 0
    for i in range(1, len(padded) - 1):
        if i < right:
            reach[i] = min(right - i, reach[2 * center - i])
        while padded[i + reach[i] + 1] == padded[i - reach[i] - 1]:
            reach[i] += 1
        if i + reach[i] > right:
            center, right = i, i + reach[i]
    return max(reach)


def postfix(tokens: list[Any]) -> int:
    stack: list[int] = []
    for token in tokens:
        stack.append(stack.pop() + stack.pop() if token == "+" else token)
    return stack[0]


def radix_sort(it: list[int]) -> list[int]:
    for shift in (0, 8):
        buckets: list[list[int]] = [[] for _ in range(256)]
        for value in it:
            buckets[value >> shift & 255].append(value)
        it = [value for bucket in buckets for value in bucket]
    return it


def smaller_behind(order: list[int]) -> int:
    tree, total = [0] * (len(order) + 1), 0
    for value in reversed(order):
        at = value
        while at:
            total += tree[at]
            at &= at - 1
        at = value + 1
        while at < len(tree):
            tree[at] += 1
            at += at & -at
    return total


def most_at_a_time(intervals: list[tuple[float, float]]) -> int:
    ends = [(min(it), 1) for it in intervals] + [(max(it), -1) for it in intervals]
    most = now = 0
    for _, change in sorted(ends):
        now += change
        most = max(most, now)
    return most


def fourier(values: list[complex]) -> list[complex]:
    if len(values) < 2:
        return values
    even, odd = fourier(values[::2]), fourier(values[1::2])
    turn = -2j * math.pi / len(values)
    turned = [cmath.exp(turn * k) * value for k, value in enumerate(odd)]
    sums = [a + b for a, b in zip(even, turned, strict=True)]
    return sums + [a - b for a, b in zip(even, turned, strict=True)]


def palindromes(text: str) -> int:
    found, n = 0, len(text)
    for center in range(n):
        for low, high in ((center, center), (center, center + 1)):
            while low >= 0 and high < n and text[low] == text[high]:
                found, low, high = found + 1, low - 1, high + 1
    return found


def best_cuts(prices: list[float]) -> float:
    best = [0.0]
    for n in range(1, len(prices) + 1):
        best.append(max(prices[k - 1] + best[n - k] for k in range(1, n + 1)))
    return best[-1]


def least_tree(rows: list[list[float]]) -> float:
    n, total, at = len(rows), 0.0, 0
    distance, outside = [math.inf] * n, set(range(1, n))
    while outside:
        for other in outside:
            distance[other] = min(distance[other], rows[at][other])
        at = min(outside, key=distance.__getitem__)
        outside.remove(at)
        total += distance[at]
    return total


def all_distances(rows: list[list[float]]) -> None:
    for k, through in enumerate(rows):
        for row in rows:
            first = row[k]
            for j, second in enumerate(through):
                row[j] = min(row[j], first + second)


def tried(weights: list[float]) -> int:
    def count(k: int, total: float) -> int:
        if k == len(weights):
            return total < 1
        return count(k + 1, total) + count(k + 1, total + weights[k])

    return count(0, 0.0)


def bit_counts(n: int) -> list[int]:
    counts = [0] * (1 << n)
    for mask in range(1, 1 << n):
        counts[mask] = counts[mask >> 1] + (mask & 1)
    return counts


def seconds(n: int) -> tuple[Any, Any]:
    all_of = np.arange(n).astype("datetime64[s]")
    return all_of, np.random.default_rng().choice(all_of, 1_000)


def sums_in_a_tree(n: int) -> list[int]:
    tree = [0] * n + [1] * n
    for k in range(n - 1, 0, -1):
        tree[k] = tree[2 * k] + tree[2 * k + 1]
    return tree


def sum_from(tree: list[int], place: int) -> int:
    low, high, total = place + len(tree) // 2, len(tree), 0
    while low < high:
        if low % 2:
            total, low = total + tree[low], low + 1
        if high % 2:
            high -= 1
            total += tree[high]
        low, high = low // 2, high // 2
    return total


def turned_at(it: list[int]) -> int:
    low, high = 0, len(it) - 1
    while low < high:
        middle = (low + high) // 2
        low, high = (middle + 1, high) if it[middle] > it[-1] else (low, middle)
    return low


def next_permutation(it: list[int]) -> None:
    k = len(it) - 1
    while k > 0 and it[k - 1] >= it[k]:
        k -= 1
    it[k:] = it[k:][::-1]


def linked(n: int) -> list[Any]:
    first: list[Any] = []
    for value in range(n):
        first = [value, first]
    return first


def turned(first: list[Any]) -> list[Any]:
    before: list[Any] = []
    while first:
        first[1], before, first = before, first, first[1]
    return before


def two_to_a_sum(it: list[float]) -> bool:
    met = set[float]()
    for value in it:
        if 3.0 - value in met:
            return True
        met.add(value)
    return False


def bits_of_all(n: int) -> list[int]:
    counts = [0]
    for k in range(1, n + 1):
        counts.append(counts[k // 2] + k % 2)
    return counts


def merged(lists: tuple[list[float], list[float]]) -> list[float]:
    (one, other), i, j, found = lists, 0, 0, []
    while i < len(one) and j < len(other):
        if one[i] <= other[j]:
            found.append(one[i])
            i += 1
        else:
            found.append(other[j])
            j += 1
    return found + one[i:] + other[j:]


def longest_rise(it: list[float]) -> int:
    longest = now = 1
    for before, value in itertools.pairwise(it):
        now = now + 1 if value > before else 1
        longest = max(longest, now)
    return longest


def pushed(it: list[int]) -> list[int]:
    heap: list[int] = []
    for value in it:
        heapq.heappush(heap, value)
    return heap


def most_that_fit(pairs: list[tuple[float, float]]) -> int:
    count, end = 0, -math.inf
    for last, first in sorted((max(it), min(it)) for it in pairs):
        if first >= end:
            count, end = count + 1, last
    return count


def halves(it: list[float]) -> float:
    if len(it) < 2:
        return sum(it)
    middle = len(it) // 2
    return sum(it) + halves(it[:middle]) + halves(it[middle:])


def not_met(it: list[int]) -> list[int]:
    met: list[int] = []
    for value in it:
        if value not in met:
            met.append(value)
    return met


def longest_part(texts: tuple[str, str]) -> int:
    one, other = texts
    longest, row = 0, [0] * (len(other) + 1)
    for a in one:
        row = [0, *(before + 1 if a == b else 0 for before, b in zip(row, other, strict=False))]
        longest = max(longest, *row)
    return longest


def on_circle(n: int) -> list[complex]:
    return [cmath.exp(2j * math.pi * random.random()) for _ in range(n)]


def wrapped(points: list[complex]) -> int:
    first = at = min(points, key=lambda p: p.real)
    for count in range(1, len(points) + 1):
        best = points[0] if points[0] != at else points[1]
        for point in points:
            if ((best - at).conjugate() * (point - at)).imag < 0:
                best = point
        at = best
        if at == first:
            return count
    return len(points)


def cholesky(matrix: Any) -> list[list[float]]:
    rows: list[list[float]] = matrix.tolist()
    for i, row in enumerate(rows):
        for j, other in enumerate(rows[: i + 1]):
            rest = row[j] - sum(map(operator.mul, row[:j], other[:j]))
            row[j] = math.sqrt(rest) if i == j else rest / other[j]
    return rows


def best_tree(weights: list[float]) -> float:
    n = len(weights)
    cost = [[0.0] * (n + 1) for _ in range(n + 1)]
    for size in range(1, n + 1):
        for first in range(n - size + 1):
            end = first + size
            least = min(cost[first][k] + cost[k + 1][end] for k in range(first, end))
            cost[first][end] = least + sum(weights[first:end])
    return cost[0][n]


def subset_sums(weights: list[float]) -> list[float]:
    sums = [0.0]
    for weight in weights:
        sums += [it + weight for it in sums]
    return sums
