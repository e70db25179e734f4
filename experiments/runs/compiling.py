"""Compiling what a study needs, before anything is timed, on all cores.

One case of each kind is run once, on its smallest mesh, in a process per structure. Numba keeps
what it compiles on disk, and a stamp beside it says what was compiled of which sources.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import closing, suppress
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from threading import Event

import hem
import structures
from experiments import harness
from experiments.harness import BASE, affinity
from experiments.runs.worker import COMPILE, Job, WorkerDiedError, perform
from structures import REGISTRY

ROOTS = tuple(Path(str(it.__file__)).parent for it in (hem, structures, harness))


def compile_kernels(
    folder: Path, jobs: Sequence[Job], compiled: Callable[[str, int, int], None]
) -> None:
    """Compile what jobs need and what is not compiled yet, and tell ``compiled`` of each structure.

    What cannot be compiled is left to be told by its measurement.
    """
    names = dict.fromkeys(job.structure for job in jobs)
    groups = [[job for job in jobs if job.structure == name] for name in names]
    groups = sorted((it for it in groups if not _stamp(it).exists()), key=_urgency)
    stop = Event()
    with ThreadPoolExecutor(len(affinity.allowed()) or os.cpu_count()) as pool:
        running = {pool.submit(_compile, folder, group, stop): group for group in groups}
        try:
            for done, future in enumerate(as_completed(running), 1):
                _keep_stamp(future, _stamp(running[future]))
                compiled(running[future][0].structure, done, len(groups))
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise


def _urgency(jobs: list[Job]) -> tuple[bool, bool]:
    """First what the others are compared with, so that it is not compiled many times over.

    What is not compiled comes next, which leaves it time.
    """
    structure = REGISTRY.get(jobs[0].structure)
    return jobs[0].structure != BASE, structure is not None and structure.compiled


def _compile(folder: Path, jobs: list[Job], stop: Event) -> None:
    with closing(perform(folder, jobs, COMPILE)) as finished:
        for _ in finished:
            if stop.is_set():
                return


def _keep_stamp(future: Future[None], stamp: Path) -> None:
    with suppress(WorkerDiedError, OSError):
        future.result()
        stamp.touch()


def _stamp(jobs: list[Job]) -> Path:
    """The file that is there if what jobs of one structure need was compiled of these sources."""
    text = " ".join([jobs[0].structure, *(job.experiment for job in jobs)])
    digest = hashlib.blake2b(_sources() + text.encode(), digest_size=8).hexdigest()
    return ROOTS[0] / "__pycache__" / f"compiled-{digest}"


@lru_cache(maxsize=1)
def _sources() -> bytes:
    """A digest of everything that is compiled, and of what compiles it."""
    files = [path for root in ROOTS for path in sorted(root.rglob("*.py"))]
    content = b"".join(path.read_bytes() for path in files)
    where = os.environ.get("NUMBA_CACHE_DIR", "")
    return hashlib.blake2b(content + f"{version('numba')} {where}".encode()).digest()
