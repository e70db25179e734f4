"""``hem study``: measure every structure, go on after anything, say whether time can be judged."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from experiments.cli.console import console, errors, user_errors
from experiments.harness import memory
from experiments.harness.presets import PRESETS
from experiments.runs import results, study
from experiments.runs.steadiness import noise
from experiments.runs.worker import DEFAULT_SEED

ProfileOption = Annotated[
    str | None,
    typer.Option(
        help="How much to measure: " + "; ".join(f"{k}: {p.what}" for k, p in PRESETS.items())
    ),
]
SeedOption = Annotated[
    int | None, typer.Option(help=f"Of the order of the cells; {DEFAULT_SEED} if not given.")
]
PinOption = Annotated[
    bool,
    typer.Option("--pin/--no-pin", help="Keep each process on one core, where that is allowed."),
]
WorkersOption = Annotated[
    str | None,
    typer.Option(
        help="The scheduler of a Dask cluster, tcp://host:port: spread the work over its machines."
    ),
]


def run_study(
    profile: ProfileOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the newest unfinished run.")
    ] = False,
    run: Annotated[
        Path | None, typer.Option(help="With --resume: the run to go on with, finished or not.")
    ] = None,
    output: Annotated[Path, typer.Option(help="Where the runs are kept.")] = results.RUNS,
    structure: Annotated[
        list[str] | None, typer.Option(help="Measure just this one; may be repeated.")
    ] = None,
    seed: SeedOption = None,
    pin: PinOption = True,
    workers: WorkersOption = None,
) -> None:
    """Measure every structure; the results go to a new folder, cell by cell.

    A cell that would not fit into memory is left out and says so; HEM_MEMORY=8G pretends that there
    is so much.
    """
    with user_errors():
        if profile is not None and profile not in PRESETS:
            raise ValueError(f"no profile is called {profile!r}; there are {', '.join(PRESETS)}")
        memory.available()  # whether HEM_MEMORY can be read
        if workers:
            _require_cluster(workers)
        chosen = structure or []
        if resume:
            folder, kept, chosen = study.resume(output, run)
            if profile not in (None, kept):
                raise ValueError(f"{folder} was begun as {kept}; resume it without --profile")
            profile = kept
            if not workers and any(folder.glob(results.MACHINES)):
                raise ValueError(f"{folder} is of a cluster; resume it with --workers tcp://…")
            _require_nothing_new(folder, structure, seed, pin)
        else:
            if run:
                raise ValueError(f"to go on with {run}, say --resume as well")
            profile = profile or "quick"
            order = DEFAULT_SEED if seed is None else seed
            folder = study.begin(profile, output, chosen, seed=order, pin=pin)
        _run_with_progress(folder, profile, chosen, workers)


def _require_cluster(workers: str) -> None:
    from experiments.runs import cluster

    cluster.require(workers)


def _require_nothing_new(
    folder: Path, structure: list[str] | None, seed: int | None, pin: bool
) -> None:
    """A run goes on as it was begun."""
    how = study.how(folder)
    given = {
        "--structure": bool(structure),
        "--seed": seed not in (None, how.seed),
        "--no-pin": how.pin and not pin,
    }
    for option, differs in given.items():
        if differs:
            raise ValueError(f"{folder} goes on as it was begun; resume it without {option}")


def _run_with_progress(folder: Path, profile: str, chosen: list[str], workers: str | None) -> None:
    begun = perf_counter()
    console.print(f"Measuring into {folder} (profile {profile}: {PRESETS[profile].what})")
    go_on = f"hem study --resume --run {folder}" + (f" --workers {workers}" if workers else "")
    try:
        with _progress(study.processes(profile, chosen), folder) as report:
            if workers:
                from experiments.runs import cluster

                cluster.run(folder, profile, workers, report, chosen, say=_warn)
            else:
                study.run(folder, profile, report, chosen, say=_warn)
    except KeyboardInterrupt:
        errors.print(f"Stopped. What is finished is in {folder}; go on with: {go_on}")
        raise typer.Exit(130) from None
    except study.StudyFailedError as failure:
        errors.print(f"[bold red]Some cells failed.[/] Try them again with: {go_on}\n")
        _warn(str(failure))
        raise typer.Exit(1) from None
    except results.CannotWriteError as error:
        raise ValueError(f"{error}. What is finished is kept; then go on with: {go_on}") from error
    _conclude(folder, perf_counter() - begun)


def _conclude(folder: Path, seconds: float) -> None:
    """Say how it went: what was left out, how steady the machine was, what to do now."""
    run = results.load(folder)
    if len(run.skipped):
        console.print(f"{len(run.skipped)} cells were left out; hem report says which and why.")
    seen = noise(run)
    console.print(f"[yellow]{seen.words}[/]" if seen.too_busy else seen.words, highlight=False)
    console.print(f"Done in {seconds:.0f} s. Now: hem table, hem report")


def _warn(text: str) -> None:
    errors.print(escape(text), highlight=False, soft_wrap=True)


@contextmanager
def _progress(
    every: list[study.Process], folder: Path
) -> Iterator[Callable[[study.Process, int], None]]:
    columns = TextColumn("{task.description:<32}"), BarColumn(), MofNCompleteColumn()
    done = {process: process.done(folder) for process in every}
    with Progress(
        *columns, TextColumn("cells, left"), TimeRemainingColumn(), console=console
    ) as bar:
        task = bar.add_task("", total=sum(len(process.cases) for process in every))
        bar.update(task, completed=sum(done.values()))

        def report(process: study.Process, count: int) -> None:
            done[process] = count
            what = f"{process.experiment.removeprefix('bench_')} · {process.structure}"
            bar.update(task, completed=sum(done.values()), description=what)

        yield report
