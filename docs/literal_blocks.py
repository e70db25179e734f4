"""Docstrings as Markdown: drawings behind a double colon and sessions become blocks of code, and
names with words beside them a list.
"""

from __future__ import annotations

import re
from typing import Any

from griffe import Extension, Module, Object

from experiments.report.figures.records import fenced

ROW = re.compile(r"(?m)^([\w`, …]+?) {2,}(?=\S)")
SESSION = re.compile(r"(?m)^(>>> .*\n?(?:^(?!\s*$).*\n?)*)")


class LiteralBlocks(Extension):
    """Rewrites every docstring, as soon as its object is there."""

    def on_instance(self, *, obj: Object, **_: Any) -> None:
        """Fence its blocks."""
        if obj.docstring:
            text = fenced(obj.docstring.value + "\n")
            text = ROW.sub(r"- \1: ", text)
            text = SESSION.sub(lambda it: f"```pycon\n{it[1].rstrip()}\n```\n", text)
            obj.docstring.value = text

    def on_package(self, *, pkg: Module, **_: Any) -> None:
        """What a package offers type checkers alone is public where it is imported on first use."""
        if not pkg.exports:
            own = (it for it in pkg.members.values() if it.is_alias)
            pkg.exports = [it.name for it in own if it.target_path.startswith(f"{pkg.path}.")]
