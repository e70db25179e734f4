"""The one door to pymeshlab: importing it, keeping it quiet, and meshes going in and out."""

import contextlib
import ctypes
import io
import os
from collections.abc import Iterator
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from hem.errors import MeshError
from hem.mesh import TriangleMesh

# Shared libraries that pymeshlab's wheel needs from the system (found with ldd), and the Debian
# and Ubuntu packages that hold them.
SYSTEM_LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libGLU.so.1": "libglu1-mesa",
    "libOpenGL.so.0": "libopengl0",
    "libEGL.so.1": "libegl1",
    "libGLX.so.0": "libglx0",
    "libX11.so.6": "libx11-6",
    "libxcb.so.1": "libxcb1",
    "libgomp.so.1": "libgomp1",
    "libgmp.so.10": "libgmp10",
}
_ALWAYS = ("libgl1", "libopengl0")
_NEEDED_FILTERS = {"create_torus", "create_implicit_surface", "meshing_repair_non_manifold_edges"}


@cache
def meshlab() -> ModuleType:
    """The pymeshlab module. ImportError names the system packages to install where some lack."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), undisturbed():
            import pymeshlab
    except ImportError as error:
        raise ImportError(_advice(str(error))) from error
    # pymeshlab imports even when its plug-ins cannot be loaded; it prints a warning then.
    plugins_lack = "libio_base" in said.getvalue()
    if plugins_lack or not set(pymeshlab.filter_list()) >= _NEEDED_FILTERS:
        raise ImportError(_advice(said.getvalue().strip()))
    module: ModuleType = pymeshlab
    return module


def mesh_set(mesh: TriangleMesh | None = None) -> Any:
    """A pymeshlab MeshSet, holding `mesh` where one is given."""
    module = meshlab()
    found = module.MeshSet(verbose=False)
    if mesh is not None:
        points = mesh.points.astype(np.float64)
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
    if "No module named" in problem:
        return f"{problem}; install it with: python -m pip install pymeshlab"
    lacking = [package for library, package in SYSTEM_LIBRARIES.items() if library in problem]
    packages = " ".join(dict.fromkeys((*_ALWAYS, *lacking)))
    return (
        f"pymeshlab cannot be loaded: {problem}. It needs system libraries that are missing here; "
        f"on Debian or Ubuntu install them with: apt-get install {packages}"
    )
