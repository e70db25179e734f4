"""The one door to pymeshlab, which runs in a process of its own: filters, and its file formats.

pymeshlab is under the GPL and optional: `pip install 'hem-mesh[study]'` brings it.
"""

import atexit
import os
import pickle
import re
import subprocess
import sys
import threading
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from hem.arrays import Indices
from hem.errors import MeshError
from hem.meshes import TriangleMesh

# Shared libraries that pymeshlab's wheel needs from the system (found with ldd), and the Debian
# and Ubuntu packages that hold them.
SYSTEM_LIBRARIES = {
    "libGL.so.1": "libgl1", "libOpenGL.so.0": "libopengl0", "libGLX.so.0": "libglx0",
    "libX11.so.6": "libx11-6", "libxcb.so.1": "libxcb1", "libgmp.so.10": "libgmp10",
}  # fmt: skip
_ALWAYS = ("libgl1", "libopengl0")
_ABSENT = re.compile(r"(lib[\w+-]+\.so[.\d]*): cannot open shared object file")


class MeshlabError(MeshError):
    """What pymeshlab said when it refused."""


class NoMeshlabError(MeshError):
    """There is no pymeshlab that could be used; the message says what to install."""


def apply(
    filter_name: str, mesh: TriangleMesh | None = None, /, percent: dict[str, float] | None = None,
    **parameters: Any,
) -> TriangleMesh:  # fmt: skip
    """What a filter of pymeshlab makes of `mesh`, or of nothing.

    `percent`: parameters in percent of the diagonal. Raises MeshError with pymeshlab's own words
    when the filter refuses, and NoMeshlabError where there is no pymeshlab.
    """
    given = {"percent": percent or {}, "parameters": parameters}
    try:
        points, triangles = _WORKER.ask("apply", name=filter_name, mesh=_arrays(mesh), **given)
    except MeshlabError as error:
        said = " ".join(error.reason.split())
        raise MeshError(f"pymeshlab's {filter_name} failed: {said}") from error
    kind = mesh.points.dtype if mesh else np.float32
    return TriangleMesh(points.astype(kind), triangles, kind)  # rounded, which nobody can change


def intersecting_faces(mesh: TriangleMesh) -> Indices:
    """(k,): the faces that other faces go through."""
    return _WORKER.ask("crossing", mesh=_arrays(mesh))


def distances(one: TriangleMesh, other: TriangleMesh, samples: int = 40_000) -> tuple[float, float]:
    """Hausdorff's and the root mean square, the larger way and both, in parts of the diagonal.

    Between so many points of each mesh, at its vertices first, and the other's surface.
    """
    meshes = [_arrays(one), _arrays(other)]
    return _WORKER.ask("distances", meshes=meshes, samples=samples)


def load_file(path: Path) -> tuple[Any, Any, int]:
    """The points and the triangles of a file, all its meshes as one. Raises MeshlabError.

    And how many of both pymeshlab has left out, as they are not finite or have a corner twice.
    """
    return _WORKER.ask("load", path=str(path))


def save_file(mesh: TriangleMesh, path: Path) -> None:
    """Write a mesh in the format of the path's extension. Raises MeshlabError."""
    _WORKER.ask("save", mesh=_arrays(mesh), path=str(path))


def installed_version() -> str:
    """Of pymeshlab. Raises NoMeshlabError where it is not installed."""
    try:
        return version("pymeshlab")
    except PackageNotFoundError as error:
        raise NoMeshlabError(_advice("it is not installed")) from error


def problem() -> str:
    """What keeps pymeshlab from loading, and what to install; empty where nothing does."""
    try:
        apply("create_cube")
    except NoMeshlabError as error:
        return error.reason
    return ""


def _arrays(mesh: TriangleMesh | None) -> Any:
    return None if mesh is None else (mesh.points, mesh.triangles)


class _Worker:
    """The process, begun when it is first asked, and anew when it has died."""

    def __init__(self) -> None:
        self._process: Any = None
        self._inherited: list[Any] = []
        self._lock = threading.Lock()

    def ask(self, what: str, **arguments: Any) -> Any:
        """The answer to a job. Raises MeshlabError, or NoMeshlabError."""
        with self._lock:
            try:
                self._process = self._process or _started()
                pickle.dump((what, arguments), self._process.stdin)
                self._process.stdin.flush()
                outcome, value = pickle.load(self._process.stdout)
            except (EOFError, OSError) as error:
                self.stop()
                raise MeshlabError("it died of this") from error
            except BaseException:  # an answer that nobody waits for any more must not come next
                self.stop()
                raise
        if outcome == "absent":
            raise NoMeshlabError(_advice(value))
        if outcome == "refused":
            raise MeshlabError(value)
        return value

    def stop(self) -> None:
        """End the process."""
        process, self._process = self._process, None
        if process:
            process.kill()
            process.communicate()

    def forget(self) -> None:
        """In a forked process, to which the other's process does not belong."""
        self._inherited.append(self._process)  # whoever closed its pipes would speak to it
        self._process, self._lock = None, threading.Lock()


def _started() -> Any:
    return subprocess.Popen(
        [sys.executable, "-P", str(Path(__file__).with_name("meshlab_worker.py"))],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        cwd=os.path.abspath(os.sep),
        start_new_session=True,  # an interrupt from the keyboard is the caller's
    )


_WORKER = _Worker()
atexit.register(_WORKER.stop)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_WORKER.forget)


def _advice(problem: str) -> str:
    """What to install, from the words of a failed import or of plug-ins that failed to load."""
    absent = list(dict.fromkeys(_ABSENT.findall(problem)))
    if not absent:
        return f"pymeshlab cannot be loaded ({problem}): pip install 'hem-mesh[study]' brings it"
    packages = dict.fromkeys([*_ALWAYS, *(SYSTEM_LIBRARIES.get(name, name) for name in absent)])
    return (
        f"pymeshlab cannot be loaded, for want of the system library {', '.join(absent)}; "
        f"on Debian or Ubuntu install it with: apt-get install {' '.join(packages)}"
    )
