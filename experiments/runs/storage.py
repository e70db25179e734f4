"""Files of a run: written whole or not at all, sealed with a checksum, set aside when damaged."""

from __future__ import annotations

import errno
import hashlib
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

SEAL = "checksum"
"""The key under which a file carries the checksum of everything else in it."""

MEND = {
    errno.ENOSPC: "make room there",
    errno.EDQUOT: "make room there",
    errno.EFBIG: "allow for larger files there",
    errno.EROFS: "choose another folder, or make this one writable",
    errno.EACCES: "choose another folder, or make this one writable",
    errno.EPERM: "choose another folder, or make this one writable",
    errno.ENOTDIR: "choose another folder: a file is in its place",
    errno.EEXIST: "choose another folder: a file is in its place",
}


class ResultsError(ValueError):
    """A run folder is missing, incomplete, damaged, in use or of another schema."""


class DamagedError(ResultsError):
    """A file of a run is not what was written."""


class CannotWriteError(OSError):
    """A file of a run cannot be written; the message says which, why, and what to do."""


def write_json(path: Path, content: Any) -> None:
    """Write beside and rename: at any time the file is whole, as it was or as it will be.

    Raises CannotWriteError, and leaves the file as it was.
    """
    write_text(path, json.dumps(content, indent=1))


def write_text(path: Path, text: str) -> None:
    """As ``write_json``, what is JSON already."""
    beside = path.with_suffix(".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with beside.open("w") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    except OSError as error:
        with suppress(OSError):
            beside.unlink()
        raise cannot_write(path, error) from error


def cannot_write(path: Path, error: OSError) -> CannotWriteError:
    """What to raise for an error at writing ``path``."""
    what_to_do = MEND.get(error.errno or 0, "see to the disk")
    return CannotWriteError(f"{path} cannot be written ({error.strerror}): {what_to_do}")


def write_sealed(path: Path, content: dict[str, Any]) -> None:
    """As ``write_json``, with the checksum of the content in it."""
    bare = {key: value for key, value in content.items() if key != SEAL}
    write_json(path, {**bare, SEAL: checksum(bare)})


def read_json(path: Path) -> dict[str, Any]:
    """Read a file of a run. Raises DamagedError naming the file unless it is as it was written.

    A file without a checksum, as older versions wrote them, is only seen to be whole.
    """
    try:
        content = json.loads(path.read_bytes())
        if not isinstance(content, dict):
            raise ValueError("it holds no object")
        if SEAL in content and content[SEAL] != checksum(content):
            raise ValueError("its checksum does not fit")
    except (OSError, ValueError, RecursionError) as error:
        raise DamagedError(f"{path} cannot be read: {error}. {_way_out(path)}") from error
    return content


def checksum(content: dict[str, Any]) -> str:
    """The checksum of everything but the seal itself: 32 hexadecimal digits."""
    bare = {key: value for key, value in content.items() if key != SEAL}
    text = json.dumps(bare, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def set_aside(path: Path) -> Path:
    """Rename a damaged file so that no run is read from it -> where it is kept."""
    names = (path.with_name(f"{path.name}.damaged{k or ''}") for k in range(1_000))
    kept = next(name for name in names if not name.exists())
    try:
        path.rename(kept)
    except OSError as error:
        raise cannot_write(path, error) from error
    return kept


def again(path: Path) -> str:
    """The command that measures again what a file of a run should hold."""
    folder = path.parent.parent if path.parent.name.startswith("machine-") else path.parent
    return f"hem study --resume --run {folder}"


def _way_out(path: Path) -> str:
    if path.name == "run.json":
        return f"Move {path.parent} away, or put back a copy of that file"
    return f"Set it aside and measure its cases again with: {again(path)}"
