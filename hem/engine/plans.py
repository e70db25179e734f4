"""The plans of algorithms, by classes that every process has.

Numba keeps machine code by the types that it is for. A class of a script, or of a notebook, is
another one in every process: each would compile anew, and leave a file that nobody reads. This
module has a class of the same fields, made when it is first asked for by its name.
"""

from __future__ import annotations

import sys
from collections import namedtuple
from functools import cache
from typing import Any

CALLED = "Plan of "


def everywhere(plan: Any) -> Any:
    """The plan itself, where another process finds its class, or the same of one that it finds."""
    kind: Any = type(plan)
    found = _found_everywhere(kind)
    return plan if found is kind else found(*map(everywhere, plan))


@cache
def _found_everywhere(kind: Any) -> Any:
    home = sys.modules.get(kind.__module__)  # there is none where text is run under a made-up name,
    if home is None or not hasattr(kind, "_fields"):  # and Numba looks for it to load kernels
        return kind
    if kind.__module__ != "__main__" and getattr(home, kind.__qualname__, None) is kind:
        return kind
    return getattr(sys.modules[__name__], CALLED + " ".join(kind._fields))


def __getattr__(name: str) -> Any:
    if not name.startswith(CALLED):
        raise AttributeError(name)
    fields = name.removeprefix(CALLED).split()
    made: Any = namedtuple("Plan", fields, rename=True)  # type: ignore[misc]
    made.__module__, made.__qualname__ = __name__, name
    return globals().setdefault(name, made)
