"""The same code against itself: how often a comparison of two runs cries wolf.

``python -m experiments.validation.a_against_a --pairs 20``:
each run of a pair is some fresh processes, in
turns with those of the other run. A case is timed as the study times it, with a reading of the
reference probe before every round. Takes about half a minute per pair.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

import structures
from experiments.harness.cases import Case, pool
from experiments.harness.operations import time_operations
from experiments.harness.presets import PRESETS, Preset
from experiments.harness.probe import reading
from experiments.harness.timer import time_query
from experiments.regression.significance import ALPHA, DRIFT, FACTOR, Comparison, compare
from experiments.runs.provenance import describe
from experiments.runs.results import write_json
from hem.contract.queries import QUERIES
from structures import REGISTRY

RESULT = Path("results/reference/a_against_a.json")
STRUCTURES = tuple(name for name, it in REGISTRY.items() if it.compiled)
OPERATIONS = ("split_edge", "split_face", "flip_edge")
SIZES = (1_000,)
PROCESSES = 3
"""Processes that make up a run, in turns with those of the other: what makes one process slow in a
case from beginning to end is then seen as noise, and not taken for the code."""
ROUNDS = 5
PROFILE = replace(PRESETS["quick"], rounds=ROUNDS, round_seconds=0.0005, case_seconds=1.0)
ALARMS = ("worse", "better")
LARGEST_SHARE = 1e-3
"""False alarms per comparison that are borne."""


class Rounds:
    """What the study's timing asks of a benchmark, with a reading of the probe before each round.

    probe: () -> seconds. ``readings``: one per round and warm-up.
    """

    def __init__(self, probe: Callable[[], float]) -> None:
        self._probe = probe
        self.readings: list[float] = []
        self.stats = SimpleNamespace(stats=SimpleNamespace(data=[]))

    def pedantic(
        self,
        function: Callable[..., Any],
        args: Sequence[Any] = (),
        *,
        setup: Callable[[], Any] | None = None,
        rounds: int,
        warmup_rounds: int = 0,
    ) -> None:
        """Time ``function`` so many times, after as many times untimed."""
        seconds = []
        for _ in range(warmup_rounds + rounds):
            given, named = (setup and setup()) or (args, {})
            self.readings.append(self._probe())
            begin = perf_counter()
            function(*given, **named)
            seconds.append(perf_counter() - begin)
        self.stats.stats.data = seconds[warmup_rounds:]


class Timed(NamedTuple):
    """A case's seconds per round, and the probe's beside them."""

    samples: list[float]
    probe: list[float]


def cases() -> Iterator[Case]:
    """Queries of random elements, operations, and building, on the compiled structures."""
    family = PROFILE.families[0]
    for name in STRUCTURES:
        for size in SIZES:
            for query in QUERIES:
                yield Case(name, family, size, query, "random")
            for operation in OPERATIONS:
                yield Case(name, family, size, operation, "batched")
        yield Case(name, family, SIZES[-1], None, "consecutive")


def measure(chosen: Sequence[Case], profile: Preset = PROFILE) -> dict[str, Timed]:
    """Time cases, each as the study does -> by structure and case."""
    return {f"{case.structure}/{case.id}": _timed(case, profile) for case in chosen}


def _timed(case: Case, profile: Preset) -> Timed:
    s = case.build()
    rounds = Rounds(reading)
    if case.subject in QUERIES:
        samples = time_query(rounds, s, str(case.subject), pool(case, s), profile)["samples"]
    elif case.subject:
        samples = time_operations(rounds, case, profile)["samples"]
    else:
        arguments = case.structure, case.mesh(), case.reference_bytes
        rounds.pedantic(structures.build, arguments, rounds=profile.rounds, warmup_rounds=1)
        samples = np.array(rounds.stats.stats.data)
    return Timed(samples.tolist(), rounds.readings)


def compared(before: dict[str, Timed], after: dict[str, Timed]) -> dict[str, Comparison]:
    """Compare every case of two runs."""
    return {
        name: compare(old.samples, after[name].samples, old.probe, after[name].probe)
        for name, old in before.items()
    }


def run_pairs(pairs: int, report: Callable[[dict[str, Any], dict[str, Comparison]], None]) -> None:
    """Measure so many pairs, each compared, and report what is kept so far after each of them."""
    kept = {key: value for key, value in describe("a against a").items() if key != "profile"}
    kept |= {"factor": FACTOR, "alpha": ALPHA, "drift": DRIFT, "rounds": PROCESSES * ROUNDS}
    kept |= {"comparisons": 0, "alarms": 0, "pairs": []}
    for pair in range(pairs):
        found = compared(*_pair(pair % 2 == 1))
        row = _row(found)
        kept["pairs"].append(row)
        kept["comparisons"] += row["comparisons"]
        kept["alarms"] += len(row["alarms"])
        report(kept, found)


def _row(found: dict[str, Comparison]) -> dict[str, Any]:
    outcomes = [it.outcome for it in found.values()]
    away = sorted(float(np.exp(abs(np.log(it.ratio)))) for it in found.values())
    return {
        "comparisons": len(found),
        "same": outcomes.count("same"),
        "undetermined": outcomes.count("undetermined"),
        "alarms": {name: it.ratio for name, it in found.items() if it.outcome in ALARMS},
        "median_ratio": float(f"{np.median(away):.4g}"),
        "worst_ratio": float(f"{away[-1]:.4g}"),
        "ratios": [float(f"{it.ratio:.3g}") for it in found.values()],
    }


def _pair(turned: bool) -> tuple[dict[str, Timed], dict[str, Timed]]:
    """Two runs, their processes in turns: 0 1 1 0 0 1, or the other way around."""
    parts: tuple[list[dict[str, Timed]], list[dict[str, Timed]]] = ([], [])
    for step in range(2 * PROCESSES):
        parts[((step + 1) // 2 + turned) % 2].append(_process())
    return joined(parts[0]), joined(parts[1])


def joined(parts: Sequence[dict[str, Timed]]) -> dict[str, Timed]:
    """One run from its processes: the rounds of each case, one process after the other."""
    return {
        name: Timed(
            [seconds for part in parts for seconds in part[name].samples],
            [seconds for part in parts for seconds in part[name].probe],
        )
        for name in parts[0]
    }


def _process() -> dict[str, Timed]:
    """All cases once, in a process of its own."""
    command = [sys.executable, "-m", "experiments.validation.a_against_a", "--measure"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"a run failed:\n{done.stderr}")
    return {name: Timed(*it) for name, it in json.loads(done.stdout).items()}


def _print(found: dict[str, Comparison], row: dict[str, Any], pair: int) -> None:
    counts = f"{row['same']:4} same {row['undetermined']:4} undetermined"
    print(f"pair {pair:3} {counts}  worst ratio {row['worst_ratio']:.2f}", flush=True)
    for name in row["alarms"]:
        it = found[name]
        print(f"   {it.outcome}: {name} {it.ratio:.2f} ({it.low:.2f} to {it.high:.2f})", flush=True)


def main() -> None:
    """Run as a command; exits with 1 if there are too many false alarms."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--pairs", type=int, default=20)
    parser.add_argument("--output", type=Path, default=RESULT)
    parser.add_argument("--measure", action="store_true", help="one process, printed as JSON")
    given = parser.parse_args()
    if given.measure:
        print(json.dumps(measure(list(cases()))))
        return
    last: dict[str, Any] = {}

    def report(kept: dict[str, Any], found: dict[str, Comparison]) -> None:
        last.update(kept)
        write_json(given.output, kept)
        _print(found, kept["pairs"][-1], len(kept["pairs"]))

    run_pairs(given.pairs, report)
    print(f"{last['comparisons']} comparisons, {last['alarms']} false alarms")
    sys.exit(last["alarms"] > LARGEST_SHARE * last["comparisons"])


if __name__ == "__main__":
    main()
