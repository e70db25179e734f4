"""``hem study``: measure every structure, resume after anything, say whether time can be judged."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from experiments.cli.console import console, errors, user_errors
from experiments.harness import PRESETS, memory
from experiments.runs import RUNS, CannotWriteError, load, noise, read_meta, study
from experiments.runs.worker import DEFAULT_SEED, Job

EXTENTS = "; ".join(f"{name}: {preset.what}" for name, preset in PRESETS.items())
PresetOption = Annotated[
    str | None, typer.Option("--preset", "--profile", help=f"How much to measure: {EXTENTS}")
]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Resume the newest unfinished run.")]
RunOption = Annotated[
    Path | None, typer.Option(help="With --resume: the run to resume, finished or not.")
]
OutputOption = Annotated[Path, typer.Option(help="Where the runs are kept.")]
StructureOption = Annotated[
    list[str] | None, typer.Option(help="Measure just this one; may be repeated.")
]
ExperimentOption = Annotated[
    list[str] | None, typer.Option(help="Run just this one; may be repeated.")
]
SeedOption = Annotated[
    int | None, typer.Option(help=f"Of the order of the cases; {DEFAULT_SEED} if not given.")
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
    preset: PresetOption = None,
    resume: ResumeOption = False,
    run: RunOption = None,
    output: OutputOption = RUNS,
    structure: StructureOption = None,
    experiment: ExperimentOption = None,
    seed: SeedOption = None,
    pin: PinOption = True,
    workers: WorkersOption = None,
) -> None:
    """Measure every structure. The results go to a new folder, case by case.

    A case that would not fit into memory is skipped and says so; HEM_MEMORY=8G pretends that there
    is so much.
    """
    with user_errors():
        memory.available()  # whether HEM_MEMORY can be read
        if workers:
            from experiments.runs import cluster

            cluster.require(workers)
        if resume:
            folder = study.resume(output, run)
            given = {
                "--preset": preset, "--structure": structure, "--experiment": experiment,
                "--seed": seed, "--no-pin": not pin,
            }  # fmt: skip
            _require_as_begun(folder, given, workers)
        elif run:
            raise ValueError(f"to resume {run}, say --resume as well")
        else:
            folder = study.begin(
                preset or "quick", output, structure or (), experiments=experiment or (),
                seed=DEFAULT_SEED if seed is None else seed, pin=pin,
            )  # fmt: skip
        _measure(folder, workers)


def _require_as_begun(folder: Path, given: Mapping[str, object], workers: str | None) -> None:
    """Raise ValueError for options that would change how a run was begun."""
    meta = read_meta(folder)
    begun = {
        "--preset": meta["preset"], "--structure": meta["structures"],
        "--experiment": meta["experiments"], "--seed": meta["seed"], "--no-pin": not meta["pin"],
    }  # fmt: skip
    for option, value in given.items():
        if value not in (None, False, [], begun[option]):
            raise ValueError(f"{folder} is resumed as it was begun: leave out {option}")
    if not workers and any(folder.glob("machine-*")):
        raise ValueError(f"{folder} is of a cluster: resume it with --workers tcp://…")


def _measure(folder: Path, workers: str | None) -> None:
    """Measure what a run lacks, and say how it went and what to do now."""
    begin, preset = perf_counter(), read_meta(folder)["preset"]
    resuming = f"hem study --resume --run {folder}" + (f" --workers {workers}" if workers else "")
    console.print(f"Measuring into {folder} (preset {preset}: {PRESETS[preset].what})")
    try:
        with _progress(study.plan(folder), folder) as observer:
            if workers:
                from experiments.runs import cluster

                cluster.run(folder, workers, observer)
            else:
                study.run(folder, observer)
    except KeyboardInterrupt:
        errors.print(f"Stopped. What is finished is in {folder}; resume with: {resuming}")
        raise typer.Exit(130) from None
    except study.StudyFailedError as failure:
        errors.print(f"[bold red]Some cases failed.[/] Try them again with: {resuming}\n")
        errors.print(escape(str(failure)), highlight=False, soft_wrap=True)
        raise typer.Exit(1) from None
    except CannotWriteError as error:
        raise ValueError(f"{error}. What is finished is kept; resume with: {resuming}") from error
    run = load(folder)
    if len(run.skipped):
        console.print(f"{len(run.skipped)} cases were skipped; hem report says which and why.")
    seen = noise(run)
    console.print(f"[yellow]{seen.words}[/]" if seen.too_busy else seen.words, highlight=False)
    console.print(f"Done in {perf_counter() - begin:.0f} s. Now: hem table, hem report")


@contextmanager
def _progress(jobs: list[Job], folder: Path) -> Iterator[study.Observer]:
    """Bars on a terminal; else a line for every finished job."""
    total = sum(len(job.ids) for job in jobs)
    done = {job: len(job.ids) - len(job.left(folder)) for job in jobs}
    if not console.is_terminal:
        yield Lines(done, total)
        return
    columns = TextColumn("{task.description:<32}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, TextColumn("left"), TimeRemainingColumn(), console=console) as bars:
        yield Bars(done, total, bars)


class Lines(study.Observer):
    """A line for every finished job, with the time that is left."""

    def __init__(self, done: dict[Job, int], total: int) -> None:
        self.done, self.total = done, total
        self.begin, self.before = perf_counter(), sum(done.values())

    def compiled(self, structure: str, done: int, total: int) -> None:
        """Say it."""
        self._print(f"compiled {structure} ({done} of {total})")
        if done == total:
            self.begin = perf_counter()

    def measured(self, job: Job, done: int) -> None:
        """Say it of the last case."""
        self.done[job] = done
        if done < len(job.ids):
            return
        finished, seconds = sum(self.done.values()), perf_counter() - self.begin
        left = seconds * (self.total - finished) / max(finished - self.before, 1)
        self._print(f"{job}: {finished} of {self.total} cases, some {left:.0f} s left")

    def say(self, text: str) -> None:
        """On standard error."""
        errors.print(escape(text), highlight=False, soft_wrap=True)

    def _print(self, text: str) -> None:
        seconds = perf_counter() - self.begin
        console.print(f"{seconds:5.0f} s  {text}", highlight=False, soft_wrap=True)


class Bars(Lines):
    """A bar for compiling, and one for all cases."""

    def __init__(self, done: dict[Job, int], total: int, bars: Progress) -> None:
        super().__init__(done, total)
        self.bars = bars
        self.compiling = bars.add_task("compiling", total=None, visible=False)
        self.measuring = bars.add_task("", total=total, completed=self.before, start=False)

    def compiled(self, structure: str, done: int, total: int) -> None:
        """Move the bar of compiling."""
        self.bars.update(self.compiling, total=total, completed=done, visible=done < total)

    def measured(self, job: Job, done: int) -> None:
        """Move the bar of the cases."""
        self.done[job] = done
        self.bars.start_task(self.measuring)
        self.bars.update(self.measuring, completed=sum(self.done.values()), description=str(job))
