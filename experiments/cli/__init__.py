"""The command line: ``hem study``, ``table``, ``report``, ``meshes``, ``info``, ``fracture``,
``check``, ``baseline update``, ``history``, ``judge``.

A command imports what it needs when it is run, so that help and mistakes are quick.
"""

from importlib.metadata import version
from pathlib import Path
from typing import Annotated

try:
    import typer
    from typer import Option
except ModuleNotFoundError as error:  # the library alone was installed
    raise SystemExit("hem: the commands need more: pip install 'hem-mesh[study]'") from error

app.command()(advise)
app.command()(meshes)
app.command()(info)
app.command()(fracture)
app.add_typer(history, name="history")
app.command()(check)
app.command("judge")(judge_file)
app.add_typer(baseline_app, name="baseline")
app.add_typer(baseline_app, name="reference", hidden=True)

__all__ = ["app", "console", "errors"]
