"""What tables and plots say of a structure: its names, its look, and what is claimed of it."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar


@dataclass(frozen=True)
class Look:
    """A line in every plot. The colors differ in lightness, so that they can be told in gray."""

    color: str
    """As ``#e69f00``."""

    marker: str
    line: str
    """Both as Matplotlib has them: ``o``, ``--``."""


@dataclass(frozen=True)
class Claims:
    """What is claimed of the costs of a structure that the thesis does not print.

    ``costs``: the class by query or operation, such as ``{"vertex_faces": "O(n_ev)"}``; what is
    not in it is not claimed. ``like``: another structure of which the same is claimed, but for the
    bytes.
    """

    source: str
    costs: Mapping[str, str] = field(default_factory=dict)
    like: str = ""


class Described:
    """Something with a name in tables and plots.

    A class that forgets a part is a TypeError when it is made; ``abstract=True`` for those that
    leave the parts to others.
    """

    name: ClassVar[str]
    """As in commands and files: ``half_edge``."""

    title: ClassVar[str]
    abbreviation: ClassVar[str]
    look: ClassVar[Look]
    thesis: ClassVar[bool] = False
    """Whether the thesis' table 1 prints it; its claims are those of the table then."""

    claims: ClassVar[Claims]
    order: ClassVar[int] = 1000
    """Its place in tables, after those of the thesis."""

    def __init_subclass__(cls, abstract: bool = False) -> None:
        super().__init_subclass__()
        if abstract:
            return
        parts = ("name", "title", "abbreviation", "look")
        missing = [it for it in parts if not hasattr(cls, it)]
        if not cls.thesis and not hasattr(cls, "claims"):
            missing.append("claims")
        if missing:
            raise TypeError(f"{place_of(cls)} does not say: {', '.join(missing)}")


def place_of(cls: type) -> str:
    """Where a class stands, for errors: its file and its name."""
    try:
        return f"{inspect.getfile(cls)}: {cls.__name__}"
    except (OSError, TypeError):
        return cls.__name__
