"""The command ``hem judge``: name the class of costs that other tools measured."""

import re
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Argument, Option

from experiments.cli.console import AsJson, console, print_json, user_errors
from experiments.report import show_rows, two_digits

CODES = {"consistent": 0, "violated": 1, "undetermined": 2}
WRITTEN = "", "log", "lg", "ln", "ld", "sqrt"  # in claims, where they name no parameter
COLORS = {"^consistent$": "green", "^violated$": "red", "^undetermined$": "yellow"}


def judge_file(
    file: Annotated[Path, Argument(help="CSV or JSON, see above.")],
    expected: Annotated[str | None, Option(help='The class that is claimed: "O(n log n)".')] = None,
    parameter: Annotated[
        str | None, Option(help="What the sizes are of, where several parameters vary.")
    ] = None,
    upper: Annotated[bool, Option("--upper", help="Slower growth keeps the claim, too.")] = False,
    exact: Annotated[bool, Option("--exact", help="Costs are counts: no cache slows.")] = False,
    plot: Annotated[Path | None, Option(help="Draw the costs: .png, .svg or .pdf.")] = None,
    as_json: AsJson = False,
) -> None:
    """Name the growth class of measured costs, and judge a claim.

    A CSV has sizes in its first column and costs in the others; equal sizes are samples. JSON is
    that of pytest-benchmark, Google Benchmark or hyperfine.
    Exit code 0; 1: a claim is violated; 2: it cannot be told, or nothing could be read.

    Example: `hem judge benchmark.json --expected "O(n log n)" --plot costs.png`
    """
    with user_errors(2):
        if upper and expected is None:
            raise ValueError("--upper is of a claim: give one with --expected")
        from hem.complexity import judge, read_curves

        options: Any = {"exact": exact, "bound": "upper" if upper else "tight"}
        curves = read_curves(file, parameter)
        claim = "O(1)" if expected is None else expected
        claim, options["variable"] = _by_letters(claim, curves[0].parameter, curves[0].fixed)
        verdicts = [judge(it.sizes, it.samples, claim, **options) for it in curves]
        if expected is None:  # then what is said is of the class that comes closest
            pairs = zip(curves, verdicts, strict=True)
            verdicts = [judge(it.sizes, it.samples, own.best, **options) for it, own in pairs]
        if plot is not None:
            from experiments.report.figures.accuracy import save_costs

            save_costs(plot, curves, verdicts, expected is not None)
        (_print_data if as_json else _print)(curves, verdicts, expected)
    if expected is not None:
        codes = {CODES[it.outcome] for it in verdicts}
        raise typer.Exit(1 if 1 in codes else max(codes))


def _by_letters(claim: str, varied: str, fixed: Sequence[str]) -> tuple[str, str | None]:
    """A claim with letters for names of parameters, and the letter of the one that is varied.

    None where it names neither that nor one that is held fixed.
    """
    from hem.complexity import canonical

    own, named = varied if re.fullmatch("[a-zA-Z]", varied) else "n_varied", set[str]()
    every = varied, *fixed
    told_apart = len({it.lower() for it in every}) == len(every)  # else by their case alone
    for name in (it for it in every if it.lower() not in WRITTEN):
        letter = own if name == varied else "n_held"
        # "nlog n" is read, too, and the O of O(…) is no parameter.
        whole = rf"(?<![a-z_]){re.escape(name)}(?![a-z_]|(?<=o)\s*\()"
        claim, times = re.subn(whole, letter, claim, flags=re.IGNORECASE if told_apart else 0)
        named |= {letter} if times else set()
    if named == {"n_held"}:
        canonical(claim)  # one letter more, that nobody knows, may be meant for the varied one
    return claim, own if named else None


def _print_data(curves: Any, verdicts: Any, expected: str | None) -> None:
    """What is known of the curves; nothing of a claim where none was made."""
    of_claim = () if expected is not None else ("outcome", "expected", "bound", "reason")
    rows = []
    for it, verdict in zip(curves, verdicts, strict=True):
        known = {key: value for key, value in asdict(verdict).items() if key not in of_claim}
        known["answer"] = verdict.answer
        rows.append({"function": it.name, "parameter": it.parameter, **known})
    print_json(rows)


def _print(curves: Any, verdicts: Any, expected: str | None) -> None:
    heads = "function", "sizes", "slope", "class", "claim", "verdict"
    shown = len(heads) if expected is not None else 4
    rows = [heads[:shown]]
    for it, verdict in zip(curves, verdicts, strict=True):
        sizes = f"{len(it.sizes)}: {it.sizes[0]:g} … {it.sizes[-1]:g}"
        row = it.name, sizes, two_digits(verdict.raw_slope), verdict.answer or "?"
        rows.append((*row, verdict.expected, verdict.outcome)[:shown])
    show_rows(console, rows, numbers=("slope",), colors=COLORS)
    for it, verdict in zip(curves, verdicts, strict=True):
        if expected is not None or not verdict.answer:
            console.print(f"{it.name}: {verdict.reason}", markup=False)
