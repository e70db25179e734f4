"""Functions of known cost that no library has: written as textbooks do, to try judges on."""

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


def add_and_discard(held: set[int], key: int) -> None:
    held.add(-key)
    held.discard(-key)


def halve(held: list[int], key: int) -> None:
    low, high = 0, len(held)
    while low < high:
        middle = (low + high) // 2
        if held[middle] < key:
            low = middle + 1
        else:
            high = middle


def divide(p: int) -> bool:
    divisor = 2
    while divisor * divisor <= p:
        if p % divisor == 0:
            return False
        divisor += 1
    return True


def bubble(it: list[float]) -> None:
    for end in range(len(it) - 1, 0, -1):
        for i in range(end):
            if it[i] > it[i + 1]:
                it[i], it[i + 1] = it[i + 1], it[i]


def hanoi(n: int) -> int:
    return hanoi(n - 1) + 1 + hanoi(n - 1) if n else 0


def edits(texts: tuple[str, str]) -> int:
    a, b = texts
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        before, row = row, [i]
        for j, y in enumerate(b, 1):
            row.append(min(before[j] + 1, row[-1] + 1, before[j - 1] + (x != y)))
    return row[-1]


def squarings(n: int) -> float:
    power, base = 1.0, 1.0000001
    while n:
        power, base, n = power * base if n & 1 else power, base * base, n >> 1
    return power


def euclid(n: int) -> int:
    a, b = n, round(n * 0.6180339887)
    while b:
        a, b = b, a % b
    return a


def heapsort(it: list[float]) -> list[float]:
    heap: list[float] = []
    for value in it:
        heapq.heappush(heap, value)
    return [heapq.heappop(heap) for _ in it]


def merge_sort(it: list[float]) -> list[float]:
    if len(it) < 2:
        return it
    half = len(it) // 2
    return list(heapq.merge(merge_sort(it[:half]), merge_sort(it[half:])))


def insertion_sort(it: list[int]) -> None:
    for i in range(1, len(it)):
        value, place = it[i], i
        while place and it[place - 1] > value:
            it[place] = it[place - 1]
            place -= 1
        it[place] = value


def selection_sort(it: list[float]) -> None:
    for i in range(len(it)):
        least = min(range(i, len(it)), key=it.__getitem__)
        it[i], it[least] = it[least], it[i]


def pascal(n: int) -> list[float]:
    row = [1.0]
    for _ in range(n):
        row = [a + b for a, b in zip([0.0, *row], [*row, 0.0], strict=True)]
    return row


def multiply(a: list[list[float]]) -> list[list[float]]:
    columns = list(zip(*a, strict=True))
    return [[sum(map(operator.mul, row, column)) for column in columns] for row in a]


def sums(it: list[int], total: int = 0) -> int:
    return sums(it[1:], total) + sums(it[1:], total + it[0]) if it else total


def halvings(n: int) -> int:
    steps = 0
    while n:
        n, steps = n // 2, steps + 1
    return steps


def prefix_sum(tree: list[int], place: int) -> int:
    total = 0
    while place:
        total += tree[place]
        place &= place - 1
    return total


def change_leaf(tree: list[float], leaf: int) -> None:
    node = leaf + len(tree) // 2
    while node > 1:
        node //= 2
        tree[node] = tree[2 * node] + tree[2 * node + 1]


def counted_root(n: int) -> int:
    root = 0
    while root * root < n:
        root += 1
    return root


def triangular(n: int) -> int:
    total = step = 0
    while total < n:
        step += 1
        total += step
    return step


def jump_search(it: Any) -> int:
    step, last = math.isqrt(len(it)), len(it) - 1
    place = 0
    while place + step < len(it) and it[place + step] <= last:
        place += step
    while it[place] < last:
        place += 1
    return place


def largest_sum(it: list[float]) -> float:
    best = here = 0.0
    for value in it:
        here = max(0.0, here + value - 0.5)
        best = max(best, here)
    return best


def random_cycle(n: int) -> list[int]:
    order, follow = random.sample(range(n), n), [0] * n
    for a, b in zip(order, [*order[1:], order[0]], strict=True):
        follow[a] = b
    return follow


def walk(follow: list[int]) -> int:
    place = 0
    for _ in follow:
        place = follow[place]
    return place


def random_graph(n: int) -> list[tuple[int, int]]:
    return [((i + 1) % n, random.randrange(n)) for i in range(n)]


def breadth_first(neighbors: list[tuple[int, int]]) -> list[int]:
    found, seen = [0], {0}
    for place in found:
        for other in neighbors[place]:
            if other not in seen:
                seen.add(other)
                found.append(other)
    return found


def quicksort(it: list[float]) -> list[float]:
    if len(it) < 2:
        return it
    pivot, rest = it[0], it[1:]
    low, high = [x for x in rest if x < pivot], [x for x in rest if x >= pivot]
    return [*quicksort(low), pivot, *quicksort(high)]


def push_downward(n: int) -> list[int]:
    heap: list[int] = []
    for value in range(n, 0, -1):
        heapq.heappush(heap, value)
    return heap


def divisors(n: int) -> list[int]:
    count = [0] * (n + 1)
    for divisor in range(1, n + 1):
        for multiple in range(divisor, n + 1, divisor):
            count[multiple] += 1
    return count


def common(texts: tuple[str, str]) -> int:
    a, b = texts
    row = [0] * (len(b) + 1)
    for x in a:
        before = row[:]
        for j, y in enumerate(b, 1):
            row[j] = before[j - 1] + 1 if x == y else max(before[j], row[j - 1])
    return row[-1]


def product(factors: tuple[list[float], list[float]]) -> list[float]:
    a, b = factors
    made = [0.0] * (len(a) + len(b))
    for i, x in enumerate(a):
        for j, y in enumerate(b, i):
            made[j] += x * y
    return made


def insert_all(n: int) -> list[int]:
    made: list[int] = []
    for i in range(n):
        made.insert(0, i)
    return made


def chain_order(sizes: list[int]) -> int:
    n = len(sizes) - 1
    cost = [[0] * n for _ in range(n)]
    for length in range(1, n):
        for i in range(n - length):
            j = i + length
            cost[i][j] = min(
                cost[i][k] + cost[k + 1][j] + sizes[i] * sizes[k + 1] * sizes[j + 1]
                for k in range(i, j)
            )
    return cost[0][-1]


def gray_code(n: int) -> list[int]:
    codes = [0]
    for bit in range(n):
        codes += [code | 1 << bit for code in reversed(codes)]
    return codes
