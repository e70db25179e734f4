"""How ``hem study`` shows how far it is."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from experiments.cli.console import console, errors
from experiments.runs import study
from experiments.runs.worker import Job


@contextmanager
def show_progress(jobs: list[Job], folder: Path) -> Iterator[study.Observer]:
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
