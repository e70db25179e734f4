"""Mutation test of the gates: faults in a copy of the sources, each of which ``hem check`` catches.

``python -m experiments.validation.mutants`` prints the table; ``-k WORD`` tries those with a word
in the name. The faults are data, see ``mutants.toml``. A copy without a fault must pass.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import tomllib
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

HERE = Path(__file__).parents[2]
COPIED = ("hem", "structures", "experiments", "results/reference")
GATES = ("work", "bytes", "class", "time")
LONGEST_SECONDS = 900
ROW = "{:<50} {:<18} {:<6} {:<7} {:>4}  {}"


class MutantError(ValueError):
    """A fault cannot be injected, or names no gate."""


@dataclass(frozen=True)
class Mutant:
    """A fault: texts in one file and what they become, and the gate that must catch it."""

    name: str
    structure: str
    gate: str
    file: str
    changes: tuple[tuple[str, str], ...]

    def apply(self, tree: Path) -> None:
        """Inject it. Raises MutantError unless each old text is there just once."""
        path = tree / self.file
        text = path.read_text("utf-8") if path.exists() else ""
        for old, new in self.changes:
            if text.count(old) != 1:
                raise MutantError(
                    f"mutants.toml, {self.name!r}: its old text is {text.count(old)} times "
                    f"in {self.file}, not once; bring it in line with the source:\n{old}"
                )
            text = text.replace(old, new)
        path.write_text(text, "utf-8")


class Trial(NamedTuple):
    """Whether the gate said what it must, the first such finding, and how long it took."""

    passed: bool
    line: str
    seconds: float


def load_mutants(text: str | None = None) -> list[Mutant]:
    """Read ``mutants.toml``, or a text like it. Raises MutantError for a wrong entry."""
    content = tomllib.loads(text or (Path(__file__).parent / "mutants.toml").read_text("utf-8"))
    return [_read_mutant(entry) for entry in content["mutant"]]


def _read_mutant(entry: dict[str, Any]) -> Mutant:
    changes = entry.get("changes") or [[entry.get("old", ""), entry.get("new", "")]]
    name, gate = entry.get("name", "?"), entry.get("gate")
    if gate not in GATES:
        raise MutantError(f"mutants.toml, {name!r}: no gate is called {gate!r}; there are {GATES}")
    if any(old == new or not old for old, new in changes):
        raise MutantError(f"mutants.toml, {name!r}: it changes nothing")
    return Mutant(name, entry["structure"], gate, entry["file"], tuple(map(tuple, changes)))


@contextmanager
def copied_tree() -> Iterator[Path]:
    """A copy of the sources and the baseline, with the machine code that was cached for them."""
    with tempfile.TemporaryDirectory(prefix="hem-mutant-") as folder:
        for part in COPIED:
            shutil.copytree(HERE / part, Path(folder) / part)  # times stay, so the cache is valid
        yield Path(folder)


def run_gate(tree: Path, structure: str = "", timed: bool = False) -> dict[str, Any]:
    """Run ``hem check --json`` in a tree -> what it printed, with its exit code as ``status``."""
    command = [sys.executable, "-m", "experiments.cli", "check", "--json"]
    command += ["--structure", structure] if structure else []
    command += ["--beside", str(HERE)] if timed else []
    try:
        done = subprocess.run(
            command, cwd=tree, capture_output=True, text=True, timeout=LONGEST_SECONDS
        )
        report = json.loads(done.stdout)
    except subprocess.TimeoutExpired:
        return {"status": 2, "worse": [], "error": f"took longer than {LONGEST_SECONDS} s"}
    except ValueError:
        return {"status": done.returncode, "worse": [], "error": done.stderr.strip()[-200:]}
    worse = [finding for finding in report["findings"] if finding["outcome"] == "worse"]
    return {"status": done.returncode, "worse": worse, "counts": report["counts"]}


def try_mutant(mutant: Mutant) -> Trial:
    """Inject one fault and run the gate. It is caught if the right part of the gate says worse."""
    begin = perf_counter()
    with copied_tree() as tree:
        mutant.apply(tree)
        report = run_gate(tree, mutant.structure, mutant.gate == "time")
    caught = [finding for finding in report["worse"] if finding["kind"] == mutant.gate]
    line = _in_words(caught) or report.get("error", f"no {mutant.gate} is worse")
    return Trial(report["status"] == 1 and bool(caught), line, perf_counter() - begin)


def try_unchanged() -> Trial:
    """Run the gate, times included, on a copy without a fault: nothing may be worse."""
    begin = perf_counter()
    with copied_tree() as tree:
        counted, timed = run_gate(tree), run_gate(tree, "half_edge", timed=True)
    decided = timed.get("counts", {}).get("same", 0) > 0
    passed = counted["status"] == 0 and timed["status"] != 1 and decided
    line = _in_words(counted["worse"] + timed["worse"]) or counted.get("error", "nothing is worse")
    return Trial(passed, line, perf_counter() - begin)


def _in_words(findings: list[dict[str, Any]]) -> str:
    return next((f"{it['where']}: {it['before']} → {it['after']}" for it in findings), "")


def main(arguments: Sequence[str] | None = None) -> int:
    """Try every mutant, print the table -> 0 if all were caught and the copy without passed."""
    parser = ArgumentParser(description="Inject faults; hem check must catch each.")
    parser.add_argument("-k", default="", metavar="WORD", help="just those with it in the name")
    word = parser.parse_args(arguments).k
    chosen = [mutant for mutant in load_mutants() if word in mutant.name]
    if not chosen:
        print(f"no mutant has {word!r} in its name; see experiments/validation/mutants.toml")
        return 2
    print(ROW.format("mutant", "structure", "gate", "caught", "s", "what the gate said"))
    _print_trial(unchanged := try_unchanged(), "none", "all", "all", "passes")
    caught = 0
    for mutant in chosen:
        trial = try_mutant(mutant)
        caught += trial.passed
        _print_trial(trial, mutant.name, mutant.structure, mutant.gate, "yes")
    print(f"{caught} of {len(chosen)} caught")
    return 0 if unchanged.passed and caught == len(chosen) else 1


def _print_trial(trial: Trial, *texts: str) -> None:
    *names, passed = texts
    answer = passed if trial.passed else "NO"
    print(ROW.format(*names, answer, f"{trial.seconds:.0f}", trial.line), flush=True)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except MutantError as error:
        sys.exit(f"hem: {error}")
