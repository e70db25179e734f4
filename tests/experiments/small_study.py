"""Studies of a few seconds for tests, and what to do to them."""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from experiments.runs import study

STRUCTURES = ["indexed"]


def begin(root: Path, **more) -> Path:
    return study.begin("smoke", root, STRUCTURES, **more)


def go_on(folder: Path, report: Callable = lambda process, done: None) -> list[str]:
    """Run what is left -> what was said."""
    said: list[str] = []
    study.run(folder, "smoke", report, STRUCTURES, say=said.append)
    return said


def samples(folder: Path) -> dict[str, list[float]]:
    """What is on disk, by case; every file must be whole."""
    found = {}
    for path in study.result_files(folder):
        content = study.read_json(path)
        owner = f"{content['experiment']}.{content['structure']}"
        found |= {f"{owner} {case['id']}": case["samples"] for case in content["cases"]}
    return found


def children_of(folder: Path) -> list[int]:
    """Processes that measure into a folder."""
    listed = subprocess.run(
        ["ps", "-eww", "-o", "pid,args"], capture_output=True, text=True, check=True
    )
    lines = [line for line in listed.stdout.splitlines() if f"--run {folder.resolve()}" in line]
    return [int(line.split()[0]) for line in lines if "defunct" not in line]


def wait_for(what: Callable[[], object], seconds: float = 30) -> None:
    until = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < until, "it did not happen"
        time.sleep(0.05)


def damage(path: Path, how: str) -> None:
    content = path.read_bytes()
    if how == "truncated":
        path.write_bytes(content[: len(content) // 2])
    elif how == "emptied":
        path.write_bytes(b"")
    elif how == "overwritten":
        path.write_bytes(os.urandom(len(content)))
    elif how == "another number":
        path.write_bytes(content.replace(b'"samples": [\n    1', b'"samples": [\n    3'))
    elif how == "without its checksum":
        bare = {key: value for key, value in json.loads(content).items() if key != "checksum"}
        path.write_text(json.dumps(bare))
    else:
        path.write_text("[]")
    assert path.read_bytes() != content
