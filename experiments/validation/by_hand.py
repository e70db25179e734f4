"""Functions of known cost that no library has: written as textbooks do, to try judges on."""

import cmath
import collections
import heapq
import math
import random
from typing import Any


def push_and_pop(heap: list[float]) -> None:
    heapq.heappush(heap, -1.0)
    heapq.heappop(heap)


def compared(one: float, other: float) -> int:
    return (one > other) - (one < other)


def balanced_tree(low: int, high: int) -> Any:
    """A node is its lower branch, its key and its higher branch."""
    middle = (low + high) // 2
    if low >= high:
        return None
    return balanced_tree(low, middle), middle, balanced_tree(middle + 1, high)


def find_in_tree(tree: Any, key: int) -> None:
    while tree and tree[1] != key:
        tree = tree[2] if key > tree[1] else tree[0]


def place_of_rank(tree: list[int], rank: int) -> int:
    place, step = 0, 1 << (len(tree) - 1).bit_length()
    while step:
        if place + step < len(tree) and tree[place + step] <= rank:
            place += step
            rank -= tree[place]
        step //= 2
    return place


def doubled(n: int) -> int:
    total, addend = 0, 3
    while n:
        if n & 1:
            total += addend
        addend += addend
        n >>= 1
    return total


def sum_of_quotients(n: int) -> int:
    total, first = 0, 1
    while first <= n:
        quotient = n // first
        last = n // quotient
        total += quotient * (last - first + 1)
        first = last + 1
    return total


def in_blocks(n: int) -> tuple[list[int], list[int]]:
    values, size = list(range(n)), max(1, math.isqrt(n))
    return values, [sum(values[i : i + size]) for i in range(0, n, size)]


def sum_by_blocks(held: tuple[list[int], list[int]]) -> int:
    """From the second of all to the last but one."""
    values, blocks = held
    size, place, total = max(1, math.isqrt(len(values))), 1, 0
    while place < len(values) - 1:
        if place % size == 0 and place + size < len(values):
            total += blocks[place // size]
            place += size
        else:
            total += values[place]
            place += 1
    return total


def horner(coefficients: list[float]) -> float:
    value = 0.0
    for coefficient in coefficients:
        value = value * 0.5 + coefficient
    return value


def run_lengths(it: list[int]) -> list[tuple[int, int]]:
    made: list[tuple[int, int]] = []
    begin = 0
    for i in range(1, len(it) + 1):
        if i == len(it) or it[i] != it[begin]:
            made.append((it[begin], i - begin))
            begin = i
    return made


def window_maxima(it: list[float]) -> list[float]:
    waiting: collections.deque[int] = collections.deque()
    made: list[float] = []
    for i, value in enumerate(it):
        while waiting and it[waiting[-1]] <= value:
            waiting.pop()
        waiting.append(i)
        if waiting[0] <= i - 50:
            waiting.popleft()
        made.append(it[waiting[0]])
    return made


def z_function(text: str) -> list[int]:
    made, left, right = [0] * len(text), 0, 0
    for i in range(1, len(text)):
        length = min(right - i, made[i - left]) if i < right else 0
        while i + length < len(text) and text[length] == text[i + length]:
            length += 1
        if i + length > right:
            left, right = i, i + length
        made[i] = length
    return made


def random_dag(n: int) -> list[list[int]]:
    return [random.choices(range(i + 1, n), k=2) if i + 1 < n else [] for i in range(n)]


def topological(after: list[list[int]]) -> list[int]:
    before = [0] * len(after)
    for some in after:
        for node in some:
            before[node] += 1
    order = [node for node, count in enumerate(before) if not count]
    for node in order:
        for other in after[node]:
            before[other] -= 1
            if not before[other]:
                order.append(other)
    return order


def three_ways(it: list[float]) -> None:
    low, here, high = 0, 0, len(it) - 1
    while here <= high:
        value = it[here]
        if value < 1 / 3:
            it[here], it[low] = it[low], value
            low, here = low + 1, here + 1
        elif value > 2 / 3:
            it[here], it[high] = it[high], value
            high -= 1
        else:
            here += 1


def merge_from_below(it: list[float]) -> list[float]:
    width = 1
    while width < len(it):
        made: list[float] = []
        for i in range(0, len(it), 2 * width):
            a, b, stop = i, min(i + width, len(it)), min(i + 2 * width, len(it))
            middle = b
            while a < middle and b < stop:
                if it[a] <= it[b]:
                    made.append(it[a])
                    a += 1
                else:
                    made.append(it[b])
                    b += 1
            made += it[a:middle] or it[b:stop]
        it, width = made, 2 * width
    return it


def covered(intervals: list[tuple[float, float]]) -> float:
    total, end = 0.0, 0.0
    for begin, length in sorted(intervals):
        total += max(0.0, begin + length - max(begin, end))
        end = max(end, begin + length)
    return total


def grown_tree(keys: list[float]) -> list[Any]:
    """A node is its lower branch, its key and its higher branch."""
    root: list[Any] = [None, keys[0], None]
    for key in keys[1:]:
        node = root
        while True:
            side = 2 if key > node[1] else 0
            if node[side] is None:
                node[side] = [None, key, None]
                break
            node = node[side]
    return root


def walks(n: int) -> int:
    place = 0
    for _ in range(n):
        for step in range(math.isqrt(n)):
            place += 1 if (place ^ step) & 1 else -1
    return place


def warped(rows: tuple[list[float], list[float]]) -> float:
    a, b = rows
    before = [0.0] + [math.inf] * len(b)
    for x in a:
        row = [math.inf]
        for j, y in enumerate(b):
            row.append(abs(x - y) + min(before[j], before[j + 1], row[j]))
        before = row
    return before[-1]


def change(n: int) -> int:
    ways = [1] + [0] * n
    for coin in range(1, n + 1):
        for amount in range(coin, n + 1):
            ways[amount] = (ways[amount] + ways[amount - coin]) % 1_000_003
    return ways[n]


def remove_all(it: list[int]) -> None:
    while it:
        it.remove(it[-1])


def eliminate(rows: list[list[float]]) -> None:
    for i, pivot in enumerate(rows):
        pivot[i] += len(rows)  # so that none vanishes
        for row in rows[i + 1 :]:
            factor = row[i] / pivot[i]
            row[i:] = [x - factor * y for x, y in zip(row[i:], pivot[i:], strict=True)]


def triangles(rows: list[list[float]]) -> int:
    n, count = len(rows), 0
    for i in range(n):
        for j in range(i):
            for k in range(j):
                count += rows[i][j] < 0.5 and rows[j][k] < 0.5 and rows[i][k] < 0.5
    return count


def full_tree(depth: int) -> int:
    return 1 + full_tree(depth - 1) + full_tree(depth - 1) if depth else 1


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
