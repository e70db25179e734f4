"""How ``hem study`` shows how far it is."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from experiments.cli.console import console, errors
from experiments.runs import Job, ResultsError, study


@contextmanager
def show_progress(jobs: list[Job], folder: Path) -> Iterator[study.Observer]:
    """Bars on a terminal; else a line for every finished job."""
    columns = TextColumn("{task.description:<32}"), BarColumn(), MofNCompleteColumn()
    left = TextColumn("left"), TimeRemainingColumn()
    off = not console.is_terminal
    # No thread refreshes the bars: it would work while a case is measured.
    with Progress(*columns, *left, console=console, auto_refresh=False, disable=off) as bars:
        yield StudyProgress(bars, {job: _done(job, folder) for job in jobs})


def _done(job: Job, folder: Path) -> int:
    """How many cases of a job are finished: none of a damaged file, which is set aside."""
    try:
        return len(job.ids) - len(job.left(folder))
    except ResultsError:
        return 0


class StudyProgress(study.Observer):
    """A bar for compiling and one for all cases, or lines with the time that is left."""

    def __init__(self, bars: Progress, done: dict[Job, int]) -> None:
        self.bars, self.done = bars, done
        self.begin, self.before = perf_counter(), sum(done.values())
        self.first = 0.0  # when measuring began, beside compiling or after it
        self.total = sum(len(job.ids) for job in done)
        self.compiling = bars.add_task("compiling", total=None, visible=False)
        self.measuring = bars.add_task("", start=False, total=self.total, completed=self.before)

    def compiled(self, structure: str, done: int, total: int) -> None:
        """Move the bar of compiling."""
        self.bars.update(self.compiling, total=total, completed=done, visible=done < total)
        self.bars.refresh()
        self._print(f"compiled {structure} ({done} of {total})")

    def measured(self, job: Job, done: int) -> None:
        """Move the bar of the cases; a line is for the last case of a job."""
        self.done[job] = done
        self.first = self.first or perf_counter()
        finished, seconds = sum(self.done.values()), perf_counter() - self.first
        self.bars.start_task(self.measuring)
        self.bars.update(self.measuring, completed=finished, description=str(job), refresh=True)
        if done == len(job.ids):
            left = seconds * (self.total - finished) / max(finished - self.before, 1)
            self._print(f"{job}: {finished} of {self.total} cases, some {left:.0f} s left")

    def repeating(self, cases: int, seconds: float) -> None:
        """Say so: the bar of the cases is full by then."""
        self.bars.update(self.measuring, description=f"{cases} disturbed, once more", refresh=True)
        self._print(f"{cases} cases were disturbed: once more, {seconds:.0f} s at most")

    def say(self, text: str) -> None:
        """On standard error."""
        errors.print(escape(text))

    def _print(self, text: str) -> None:
        if not console.is_terminal:
            console.print(f"{perf_counter() - self.begin:5.0f} s  {text}", soft_wrap=True)
