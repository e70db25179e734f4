"""Docstrings as Markdown: drawings behind a double colon and sessions become blocks of code, and
names with words beside them a list.
"""

from __future__ import annotations

import re
from typing import Any

from griffe import Attribute, Extension, Module, Object

from experiments.report.figures.records import fenced

ROW = re.compile(r"(?m)^([\w`, …]+?) {2,}(?=\S)")
LONGEST = 400  # characters of a value that is shown
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

    def on_attribute(self, *, attr: Attribute, **_: Any) -> None:
        """A value that is a long table is left to its description."""
        if len(str(attr.value)) > LONGEST:
            attr.value = None

    def on_module(self, *, mod: Module, **_: Any) -> None:
        """A function with its file's name is also listed in the rooms where the file hides it."""
        room: Any = mod.parent
        while mod.name in mod.members and room and mod.name in (room.exports or ()):
            if room.imports.get(mod.name) != f"{room.path}.{mod.name}":  # not the file itself
                room.members[f"{mod.name}()"] = mod.members[mod.name]
            room = room.parent
