"""Things that go by a name, or by a number."""

import difflib
import operator
from collections.abc import Mapping
from typing import Any, TypeVar

from hem.errors import MeshError

T = TypeVar("T")


def look_up(name: str, known: Mapping[str, T], kind: str) -> T:
    """What has this name. Raises MeshError with the names there are, and the nearest one."""
    if isinstance(name, str) and name in known:
        return known[name]
    near = difflib.get_close_matches(str(name), known, n=1)
    meant = f"; did you mean {near[0]!r}?" if near else ""
    raise MeshError(f"no {kind} {name!r} (there are {', '.join(known)}){meant}")


def whole(given: Any, what: str) -> int:
    """An integer as Python's own, which does not overflow. Raises MeshError for what is none."""
    try:
        return operator.index(given)
    except TypeError:
        raise MeshError(f"{what} is an integer, not {given!r}") from None
