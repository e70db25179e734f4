"""Functions of known cost that no library has: written as textbooks do, to try judges on."""

import math
from typing import Any


def doubled_at(it: tuple[Any, Any]) -> None:
    values, places = it
    values[places] *= 2


def best_gain(prices: list[float]) -> float:
    least, best = math.inf, 0.0
    for price in prices:
        least = min(least, price)
        best = max(best, price - least)
    return best


def depth(text: str) -> int:
    deepest = now = 0
    for letter in text:
        now += 1 if letter == "(" else -1
        deepest = max(deepest, now)
    return deepest


def joined(pairs: list[tuple[float, float]]) -> list[tuple[float, float]]:
    found = list[tuple[float, float]]()
    for first, last in sorted((min(it), max(it)) for it in pairs):
        if found and first <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], last)
        else:
            found.append((first, last))
    return found


def cocktail_sort(it: list[int]) -> None:
    low, high, step = 0, len(it) - 1, 1
    while low < high:
        places = range(low, high) if step > 0 else range(high - 1, low - 1, -1)
        for k in places:
            if it[k] > it[k + 1]:
                it[k], it[k + 1] = it[k + 1], it[k]
        low, high, step = low + (step < 0), high - (step > 0), -step


def determinant(matrix: Any) -> float:
    rows, found = matrix.tolist(), 1.0
    for k, row in enumerate(rows):
        found *= row[k]
        for i in range(k + 1, len(rows)):
            share = rows[i][k] / row[k]
            rows[i] = [a - share * b for a, b in zip(rows[i], row, strict=True)]
    return found
