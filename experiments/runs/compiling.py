"""Compiling and counting, before anything is timed, on all cores.

What is counted does not depend on what runs beside it. To compile, one case of each kind is run
once, on its smallest mesh, in a process per structure. Numba keeps what it compiles on disk, and a
stamp beside it says what was compiled of which sources.
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


def compile_and_count(
    folder: Path,
    jobs: Sequence[Job],
    compiled: Callable[[str, int, int], None],
    count: Callable[[list[Job], Event], None],
) -> None:
    """Compile what timed jobs need, and do those that only count, on all cores.

    ``compiled`` is told of each structure whose kernels are ready; ``count`` does the jobs of one
    structure, until the event is set. What cannot be compiled, its measurement will tell.
    """
    timed = [it for it in _by_structure(jobs, timed=True) if not _stamp(it).exists()]
    timed.sort(key=_urgency)
    stop = Event()
    with ThreadPoolExecutor(len(affinity.allowed()) or os.cpu_count()) as pool:
        running = {pool.submit(_compile, folder, group, stop): group for group in timed}
        counting = [pool.submit(count, group, stop) for group in _by_structure(jobs, timed=False)]
        try:
            for done, future in enumerate(as_completed(running), 1):
                _keep_stamp(future, _stamp(running[future]))
                compiled(running[future][0].structure, done, len(timed))
            for future in as_completed(counting):
                future.result()
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise


def _by_structure(jobs: Sequence[Job], timed: bool) -> list[list[Job]]:
    """The jobs that take times, or those that only count, a group per structure."""
    chosen = [job for job in jobs if job.timed == timed]
    names = dict.fromkeys(job.structure for job in chosen)
    return [[job for job in chosen if job.structure == name] for name in names]


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
