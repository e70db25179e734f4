"""Studies of a few seconds for tests, and what to do to them."""

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from subprocess import PIPE, Popen

import psutil

from experiments.runs import CaseFile, study
from experiments.runs.store import case_files

PATIENCE_SECONDS = 300


class Recorder(study.Observer):
    """Keeps what is said, and calls ``measured`` if it is given."""

    def __init__(self, measured: Callable | None = None) -> None:
        self.said: list[str] = []
        self.measured = measured or super().measured

    def say(self, text: str) -> None:
        self.said.append(text)


def begin(root: Path, *experiments: str, structures=("indexed",), **more) -> Path:
    return study.begin("smoke", root, structures, experiments=experiments or ("memory",), **more)


def go_on(folder: Path, measured: Callable | None = None) -> list[str]:
    """Run what is left -> what was said."""
    observer = Recorder(measured)
    study.run(folder, observer)
    return observer.said


def in_new_process(script: str, folder: Path, *more: str, **how) -> Popen:
    """Run a script that knows a ``folder``, and may tell of a ``study`` by ``Prints()``."""
    begin = (
        "import sys, time; from pathlib import Path; folder = Path(sys.argv[1])\n"
        "from experiments.harness import Measurement\n"
        "from experiments.runs import CaseFile, cluster, store, study\n"
        "class Prints(study.Observer):\n"
        "    def measured(self, job, done): print(job, flush=True)\n"
    )
    command = [sys.executable, "-c", begin + script, str(folder), *more]
    return Popen(command, stdout=PIPE, stderr=PIPE, text=True, **how)


def samples(folder: Path) -> dict[str, list[float]]:
    """What is on disk, by case."""
    files = [CaseFile.at(path) for path in case_files(folder)]
    return {f"{it.path.stem} {key}": case.samples for it in files for key, case in it.cases.items()}


def workers_of(folder: Path) -> list[psutil.Process]:
    """Processes that measure into a folder."""
    running = psutil.process_iter(["cmdline", "status"])
    alive = (it for it in running if it.info["status"] != psutil.STATUS_ZOMBIE)
    return [it for it in alive if str(folder.resolve()) in "".join(it.info["cmdline"] or ())[-999:]]


def wait_for(what: Callable[[], object]) -> None:
    """Wait until something is so; as long as it takes on a busy machine."""
    until = time.monotonic() + PATIENCE_SECONDS
    while not what():
        assert time.monotonic() < until, "it did not happen"
        time.sleep(0.05)


def damage(path: Path, how: str) -> None:
    content = path.read_bytes()
    lines = content.splitlines(keepends=True)
    changed = {
        "truncated": content[: len(content) // 2],
        "emptied": b"",
        "overwritten": os.urandom(len(content)),
        "another number": content.replace(b'"samples":[1', b'"samples":[3'),
        "without its checksum": content.replace(b',"checksum":', b',"summary":'),
        "a line less": b"".join(lines[:1] + lines[2:]),
        "a list": b"[]\n",
        "joined with a copy": 2 * content,
    }[how]
    assert changed != content
    path.write_bytes(changed)
