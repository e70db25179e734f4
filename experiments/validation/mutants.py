"""Mutation test of the gates: faults in a copy of the sources, each of which ``hem check`` catches.

``python -m experiments.validation.mutants`` prints the table; ``-k WORD`` tries those with a word
in the name. The faults are data, see ``mutants.toml``. A copy without a fault must pass.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

HERE = Path(__file__).parents[2]
COPIED = ("hem", "structures", "experiments", "notebooks", "results/reference")
GATES = ("work", "bytes", "class", "time")
LONGEST_SECONDS = 900
ROW = "{:<50} {:<18} {:<6} {:<7} {}"


@dataclass(frozen=True)
class Mutant:
    """A fault: a text or pairs of them (``changes``) in one file; a gate must catch it."""

    name: str
    structure: str
    gate: str
    file: str
    old: str = ""
    new: str = ""
    changes: Sequence[Sequence[str]] = ()

    def __post_init__(self) -> None:
        if self.gate not in GATES:
            raise ValueError(f"{self.name!r}: no gate is called {self.gate!r}; there are {GATES}")

    def apply(self, tree: Path) -> None:
        """Inject it. Raises ValueError unless each old text is there just once."""
        path = tree / self.file
        text = path.read_text("utf-8") if path.exists() else ""
        for old, new in self.changes or [(self.old, self.new)]:
            if text.count(old) != 1 or old == new:
                raise ValueError(
                    f"{self.name!r}: its old text is {text.count(old)} times in {self.file}, not "
                    f"once, or does not change; bring it in line with the source:\n{old}"
                )
            text = text.replace(old, new)
        path.write_text(text, "utf-8")


def load_mutants(text: str | None = None) -> list[Mutant]:
    """Read ``mutants.toml``, or a text like it. Raises ValueError for a gate that there is not."""
    content = tomllib.loads(text or (Path(__file__).parent / "mutants.toml").read_text("utf-8"))
    return [Mutant(name, **entry) for name, entry in content.items()]


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
    output: dict[str, Any] = {"capture_output": True, "text": True}
    try:
        done = subprocess.run(command, cwd=tree, timeout=LONGEST_SECONDS, **output)
        report = json.loads(done.stdout)
    except subprocess.TimeoutExpired as error:
        return {"status": 2, "worse": [], "error": str(error)}
    except ValueError:
        return {"status": done.returncode, "worse": [], "error": done.stderr.strip()[-200:]}
    worse = [finding for finding in report["findings"] if finding["outcome"] == "worse"]
    return {"status": done.returncode, "worse": worse, "counts": report["counts"]}


def try_mutant(mutant: Mutant) -> tuple[bool, str]:
    """Inject one fault -> whether the right part of the gate says worse, and what it says."""
    with copied_tree() as tree:
        mutant.apply(tree)
        report = run_gate(tree, mutant.structure, mutant.gate == "time")
    caught = [finding for finding in report["worse"] if finding["kind"] == mutant.gate]
    line = _in_words(caught) or report.get("error", f"no {mutant.gate} is worse")
    return report["status"] == 1 and bool(caught), line


def try_unchanged() -> tuple[bool, str]:
    """Run the gate, times included, without a fault -> whether nothing is worse, and what is."""
    with copied_tree() as tree:
        counted, timed = run_gate(tree), run_gate(tree, "half_edge", timed=True)
    decided = timed.get("counts", {}).get("same", 0) > 0
    passed = counted["status"] == 0 and timed["status"] != 1 and decided
    line = _in_words(counted["worse"] + timed["worse"]) or counted.get("error", "nothing is worse")
    return passed, line


def _in_words(findings: list[dict[str, Any]]) -> str:
    return next((f"{it['where']}: {it['before']} → {it['after']}" for it in findings), "")


def main(word: Annotated[str, typer.Option("-k", help="Just those named so.")] = "") -> None:
    """Inject faults; hem check must catch each. Exits with 1 if one was missed."""
    chosen = [mutant for mutant in load_mutants() if word in mutant.name]
    if not chosen:
        raise ValueError(f"no name in experiments/validation/mutants.toml has {word!r} in it")
    print(ROW.format("mutant", "structure", "gate", "caught", "what the gate said"))
    unchanged, line = try_unchanged()
    print(ROW.format("none", "all", "all", "passes" if unchanged else "NO", line), flush=True)
    caught = 0
    for mutant in chosen:
        passed, line = try_mutant(mutant)
        caught += passed
        answer = mutant.name, mutant.structure, mutant.gate, "yes" if passed else "NO", line
        print(ROW.format(*answer), flush=True)
    print(f"{caught} of {len(chosen)} caught")
    raise SystemExit(not (unchanged and caught == len(chosen)))


if __name__ == "__main__":
    try:
        typer.run(main)
    except ValueError as error:
        sys.exit(f"hem: {error}")
