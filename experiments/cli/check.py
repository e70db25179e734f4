"""The commands ``hem check`` and ``hem reference update``."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from experiments import carried
from experiments.cli.console import console, errors, user_errors

HERE = Path("results/reference")
BASELINE = HERE if HERE.is_dir() else carried("results/reference")
Reference = Annotated[Path, typer.Option(help="The folder with what is compared with.")]

FACTOR_HELP = (
    "How many times slower counts as worse; less passes. Default: 2 from run to run, 1.15 by turns."
)


def check(
    run: Annotated[
        Path | None,
        typer.Argument(help="The folder of a run. Without it only what is exact, in seconds."),
    ] = None,
    beside: Annotated[
        Path | None,
        typer.Option(help="Another checkout: time the queries there and here by turns."),
    ] = None,
    structure: Annotated[
        list[str] | None, typer.Option(help="Measure just this one; may be repeated.")
    ] = None,
    factor: Annotated[float | None, typer.Option(help=FACTOR_HELP)] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead.")] = False,
    markdown: Annotated[
        Path | None, typer.Option(help="Write a summary for a pull request to this file.")
    ] = None,
    reference: Reference = BASELINE,
) -> None:
    """Compare with the reference. Exit code 0; 1: something got worse; 2: it cannot be told."""
    with could_not_measure(), user_errors():
        if factor is not None and not factor > 1:
            raise ValueError(f"--factor is more than 1, such as 1.5, not {factor:g}")
        from experiments.regression import findings_shown
        from experiments.regression.findings import code
        from experiments.regression.gate import compare_all

        findings, notes = compare_all(run, beside, structure or [], factor, reference)
        if as_json:
            content = findings_shown.as_json(findings, notes)
            sys.stdout.write(json.dumps(content, indent=1, ensure_ascii=False) + "\n")
        else:
            findings_shown.show(findings, notes, console)
        if markdown is not None:
            markdown.write_text(findings_shown.as_markdown(findings, notes), "utf-8")
    raise typer.Exit(code(findings))


@contextmanager
def could_not_measure() -> Iterator[None]:
    """Exit with 2 instead of 1 whatever goes wrong: 1 says that something got worse."""
    try:
        yield
    except typer.Exit as error:
        raise typer.Exit(2 if error.exit_code == 1 else error.exit_code) from error
    except Exception as error:
        errors.print(f"hem: it could not be measured: {error!r}", highlight=False, markup=False)
        raise typer.Exit(2) from error


reference_app = typer.Typer(no_args_is_help=True, help="What hem check compares with.")


@reference_app.callback()
def _reference() -> None:
    """What hem check compares with."""


@reference_app.command("update")
def update(
    run: Annotated[
        Path | None,
        typer.Argument(help="The folder of a run. Without it only what is exact is updated."),
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    reference: Reference = HERE,
) -> None:
    """Measure what is exact, show what would change in the reference, and write it."""
    with user_errors():
        from experiments.regression.gate import Update

        fresh = Update.prepare(run, reference)
        lines = fresh.difference()
        for sign, line in lines:
            color = {"+": "green", "-": "red"}.get(sign, "cyan")
            console.print(f"[{color}]{sign}[/] {escape(line)}", highlight=False, soft_wrap=True)
        if not lines:
            console.print(f"{reference} says just this already.")
            return
        for doubt in fresh.doubts():
            console.print(f"[yellow]Mind that {doubt}.[/]")
        if not yes and not typer.confirm(f"Write this to {reference}?"):
            errors.print("Nothing was written.")
            raise typer.Exit(1)
        fresh.write()
        console.print(f"Written to {reference}; look at it with: git diff --stat {reference}")
