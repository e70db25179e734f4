"""Functions of known cost that no library has: written as textbooks do, to try judges on."""

import bisect
import collections
import heapq
import math
import operator
import random
from typing import Any


def append(n: int) -> list[int]:
    made: list[int] = []
    for i in range(n):
        made.append(i)
    return made


def drain(heap: list[float]) -> None:
    while heap:
        heapq.heappop(heap)


def push_and_pop(heap: list[float]) -> None:
    heapq.heappush(heap, -1.0)
    heapq.heappop(heap)


def compared(one: float, other: float) -> int:
    return (one > other) - (one < other)


def gallop(held: list[int], key: int) -> None:
    bound = 1
    while bound < len(held) and held[bound] < key:
        bound *= 2
    bisect.bisect_left(held, key, bound // 2, min(bound + 1, len(held)))


def digit_sum(n: int) -> int:
    total = 0
    while n:
        total += n % 2
        n //= 2
    return total


def steps_to_root(n: int) -> int:
    step, square = 0, 0
    while square < n:
        step += 1
        square += 2 * step - 1
    return step


def squared(it: list[float]) -> float:
    total = 0.0
    for value in it:
        total += value * value
    return total


def balanced(text: str) -> bool:
    open_: list[str] = []
    for letter in text:
        if letter == "(":
            open_.append(letter)
        elif not open_ or open_.pop() != "(":
            return False
    return not open_


def nearest_smaller(it: list[float]) -> list[float]:
    waiting: list[float] = []
    made: list[float] = []
    for value in it:
        while waiting and waiting[-1] >= value:
            waiting.pop()
        made.append(waiting[-1] if waiting else -1.0)
        waiting.append(value)
    return made


def pairs_of_sum(ascending: list[float]) -> int:
    low, high, count = 0, len(ascending) - 1, 0
    while low < high:
        if ascending[low] + ascending[high] < 1:
            low += 1
        else:
            high -= 1
            count += 1
    return count


def running_median(it: list[float]) -> list[float]:
    low: list[float] = []
    high: list[float] = []
    made: list[float] = []
    for value in it:
        heapq.heappush(high, -heapq.heappushpop(low, -value))
        if len(high) > len(low):
            heapq.heappush(low, -heapq.heappop(high))
        made.append(-low[0])
    return made


def closest_pair(points: list[tuple[float, float]]) -> float:
    def within(some: list[tuple[float, float]]) -> tuple[float, list[tuple[float, float]]]:
        if len(some) < 2:
            return math.inf, some
        half = len(some) // 2
        middle = some[half][0]
        (one, left), (other, right) = within(some[:half]), within(some[half:])
        least = min(one, other)
        upward = list(heapq.merge(left, right, key=operator.itemgetter(1)))
        strip: list[tuple[float, float]] = []
        for x, y in upward:
            if abs(x - middle) < least:
                for there in strip[-7:]:
                    least = min(least, math.dist(there, (x, y)))
                strip.append((x, y))
        return least, upward

    return within(sorted(points))[0]


def triangle(n: int) -> list[list[int]]:
    return [[row * (row - 1) // 2 + i for i in range(1, row + 1)] for row in range(1, n + 1)]


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
