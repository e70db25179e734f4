"""Notebooks: found, executed in this process, and turned into the bodies of pages.

No kernels: to start one and import everything anew takes longer than most chapters.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import nbformat
from IPython.core.displayhook import DisplayHook
from IPython.core.displaypub import CapturingDisplayPublisher
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from nbconvert import HTMLExporter
from traitlets import Type
from traitlets.config import Config

from experiments import carried
from experiments.report.session import MissingError
from experiments.runs import ResultsError

HERE = Path(__file__).parent
FRONT = "index"
"""The notebook of the front page."""


@cache
def page_titles() -> dict[str, str]:
    """The titles of the pages by the name of their notebook, in the order they are read.

    Both stand in the notebook's metadata. Raises ResultsError for a notebook without them.
    """
    found = {}
    for path in carried("notebooks").glob("*.ipynb"):
        about = nbformat.read(path, as_version=4).metadata
        if not {"title", "order"} <= set(about):
            raise ResultsError(f"{path}: its metadata has to give a title and an order")
        found[about["order"], path.stem] = about["title"]
    return {name: title for (_, name), title in sorted(found.items())}


def body(name: str) -> str:
    """Execute a notebook -> the body of its page, without its code.

    Raises ResultsError naming the notebook if a cell fails.
    """
    notebook = nbformat.read(carried("notebooks") / f"{name}.ipynb", as_version=4)
    execute(notebook, name)
    exporter = HTMLExporter(
        template_name="chapter",
        extra_template_basedirs=[str(HERE / "templates")],
        exclude_anchor_links=True,
    )
    return str(exporter.from_notebook_node(notebook)[0])


def execute(notebook: Any, name: str) -> None:
    """Run every cell; its outputs go into the notebook, pictures described by their heading.

    A cell that lacks a measurement or a package says so and the next one is run.
    """
    _Shell.clear_instance()
    shell: Any = _Shell.instance(config=Config({"HistoryManager": {"enabled": False}}))
    heading = name
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            lines = [line for line in cell.source.splitlines() if line.startswith("#")]
            heading = lines[-1].strip("# ") if lines else heading
        elif cell.cell_type == "code":
            cell.outputs = _outputs(shell, cell.source, heading, name)


class _Hook(DisplayHook):
    """Publishes the value of a cell instead of printing it."""

    shell: Any

    def __call__(self, result: Any = None) -> None:
        if result is not None:
            self.shell.display_pub.publish(*self.shell.display_formatter.format(result))


class _Shell(InteractiveShell):
    """An interpreter that collects what cells show."""

    displayhook_class = Type(_Hook)
    display_pub_class = Type(CapturingDisplayPublisher)


def _outputs(shell: Any, source: str, heading: str, name: str) -> list[Any]:
    shell.display_pub.outputs = []
    with capture_output(display=False) as printed:
        done = shell.run_cell(source)
    error = done.error_before_exec or done.error_in_exec
    outputs = [_output(**shown, heading=heading) for shown in shell.display_pub.outputs]
    if printed.stdout and not error:
        outputs.append(nbformat.v4.new_output("stream", text=printed.stdout))
    if isinstance(error, MissingError):
        outputs.append(nbformat.v4.new_output("display_data", {"text/plain": str(error)}))
        outputs[-1].metadata["missing"] = True
    elif error:
        what = f"{type(error).__name__}: {error}"
        raise ResultsError(f"notebooks/{name}.ipynb cannot report this run: {what}") from error
    return outputs


def _output(data: Any, metadata: Any, heading: str, **_: Any) -> Any:
    """A displayed value as a notebook keeps it; a picture has the alternative text it needs."""
    metadata = dict(metadata or {})
    for kind in {"image/jpeg", "image/png", "image/svg+xml"} & set(data):
        metadata[kind] = {"alt": f"Plot: {heading}", **metadata.get(kind, {})}
    return nbformat.v4.new_output("display_data", data=_text(data), metadata=metadata)


def _text(data: Any) -> Any:
    from base64 import b64encode

    return {
        kind: b64encode(value).decode() if isinstance(value, bytes) else value
        for kind, value in data.items()
    }
