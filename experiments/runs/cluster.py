"""A study spread over the machines of a Dask cluster.

A job is one task, so that a curve is measured on one machine. A machine's worker is started with
``--resources machine=1``, and has one task at a time; Dask gives those of a lost one to another.
"""

import os
import re
import socket
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from filelock import FileLock

from experiments.runs import study
from experiments.runs.provenance import describe
from experiments.runs.run import load
from experiments.runs.store import META, read_meta, write_meta, writing
from experiments.runs.worker import Job, end_of_log, perform
from hem.whole_files import write_whole

ADDRESS = re.compile(r"[a-z]+://.+:\d+")
CONNECT_SECONDS = 10
VARIABLE = "HEM_MACHINE"  # names a worker's machine, if its host's name is not enough
TASK = {"resources": {"machine": 1}, "retries": 2, "pure": False}
WAIT = {"timeout": 60, "return_when": "FIRST_COMPLETED"}  # and so long if all machines are gone

Returned = tuple[bytes, str, dict[str, Any]]
"""What a machine returns of a job: its file, the end of its log, and what machine it is."""


class ClusterError(ValueError):
    """There is no such cluster, or its machines cannot measure; the message says what to do."""


def require(address: str) -> None:
    """Raise ClusterError unless a study can be sent to ``address``."""
    if find_spec("distributed") is None:
        how = "install it with: pip install 'hem-mesh[cluster]'"
        raise ClusterError(f"--workers needs Dask, which is not installed; {how}")
    with _client(address) as client:
        workers = client.scheduler_info(n_workers=-1)["workers"].values()
        if not any("machine" in worker["resources"] for worker in workers):
            how = f"start one with: dask worker {address} --nthreads 1 --resources machine=1"
            raise ClusterError(f"{address} has no workers for it; on each machine {how}")


def run(folder: Path, address: str, observer: study.Observer | None = None) -> None:
    """Measure what the folder lacks on a cluster, as ``study.run``; ClusterError if none is."""
    from distributed import wait

    observer = observer or study.Observer()
    with (
        study.prepared(folder, observer.say, True),
        _client(address) as client,
        client.as_current(),
    ):
        places = [folder, *folder.glob("machine-*/")]
        jobs = [job for job in study.plan(folder) if all(map(job.left, places))]
        commit = read_meta(folder)["commit"]
        running = {client.submit(measure_here, job, commit, **TASK): job for job in jobs}
        failures: list[str] = []
        try:
            while running:
                try:
                    ended = wait(list(running), **WAIT)
                except TimeoutError:
                    if client.ncores():
                        continue
                    gone = "all machines are gone; start one and resume the run"
                    raise ClusterError(gone) from None
                for future in ended.done:
                    failures += _take(folder, running.pop(future), future, observer)
        finally:
            client.cancel(list(running), force=True)
        if failures:
            raise study.StudyFailedError("\n\n".join(failures))
        used = [folder / it for it in sorted(set(load(folder).cases["machine"]))]
        names = [str(read_meta(it).get("host", "where it was begun")) for it in used]
        several = {"cpu": f"{len(names)} machines", "machines": names}  # whose times do not mix
        study.finish(folder, read_meta(used[0])["machine"] if len(used) == 1 else several)


def measure_here(job: Job, commit: str) -> Returned:
    """Measure a job where this is called, on a worker of the cluster."""
    from distributed import get_worker

    worker = get_worker()
    key, tasks = worker.get_current_task(), worker.state.tasks
    return measure_alone(job, commit, lambda: key in tasks and tasks[key].state == "executing")


def measure_alone(job: Job, commit: str, wanted: Callable[[], bool]) -> Returned:
    """Measure a job alone here; ClusterError if other code runs here, or nobody wants the job."""
    host = os.environ.get(VARIABLE) or socket.gethostname()
    about = {**describe(job.preset), "host": host}
    if about["commit"] != commit:
        differ = f"{host} runs commit {about['commit'][:12]}, the study {commit[:12]}"
        raise ClusterError(f"{differ}: bring them to the same and resume")

    def require_wanted(*_: Any) -> None:
        if not wanted():
            raise ClusterError(f"{job} is not wanted any more")

    lock = FileLock(Path(tempfile.gettempdir()) / f"hem-{host}.lock")
    with lock, tempfile.TemporaryDirectory(prefix="hem-") as name:
        place = Path(name)
        require_wanted()
        study.compile_and_count(place, [job], require_wanted, lambda *_: None)
        with closing(perform(place, [job])) as finished:
            for _ in finished:
                require_wanted()
        path = job.file(place).path
        content = path.read_bytes() if path.exists() else b""
        return content, end_of_log(place, job), about


def _take(folder: Path, job: Job, future: Any, observer: study.Observer) -> list[str]:
    """Keep what a machine returned of a job -> why it failed, if it did."""
    if future.status != "finished":
        return [f"{job}: {future.exception()}"]
    content, log, about = future.result()
    place = folder / f"machine-{about['host']}"
    if not (place / META).exists():
        write_meta(place, about)
    path = job.file(place).path
    with writing(path):
        write_whole(path, content)
    left = job.left(place)
    observer.measured(job, len(job.ids) - len(left))
    return [f"{job}, {place.name}:\n{log}"] if left else []


@contextmanager
def _client(address: str) -> Iterator[Any]:
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
