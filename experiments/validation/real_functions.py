"""Judges on real functions: how often each names the class that a function is known to have.

``python -m experiments.validation.real_functions`` measures every function held out, a quarter of
an hour, and asks every judge. ``--busy`` keeps the other core busy with memory the while.
"""

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from subprocess import DEVNULL, Popen
from typing import Annotated, Any

import numpy as np
import pandas as pd
import typer
from typer import Option

from experiments.runs import describe
from experiments.validation.accuracy import UNDETERMINED, Judge, installed_judges
from experiments.validation.accuracy import load_accuracy as load_answers
from experiments.validation.functions import HELD_OUT
from hem.complexity import BUDGET, InParts, Measured, canonical, measure, parse

RESULT = Path("results/reference/real_functions.json")
COLUMNS = ["function", "growth", "source", "neighbor", "judge", "answer"]
SAME_POWER = 0.1  # of exponents: a power law that is told by so much is right
NEIGHBORS = "shared", "busy"  # the machine as it is left, and with one program more

KINDS = ["right", "one of two", "wrong", UNDETERMINED]
ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"), "1")
"""A class is of work, not of how many cores share it."""

POWERS = 2 ** np.arange(6, 21)
NEIGHBOR = """
import os
import numpy as np
parent, a = os.getppid(), np.ones(2**24)
while os.getppid() == parent:  # nothing is left behind where that is killed
    a += 1
"""


@contextmanager
def neighbor(busy: bool) -> Iterator[None]:
    """A program beside that uses a core and the memory; or none."""
    program = Popen([sys.executable, "-c", NEIGHBOR], stdout=DEVNULL) if busy else None
    try:
        yield
    finally:
        if program:
            program.kill()
            program.wait()


def answers_of(found: Measured, judges: dict[str, Judge]) -> dict[str, str]:
    """What every judge says of the costs, ours with and without knowing the memory."""
    told = {"hem": found.judge(resamples=2).answer}
    told["hem, memory unknown"] = found.judge(latency=None, resamples=2).answer
    others = {name: ask for name, ask in judges.items() if name != "hem"}
    told |= {name: ask(found.sizes, found.samples, None) or "" for name, ask in others.items()}
    return {name: answer or UNDETERMINED for name, answer in told.items()}


def kind_of(answer: str, growth: str) -> str:
    """Whether an answer is right: the class alone, one of two that it names, or another."""
    if answer == UNDETERMINED:
        return UNDETERMINED
    named, known = answer.split(" or "), parse(growth)
    right = growth in named
    for told in map(parse, named):  # one fractional power may be told as another close by
        fractions = told.power % 0.5 and known.power % 0.5 and told.logs == 0
        right |= bool(fractions) and abs(told.power - known.power) <= SAME_POWER
    if not right:
        return "wrong"
    return "right" if len(named) == 1 else "one of two"


def _with_kinds(answers: pd.DataFrame) -> pd.DataFrame:
    kinds = [kind_of(*row) for row in answers[["answer", "growth"]].itertuples(index=False)]
    return answers.assign(kind=kinds)


def shares(answers: pd.DataFrame) -> pd.DataFrame:
    """Functions by kind of answer: a row per neighbor and judge."""
    keys = ["neighbor", "judge"]
    counted = _with_kinds(answers).pivot_table(
        "function", keys, "kind", aggfunc="count", fill_value=0, sort=False
    )
    return counted.reindex(columns=KINDS, fill_value=0)


def by_judge(answers: pd.DataFrame) -> pd.DataFrame:
    """The shares, as a page shows them."""
    table = shares(answers).reset_index().rename_axis(columns=None)
    table["judge"] += ", " + table["neighbor"] + " machine"
    return table[["judge", *KINDS]]


def _read(line: dict[str, Any]) -> Measured:
    """What was measured, as it was written down."""
    parts, rows = line.pop("in_parts"), map(np.array, line.pop("samples"))
    known: dict[str, Any] = {key: np.array(values) for key, values in line.items()}
    beside = parts and InParts(np.array(parts["sizes"]), list(map(np.array, parts["ratios"])))
    return Measured(samples=list(rows), in_parts=beside, **known)


def _rows(budget: float, busy: bool, measured: Path | None) -> Iterator[list[str]]:
    """Measure, or read what was measured, and ask -> rows of the answers."""
    judges, kept = installed_judges(), {}
    if measured and measured.exists():
        lines = map(json.loads, measured.read_text("utf-8").splitlines())
        kept = {line.pop("function"): line for line in lines}
    with neighbor(busy and len(kept) < len(HELD_OUT)):
        for it in HELD_OUT:
            if line := kept.get(it.name):
                found = _read(line)
            else:
                sizes = POWERS if it.powers else None
                found = measure(it.call, it.make, sizes, budget=budget, most=it.most)
                if measured:
                    line = {"function": it.name, **asdict(found)}
                    with measured.open("a", encoding="utf-8") as file:
                        file.write(json.dumps(line, default=np.ndarray.tolist) + "\n")
            who = [it.name, canonical(it.growth), it.source, NEIGHBORS[busy]]
            for judge, answer in answers_of(found, judges).items():
                yield [*who, judge, answer]


def main(
    output: Path = RESULT,
    budget: Annotated[float, Option(help="Seconds per function.")] = BUDGET,
    busy: Annotated[bool, Option("--busy", help="Beside a program that uses memory.")] = False,
    measured: Annotated[
        Path | None, Option(help="Costs are kept in it; what it has is not measured again.")
    ] = None,
) -> None:
    """Measure all functions, ask all judges, keep the answers and print the shares."""
    if not ONE_THREAD.items() <= os.environ.items():  # read once, when NumPy is imported
        os.execve(sys.executable, sys.orig_argv, os.environ | ONE_THREAD)
    kept = {key: value for key, value in describe("").items() if key != "preset"}
    rows = list(_rows(budget, busy, measured))
    other = [] if not output.exists() else load_answers(output)[1].to_numpy().tolist()
    rows += [row for row in other if row[3] != NEIGHBORS[busy]]
    kept |= {"budget": budget, "columns": COLUMNS, "rows": rows}
    output.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", "utf-8")
    answers = _with_kinds(pd.DataFrame(rows, columns=COLUMNS))
    missed = answers[(answers["judge"] == "hem") & (answers["kind"] != "right")]
    shown = ["function", "neighbor", "growth", "answer"]
    print(missed[shown].to_string(index=False))
    print(shares(answers).to_string())


if __name__ == "__main__":
    typer.run(main)
