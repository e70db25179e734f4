"""Costs by size out of the files that other tools write.

Read are CSV and the JSON of pytest-benchmark, Google Benchmark and hyperfine.
"""

import csv
import json
import re
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from math import inf, isfinite, nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hem.complexity.notation import Array

Row = tuple[str, dict[str, float], list[float]]  # a function's name, its parameters, its samples
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
DIGITS = re.compile(r"(\d+(?:\.\d+)?(?:e[+-]?\d+)?)")  # what splits by it has numbers at odd places
MALFORMED = KeyError, TypeError, AttributeError, OverflowError, RecursionError, json.JSONDecodeError
OBJECT, ADDRESS = "UNSERIALIZABLE[", re.compile(r"^UNSERIALIZABLE\[| at 0x\w+|(?<=>)\]$")


class Curve(NamedTuple):
    """Costs of one function along one parameter; others are held ``fixed``."""

    name: str
    parameter: str
    sizes: Array
    samples: list[Array]
    fixed: tuple[str, ...] = ()


def read_curves(path: str | Path, parameter: str | None = None) -> list[Curve]:
    """The curves of a file, a function each, in the file's order.

    parameter: the one that sizes are of; it may be left out where only one varies. The others are
    held fixed: there is a curve for each of their values.
    A CSV has the sizes in its first column and a function in each further one; rows of one size are
    its samples. Warns of runs that failed, as Google Benchmark and hyperfine say, and skips them.
    Raises ValueError that says what is wrong with the file, OSError if there is none.
    """
    try:
        text = Path(path).read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path} is no text in UTF-8: {error}") from error
    is_json = text.lstrip()[:1] in ("{", "[")
    rows = list(_read_json(text, path) if is_json else _read_csv(text, path))
    values: dict[str, set[float]] = defaultdict(set)
    for function, parameters, samples in rows:
        if wrong := [it for it in samples if not 0 < it < inf]:
            where = ", ".join([function, *(f"{k}={v:.15g}" for k, v in parameters.items())])
            raise ValueError(
                f"{path}, {where}: a cost is positive, not {wrong[0]:g}; leave out what was too "
                "quick for the clock"
            )
        for name, value in parameters.items():
            values[name].add(value)
    varied = [name for name, some in values.items() if len(some) > 1]
    if not parameter and not varied:
        raise ValueError(f"{path} has no costs at different sizes: nothing varies in it")
    if not parameter and len(varied) > 1:
        raise ValueError(f"{path} varies {', '.join(varied)}: say which one with --parameter")
    chosen = parameter or varied[0]
    if chosen not in values:
        known = ", ".join(values) or "none"
        raise ValueError(f"{path} has no parameter {chosen!r}; there are: {known}")
    found: dict[str, dict[float, list[float]]] = defaultdict(lambda: defaultdict(list))
    for name, parameters, samples in rows:
        if chosen in parameters:
            if (size := parameters[chosen]) < 1:
                raise ValueError(f"{path}, {name}: {chosen} is {size:g}, and sizes are at least 1")
            fixed = (f"{k}={v:.15g}" for k, v in parameters.items() if k != chosen)
            found[", ".join([name, *fixed])][size] += samples
    held = tuple(name for name in values if name != chosen)
    return [
        Curve(name, chosen, np.array(ns := sorted(cells)), [np.array(cells[n]) for n in ns], held)
        for name, cells in found.items()
    ]


def _read_csv(text: str, path: str | Path) -> Iterator[Row]:
    try:
        lines = [(i, line) for i, line in enumerate(csv.reader(text.splitlines()), 1) if any(line)]
    except csv.Error as error:
        raise ValueError(f"{path} is no CSV of costs: {error}") from error
    if not lines or len(lines[0][1]) < 2:
        needed = "sizes first, then a column per function, with commas between"
        raise ValueError(f"{path} is no CSV of costs: {needed}")
    first = [it.strip() for it in lines[0][1]]
    headed = _number(first[0]) is None and not first[0][:1].isdigit()  # 1O0 is a mistake
    names = first if headed else ["n", *(f"column {i + 1}" for i in range(1, len(first)))]
    if again := [name for name, times in Counter(names).items() if times > 1]:
        raise ValueError(f"{path} has two columns {again[0]!r}: each function needs a name")
    for number, line in lines[headed:]:
        size = _number(line[0])
        if size is None or len(line) > len(names):
            raise ValueError(f"{path}, row {number}: a size and a number per function are needed")
        for name, cell in zip(names[1:], line[1:], strict=False):
            if (cost := _number(cell)) is not None:
                yield name, {names[0]: size}, [cost]
            elif cell.strip():  # none is right: not every function was measured at every size
                raise ValueError(f"{path}, row {number}, {name}: {cell!r} is no number")


def _read_json(text: str, path: str | Path) -> list[Row]:
    known = "pytest-benchmark, Google Benchmark or hyperfine"
    try:
        content = json.loads(text)
        if not {"results", "benchmarks"} & {*content}:
            raise ValueError(f"{path} is no JSON of {known}: it has no benchmarks and no results")
        if "results" in content:
            return list(_hyperfine(content["results"]))
        if "machine_info" in content:
            return list(_pytest_benchmark(content["benchmarks"]))
        return list(_google_benchmark(content["benchmarks"]))
    except MALFORMED as error:
        raise ValueError(f"{path} is no JSON of {known}: {error!r}") from error


def _hyperfine(results: list[dict[str, Any]]) -> Iterator[Row]:
    """A command's name has a parameter where its number is that of the parameter in every run.

    It ends with what else was varied where the command does not tell that.
    """
    alike: dict[tuple[str, ...], list[tuple[list[str], dict[str, float], list[float]]]] = {}
    for it in results:
        command, (parameters, others) = it["command"], _parted(it.get("parameters", {}))
        told = [it for it in others if re.search(rf"(?<![^\W_]){re.escape(it)}(?![^\W_])", command)]
        title = ", ".join([command, *(it for it in others if it not in told)])
        parts, times = DIGITS.split(title), it.get("times") or [it["mean"]]
        codes = (it.get("times") and it.get("exit_codes")) or [0] * len(times)
        if failed := sum(code != 0 for code in codes):
            words = f"{command}: {failed} of {len(codes)} runs failed and are skipped"
            warnings.warn(words, stacklevel=2)
        # Times 1.0, as null and text are no costs.
        times = [1.0 * time for time, code in zip(times, codes, strict=True) if code == 0]
        if times:
            alike.setdefault(tuple(parts[::2]), []).append((parts, parameters, times))
    for runs in alike.values():
        named = {}
        for place in range(1, len(runs[0][0]), 2):
            for key in runs[0][1]:
                if all(float(parts[place]) == known.get(key) for parts, known, _ in runs):
                    named[place] = "{" + key + "}"
        for parts, parameters, times in runs:
            name = "".join(named.get(place, part) for place, part in enumerate(parts))
            yield name, parameters, times


def _pytest_benchmark(benchmarks: list[dict[str, Any]]) -> Iterator[Row]:
    """A test is named by its file and class, too, where another has its name.

    An object names a curve of its own where it is given at several sizes; where each size has its
    own, it names none. Its address is told where that alone tells it from another.
    """
    rows, asked = [], defaultdict[Any, set[Any]](set)
    for it in benchmarks:
        test = tuple((it.get(key) or it["name"]).partition("[")[0] for key in ("name", "fullname"))
        given = it.get("params") or {}
        if not _parted(given)[0]:
            given = (it.get("extra_info") or {}) | given
        parameters, others = _parted(given)
        rows.append((test, parameters, others, it["stats"]))
        for value in others:
            asked[test, value].add(tuple(parameters.values()))
    names = Counter(name for name, _ in {test for test, *_ in rows})
    kept = {key for key, at in asked.items() if len(at) > 1 or not key[1].startswith(OBJECT)}
    alike = Counter((test, ADDRESS.sub("", value)) for test, value in kept)
    for test, parameters, others, stats in rows:
        title = [test[0] if names[test[0]] == 1 else test[1]]
        for value in others:
            plain = ADDRESS.sub("", value)
            title += [plain if alike[test, plain] == 1 else value] * ((test, value) in kept)
        costs = [1.0 * it for it in stats.get("data") or [stats["median"]]]
        yield ", ".join(title), parameters, costs


def _google_benchmark(benchmarks: list[dict[str, Any]]) -> Iterator[Row]:
    """A benchmark of which no run is told, or none that did not fail, costs its median."""
    told = []
    for it in benchmarks:
        if it.get("error_occurred") or it.get("skipped"):
            warnings.warn(f"{it['name']} failed and is skipped", stacklevel=2)
        else:
            told.append((it, it.get("run_type", "iteration") == "iteration"))
    known = {it.get("run_name", it["name"]) for it, is_run in told if is_run}
    for it, is_run in told:
        is_median = it.get("aggregate_name") == "median"
        if not is_run and (not is_median or it.get("run_name", it["name"]) in known):
            continue
        name, *arguments = it.get("run_name", it["name"]).split("/")
        parameters, unnamed = {}, []
        for argument in arguments:
            key, _, value = argument.rpartition(":")
            number = _number(value)
            if number is None:
                name += f"/{argument}"  # a template's, or a setting such as real_time
            elif not key:
                unnamed.append(number)
            elif key not in ("iterations", "repeats", "min_time", "min_warmup_time"):
                parameters[key] = number
        one = len(unnamed) == 1 and not parameters.keys() - {"threads"}
        for place, number in enumerate(unnamed, 1):
            parameters["n" if one else f"argument {place}"] = number
        is_real = {"real_time", "manual_time"} & {*arguments}
        unit = UNITS[it.get("time_unit", "ns")]
        yield name, parameters, [it["real_time" if is_real else "cpu_time"] * unit]


def _number(value: Any) -> float | None:
    try:
        number = nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return number if isfinite(number) else None


def _parted(given: dict[str, Any]) -> tuple[dict[str, float], list[str]]:
    """Those of some values that are numbers, and the others as text."""
    numbers = {key: _number(value) for key, value in given.items()}
    others = [str(value) for key, value in given.items() if numbers[key] is None]
    return {key: value for key, value in numbers.items() if value is not None}, others
