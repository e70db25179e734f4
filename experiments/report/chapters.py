"""The chapters of the report: the notebooks, run on a run folder."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager
from html import escape, unescape
from pathlib import Path

from experiments import carried
from experiments.runs.results import ResultsError

NOTEBOOKS = carried("notebooks")
CHAPTERS = {
    "comparison_table": "The comparison table",
    "query_scaling": "How queries scale",
    "memory": "Memory",
    "operations": "Operations",
    "half_edge_or_indexed": "Half-edge or indexed?",
    "references_and_pairs": "References, indices and pairs",
    "errata": "What the listings do",
    "fracture": "Destruction",
    "regression": "From commit to commit",
    "accuracy": "How far to trust it",
}
"""The notebooks in the order they are read. A new chapter is one notebook and one line here."""

AT_ONCE = 2
"""Notebooks that run beside each other."""

QUIET = ["--IPKernelApp.log_level=40"]  # no warnings about how a local kernel is talked to

RUN_VARIABLE = "HEM_RUN"
"""The environment variable that tells a notebook which run to read."""


def bodies(run_folder: Path) -> dict[str, str]:
    """Run every notebook -> the bodies of their pages.

    In a thread with a loop of its own, as a notebook from which this is called has one already. An
    interrupt cancels what runs there, which ends the kernels, before it goes on.
    """
    loop = asyncio.new_event_loop()
    everything = loop.create_task(_all(run_folder))
    with (
        closing(loop),
        _environment(RUN_VARIABLE, str(run_folder.resolve())),
        ThreadPoolExecutor(1) as pool,
    ):
        running = pool.submit(loop.run_until_complete, everything)
        try:
            return running.result()
        finally:
            loop.call_soon_threadsafe(everything.cancel)


async def _all(run_folder: Path) -> dict[str, str]:
    places = asyncio.Semaphore(AT_ONCE)

    async def chapter(name: str) -> str:
        async with places:
            return await _chapter(name, run_folder)

    try:
        async with asyncio.TaskGroup() as group:
            tasks = {name: group.create_task(chapter(name)) for name in CHAPTERS}
    except ExceptionGroup as failed:
        raise failed.exceptions[0] from None
    return {name: task.result() for name, task in tasks.items()}


async def _chapter(name: str, run_folder: Path) -> str:
    """Run a notebook -> the body of its page, without its code."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError
    from nbconvert import HTMLExporter

    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    client = NotebookClient(
        notebook, timeout=300, kernel_name="python3", extra_arguments=QUIET,
        shutdown_kernel="immediate",
    )  # fmt: skip
    try:
        await client.async_execute(cwd=str(NOTEBOOKS))
    except CellExecutionError as error:
        what = f"{error.ename}: {error.evalue}"
        raise ResultsError(f"notebooks/{name}.ipynb cannot read {run_folder}: {what}") from error
    exporter = HTMLExporter(template_name="basic", exclude_input=True, exclude_output_prompt=True)
    body = _described(exporter.from_notebook_node(notebook)[0])
    # Claims, whose keys have a slash, are on the front page.
    return re.sub(r'href="#([\w.-]+/)', r'href="index.html#\1', body)


def _described(body: str) -> str:
    """A chapter in which every picture is described by the heading that it stands under."""
    heading = ""
    parts = re.split(r"(<h[1-6].*?</h[1-6]>)", body, flags=re.DOTALL)
    for i, part in enumerate(parts):
        if i % 2:
            heading = escape(unescape(re.sub(r"<[^>]*>|¶", "", part)).strip())
        parts[i] = re.sub(r'alt="No description[^"]*"', f'alt="Plot: {heading}"', part)
    return "".join(parts)


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
