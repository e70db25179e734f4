"""Two trees timed by turns, so that whatever slows the machine slows both.

Each tree has a process of its own; they answer the same query a round at a time, one after the
other, with a fixed piece of work timed beside every round. That tells a slow-down of a fifth that
no two runs apart could show.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from experiments.check import Finding, claim_of
from experiments.significance import FACTOR, Comparison, compare
from hem.queries import QUERIES
from structures import REGISTRY

VERTICES = 1_000
ROUNDS = 24
MOST_ROUNDS = 96
ROUND_SECONDS = 0.002

FURTHER = 4
"""Pairs of processes in which a query is timed again that was not as before in the first. Where a
process happens to lie in memory alone was measured to make a query slower by 1.6, in two of ten
processes of the same code (compare Mytkowicz et al., Producing wrong data without doing anything
obviously wrong, ASPLOS 2009): so a tree is slower only if no pair says otherwise."""

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
    before: Path, after: Path, structures: Sequence[str] = (), factor: float = FACTOR
) -> list[Finding]:
    """Time every query of the compiled structures in both trees, some two minutes at most.

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
    pairs = {it: [pair] for it, pair in _in_new_processes(before, after, wanted, factor)}
    doubtful = [it for it in wanted if _judged(*it, pairs[it], factor).outcome != "same"]
    for _ in range(FURTHER):
        for it, pair in _in_new_processes(before, after, doubtful, factor):
            pairs[it].append(pair)
    return [_judged(*it, pairs[it], factor) for it in wanted]


class Timed(NamedTuple):
    """A query in a process: seconds per round, the probe's beside them, handles that a round asks.

    error: why it could not be timed, or empty.
    """

    samples: list[float]
    probe: list[float]
    handles: int
    error: str = ""


Pair = tuple[Timed, Timed]


def _judged(name: str, query: str, pairs: Sequence[Pair], factor: float) -> Finding:
    """What most pairs of processes say; a tree is slower or faster if besides none says otherwise.

    A pair that failed is not passed over.
    """
    where = f"turns/{name}/{query}/torus/{VERTICES}/consecutive"
    errors = [it.error for pair in pairs for it in pair if it.error]
    if errors:
        why = f"could not be timed: {errors[0]}"
        return Finding("undetermined", "time", where, "", "", why, claim_of(where))
    found = [compare(it.samples, to.samples, it.probe, to.probe, factor) for it, to in pairs]
    said = Counter(it.outcome for it in found)
    outcome, most = said.most_common(1)[0]
    agreed = outcome == "same" or most + said["undetermined"] == len(found)
    decided = outcome if agreed and 2 * most > len(found) else "undetermined"
    middle = sorted(range(len(found)), key=lambda i: found[i].ratio)[len(found) // 2]
    old, new = (f"{1e9 * np.median(it.samples) / it.handles:.3g} ns" for it in pairs[middle])
    return Finding(decided, "time", where, old, new, _why(found, middle), claim_of(where))


def _why(found: Sequence[Comparison], middle: int) -> str:
    it = found[middle]
    words = f"× {it.ratio:.3f}, 95 % [{it.low:.3f}, {it.high:.3f}], p = {it.p:.1g}"
    if len(found) == 1:
        return words
    said = Counter(it.outcome for it in found).most_common()
    return f"{words}; processes: {', '.join(f'{count} {it}' for it, count in said)}"


def _in_new_processes(
    before: Path, after: Path, wanted: Sequence[tuple[str, str]], factor: float
) -> Iterator[tuple[tuple[str, str], Pair]]:
    """Time in a new process of each tree."""
    with ExitStack() as stack:
        workers = [stack.enter_context(_worker(tree)) for tree in (before, after) if wanted]
        for name, query in wanted:
            try:
                pair = _by_turns(workers, name, query, factor)
            except (OSError, ValueError) as error:
                failed = Timed([], [], 0, str(error))
                pair = failed, failed
            yield (name, query), pair


def _by_turns(workers: Sequence[Worker], name: str, query: str, factor: float) -> Pair:
    """More rounds as long as they cannot tell, ``MOST_ROUNDS`` at most."""
    once = min(it.ask(structure=name, query=query) for it in workers)
    times = max(1, round(ROUND_SECONDS / once))
    for worker in workers:
        worker.ask(times=times, query=query)
    old, new = (Timed([], [], times * _handles(query)) for _ in workers)
    while True:
        for k in range(2 * ROUNDS):
            which = (k + k // 2) % 2  # neither is always the first: 0 1 1 0
            sample, probe = workers[which].ask(query=query)
            (old, new)[which].samples.append(sample)
            (old, new)[which].probe.append(probe)
        found = compare(old.samples, new.samples, old.probe, new.probe, factor)
        if found.outcome != "undetermined" or len(old.samples) >= MOST_ROUNDS:
            return old, new


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
