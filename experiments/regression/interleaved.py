"""Two trees timed interleaved, so that whatever slows the machine slows both.

Each tree has a worker process, some one after another; a pair of them answers the same query a
round at a time, ABBA, the calibration loop beside every round. A slowdown of a fifth shows then.
"""

import json
import os
import sys
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from subprocess import PIPE, Popen
from typing import Any, NamedTuple

import numpy as np

from experiments.harness import calibration
from experiments.regression.compare import claim_of
from experiments.regression.findings import CaseKey, Change, Finding, Kind, vote
from experiments.regression.significance import FACTOR, Comparison, compare_rounds
from hem.contract import QUERIES
from structures import REGISTRY

HERE = Path(__file__).parents[2]  # the tree that this is
WORKER = Path(__file__).with_name("interleaved_worker.py")

VERTICES = 1_000
ROUNDS = 24
MOST_ROUNDS = 96
ROUND_SECONDS = 0.002

PAIRS, FURTHER = 2, 3
"""Pairs of processes that time a query, and how many more where one of the first does not find it
as before. Where a process lies in memory was measured to make a query slower by 1.6, in two of ten
processes of the same code (compare Mytkowicz et al., Producing wrong data without doing anything
obviously wrong, ASPLOS 2009): so a tree is slower only if no pair says otherwise."""

Case = tuple[str, str]  # a structure and a query


class PairTimed(NamedTuple):
    """What two processes say of a query, in median seconds per handle; ``error``: why nothing."""

    compared: Comparison = Comparison(Change.UNDETERMINED, np.nan, 0, np.inf)
    before: float = np.nan
    after: float = np.nan
    error: str = ""


def require_tree(path: Path) -> None:
    """Raise ValueError where there is no tree."""
    if not (path / "hem" / "__init__.py").exists():
        raise ValueError(f"--beside {path} is no checkout: there is no hem/__init__.py in it")


def compare_trees(
    before: Path, after: Path = HERE, structures: Collection[str] = (), factor: float = FACTOR
) -> list[Finding]:
    """Time every query of the compiled structures in both trees, usually in a minute or two.

    The first time it compiles; what does not run cannot be told. Raises ValueError for no tree.
    """
    require_tree(before)
    chosen = structures or REGISTRY
    names = [name for name, it in REGISTRY.items() if it.compiled and name in chosen]
    wanted = [(name, query) for name in names for query in QUERIES]
    if not wanted:
        none = f"none of {', '.join(structures)} is compiled"
        why = f"{none}, so there is nothing to time interleaved"
        return [Finding(Change.UNDETERMINED, Kind.TIME, CaseKey("interleaved"), why=why)]
    timed: dict[Case, list[PairTimed]] = {case: [] for case in wanted}
    for _ in range(PAIRS + FURTHER):
        for case, pair in time_in_new_processes(before, after, wanted, factor):
            timed[case].append(pair)
        wanted = [case for case in wanted if _is_open(timed[case])]
    return [_judge(*case, pairs) for case, pairs in timed.items()]


def _is_open(pairs: Sequence[PairTimed]) -> bool:
    """Whether further pairs could tell more."""
    not_as_before = any(it.compared.change != Change.SAME for it in pairs[:PAIRS])
    return not pairs[-1].error and (len(pairs) < PAIRS or not_as_before)


def _judge(name: str, query: str, pairs: Sequence[PairTimed]) -> Finding:
    """The pairs' vote. One that could not be timed is not passed over."""
    key = CaseKey("interleaved", name, query, "torus", 2 * VERTICES, order="consecutive")
    claim = claim_of(key._replace(experiment="bench_queries"))
    if errors := [pair.error for pair in pairs if pair.error]:
        why = f"could not be timed: {errors[0]}"
        return Finding(Change.UNDETERMINED, Kind.TIME, key, why=why, claim=claim)
    middle = sorted(pairs, key=lambda pair: pair.compared.ratio)[len(pairs) // 2]
    seconds = middle.before, middle.after
    old, new = (f"{1e9 * it:,.{0 if it >= 1e-7 else 2}f} ns" for it in seconds)
    change, said = vote((pair.compared.change for pair in pairs), unanimous=True)
    _, ratio, low, high = middle.compared
    why = f"× {ratio:.2f} [{low:.2f}, {high:.2f}]; {said}"
    return Finding(change, Kind.TIME, key, old, new, why, claim=claim, random=True)


def time_in_new_processes(
    before: Path, after: Path, wanted: Sequence[Case], factor: float
) -> Iterator[tuple[Case, PairTimed]]:
    """Time in a new process of each tree -> by query what they say, or why they could not."""
    with ExitStack() as stack:
        workers = [stack.enter_context(_worker(tree)) for tree in (before, after) if wanted]
        for case in wanted:
            try:
                yield case, _time_pair(workers, *case, factor)
            except (OSError, ValueError) as error:
                yield case, PairTimed(error=str(error))


def _time_pair(workers: Sequence[Popen[str]], name: str, query: str, factor: float) -> PairTimed:
    """More rounds as long as they cannot tell, ``MOST_ROUNDS`` at most."""
    ask = {"structure": name, "query": query}
    once = min(_ask(worker, **ask, times=1)[1] for worker in workers)
    times = max(1, round(ROUND_SECONDS / once))
    handles = [_ask(worker, **ask, times=times)[0] for worker in workers]
    rounds: list[list[Any]] = [[], []]
    while True:
        for k in range(2 * ROUNDS):
            which = (k + k // 2) % 2  # neither is always the first: 0 1 1 0
            rounds[which].append(_ask(workers[which]))
        samples, loops = zip(*(np.transpose(them).tolist() for them in rounds), strict=True)
        compared = compare_rounds(samples[0], samples[1], loops[0], loops[1], factor)
        if compared.change != Change.UNDETERMINED or len(rounds[0]) >= MOST_ROUNDS:
            old, new = (np.median(it) / k for it, k in zip(samples, handles, strict=True))
            return PairTimed(compared, float(old), float(new))


def _ask(worker: Any, **question: Any) -> Any:
    """Ask and wait for the answer. Raises OSError with what it said if it failed or has ended."""
    with suppress(BrokenPipeError):
        worker.stdin.write(json.dumps(question) + "\n")
        worker.stdin.flush()
    answer = worker.stdout.readline()
    if not answer:
        said = worker.stderr.read().strip().splitlines()
        raise OSError(said[-1] if said else "the process ended")
    found = json.loads(answer)
    if isinstance(found, dict):
        raise OSError(found["error"])
    return found


@contextmanager
def _worker(tree: Path) -> Iterator[Popen[str]]:
    command = [sys.executable, str(WORKER), str(calibration.__file__), str(VERTICES)]
    # The tree alone is on its path, not the folder of the worker's own file.
    environment = {**os.environ, "PYTHONPATH": str(tree.resolve()), "PYTHONSAFEPATH": "1"}
    pipes: dict[str, Any] = {"stdin": PIPE, "stdout": PIPE, "stderr": PIPE}
    with Popen(command, cwd=tree, env=environment, text=True, **pipes) as process:
        try:
            yield process
        finally:
            process.kill()
            with suppress(BrokenPipeError):  # it ended before it was asked
                process.communicate()
