"""The study: what is measured, how it is judged, and the command line."""

from collections.abc import Collection, Iterable
from pathlib import Path


def carried(folder: str) -> Path:
    """A folder of the checkout that an installed wheel carries with it, such as ``notebooks``."""
    here = Path(__file__).parent
    installed = here / "carried" / folder
    return installed if installed.is_dir() else here.parent / folder


def require_known(kind: str, names: Iterable[str], known: Collection[str]) -> None:
    """Raise ValueError, with the names that there are, for one that is not among them."""
    for name in names:
        if name not in known:
            raise ValueError(f"no {kind} is called {name!r}; there are {', '.join(known)}")
