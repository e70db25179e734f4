"""Meshes kept on disk, so that what takes seconds to make is made once."""

import io
import os
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from hem.meshes import TriangleMesh
from hem.whole_files import write_whole

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
    except Exception:  # a broken file can raise whatever zipfile and NumPy have, and be no archive
        mesh = make()
    content = io.BytesIO()
    np.savez(content, points=mesh.points, triangles=mesh.triangles)
    try:
        write_whole(path, content.getvalue())
    except OSError as error:
        warnings.warn(f"cannot keep a mesh in {path.parent}: {error}", stacklevel=2)
    return mesh
