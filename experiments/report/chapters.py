"""The pages and the claims' figures of a report, made by a few processes at a time."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from threading import Thread
from typing import Any

from experiments.report.session import Session, share

PRELOADED = ["experiments.report.notebooks", "experiments.report.claim_figures"]
"""What takes long to import; the processes share it where the system can fork them."""


@contextmanager
def workers(session: Session) -> Iterator[ProcessPoolExecutor]:
    """Processes that know the run, one per core; an interrupt or an error ends them."""
    methods = multiprocessing.get_all_start_methods()
    context: Any = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if "forkserver" in methods:
        context.set_forkserver_preload(PRELOADED)
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(len(os.sched_getaffinity(0)), context, _begin, (session,))
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in set(multiprocessing.active_children()) - others:
            worker.terminate()
        raise
    pool.shutdown()


def bodies(pool: ProcessPoolExecutor, names: Iterable[str]) -> dict[str, Future[str]]:
    """Begin to execute these notebooks -> the bodies of their pages to come."""
    from experiments.report.notebooks import body

    return {name: pool.submit(body, name) for name in names}


def _begin(session: Session) -> None:
    """What a process does first. It ends with its parent, who alone hears an interrupt."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_parent, daemon=True).start()
    share(session)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent:
        parent.join()
        os._exit(1)
