"""A study spread over the machines of a Dask cluster.

A process of the study, an experiment on a structure, is one task, so that the points of a curve are
all measured on the same machine. Each machine has one task at a time, and a folder of its own in
the run. What a machine has finished comes back case by case; a task whose machine is lost goes to
another one.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Any

from experiments.runs.cluster_work import Running, Work
from experiments.runs.machine_task import Outcome, Task, perform, who
from experiments.runs.provenance import source
from experiments.runs.results import read_json, result_files, write_sealed
from experiments.runs.study import (
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
        work = Work(folder, how(folder), report, say)
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


def _spread(client: Client, work: Work) -> None:
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


def _look_after(work: Work, it: Running, workers: set[str]) -> None:
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


def _submit(client: Client, work: Work, process: Process, machine: str, worker: str) -> Running:
    task = work.task(process, machine)
    future = client.submit(
        measured_here, task, machine, work.topic, workers=[worker], pure=False, retries=0
    )
    return Running(process, machine, worker, future)


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


def _machines(client: Client, work: Work, known: dict[str, str]) -> dict[str, str]:
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
