"""Proof that the gate catches: faults injected into a copy of the sources, each to be caught.

``python -m experiments.validation.mutants`` prints the table;
``-k WORD`` tries those with a word in the name.
The faults are data, see ``mutants.toml``. The copy without any fault must pass.
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

from rich.console import Console

HERE = Path(__file__).parents[2]
COPIED = ("hem", "structures", "experiments", "results/reference")
GATES = ("work", "bytes", "class", "time")
LONGEST_SECONDS = 300
ROW = "{:<50} {:<18} {:<6} {:<7} {:>4}  {}"


class MutantError(ValueError):
    """A fault cannot be injected: its text is not there, or not once."""


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


class Tried(NamedTuple):
    """What the gate made of a tree: ``line`` is the first that it printed of this kind."""

    caught: bool
    line: str
    seconds: float


def load_mutants(text: str | None = None) -> list[Mutant]:
    """The faults of ``mutants.toml``, or of a text like it. Raises MutantError for a wrong one."""
    content = tomllib.loads(text or (Path(__file__).parent / "mutants.toml").read_text("utf-8"))
    return [_mutant(entry) for entry in content["mutant"]]


def _mutant(entry: dict[str, Any]) -> Mutant:
    # A text that begins on a line of its own must do so in the file as well.
    changes = entry.get("changes") or [[entry.get("old", ""), entry.get("new", "")]]
    name, gate = entry.get("name", "?"), entry.get("gate")
    if gate not in GATES:
        raise MutantError(f"mutants.toml, {name!r}: no gate is called {gate!r}; there are {GATES}")
    if any(old == new or not old for old, new in changes):
        raise MutantError(f"mutants.toml, {name!r}: it changes nothing")
    return Mutant(name, entry["structure"], gate, entry["file"], tuple(map(tuple, changes)))


@contextmanager
def copied() -> Iterator[Path]:
    """A copy of the sources and the reference, with the machine code that was cached for them."""
    with tempfile.TemporaryDirectory(prefix="hem-mutant-") as folder:
        for part in COPIED:
            shutil.copytree(HERE / part, Path(folder) / part)  # times stay, so the cache is valid
        yield Path(folder)


def gate(tree: Path, structure: str = "", timed: bool = False) -> tuple[int, dict[str, Any]]:
    """Run the gate in a tree -> its exit code, and what it printed as JSON."""
    command = [sys.executable, "-m", "experiments.cli", "check", "--json"]
    command += ["--structure", structure] if structure else []
    command += ["--beside", str(HERE)] if timed else []
    try:
        done = subprocess.run(
            command, cwd=tree, capture_output=True, text=True, timeout=LONGEST_SECONDS
        )
    except subprocess.TimeoutExpired:
        return 2, {"findings": [], "error": f"took longer than {LONGEST_SECONDS} s"}
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        said = done.stderr.strip().splitlines()
        return done.returncode, {"findings": [], "error": said[-1] if said else "nothing was said"}


def attempt(mutant: Mutant) -> Tried:
    """Inject one fault and run the gate. It is caught if the right part of the gate says worse."""
    begun = perf_counter()
    with copied() as tree:
        mutant.apply(tree)
        exit_code, said = gate(tree, mutant.structure, mutant.gate == "time")
    worse = [it for it in said["findings"] if it["outcome"] == "worse"]
    of_kind = [it for it in worse if it["kind"] == mutant.gate]
    caught = exit_code == 1 and bool(of_kind)
    seconds = perf_counter() - begun
    if of_kind:
        return Tried(caught, line(of_kind[0]), seconds)
    return Tried(False, said.get("error") or f"exit code {exit_code}, no {mutant.gate}", seconds)


def sound() -> Tried:
    """Run the gate, times included, on a copy without any fault: nothing may be worse."""
    begun = perf_counter()
    with copied() as tree:
        exact_code, exact = gate(tree)
        timed_code, timed = gate(tree, "half_edge", timed=True)
    told = timed.get("counts", {}).get("same", 0) > 0
    passed = exact_code == 0 and timed_code != 1 and told
    findings = [it for it in exact["findings"] + timed["findings"] if it["outcome"] == "worse"]
    text = line(findings[0]) if findings else str(exact.get("error") or "nothing is worse")
    return Tried(passed, text, perf_counter() - begun)


def line(finding: dict[str, Any]) -> str:
    """What the gate says of one finding, without the claim."""
    why = f" ({finding['why']})" if finding["why"] else ""
    return f"{finding['where']}: {finding['before']} → {finding['after']}{why}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Try every mutant, print the table -> 0 if all were caught and the copy without passed."""
    parser = ArgumentParser(description="Inject faults; each must be caught by the gate.")
    parser.add_argument("-k", default="", metavar="WORD", help="just those with it in the name")
    word = parser.parse_args(arguments).k
    console = Console()
    chosen = [it for it in load_mutants() if word in it.name]
    if not chosen:
        console.print(f"no mutant has {word!r} in its name; see experiments/mutants.toml")
        return 2
    good = True
    print(ROW.format("mutant", "structure", "gate", "caught", "s", "what the gate said"))
    for mutant in (None, *chosen):
        tried = attempt(mutant) if mutant else sound()
        good &= tried.caught
        words = ("yes", "NO") if mutant else ("passes", "FAILS")
        names = (mutant.name, mutant.structure, mutant.gate) if mutant else ("none", "all", "all")
        answer = words[0] if tried.caught else words[1]
        row = ROW.format(*names, answer, f"{tried.seconds:.0f}", tried.line)
        print(row, flush=True)
    console.print("All caught." if good else "[bold red]Not all were caught.[/]")
    return 0 if good else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except MutantError as error:
        sys.exit(f"hem: {error}")
