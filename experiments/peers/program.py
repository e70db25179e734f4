"""Libraries in C++: one program, compiled where Debian's packages are, that measures itself.

It is timed inside, in loops of its own; Python gives it a mesh, and reads what it tells. The
Polygon Mesh Processing library (pmp) is not among them, as Debian has no package of it.
"""

import hashlib
import json
import re
import shutil
import subprocess
from functools import lru_cache, partial
from operator import itemgetter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from experiments.peers.peer import BATCHED, BUILD, SIX, Mesh, Peer
from hem.arrays import Array
from hem.contract import QUERIES
from hem.sources import cache_folder

SOURCE = Path(__file__).with_name("program.cpp")
COMPILER = "g++"
OPTIONS = ("-std=c++17", "-O3", "-DNDEBUG", "-march=native")
HEADERS = Path("/usr/include")
NEEDED = "CGAL/version.h", "OpenMesh/Core/System/config.h"  # of both, as it is one program
PACKAGES = "g++ libcgal-dev libopenmesh-dev"
LOOPS = (*(it for it in QUERIES if it != "edge_edges"), *BATCHED, *SIX, BUILD)
"""Neither library walks from an edge to those at its ends."""


@lru_cache(maxsize=1)
def compiled() -> Path:
    """The program, compiled in half a minute and kept; raises OSError with the compiler's words."""
    known = SOURCE.read_bytes() + " ".join(OPTIONS).encode()
    program = cache_folder() / f"peers-{hashlib.blake2b(known, digest_size=8).hexdigest()}"
    if not program.exists():
        program.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(dir=program.parent) as own:  # as others may compile it, too
            fresh = Path(own) / program.name
            command = [COMPILER, *OPTIONS, str(SOURCE), "-o", str(fresh), "-lOpenMeshCore"]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode:
                raise OSError(f"{SOURCE} cannot be compiled here:\n{done.stderr}")
            fresh.replace(program)
    return program


def tell(
    library: str, points: Array, triangles: Array, few: int = 0, rounds: int = 0, whole: int = 0
) -> dict[str, Any]:
    """What the program tells of a mesh, see ``program.cpp``; raises OSError where it ends."""
    with TemporaryDirectory() as folder:
        files = [Path(folder) / name for name in ("points", "triangles")]
        points.astype(np.float32).tofile(files[0])
        triangles.astype(np.int32).tofile(files[1])
        command = [*map(str, (compiled(), library, *files, few, rounds, whole))]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise OSError(f"ends with {done.returncode}: {done.stderr.strip()}")
    return dict(json.loads(done.stdout.splitlines()[-1]))


def header_version(header: str, pattern: str) -> str:
    """The version that a header names; empty where the program cannot be compiled."""
    if not (all((HEADERS / it).exists() for it in NEEDED) and shutil.which(COMPILER)):
        return ""
    if not (found := re.search(pattern, (HEADERS / header).read_text(errors="replace"))):
        return ""
    return found[1] if "." in found[1] else ".".join(f"{int(found[1], 16) >> 8:x}")


def peer(library: str, header: str, pattern: str, site: str, manual: str, more: str) -> Peer:
    """A library of the program, whose version a header names by a pattern."""
    tells = partial(tell, library)
    return Peer(
        f"{library} (C++)", PACKAGES, site, manual, more, build=tells,
        faces=itemgetter("faces"), weigh=itemgetter("bytes"), collapse=_collapsed,
        looped=tells, loops=LOOPS, told_version=partial(header_version, header, pattern),
    )  # fmt: skip


def _collapsed(m: Mesh) -> int:
    m["faces"] = m["left"]
    return int(m["collapsed"])
