"""A study spread over the machines of a Dask cluster.

A process of the study, an experiment on a structure, is one task, so that the points of a curve are
all measured on the same machine. Each machine has one task at a time, and a folder of its own in
the run. What a machine has finished comes back cell by cell; a task whose machine is lost goes to
another one.
"""

from __future__ import annotations

import re
import warnings
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from importlib.util import find_spec
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Any

from experiments.children import CANNOT_WRITE, How
from experiments.machine_task import Outcome, Task, perform, who
from experiments.provenance import source
from experiments.results import read_json, result_files, write_sealed
from experiments.stored import write_text
from experiments.study import (
    Process,
    Report,
    StudyFailedError,
    finish,
    how,
    prepared,
    processes,
)

if TYPE_CHECKING:
    from distributed import Client

TRIES = 3
"""On how many machines a task is tried that does not end."""

ADDRESS = re.compile(r"[a-z]+://.+:\d+")
CONNECT_SECONDS = 10
POLL_SECONDS = 0.25
LONELY_SECONDS = 60
"""How long to wait for a machine when all are gone."""


class ClusterError(ValueError):
    """There is no such cluster, or its machines cannot measure; the message says what to do."""


def require(address: str) -> None:
    """Raise ClusterError unless a study can be sent to ``address``."""
    if find_spec("distributed") is None:
        raise ClusterError(
            "--workers needs Dask, which is not installed; install it with: "
            "pip install 'hem[cluster]'"
        )
    with _client(address) as client:
        if not client.ncores():
            raise ClusterError(
                f"{address} has no workers; on each machine start one with: dask worker {address}"
            )


def run(
    folder: Path,
    profile: str,
    address: str,
    report: Report,
    structures: Sequence[str] = (),
    say: Callable[[str], None] = warnings.warn,
) -> None:
    """Run what the folder lacks on the machines of a cluster, and mark it finished.

    As ``study.run``, and raises ClusterError if the cluster is not there, or runs other code.
    """
    with prepared(folder, say), _client(address) as client:
        work = _Work(folder, how(folder), report, say)
        work.add(processes(profile, structures))
        client.subscribe_topic(work.topic, work.hear)
        try:
            _spread(client, work)
        finally:
            client.cancel([it.future for it in work.running.values()], force=True)
            client.unsubscribe_topic(work.topic)
        if work.failures:
            raise StudyFailedError("\n\n".join(work.failures))
        finish(folder, together(folder))


def together(folder: Path) -> dict[str, Any]:
    """What measured a run: its one machine, or that there were several, whose times do not mix."""
    used = sorted({path.parent for path in result_files(folder)} - {folder})
    if len(used) == 1:
        return dict(read_json(used[0] / "run.json")["machine"])
    names = [path.name.removeprefix("machine-") for path in used]
    return {"cpu": f"{len(names)} machines", "machines": names}


@contextmanager
def _client(address: str) -> Iterator[Client]:
    from distributed import Client

    try:
        if not ADDRESS.fullmatch(address):
            raise ValueError("no address")
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(
            f"no cluster answers at {address}: start one with: dask scheduler, "
            "and give the address that it prints, tcp://host:port"
        ) from error
    try:
        yield client
    finally:
        client.close(timeout=CONNECT_SECONDS)


@dataclass(frozen=True)
class _Running:
    """A task on its way."""

    process: Process
    machine: str
    worker: str
    future: Any


@dataclass
class _Work:
    """What is to be done, what is on its way, and what came back."""

    folder: Path
    how: How
    report: Report
    say: Callable[[str], None]
    waiting: list[Process] = field(default_factory=list)
    running: dict[str, _Running] = field(default_factory=dict)
    tries: dict[Process, list[str]] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    news: deque[tuple[str, str, str, str]] = field(default_factory=deque)

    @property
    def topic(self) -> str:
        """Where machines tell of cells as they finish them."""
        return f"hem-{self.folder.name}"

    def add(self, every: list[Process]) -> None:
        """Everything that is not complete on any machine."""
        for process in every:
            done = max(process.done(place) for place in self.places())
            self.report(process, done)
            if done < len(process.cells):
                self.waiting.append(process)

    def places(self) -> list[Path]:
        """The folders with results: the run's own, and its machines'."""
        return [self.folder, *sorted(self.folder.glob("machine-*/"))]

    def file(self, process: Process, machine: str) -> Path:
        """Where the cells of a process on a machine are kept."""
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

    def ended(self, it: _Running, outcome: Outcome) -> None:
        """Keep what a task leaves; what is not complete has failed."""
        if outcome.text is not None:
            self.keep(it.process, it.machine, outcome.text)
        if it.process.done(self.file(it.process, it.machine).parent) == len(it.process.cells):
            self._supersede(it)
        elif outcome.code == CANNOT_WRITE:
            self.lost(it, f"it has no room for results: {outcome.output}")
        else:
            name = f"{it.process.experiment} on {it.process.structure}, {it.machine}"
            self.failures.append(f"{name}:\n{outcome.output}")

    def _supersede(self, it: _Running) -> None:
        """Leave one machine's results of a process, so that no curve is of two machines."""
        mine = self.file(it.process, it.machine)
        for place in self.places():
            other = place / mine.name
            if other != mine and other.exists():
                other.rename(other.with_name(f"{other.name}.superseded"))

    def lost(self, it: _Running, why: str) -> None:
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


def _spread(client: Client, work: _Work) -> None:
    """Keep every machine at one task until there are none left."""
    known: dict[str, str] = {}
    seen = monotonic()
    while work.waiting or work.running:
        workers = _machines(client, work, known)
        work.keep_news()
        seen = monotonic() if workers else seen
        if monotonic() - seen > LONELY_SECONDS:
            raise ClusterError("all machines of the cluster are gone; start one and resume the run")
        for it in list(work.running.values()):
            _look_after(work, it, set(workers.values()))
        for machine, worker in workers.items():
            process = None
            if machine not in work.running:
                process = work.next_for(machine, others=len(workers) > 1)
            if process:
                work.waiting.remove(process)
                work.running[machine] = _submit(client, work, process, machine, worker)
        sleep(POLL_SECONDS)


def _look_after(work: _Work, it: _Running, workers: set[str]) -> None:
    """Take what a task gave, if it has ended or its worker is lost."""
    if it.future.status == "pending" and it.worker in workers:
        return
    if it.future.status == "finished":
        work.ended(it, it.future.result())
    else:
        gone = it.worker not in workers
        error = None if gone else it.future.exception(timeout=CONNECT_SECONDS)
        it.future.cancel(force=True)
        work.lost(it, "its worker was lost" if gone else repr(error))
    del work.running[it.machine]


def _submit(client: Client, work: _Work, process: Process, machine: str, worker: str) -> _Running:
    task = work.task(process, machine)
    future = client.submit(
        measured_here, task, machine, work.topic, workers=[worker], pure=False, retries=0
    )
    return _Running(process, machine, worker, future)


def measured_here(task: Task, machine: str, topic: str) -> Outcome:
    """Run a task where this is called, a worker of the cluster."""
    from distributed import get_worker

    worker: Any = get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        state = worker.state.tasks.get(key)
        return state is not None and state.state == "executing"

    def send(text: str) -> None:
        worker.log_event(topic, (machine, task.experiment, task.structure, text))

    return perform(task, machine, wanted, send)


def _machines(client: Client, work: _Work, known: dict[str, str]) -> dict[str, str]:
    """By machine one of its workers, the same as before where it is still there.

    ``known``: by worker its machine; new ones are asked who they are and get a folder.
    """
    workers = list(client.ncores())
    new = [worker for worker in workers if worker not in known]
    answers = client.run(who, work.how.profile, workers=new, on_error="return") if new else {}
    for worker, answer in answers.items():
        if isinstance(answer, OSError):
            continue  # it is gone again
        _require_same_code(worker, answer)
        known[worker] = answer["digest"]
        path = work.folder / f"machine-{answer['digest']}" / "run.json"
        if not path.exists():
            write_sealed(path, {**answer["about"], **asdict(work.how)})
    here = {known[worker]: worker for worker in reversed(workers) if worker in known}
    return here | {it.machine: it.worker for it in work.running.values() if it.worker in workers}


def _require_same_code(worker: str, answer: Any) -> None:
    if isinstance(answer, Exception):
        raise ClusterError(
            f"the worker {worker} cannot measure ({answer!r}): install there what is installed here"
        )
    mine, its = _named(source()), _named(answer["about"])
    if its != mine:
        raise ClusterError(
            f"the worker {worker} runs commit {its}, here it is {mine}: "
            "bring them to the same and begin again"
        )


def _named(about: dict[str, Any]) -> str:
    return str(about["commit"])[:12] + (" with changes" if about["dirty"] else "")
