"""The study: what is measured, how it is judged, and the command line."""

from pathlib import Path


def carried(folder: str) -> Path:
    """A folder of the checkout that an installed wheel carries with it, such as ``notebooks``."""
    here = Path(__file__).parent
    installed = here / "carried" / folder
    return installed if installed.is_dir() else here.parent / folder
