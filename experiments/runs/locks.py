"""Who measures into a folder, so that no two do at once.

The lock is the operating system's: it goes when its process ends, however that was, so a lock file
that is left behind blocks nobody.
"""

from __future__ import annotations

import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from experiments.runs.storage import ResultsError, cannot_write

LOCK = ".lock"


class InUseError(ResultsError):
    """Another process measures into the folder."""


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Keep a run folder for this process. Raises InUseError naming the process that has it."""
    path = folder / LOCK
    try:
        file = path.open("a+")
    except OSError as error:
        raise cannot_write(path, error) from error
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InUseError(
                f"{folder} is being measured into by {_holder(file)}: wait until that has ended, "
                "or end it; or begin a run of its own with: hem study"
            ) from None
        _sign(file)
        yield
        file.truncate(0)


def _sign(file: TextIO) -> None:
    file.truncate(0)
    try:
        file.write(f"process {os.getpid()} on {socket.gethostname()}")
        file.flush()
    except OSError as error:
        raise cannot_write(Path(file.name), error) from error


def _holder(file: TextIO) -> str:
    file.seek(0)
    return file.read() or "another process"
