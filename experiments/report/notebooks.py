"""Notebooks: found, executed in this process, and turned into the bodies of pages.

No kernels: to start one and import everything anew takes longer than most chapters.
"""

import sys
from base64 import b64encode
from functools import cache
from pathlib import Path
from typing import Any

import nbformat
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from nbconvert import HTMLExporter
from traitlets.config import Config

from experiments import carried
from experiments.report.session import LACKING
from experiments.runs import ResultsError

FRONT = "index"  # the notebook of the front page


@cache
def page_titles() -> dict[str, str]:
    """The titles of pages by notebook, in reading order; ResultsError where one has none."""
    found = {}
    for path in carried("notebooks").glob("*.ipynb"):
        about = read(path.stem).metadata
        if not {"title", "order"} <= set(about) or not isinstance(about["order"], int | float):
            raise ResultsError(f"{path}: its metadata has to give a title, and a number as order")
        found[about["order"], path.stem] = about["title"]
    return {name: title for (_, name), title in sorted(found.items())}


def read(name: str) -> Any:
    """A notebook that is a page, by its name. Raises ResultsError for a file that is none."""
    path = carried("notebooks") / f"{name}.ipynb"
    try:
        return nbformat.read(path, as_version=4)
    except Exception as error:  # of several kinds, as it is damaged
        raise ResultsError(f"{path} is no notebook: {error}") from error


def body(name: str) -> str:
    """Execute a notebook -> its page's body, without code. ResultsError names it if one fails."""
    execute(notebook := read(name), name)
    places = [str(Path(__file__).parent / "templates")]
    look: dict[str, Any] = {"template_name": "chapter", "extra_template_basedirs": places}
    return str(HTMLExporter(**look, exclude_anchor_links=True).from_notebook_node(notebook)[0])


def execute(notebook: Any, name: str) -> dict[str, Any]:
    """Run every cell into the notebook -> what they named; one that lacks something says so."""
    InteractiveShell.clear_instance()
    shell: Any = InteractiveShell.instance(config=Config({"HistoryManager": {"enabled": False}}))
    heading = name
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = _outputs(shell, cell.source, heading, name)
        else:
            heads = [line.strip("# ") for line in cell.source.splitlines() if line[:1] == "#"]
            heading = [heading, *heads][-1]
    return dict(shell.user_ns)


def _outputs(shell: Any, source: str, heading: str, name: str) -> list[Any]:
    with capture_output() as captured:
        shell.display_trap.hook = sys.displayhook  # the value of a cell is captured, too
        done = shell.run_cell(source)
    error = done.error_before_exec or done.error_in_exec
    outputs = [_output(shown.data, shown.metadata, heading) for shown in captured.outputs]
    if captured.stdout and not error:
        outputs.append(nbformat.v4.new_output("stream", text=captured.stdout))
    if isinstance(error, LACKING):
        missing = {"metadata": {"missing": True}, "data": {"text/plain": str(error)}}
        outputs.append(nbformat.v4.new_output("display_data", **missing))
    elif error:
        what = f"{type(error).__name__}: {error}"
        raise ResultsError(f"notebooks/{name}.ipynb cannot report this run: {what}") from error
    return outputs


def _output(data: Any, metadata: Any, heading: str) -> Any:
    """A displayed value as a notebook keeps it; a picture has the alternative text it needs."""
    metadata, texts = dict(metadata or {}), dict(data)
    for kind, value in data.items():
        if kind.startswith("image/"):
            shown = metadata.get(kind, {})
            more = shown.get("alt", "").strip(" :")
            metadata[kind] = shown | {"alt": f"{heading}. {more}".strip()}
        if isinstance(value, bytes):
            texts[kind] = b64encode(value).decode()
    return nbformat.v4.new_output("display_data", data=texts, metadata=metadata)
