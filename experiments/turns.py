"""Two trees timed by turns, so that whatever slows the machine slows both.

Each tree has a process of its own; they answer the same query a round at a time, one after the
other, with a fixed piece of work timed beside every round. That tells a slow-down of a fifth that
no two runs apart could show.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from experiments.check import Finding, claim_of
from experiments.significance import FACTOR, Comparison, compare
from hem.queries import QUERIES
from structures import REGISTRY

VERTICES = 1_000
ROUNDS = 24
MOST_ROUNDS = 96
ROUND_SECONDS = 0.002

WORKER = """
import json, sys
from time import perf_counter
import numpy as np
import hem, structures

probed = np.random.default_rng(0).random(20_000)
mesh = hem.generate("torus", {vertices})

def seconds(work, *given):
    begin = perf_counter()
    work(*given)
    return perf_counter() - begin

for line in sys.stdin:
    asked = json.loads(line)
    if "structure" in asked:
        s = structures.build(asked["structure"], mesh)
        handles = s.handles(asked["query"].split("_")[0])
        s.sweep(asked["query"], handles)  # compiles
        answer = min(seconds(s.sweep, asked["query"], handles) for _ in range(5))
    elif "times" in asked:
        many = np.tile(handles, asked["times"])
        answer = s.sweep(asked["query"], many)
    else:
        probe = seconds(np.sort, probed)
        answer = seconds(s.sweep, asked["query"], many), probe
    print(json.dumps(answer), flush=True)
"""
"""What runs in either tree; it holds on to nothing but the contract, so that old trees do, too."""


def compare_trees(
    before: Path, after: Path, structures: Sequence[str] = (), factor: float | None = None
) -> list[Finding]:
    """Time every query of the compiled structures in both trees, a minute at most.

    Raises ValueError where ``before`` is no tree; what does not run there cannot be told.
    """
    if not (before / "hem" / "__init__.py").exists():
        raise ValueError(f"--beside {before} is no checkout: there is no hem/__init__.py in it")
    wanted = [
        (name, query)
        for name, kind in REGISTRY.items()
        for query in QUERIES
        if kind.compiled and (not structures or name in structures)
    ]
    if not wanted:
        why = f"none of {', '.join(structures)} is compiled, so there is nothing to time by turns"
        return [Finding("undetermined", "time", "turns", "", "", why)]
    found = _in_pairs(before, after, wanted, factor or FACTOR)
    doubtful = [it for it, finding in found.items() if finding.outcome in ("worse", "better")]
    for it, again in _in_pairs(before, after, doubtful, factor or FACTOR).items():
        if again.outcome != found[it].outcome:
            why = f"{found[it].outcome} at first, {again.outcome} in other processes: {again.why}"
            found[it] = replace(again, outcome="undetermined", why=why)
    return list(found.values())


def _in_pairs(
    before: Path, after: Path, wanted: Sequence[tuple[str, str]], factor: float
) -> dict[tuple[str, str], Finding]:
    """Time in a pair of new processes, as where a process lies in memory makes a difference."""
    with ExitStack() as stack:
        workers = [stack.enter_context(_worker(tree)) for tree in (before, after) if wanted]
        return {(name, query): _timed(workers, name, query, factor) for name, query in wanted}


def _timed(workers: Sequence[Worker], name: str, query: str, factor: float) -> Finding:
    where = f"turns/{name}/{query}/torus/{VERTICES}/consecutive"
    try:
        found, seconds = _by_turns(workers, name, query, factor)
    except (OSError, ValueError) as error:
        why = f"could not be timed: {error}"
        return Finding("undetermined", "time", where, "", "", why, claim_of(where))
    shown = [f"{1e9 * it:.3g} ns" for it in seconds]
    why = f"× {found.ratio:.3f}, 95 % [{found.low:.3f}, {found.high:.3f}], p = {found.p:.1g}"
    return Finding(found.outcome, "time", where, shown[0], shown[1], why, claim_of(where))


def _by_turns(
    workers: Sequence[Worker], name: str, query: str, factor: float
) -> tuple[Comparison, list[float]]:
    """The comparison, and the median seconds per query in either tree."""
    once = min(it.ask(structure=name, query=query) for it in workers)
    times = max(1, round(ROUND_SECONDS / once))
    for worker in workers:
        worker.ask(times=times, query=query)
    samples: list[list[float]] = [[], []]
    probes: list[list[float]] = [[], []]
    while True:
        for k in range(2 * ROUNDS):
            which = (k + k // 2) % 2  # neither is always the first: 0 1 1 0
            sample, probe = workers[which].ask(query=query)
            samples[which].append(sample)
            probes[which].append(probe)
        found = compare(samples[0], samples[1], probes[0], probes[1], factor)
        if found.outcome != "undetermined" or len(samples[0]) >= MOST_ROUNDS:
            handles = times * _handles(query)
            return found, [sorted(it)[len(it) // 2] / handles for it in samples]


def _handles(query: str) -> int:
    return VERTICES * {"vertex": 1, "edge": 3, "face": 2}[QUERIES[query].source]


class Worker:
    """A process that times in one tree."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process

    def ask(self, **question: Any) -> Any:
        """Ask and wait for the answer. Raises OSError with what it said if it has ended."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        assert self.process.stderr is not None
        try:
            self.process.stdin.write(json.dumps(question) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass
        answer = self.process.stdout.readline()
        if not answer:
            said = self.process.stderr.read().strip().splitlines()
            raise OSError(said[-1] if said else "the process ended")
        return json.loads(answer)


@contextmanager
def _worker(tree: Path) -> Iterator[Worker]:
    command = [sys.executable, "-c", WORKER.replace("{vertices}", str(VERTICES))]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, cwd=tree, stdin=pipe, stdout=pipe, stderr=pipe, text=True
    ) as process:
        try:
            yield Worker(process)
        finally:
            process.kill()
            if process.stdin:
                with suppress(BrokenPipeError):  # it ended before it was asked
                    process.stdin.close()
