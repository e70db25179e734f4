"""The commands ``hem check`` and ``hem baseline update``."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from typer import Argument, Option

from experiments import carried, require_known
from experiments.cli.console import (
    AsJson,
    Structures,
    console,
    errors,
    print_json,
    run_folder,
    user_errors,
)

if TYPE_CHECKING:  # takes a second to import, and `hem --help` has no need of it
    from experiments.regression import Compared, Measured
    from experiments.runs import Run

Baseline = Annotated[
    Path, Option("--baseline", "--reference", help="The folder with what is compared with.")
]
HERE = Path("results/reference")
BASELINE = HERE if HERE.is_dir() else carried("results/reference")
FACTOR_HELP = "How many times slower is worse. Default: 2 from run to run, 1.15 interleaved."


def check(
    run: Annotated[Path | None, Argument(help="A run; without it only what is counted.")] = None,
    beside: Annotated[Path | None, Option(help="Another checkout, to be timed beside.")] = None,
    structure: Structures = None,
    factor: Annotated[float | None, Option(help=FACTOR_HELP)] = None,
    as_json: AsJson = False,
    markdown: Annotated[Path | None, Option(help="A summary, for a pull request.")] = None,
    baseline: Baseline = BASELINE,
) -> None:
    """Compare with the baseline. Exit code 0; 1: something got worse; 2: it cannot be told.

    Example: `hem check results/runs/NAME --markdown check.md`
    """
    with user_errors(2):  # 1 says that something got worse
        if factor is not None and not factor > 1:
            raise ValueError(f"--factor is more than 1, such as 1.5, not {factor:g}")
        if markdown is not None:  # rather now than after all is measured
            new = not markdown.exists()
            markdown.open("a").close()
            if new:
                markdown.unlink()
        compared = _compare(run, beside, structure or [], factor, baseline)
        from experiments.regression import exit_code
        from experiments.report import findings as shown

        if as_json:
            print_json(shown.as_json(*compared))
        else:
            shown.show(*compared, console)
        if markdown is not None:
            markdown.write_text(shown.as_markdown(*compared), "utf-8")
    raise typer.Exit(exit_code(compared.findings))


def _compare(
    run: Path | None, beside: Path | None, structures: list[str], factor: float | None, folder: Path
) -> Compared:
    """All that was asked for. Raises ValueError for what a user can mend."""
    chosen = run_folder(run) if run else None
    from structures import NAMED

    require_known("structure", structures, NAMED)
    from experiments import regression as gate

    if beside:  # all mistakes are told before anything is measured
        gate.require_tree(beside)
    loaded = chosen and _load(chosen)
    before = gate.load_baseline(gate.COUNTERS, folder)
    runs = loaded and (gate.load_baseline(gate.RUN, folder), gate.reduce_run(loaded))
    factors: dict[str, Any] = {} if factor is None else {"factor": factor}
    after = gate.measure_counters(structures)
    before = before.only(structures) if structures else before
    findings, notes = gate.compare_counters(before, after)
    if structures:
        notes.append(f"just {', '.join(structures)} was measured")
    if runs:
        of_runs = gate.compare_runs(*runs, **factors)
        findings, notes = findings + of_runs.findings, notes + of_runs.notes
    else:
        notes.append("just the counters were compared; all of a run with: hem check RUN")
    if beside:
        findings += gate.compare_trees(beside, structures=structures, **factors)
    return gate.Compared(findings, list(dict.fromkeys(notes)))


def _load(folder: Path) -> Run:
    from experiments.harness import own_mesh
    from experiments.regression import Kind
    from experiments.runs import load, resume_command

    if mesh := own_mesh.of_run(folder):
        why = "the baseline is not: there is no comparing"
        raise ValueError(f"{folder} is on {mesh[0]}, and {why}")
    run = load(folder)
    if not set(run.cases["kind"]) <= {*Kind}:
        raise ValueError(f"{folder} is of other libraries, of which there is no baseline")
    if run.cases.empty:
        raise ValueError(f"{folder} holds no case; resume it with: {resume_command(folder)}")
    return run


DOUBTS = {
    "dirty": "the run was made with changes that are not committed",
    "too_busy": "the machine was too busy to judge the run by time",
}
"""What speaks against a run as a baseline."""
baseline_app = typer.Typer(help="What hem check compares with.", no_args_is_help=True)


@baseline_app.command()
def update(
    run: Annotated[Path | None, Argument(help="A run; without it only what is counted.")] = None,
    yes: Annotated[bool, Option("--yes", help="Do not ask.")] = False,
    baseline: Baseline = HERE,
) -> None:
    """Measure the counters, show what would change in the baseline, and write it.

    Example: `hem baseline update results/runs/NAME`
    """
    chosen = run_folder(run) if run else None
    from experiments import regression

    # Mistakes are told before anything is measured.
    of_run = {regression.RUN: _finished(chosen)} if chosen else {}
    counters = regression.measure_counters()
    for case in counters.run.skipped.to_dict("records"):
        where = f"{case['experiment']}/{case['structure']}/{case['id']}"
        raise ValueError(f"{where} could not be measured, so nothing is kept: {case['skipped']}")
    fresh = {regression.COUNTERS: counters} | of_run
    changed = {part: it for part, it in fresh.items() if _print_difference(part, it, baseline)}
    if not changed:
        console.print(f"{baseline} says just this already.", markup=False)
        return
    if regression.RUN in changed:
        for key, words in DOUBTS.items():
            if changed[regression.RUN].run.meta.get(key):
                console.print(f"[yellow]Mind that {words}.[/]")
    if not yes and not typer.confirm(f"Write this to {baseline}?"):
        errors.print("Nothing was written.")
        raise typer.Exit(1)
    for part, measured in changed.items():
        regression.save_baseline(part, measured, baseline)
    told = f"Written to {baseline}; look at it with: git diff --stat {shlex.quote(str(baseline))}"
    console.print(told, markup=False, soft_wrap=True)


def _finished(folder: Path) -> Measured:
    from experiments.regression import reduce_run
    from experiments.runs import resume_command

    run = _load(folder)
    if "finished" not in run.meta:
        raise ValueError(f"{folder} is not finished; resume it with: {resume_command(folder)}")
    if part := [key for key in ("structures", "experiments") if run.meta.get(key)]:
        raise ValueError(f"{folder} is of some {part[0]} alone, and a baseline is of all")
    measured = reduce_run(run)
    if not (measured.run.cases["kind"] == "time").any():
        raise ValueError(f"{folder} has no times to compare with: measure a larger preset")
    return measured


def _print_difference(part: str, fresh: Measured, folder: Path) -> bool:
    """Print what would change in a part of the baseline -> whether anything would."""
    from experiments.regression import describe_difference, load_baseline

    try:
        before = load_baseline(part, folder)
    except ValueError:
        console.print(f"[green]+[/] {part}: {len(fresh.run.cases):,} cases")
        return True  # what cannot be read is replaced
    lines = describe_difference(before, fresh)
    for line in lines:
        console.print(f"[cyan]±[/] {escape(line)}", soft_wrap=True)
    return bool(lines)
