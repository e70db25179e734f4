"""What a machine of a cluster does: one process of a study at a time, and hands back its file."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import socket
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import sleep
from typing import Any

from experiments.runs import worker
from experiments.runs.provenance import describe
from experiments.runs.results import ResultFile
from experiments.runs.worker import How

VARIABLE = "HEM_MACHINE"
"""Environment variable of a worker that tells machines apart which look alike."""

WAIT_SECONDS = 0.25


class AbandonedError(RuntimeError):
    """Whoever asked for a task does not want it any more."""


@dataclass(frozen=True)
class Task:
    """A process to run: ``text`` is its file as far as it was measured on this machine before."""

    experiment: str
    structure: str
    how: How
    text: str | None = None


@dataclass(frozen=True)
class Outcome:
    """What a task leaves: its file, and the exit code and the end of what it printed."""

    text: str | None
    code: int
    output: str


def who(profile: str) -> dict[str, Any]:
    """Which machine it is: ``digest``, eight digits, other ones on each, and what ``about`` it."""
    about = describe(profile)
    name = os.environ.get(VARIABLE) or socket.gethostname()
    known = json.dumps([name, about["machine"]], sort_keys=True)
    digest = hashlib.sha256(known.encode()).hexdigest()[:8]
    return {"digest": digest, "about": {**about, "host": name}}


def perform(
    task: Task, digest: str, wanted: Callable[[], bool], send: Callable[[str], None]
) -> Outcome:
    """Run a task in a folder of its own; no other one of this machine runs meanwhile.

    ``wanted()`` is asked a few times a second, AbandonedError raised as soon as it is not, and
    ``send(text)`` is given the file each time there is another case in it.
    """

    def require_wanted() -> None:
        if not wanted():
            raise AbandonedError(f"{task.experiment} on {task.structure} is not wanted any more")

    with _alone(digest, require_wanted), tempfile.TemporaryDirectory(prefix="hem-") as place:
        path = ResultFile(Path(place), task.experiment, task.structure).path
        if task.text is not None:
            path.write_text(task.text)
        sent = task.text

        def poll() -> None:
            nonlocal sent
            require_wanted()
            text = path.read_text() if path.exists() else None
            if text is not None and text != sent:
                send(text)
                sent = text

        measured = worker.measure(Path(place), task.experiment, task.structure, task.how, poll)
        return Outcome(path.read_text() if path.exists() else None, *measured)


@contextmanager
def _alone(digest: str, waiting: Callable[[], None]) -> Iterator[None]:
    """Wait until no other task measures on this machine, whichever study it belongs to."""
    with (Path(tempfile.gettempdir()) / f"hem-machine-{digest}.lock").open("w") as file:
        while True:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                waiting()
                sleep(WAIT_SECONDS)
        yield
