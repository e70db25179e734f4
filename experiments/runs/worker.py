"""One process of a study: an experiment on a structure, measured by a pytest of its own."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from threading import Thread

POLL_SECONDS = 0.25
PATIENCE_SECONDS = 5
LINES_KEPT = 15

CANNOT_WRITE = 74
"""Exit code of a process that could not keep its results; then no other can, either."""

DEFAULT_SEED = 1
DIE_WITH_PARENT = 1
"""PR_SET_PDEATHSIG of Linux."""


@dataclass(frozen=True)
class How:
    """How a study measures: its profile, the seed of its order, and whether on one core."""

    profile: str
    seed: int = DEFAULT_SEED
    pin: bool = True


def measure(
    folder: Path, experiment: str, structure: str, how: How, poll: Callable[[], None]
) -> tuple[int, str]:
    """Measure what ``folder`` lacks of one process -> exit code, and the end of what it printed.

    ``poll()`` is called a few times a second. Whatever it raises, KeyboardInterrupt above all, ends
    the process before it goes on.
    """
    file = Path(str(import_module(f"experiments.{experiment}").__file__))
    command = [sys.executable, "-m", "pytest", str(file), "-q", "--no-header", "--tb=short"]
    command += ["-p", "no:cacheprovider", "--benchmark-quiet", "--profile", how.profile]
    command += ["--structure", structure, "--run", str(folder.resolve())]
    command += ["--study", str(os.getpid()), "--case-seed", str(how.seed)]
    command += ["--pin"] if how.pin else []
    with _started(command, file.parent.parent) as child:
        log = _Log(child, folder / "logs" / f"{experiment}.{structure}.txt")
        for _ in _until_it_ends(child):
            poll()
        return child.returncode, log.end()


def end_with(study: int) -> None:
    """Have this process ended as soon as the study that started it is gone; Linux only."""
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(DIE_WITH_PARENT, signal.SIGKILL)
    if os.getppid() != study:
        raise SystemExit("the study that began this was killed")


@contextmanager
def _started(command: list[str], cwd: Path) -> Iterator[subprocess.Popen[str]]:
    """A process that does not outlive the block."""
    child = subprocess.Popen(
        command, cwd=cwd, env=_own(), text=True, errors="replace",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    try:
        yield child
    finally:
        _end(child)


def _end(child: subprocess.Popen[str]) -> None:
    if child.poll() is None:
        child.terminate()
        try:
            child.wait(PATIENCE_SECONDS)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()


class _Log:
    """What a process prints: in a file as far as there is room for it, its end in memory."""

    def __init__(self, child: subprocess.Popen[str], path: Path) -> None:
        self._last: deque[str] = deque(maxlen=LINES_KEPT)
        self._reader = Thread(target=self._read, args=(child, path), daemon=True)
        self._reader.start()

    def end(self) -> str:
        self._reader.join(PATIENCE_SECONDS)
        return "".join(self._last)

    def _read(self, child: subprocess.Popen[str], path: Path) -> None:
        output = iter(child.stdout or ())
        with suppress(OSError):
            path.parent.mkdir(exist_ok=True)
            with path.open("w", buffering=1) as file:
                for line in output:
                    self._last.append(line)
                    file.write(line)
        self._last.extend(output)


def _own() -> dict[str, str]:
    """The environment without what concerns another pytest, which might turn measuring off."""
    return {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}


def _until_it_ends(child: subprocess.Popen[str]) -> Iterator[None]:
    while True:
        try:
            child.wait(POLL_SECONDS)
        except subprocess.TimeoutExpired:
            yield
        else:
            return
