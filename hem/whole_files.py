"""Files that are whole or not there, and lines that are appended whole or not at all."""

import os
import secrets
import shutil
from contextlib import suppress
from io import RawIOBase
from pathlib import Path


def write_whole(path: str | os.PathLike[str], content: str | bytes) -> None:
    """Put a file in place, or replace the one there, so that no reader ever meets half of it.

    Text is written as UTF-8, with its line ends as they are; the folder is made if need be. A file
    that is replaced keeps its permissions, and a link goes on leading to it. When this returns, the
    content is on the disk. Raises OSError, and leaves what was there as it was.
    """
    target = Path(os.path.realpath(path))
    target.parent.mkdir(parents=True, exist_ok=True)
    beside = target.with_name(f".{target.name[:40]}-{secrets.token_hex(4)}.part")
    try:
        with beside.open("xb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, beside)
        beside.replace(target)
    except BaseException:
        with suppress(OSError):
            beside.unlink()
        raise


def append_whole(file: RawIOBase, content: bytes, before: int) -> None:
    """Append to an open file of ``before`` bytes, and have it on the disk.

    Raises OSError, and leaves the file as it was.
    """
    try:
        while content:
            content = content[file.write(content) :]
        os.fsync(file.fileno())
    except OSError:
        with suppress(OSError):
            file.truncate(before)
        raise
