"""A file is whole or as it was."""

import os
from pathlib import Path

import pytest

from hem.whole_files import append_whole, write_whole


def test_a_file_is_written_replaced_and_nothing_is_left_beside(tmp_path: Path) -> None:
    file = tmp_path / "new folder" / "file.txt"
    write_whole(file, "first\n")
    write_whole(file, "größer\n")
    assert file.read_bytes() == "größer\n".encode()
    write_whole(file, bytes(range(256)))
    assert file.read_bytes() == bytes(range(256))
    assert os.listdir(file.parent) == ["file.txt"]
    long = tmp_path / ("🐇" * 60 + ".txt")  # 244 bytes of the 255 that a name may have
    write_whole(long, "third")
    assert long.read_text() == "third"


@pytest.mark.skipif(os.name != "posix", reason="permissions and links as POSIX has them")
def test_a_file_that_is_replaced_keeps_its_permissions_and_its_links(tmp_path: Path) -> None:
    file, link = tmp_path / "file.txt", tmp_path / "link.txt"
    write_whole(file, "old")
    file.chmod(0o640)
    link.symlink_to(file)
    write_whole(link, "new")
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert file.stat().st_mode & 0o777 == 0o640


def test_what_fails_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "file.txt"
    write_whole(file, "old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_whole(file, "new")
    with file.open("ab", buffering=0) as opened, pytest.raises(OSError, match="No space left"):
        append_whole(opened, b"more", 3)
    assert file.read_text() == "old"
    assert os.listdir(tmp_path) == ["file.txt"]
