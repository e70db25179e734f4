"""The one door to pymeshlab: importing it, keeping it quiet, and meshes going in and out."""

import contextlib
import ctypes
import io
import os
import re
from collections.abc import Iterator
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from hem.errors import MeshError
from hem.meshes.polygons import PolygonMesh
from hem.meshes.triangles import TriangleMesh

# Shared libraries that pymeshlab's wheel needs from the system (found with ldd), and the Debian
# and Ubuntu packages that hold them.
SYSTEM_LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libOpenGL.so.0": "libopengl0",
    "libGLX.so.0": "libglx0",
    "libX11.so.6": "libx11-6",
    "libxcb.so.1": "libxcb1",
    "libgmp.so.10": "libgmp10",
}
_ALWAYS = ("libgl1", "libopengl0")
_ABSENT = re.compile(r"(lib[\w+-]+\.so[.\d]*): cannot open shared object file")


def meshlab() -> ModuleType:
    """The pymeshlab module. ImportError names the system packages to install where some lack."""
    module, problem = _imported()
    if module is None:
        raise ImportError(problem)
    return module


def problem() -> str:
    """What keeps pymeshlab from loading, and what to install; empty where nothing does."""
    return _imported()[1]


@cache
def _imported() -> tuple[ModuleType | None, str]:
    """The module, or what is wrong with it."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), undisturbed():
            import pymeshlab
    except ImportError as error:
        return None, _advice(str(error))
    # Plug-ins that cannot be loaded are only printed; without this one there are no file formats.
    broken = "libio_base.so" in said.getvalue()
    return (None, _advice(said.getvalue())) if broken else (pymeshlab, "")


def mesh_set(mesh: TriangleMesh | PolygonMesh | None = None) -> Any:
    """A pymeshlab MeshSet, holding `mesh` where one is given."""
    module = meshlab()
    found = module.MeshSet(verbose=False)
    if mesh is not None:
        points = mesh.points.astype(np.float64)
        if isinstance(mesh, PolygonMesh):
            faces = [np.array(face, np.int32) for face in mesh.faces]
            found.add_mesh(module.Mesh(vertex_matrix=points, face_list_of_indices=faces))
        else:
            found.add_mesh(module.Mesh(points, mesh.triangles.astype(np.int32)))
    return found


def apply(filter_name: str, mesh: TriangleMesh | None = None, /, **parameters: Any) -> TriangleMesh:
    """What a filter of pymeshlab makes of `mesh`, or of nothing.

    Raises MeshError with pymeshlab's own words when the filter refuses.
    """
    meshes = mesh_set(mesh)
    try:
        with undisturbed():
            meshes.apply_filter(filter_name, **parameters)
    except meshlab().PyMeshLabException as error:
        raise MeshError(
            f"pymeshlab's {filter_name} failed: {' '.join(str(error).split())}"
        ) from error
    current = meshes.current_mesh()
    return TriangleMesh(current.vertex_matrix(), current.face_matrix())


@contextlib.contextmanager
def undisturbed() -> Iterator[None]:
    """Keep pymeshlab from writing to standard output and from changing the current folder.

    Some filters report progress with printf, past pymeshlab's own verbosity and past sys.stdout,
    so the file descriptor itself is pointed elsewhere. Loading and saving leave the process in the
    file's folder. Both concern the whole process: not for threads that print or open files.
    """
    folder = os.getcwd()
    flush = ctypes.CDLL(None if os.name == "posix" else "ucrtbase").fflush
    flush(None)
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.chdir(folder)
        flush(None)
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def _advice(problem: str) -> str:
    """What to install, from the words of a failed import or of plug-ins that failed to load."""
    absent = list(dict.fromkeys(_ABSENT.findall(problem)))
    if not absent:
        return f"pymeshlab cannot be loaded: {problem}; python -m pip install pymeshlab brings it"
    packages = dict.fromkeys([*_ALWAYS, *(SYSTEM_LIBRARIES.get(name, name) for name in absent)])
    return (
        f"pymeshlab cannot be loaded, for want of the system library {', '.join(absent)}; "
        f"on Debian or Ubuntu install it with: apt-get install {' '.join(packages)}"
    )
