"""Two trees timed by turns, so that whatever slows the machine slows both.

Each tree has a process of its own, some one after another; a pair of them answers the same query a
round at a time, one after the other, with a fixed piece of work timed beside every round. That
tells a slow-down of a fifth that no two runs apart could show.
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

from experiments.regression.findings import Finding, claim_of
from experiments.regression.significance import FACTOR, Comparison, compare
from hem.contract import QUERIES
from structures import REGISTRY

VERTICES = 1_000
ROUNDS = 24
MOST_ROUNDS = 96
ROUND_SECONDS = 0.002

PAIRS, FURTHER = 2, 3
"""Pairs of processes that time a query, and how many more where one of the first does not find it
as before. Where a process happens to lie in memory alone was measured to make a query slower by
1.6, in two of ten processes of the same code (compare Mytkowicz et al., Producing wrong data
without doing anything obviously wrong, ASPLOS 2009): so a tree is slower only if no pair says
otherwise."""

STRAYS = 1
"""Pairs that may say otherwise where most say that a query is as before."""

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
    """Time every query of the compiled structures in both trees, usually in a minute or two.

    A tree that never ran compiles first. Raises ValueError where ``before`` is no tree; what does
    not run there cannot be told.
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
    pairs: dict[tuple[str, str], list[Pair | str]] = {it: [] for it in wanted}
    for _ in range(PAIRS):
        for it, pair in _in_new_processes(before, after, wanted, factor):
            pairs[it].append(pair)
    doubtful = [it for it in wanted if _in_doubt(pairs[it])]
    for _ in range(FURTHER):
        for it, pair in _in_new_processes(before, after, doubtful, factor):
            pairs[it].append(pair)
    return [_judged(*it, pairs[it]) for it in wanted]


class Pair(NamedTuple):
    """What two processes, one of each tree, say of a query; their median seconds per handle."""

    compared: Comparison
    before: float
    after: float


def _in_doubt(pairs: Sequence[Pair | str]) -> bool:
    """Whether further pairs could tell more: not where one could not be timed."""
    timed = [it for it in pairs if not isinstance(it, str)]
    return len(timed) == len(pairs) and any(it.compared.outcome != "same" for it in timed)


def _judged(name: str, query: str, pairs: Sequence[Pair | str]) -> Finding:
    """What more than half of the pairs say, if not too many others say another thing.

    Others may be undetermined. One that could not be timed is not passed over.
    """
    where = f"turns/{name}/{query}/torus/{VERTICES}/consecutive"
    errors = [it for it in pairs if isinstance(it, str)]
    if errors:
        why = f"could not be timed: {errors[0]}"
        return Finding("undetermined", "time", where, "", "", why, claim_of(where))
    timed = sorted((it for it in pairs if isinstance(it, Pair)), key=lambda it: it.compared.ratio)
    said = Counter(it.compared.outcome for it in timed)
    outcome, most = said.most_common(1)[0]
    others = len(timed) - most - said["undetermined"]
    agreed = others <= (STRAYS if outcome == "same" else 0) and 2 * most > len(timed)
    decided = outcome if agreed else "undetermined"
    middle = timed[len(timed) // 2]
    old, new = (f"{1e9 * it:.3g} ns" for it in (middle.before, middle.after))
    it = middle.compared
    why = f"× {it.ratio:.3f}, 95 % [{it.low:.3f}, {it.high:.3f}], p = {it.p:.1g}; pairs: "
    why += ", ".join(f"{count} {it}" for it, count in said.most_common())
    return Finding(decided, "time", where, old, new, why, claim_of(where))


def _in_new_processes(
    before: Path, after: Path, wanted: Sequence[tuple[str, str]], factor: float
) -> Iterator[tuple[tuple[str, str], Pair | str]]:
    """Time in a new process of each tree -> by query what they say, or why they could not."""
    with ExitStack() as stack:
        workers = [stack.enter_context(_worker(tree)) for tree in (before, after) if wanted]
        for name, query in wanted:
            try:
                found: Pair | str = _by_turns(workers, name, query, factor)
            except (OSError, ValueError) as error:
                found = str(error)
            yield (name, query), found


def _by_turns(workers: Sequence[Worker], name: str, query: str, factor: float) -> Pair:
    """More rounds as long as they cannot tell, ``MOST_ROUNDS`` at most."""
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
            samples[which].append(sample / (times * _handles(query)))
            probes[which].append(probe)
        found = compare(samples[0], samples[1], probes[0], probes[1], factor)
        if found.outcome != "undetermined" or len(samples[0]) >= MOST_ROUNDS:
            return Pair(found, *(float(np.median(it)) for it in samples))


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
