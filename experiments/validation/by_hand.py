"""Functions of known cost that no library has: written as textbooks do, to try judges on."""

import bisect
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


def append_and_pop(held: Any) -> None:
    held.append(0)
    held.pop()


def in_thirds(held: list[int], key: int) -> None:
    low, high = 0, len(held)
    while low < high:
        third = (high - low) // 3
        left, right = low + third, high - 1 - third
        if key < held[left]:
            high = left
        elif key > held[right]:
            low = right + 1
        elif key in (held[left], held[right]):
            return
        else:
            low, high = left + 1, right


def search_tree(n: int) -> list[int]:
    """A node's children are at twice its place, and after it."""
    held, sorted_so_far = [0] * (n + 1), 0
    path: list[int] = []
    place = 1
    while path or place <= n:
        while place <= n:
            path.append(place)
            place *= 2
        place = path.pop()
        held[place] = sorted_so_far
        sorted_so_far += 1
        place = 2 * place + 1
    return held


def descend(held: list[int], key: int) -> None:
    place = 1
    while place < len(held) and held[place] != key:
        place = 2 * place + (key > held[place])


def two_squares(n: int) -> int:
    return sum(math.isqrt(n - a * a) ** 2 == n - a * a for a in range(math.isqrt(n) + 1))


def odd_numbers(n: int) -> int:
    odd = 1
    while n > 0:
        n -= odd
        odd += 2
    return odd


def counting_sort(it: list[int]) -> list[int]:
    counts = [0] * 100
    for value in it:
        counts[value] += 1
    made: list[int] = []
    for value, count in enumerate(counts):
        made += [value] * count
    return made


def prefixes(text: str) -> list[int]:
    made, length = [0] * len(text), 0
    for i in range(1, len(text)):
        while length and text[i] != text[length]:
            length = made[length - 1]
        length += text[i] == text[length]
        made[i] = length
    return made


def majority(votes: list[int]) -> int:
    leader, lead = votes[0], 0
    for vote in votes:
        if not lead:
            leader = vote
        lead += 1 if vote == leader else -1
    return leader


def increasing(it: list[float]) -> int:
    ends: list[float] = []
    for value in it:
        place = bisect.bisect_left(ends, value)
        ends[place : place + 1] = [value]
    return len(ends)


def huffman(weights: list[float]) -> float:
    heap, total = list(weights), 0.0
    heapq.heapify(heap)
    while len(heap) > 1:
        merged = heapq.heappop(heap) + heapq.heappop(heap)
        total += merged
        heapq.heappush(heap, merged)
    return total


def inversions(it: list[float]) -> int:
    if len(it) < 2:
        return 0
    left, right = it[: len(it) // 2], it[len(it) // 2 :]
    count = inversions(left) + inversions(right)
    merged: list[float] = []
    i = 0
    for value in right:
        while i < len(left) and left[i] <= value:
            merged.append(left[i])
            i += 1
        count += len(left) - i
        merged.append(value)
    it[:] = merged + left[i:]
    return count


def hull(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    made: list[tuple[float, float]] = []
    for x, y in sorted(points):
        while len(made) > 1:
            (ax, ay), (bx, by) = made[-2:]
            if (bx - ax) * (y - ay) < (by - ay) * (x - ax):
                break
            made.pop()
        made.append((x, y))
    return made


def palindromes(text: str) -> int:
    n, count, inner = len(text), 0, [False] * len(text)
    for i in range(n - 1, -1, -1):
        ends = [text[i] == text[j] and (j - i < 2 or inner[j - 1]) for j in range(i, n)]
        inner[i:] = ends
        count += sum(ends)
    return count


def knapsack(values: list[int]) -> int:
    best = [0] * (len(values) + 1)
    for weight, value in enumerate(values, 1):
        for room in range(len(best) - 1, weight - 1, -1):
            best[room] = max(best[room], best[room - weight] + value)
    return best[-1]


def pop_all(it: list[int]) -> None:
    while it:
        it.pop(0)


def closure(costs: list[list[float]]) -> list[list[bool]]:
    reach = [[cost < 0.1 for cost in row] for row in costs]
    for middle in range(len(reach)):
        through = reach[middle]
        for row in reach:
            known = row[middle]
            for j in range(len(row)):
                row[j] = row[j] or (known and through[j])
    return reach


def subsets(it: list[int]) -> list[list[int]]:
    made: list[list[int]] = [[]]
    for value in it:
        made += [[*some, value] for some in made]
    return made


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


def bit_strings(n: int) -> list[str]:
    return [""] if not n else [bit + rest for bit in "01" for rest in bit_strings(n - 1)]
