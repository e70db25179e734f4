"""The six algorithms of Sieger & Botsch (2011) beside CGAL's and OpenMesh's C++, in one run.

``make peers-cpp`` compiles ``peers.cpp`` and runs this, where Debian's g++, libcgal-dev and
libopenmesh-dev are installed. One thread against one thread, in seconds of the processor, so other
programs on the machine make the least difference.
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import thread_time

import numpy as np
from numba import config
from rich.console import Console
from rich.table import Table

import hem
import structures
from hem.algorithms import SIX

PACKAGES = ("g++", "libcgal-dev", "libopenmesh-dev")
COMPILE = ("g++", "-std=c++17", "-O3", "-DNDEBUG", "-march=native")
SIZES = (100_000, 1_000_000)
ROUNDS = 5

Seconds = dict[str, dict[str, float]]
"""By library or structure, then by algorithm: the least of all rounds."""


def compile_peers(folder: Path) -> Path:
    """The program, compiled. Ends the process with a word on what is missing where it cannot be."""
    program, source = folder / "peers", Path(__file__).with_name("peers.cpp")
    needed = f"install {', '.join(PACKAGES)} (apt-get install {' '.join(PACKAGES)})"
    if not shutil.which(COMPILE[0]):
        sys.exit(f"peers-cpp: there is no C++ compiler here; {needed}")
    command = [*COMPILE, str(source), "-o", str(program), "-lOpenMeshCore"]
    compiled = subprocess.run(command, capture_output=True, text=True)
    if compiled.returncode:
        sys.exit(
            f"peers-cpp: the C++ libraries cannot be compiled here; {needed}\n{compiled.stderr}"
        )
    return program


def time_ours(original: structures.Structure) -> dict[str, float]:
    """One round of each algorithm, each on a copy."""
    seconds = {}
    for name, algorithm in SIX.items():
        s = original.copy()
        begin = thread_time()
        algorithm(s)
        seconds[name] = thread_time() - begin
    return seconds


def compare(program: Path, vertices: int) -> Seconds:
    """Rounds of theirs and of ours in turn, on a torus."""
    mesh, least = hem.generate("torus", vertices), Seconds()
    files = [program.with_name(name) for name in ("points", "triangles")]
    mesh.points.astype(np.float32).tofile(files[0])
    mesh.triangles.astype(np.int32).tofile(files[1])
    ours = {
        name: structures.build(name, mesh)
        for name, it in structures.REGISTRY.items()
        if it.compiled and not it.searches and not it.rebuilds
    }
    for name, s in ours.items():
        s.vertex_faces(0)  # makes the scratch
        time_ours(structures.build(name, hem.generate("torus", 1_000)))  # compiles
    for _ in range(ROUNDS):
        measured: Seconds = json.loads(subprocess.check_output([program, *files, "1"]))
        measured |= {name: time_ours(s) for name, s in ours.items()}
        for name, seconds in measured.items():
            known = least.setdefault(name, seconds)
            least[name] = {it: min(known[it], seconds[it]) for it in SIX}
    return least


def print_seconds(vertices: int, least: Seconds) -> None:
    """Nanoseconds per vertex, and how many times faster than CGAL that is."""
    title = f"Torus of {vertices:,} vertices: ns per vertex (times faster than CGAL)"
    table = Table("", *SIX, title=title, title_justify="left")
    for name, seconds in least.items():
        cells = [
            f"{1e9 * seconds[it] / vertices:,.0f} ({least['CGAL'][it] / seconds[it]:.2f})"
            for it in SIX
        ]
        table.add_row(name, *cells)
    Console().print(table)


def main() -> None:
    """Compile, compare at every size, and print a table after each."""
    config.NUMBA_NUM_THREADS = 1
    with TemporaryDirectory() as folder:
        program = compile_peers(Path(folder))
        for vertices in SIZES:
            print_seconds(vertices, compare(program, vertices))


if __name__ == "__main__":
    main()
