"""Meshes kept on disk, so that what takes seconds to make is made once."""

import os
import tempfile
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from hem.meshes.triangles import TriangleMesh

FORMAT = 1


def cache_folder() -> Path:
    """Where meshes are kept: HEM_CACHE where it is set, else the user's cache folder."""
    from platformdirs import user_cache_path

    chosen = os.environ.get("HEM_CACHE")
    return Path(chosen) if chosen else user_cache_path("hem")


def cached(key: str, make: Callable[[], TriangleMesh]) -> TriangleMesh:
    """The mesh kept under `key`; else what `make` gives, and keep it.

    A file that is broken is made anew, and a folder that cannot be written costs only time: it
    warns and goes on. `key` must name everything that the mesh depends on but this file's FORMAT.
    """
    path = cache_folder() / f"{key}-v{FORMAT}.npz"
    try:
        with np.load(path, allow_pickle=False) as kept:
            return TriangleMesh(kept["points"], kept["triangles"])
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        mesh = make()
    try:
        _write(path, mesh)
    except OSError as error:
        warnings.warn(f"cannot keep a mesh in {path.parent}: {error}", stacklevel=2)
    return mesh


def _write(path: Path, mesh: TriangleMesh) -> None:
    """Written beside and renamed, so that no reader ever meets half a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=".npz")
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, points=mesh.points, triangles=mesh.triangles)
        os.replace(beside, path)
    except BaseException:
        os.unlink(beside)
        raise
