"""Bookkeeping for a study on a cluster: what is to be done, on its way, and back."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from experiments.runs.machine_task import Outcome, Task
from experiments.runs.storage import write_text
from experiments.runs.study import Process, Report
from experiments.runs.worker import CANNOT_WRITE, How

TRIES = 3
"""On how many machines a task is tried that does not end."""


@dataclass(frozen=True)
class Running:
    """A task on its way."""

    process: Process
    machine: str
    worker: str
    future: Any


@dataclass
class Work:
    """What is to be done, what is on its way, and what came back."""

    folder: Path
    how: How
    report: Report
    say: Callable[[str], None]
    waiting: list[Process] = field(default_factory=list)
    running: dict[str, Running] = field(default_factory=dict)
    tries: dict[Process, list[str]] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    news: deque[tuple[str, str, str, str]] = field(default_factory=deque)

    @property
    def topic(self) -> str:
        """Where machines tell of cases as they finish them."""
        return f"hem-{self.folder.name}"

    def add(self, every: list[Process]) -> None:
        """Everything that is not complete on any machine."""
        for process in every:
            done = max(process.done(place) for place in self.places())
            self.report(process, done)
            if done < len(process.cases):
                self.waiting.append(process)

    def places(self) -> list[Path]:
        """The folders with results: the run's own, and its machines'."""
        return [self.folder, *sorted(self.folder.glob("machine-*/"))]

    def file(self, process: Process, machine: str) -> Path:
        """Where the cases of a process on a machine are kept."""
        place = self.folder / f"machine-{machine}"
        return place / f"{process.experiment}.{process.structure}.json"

    def task(self, process: Process, machine: str) -> Task:
        """What to ask of a machine: to go on with what it has measured before."""
        path = self.file(process, machine)
        text = path.read_text() if path.exists() else None
        return Task(process.experiment, process.structure, self.how, text)

    def hear(self, event: tuple[Any, Any]) -> None:
        """Take note of what a machine has finished; called from another thread."""
        self.news.append(event[1])

    def keep_news(self) -> None:
        """Keep what machines have finished so far of the tasks that are running there."""
        while self.news:
            machine, experiment, structure, text = self.news.popleft()
            it = self.running.get(machine)
            if it and (it.process.experiment, it.process.structure) == (experiment, structure):
                self.keep(it.process, machine, text)

    def keep(self, process: Process, machine: str, text: str) -> None:
        """Keep a file as it came. Raises CannotWriteError."""
        path = self.file(process, machine)
        write_text(path, text)
        self.report(process, process.done(path.parent))

    def ended(self, it: Running, outcome: Outcome) -> None:
        """Keep what a task leaves; what is not complete has failed."""
        if outcome.text is not None:
            self.keep(it.process, it.machine, outcome.text)
        if it.process.done(self.file(it.process, it.machine).parent) == len(it.process.cases):
            self._supersede(it)
        elif outcome.code == CANNOT_WRITE:
            self.lost(it, f"it has no room for results: {outcome.output}")
        else:
            name = f"{it.process.experiment} on {it.process.structure}, {it.machine}"
            self.failures.append(f"{name}:\n{outcome.output}")

    def _supersede(self, it: Running) -> None:
        """Leave one machine's results of a process, so that no curve is of two machines."""
        mine = self.file(it.process, it.machine)
        for place in self.places():
            other = place / mine.name
            if other != mine and other.exists():
                other.rename(other.with_name(f"{other.name}.superseded"))

    def lost(self, it: Running, why: str) -> None:
        """Have a task tried on another machine, unless it was on too many."""
        tried = self.tries.setdefault(it.process, [])
        tried.append(it.machine)
        name = f"{it.process.experiment} on {it.process.structure}"
        self.say(f"{name} did not end on machine {it.machine}: {why}")
        if len(tried) < TRIES:
            self.waiting.insert(0, it.process)
        else:
            self.failures.append(f"{name} did not end on {', '.join(tried)}: {why}")

    def next_for(self, machine: str, others: bool) -> Process | None:
        """A task for a machine: one it has begun, else one it has not failed at.

        ``others``: whether there are other machines, to leave the rest to.
        """
        fresh = [it for it in self.waiting if machine not in self.tries.get(it, ())]
        begun = [it for it in fresh if self.file(it, machine).exists()]
        choice = begun or fresh or ([] if others else self.waiting)
        return choice[0] if choice else None
