"""The process in which pymeshlab runs: jobs come in, and what became of them goes out.

pymeshlab prints past sys.stdout, changes the current folder, and some broken files kill it; here it
does so to nobody else. Nothing of hem is imported. A job is (what, arguments), its answer
("done" | "refused" | "absent", value), both pickled.
"""

import contextlib
import io
import os
import pickle
import re
import sys
import tempfile
from collections.abc import Callable
from itertools import chain
from typing import Any

import numpy as np


def main() -> None:
    """Answer jobs until there are no more."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    problem = import_problem()
    while True:
        try:
            what, arguments = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        pickle.dump(("absent", problem) if problem else answer(what, arguments), answers)
        answers.flush()


def import_problem() -> str:
    """Why pymeshlab cannot be used; empty if it can."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said):
            import pymeshlab  # noqa: F401
    except ImportError as error:
        return str(error) or "it cannot be imported"
    # Plug-ins that cannot be loaded are only printed; without this one there are no file formats.
    return said.getvalue() if "libio_base.so" in said.getvalue() else ""


def answer(what: str, arguments: dict[str, Any]) -> tuple[str, Any]:
    """What pymeshlab makes of one job, or says to it."""
    import pymeshlab

    try:
        return "done", JOBS[what](pymeshlab, **arguments)
    except pymeshlab.PyMeshLabException as error:
        return "refused", str(error)


def apply(
    pymeshlab: Any, name: str, mesh: Any, percent: dict[str, float], parameters: dict[str, Any]
) -> tuple[Any, Any]:
    """The points and triangles that a filter makes."""
    shares = {key: pymeshlab.PercentageValue(value) for key, value in percent.items()}
    meshes = filled(pymeshlab, mesh)
    meshes.apply_filter(name, **shares, **parameters)
    current = meshes.current_mesh()
    return current.vertex_matrix(), current.face_matrix()


def crossing(pymeshlab: Any, mesh: Any) -> Any:
    """The faces that intersect others, (k,)."""
    meshes = filled(pymeshlab, mesh)
    meshes.apply_filter("compute_selection_by_self_intersections_per_face")
    return np.flatnonzero(meshes.current_mesh().face_selection_array())


def distances(pymeshlab: Any, meshes: list[Any], samples: int) -> tuple[float, float]:
    """Hausdorff's and the root mean square of two meshes, both ways, in parts of the diagonal."""
    both = filled(pymeshlab, *meshes)
    given = {"samplenum": samples, "maxdist": pymeshlab.PercentageValue(50)}
    found = [
        both.get_hausdorff_distance(sampledmesh=a, targetmesh=1 - a, **given) for a in range(2)
    ]
    parts = np.array([[it["max"], it["RMS"]] for it in found]) / found[0]["diag_mesh_0"]
    return float(parts[:, 0].max()), float(np.sqrt((parts[:, 1] ** 2).mean()))


def load(pymeshlab: Any, path: str) -> tuple[Any, Any, int]:
    """The points and triangles of a file, all its meshes as one, and how many were left out."""
    with tempfile.TemporaryFile() as said:
        os.dup2(said.fileno(), 2)
        try:
            meshes = pymeshlab.MeshSet(verbose=True)
            meshes.load_new_mesh(path)
        finally:
            os.dup2(1, 2)
        said.seek(0)
        left_out = sum(map(int, chain(*re.findall(_LEFT_OUT, said.read()))))
    points = [part.transformed_vertex_matrix() for part in meshes]
    starts = np.cumsum([0, *map(len, points)])
    faces = [part.face_matrix() + start for part, start in zip(meshes, starts, strict=False)]
    for part, rows in zip(meshes, faces, strict=True):
        if np.linalg.det(part.transform_matrix()) < 0:  # mirrored, its faces run the other way
            rows[:, 1:] = rows[:, :0:-1].copy()
    return np.concatenate(points), np.concatenate(faces), left_out


def save(pymeshlab: Any, mesh: Any, path: str) -> None:
    """Write a mesh into a file."""
    options = {name: name == "lossless" for name in _OPTIONS.get(path[-3:], "").split()}
    filled(pymeshlab, mesh).save_current_mesh(path, **options)


def filled(pymeshlab: Any, *given: Any) -> Any:
    """A MeshSet that holds meshes (points, triangles), or nothing."""
    meshes = pymeshlab.MeshSet(verbose=False)
    for points, triangles in filter(None, given):
        meshes.add_mesh(pymeshlab.Mesh(points.astype(np.float64), triangles.astype(np.int32)))
    return meshes


_LEFT_OUT = rb"contains (\d+) vertices with NAN coords and (\d+) degenerated faces"
_OPTIONS = {
    "ctm": "lossless", "wrl": "save_vertex_color",
    "dae": "save_vertex_color save_vertex_normal", "x3d": "save_vertex_color save_vertex_normal",
}  # fmt: skip
"""What is said of a format to write: lossless, or it would be quantized, and nothing made up."""

JOBS: dict[str, Callable[..., Any]] = {
    job.__name__: job for job in (apply, crossing, distances, load, save)
}

if __name__ == "__main__":
    main()
