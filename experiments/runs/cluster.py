"""A study spread over the machines of a Dask cluster.

A job, an experiment on a structure, is one task, so that the points of a curve are all measured on
the same machine. Workers are started with ``--resources machine=1``, one on each machine, so that a
machine has one task at a time; Dask places the tasks, and gives those of a lost worker to another.
What a machine has measured comes back job by job, into a folder of its own in the run.
"""

from __future__ import annotations

import os
import re
import socket
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from filelock import FileLock

from experiments.runs.compiling import compile_and_count
from experiments.runs.provenance import describe
from experiments.runs.store import META, CaseFile, cannot_write, case_files, read_meta, write_meta
from experiments.runs.study import Observer, StudyFailedError, finish, plan, prepared
from experiments.runs.worker import Job, end_of_log, log_of, perform
from hem.whole_files import write_whole

if TYPE_CHECKING:  # it is an extra
    from distributed import Client

ADDRESS = re.compile(r"[a-z]+://.+:\d+")
CONNECT_SECONDS = 10
LONELY_SECONDS = 60  # how long to wait for a machine when all are gone
VARIABLE = "HEM_MACHINE"
"""Environment variable of a worker that names its machine, if its host's name is not enough."""
TASK = {"resources": {"machine": 1}, "retries": 2, "pure": False}
START = "dask worker {} --nthreads 1 --resources machine=1"


class ClusterError(ValueError):
    """There is no such cluster, or its machines cannot measure; the message says what to do."""


@dataclass(frozen=True)
class Returned:
    """What a machine returns of a job: its file, the end of its log, and what machine it is."""

    content: bytes
    log: str
    about: dict[str, Any]


def require(address: str) -> None:
    """Raise ClusterError unless a study can be sent to ``address``."""
    if find_spec("distributed") is None:
        raise ClusterError(
            "--workers needs Dask, which is not installed; install it with: "
            "pip install 'hem-mesh[cluster]'"
        )
    with _client(address) as client:
        workers = client.scheduler_info(n_workers=-1)["workers"].values()
        if not any("machine" in worker["resources"] for worker in workers):
            raise ClusterError(
                f"{address} has no workers for it; on each machine start one with: "
                f"{START.format(address)}"
            )


def run(folder: Path, address: str, observer: Observer | None = None) -> None:
    """Measure what the folder lacks on the machines of a cluster, and mark the run finished.

    As ``study.run``; raises ClusterError if the cluster is not there.
    """
    observer = observer or Observer()
    with prepared(folder, observer.say), _client(address) as client, client.as_current():
        places = [folder, *folder.glob("machine-*/")]
        jobs = [job for job in plan(folder) if all(map(job.left, places))]
        commit = read_meta(folder)["commit"]
        running = {client.submit(measure_here, job, commit, **TASK): job for job in jobs}
        failures: list[str] = []
        try:
            while running:
                for future in _finished(client, list(running)):
                    failures += _take(folder, running.pop(future), future, observer)
        finally:
            client.cancel(list(running), force=True)
        if failures:
            raise StudyFailedError("\n\n".join(failures))
        finish(folder, together(folder))


def together(folder: Path) -> dict[str, Any]:
    """What measured a run: its one machine, or that there were several, whose times do not mix."""
    used = sorted({path.parent for path in case_files(folder)} - {folder})
    if len(used) == 1:
        return dict(read_meta(used[0])["machine"])
    names = [path.name.removeprefix("machine-") for path in used]
    return {"cpu": f"{len(names)} machines", "machines": names}


def measure_here(job: Job, commit: str) -> Returned:
    """Measure a job where this is called, on a worker of the cluster."""
    from distributed import get_worker

    worker: Any = get_worker()
    key = worker.get_current_task()
    tasks = worker.state.tasks
    return measure_alone(job, commit, lambda: key in tasks and tasks[key].state == "executing")


def measure_alone(job: Job, commit: str, wanted: Callable[[], bool]) -> Returned:
    """Measure a job in a folder of its own, while nothing else of this machine is measured.

    Raises ClusterError if other code runs here, or as soon as nobody wants the job any more.
    """
    host = os.environ.get(VARIABLE) or socket.gethostname()
    about = {**describe(job.options.preset), "host": host}
    if about["commit"] != commit:
        raise ClusterError(
            f"{host} runs commit {about['commit'][:12]}, the study {commit[:12]}: "
            "bring them to the same and resume"
        )

    def require_wanted(*_: Any) -> None:
        if not wanted():
            raise ClusterError(f"{job} is not wanted any more")

    lock = FileLock(Path(tempfile.gettempdir()) / f"hem-{host}.lock")
    with lock, tempfile.TemporaryDirectory(prefix="hem-") as name:
        place = Path(name)
        require_wanted()
        compile_and_count(place, [job], require_wanted, lambda *_: None)
        with closing(perform(place, [job])) as finished:
            for _ in finished:
                require_wanted()
        path = CaseFile(place, job.experiment, job.structure).path
        content = path.read_bytes() if path.exists() else b""
        return Returned(content, end_of_log(log_of(place, job)), about)


def _finished(client: Client, running: list[Any]) -> list[Any]:
    """What has ended, if anything. Raises ClusterError if all machines are gone."""
    from distributed import wait

    try:
        return list(wait(running, timeout=LONELY_SECONDS, return_when="FIRST_COMPLETED").done)
    except TimeoutError:
        if client.ncores():
            return []
        raise ClusterError("all machines are gone; start one and resume the run") from None


def _take(folder: Path, job: Job, future: Any, observer: Observer) -> list[str]:
    """Keep what a machine returned of a job -> why it failed, if it did."""
    if future.status != "finished":
        return [f"{job}: {future.exception()}"]
    returned: Returned = future.result()
    place = folder / f"machine-{returned.about['host']}"
    path = CaseFile(place, job.experiment, job.structure).path
    try:
        if not (place / META).exists():
            write_meta(place, returned.about)
        write_whole(path, returned.content)
    except OSError as error:
        raise cannot_write(path, error) from error
    left = job.left(place)
    observer.measured(job, len(job.ids) - len(left))
    return [f"{job}, {place.name}:\n{returned.log}"] if left else []


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
