"""What a library does to its process: the bytes it takes, and what it makes of bad input.

Each is asked in a process of its own, as some end it: ``python -m experiments.peers.trials``.
"""

import ctypes
import gc
import json
import os
import re
import signal
import subprocess
import sys
from contextlib import suppress
from functools import lru_cache
from textwrap import shorten
from typing import Any, NamedTuple

import numpy as np
import psutil

import hem
from experiments.harness import CheckFailedError, check_rows
from experiments.peers.outcome import as_given
from experiments.peers.peer import BYTES, Mesh, Peer
from experiments.peers.registry import PEERS
from hem.arrays import Array
from hem.contract import QUERIES

PATIENCE = 120
"""Seconds after which a process that says nothing is given up."""
SMALL_PAGES = {"NUMPY_MADVISE_HUGEPAGE": "0"}
"""A page of 2 MB counts as a whole however little of it is used: by them ours weighed 123 to 162
bytes per vertex."""
MARK = "told: "
"""What a line begins with that is not a library's own."""

WORDS = 160
"""Characters kept of what is said."""

STRIP = 5
CORNERS = np.stack([np.cos(np.arange(STRIP)), np.sin(np.arange(STRIP)), np.arange(STRIP) % 2], 1)
TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


class Bad(NamedTuple):
    """What a mesh of triangles cannot be, or must not become: ``collapse`` its first edge."""

    title: str
    triangles: list[tuple[int, int, int]]
    collapse: bool = False


BAD_INPUT = {
    "three_faces": Bad("Three at an edge", [(0, 1, 2), (1, 0, 3), (0, 1, 4)]),
    "two_fans": Bad("Two fans", [(0, 1, 2), (0, 3, 4)]),
    "moebius": Bad("Möbius strip", [(i, (i + 1) % 5, (i + 2) % 5) for i in range(STRIP)]),
    "tetrahedron": Bad("Tetrahedron", TETRAHEDRON, True),
}
"""By name. In the strip of five triangles the last joins the first turned over."""


def give(peer: Peer, bad: Bad) -> tuple[str, str]:
    """Whether a library refuses bad input, and its words or what came of it."""
    triangles = np.array(bad.triangles, np.int32)
    points = CORNERS[: triangles.max() + 1].astype(np.float64)
    try:
        m = peer.build(points, triangles)
        if not bad.collapse:
            return _held(peer, m, triangles)
        if peer.collapse:
            done = peer.collapse(m)
        elif operate := peer.operations.get("collapse_edge"):
            done = operate(m, peer.handles(m, "edge", [0]), points[:1])
        else:
            return "N/A", "collapses no edges"
        left = f"faces left: {peer.faces(m)}"
        return ("accepted", left) if done else ("refused", "by its own test")
    except Exception as error:
        words = f"{type(error).__name__}: {_plain(str(error))}"
        return "refused", shorten(words, WORDS, placeholder=" …")


def _held(peer: Peer, m: Mesh, triangles: Array) -> tuple[str, str]:
    """Whether what was accepted is all there, and answers as the triangle list does."""
    kept, given = peer.faces(m), len(triangles)
    if kept != given:
        return "changed", f"{kept} of {given} faces are there"
    numbers = np.arange(triangles.max() + 1)
    handles = peer.handles(m, "vertex", numbers.tolist())
    for query in ("vertex_faces", "vertex_vertices"):
        if ask := peer.single.get(query):
            try:
                answers = [*map(ask(m), handles)]
                check_rows(peer.title, QUERIES[query], triangles, numbers, answers)
            except CheckFailedError:
                return "changed", f"all faces are there, and {query} leaves some out"
    return "accepted", "all faces are there"


def _plain(words: str) -> str:
    """Words without colors, and without where in a C++ source they were said."""
    uncolored = re.sub(r"\x1b\[[\d;]*m", "", words)
    return " ".join(re.sub(r"^.*\.cpp:\d+: ", "", uncolored, flags=re.DOTALL).split())


def weigh(peer: Peer, points: Array, triangles: Array) -> int:
    """Bytes by which the process grows that builds a mesh: of its own, not shared (USS)."""
    process = psutil.Process()
    small = hem.generate("torus", 400)
    peer.build(*as_given(small))  # loads it all
    before = _own_bytes(process)
    kept = peer.build(points.copy(), triangles.copy())  # who keeps these has them weighed
    grown = _own_bytes(process) - before
    return peer.weigh(kept) if peer.weigh else grown


def _own_bytes(process: psutil.Process) -> int:
    """What a process shares with no other, once what was freed is given back where that goes."""
    gc.collect()
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
    return int(process.memory_full_info().uss)


@lru_cache
def told_by_child(name: str, family: str, size: int) -> dict[str, Any]:
    """What processes of their own tell of a library: the ``BYTES`` of a mesh, None if it ended;
    and by name what becomes of each bad input, ``("ended", how)`` where the process did.
    """
    told: dict[str, Any] = {}
    own = os.environ | SMALL_PAGES
    left = [f"{BYTES} {family} {size}", *BAD_INPUT]
    while left:
        command = [sys.executable, "-m", __name__, name, *left]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=PATIENCE, env=own
            )
            lines, code = done.stdout.splitlines(), done.returncode
            how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        except subprocess.TimeoutExpired as error:
            lines, how = bytes(error.stdout or b"").decode().splitlines(), "it said nothing more"
        told |= dict(json.loads(line[len(MARK) :]) for line in lines if line.startswith(MARK))
        left = [task for task in left if task.split()[0] not in told]
        if left:
            lost, *_ = left.pop(0).split()
            told[lost] = None if lost == BYTES else ("ended", how)
    return told


def main(name: str, *tasks: str) -> None:
    """Print what becomes of each task, a line of JSON each."""
    peer = PEERS[name]
    for task, *about in map(str.split, tasks):
        if task == BYTES:
            mesh = hem.generate(about[0], int(about[1]))
            found: Any = weigh(peer, *as_given(mesh))
        else:
            found = give(peer, BAD_INPUT[task])
        print(MARK + json.dumps([task, found]), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
