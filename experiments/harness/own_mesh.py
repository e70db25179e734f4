"""A mesh of one's own to be measured: at its size, and as coarser and finer versions of it.

Coarser ones are simplified, in finer ones every edge is halved.
The versions stand in the folder of the run, so that it can be resumed wherever its mesh has gone.
"""

import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import structures
from experiments.presets import COARSER, FINE_ENOUGH, LARGEST, SMALLEST
from hem.algorithms import simplify
from hem.contract import Navigable
from hem.errors import MeshError, MeshWarning, NonManifoldError
from hem.meshes import TriangleMesh, used_only
from hem.sources import find_mesh

FOLDER = "mesh"

_HOLDER = next(
    name for name, it in structures.REGISTRY.items() if it.compiled and issubclass(it, Navigable)
)
"""The structure in which versions are made."""

_folders: dict[str, Path] = {}

OwnMesh = tuple[str, tuple[int, ...]]
"""How cases call it, and the numbers of vertices of its versions."""


def called(name: str) -> str:
    """How cases call a mesh: ``model.obj``, ``sphere-2000``."""
    return Path(name).name.replace(":", "-")


def keep_versions(folder: Path, name: str, repair: bool = False) -> dict[str, NonManifoldError]:
    """Keep a mesh, and its versions, in the folder of a run -> why structures cannot hold it.

    ``name``: see ``hem.find_mesh``. What is not manifold has no coarser versions, and only
    structures that search hold it. Raises MeshError for what cannot be read, and without faces.
    """
    found = find_mesh(name, repair)
    mesh = found if isinstance(found, TriangleMesh) else found.triangulated()
    if mesh is not found:
        why = "what is measured is the same on every structure"
        warnings.warn(f"faces of {name} are cut into triangles: {why}", MeshWarning, stacklevel=3)
    if not len(mesh.triangles):
        raise MeshError(f"there is nothing to measure: {name} has no faces")
    refusals = _refusals(mesh)
    kept = folder / FOLDER / called(name)
    kept.mkdir(parents=True)
    for it in (*(() if refusals else _coarser(mesh)), mesh, *_finer(mesh)):
        np.savez(kept / str(len(it.points)), points=it.points, triangles=it.triangles)
    return refusals


def of_run(folder: Path) -> OwnMesh | None:
    """The mesh of a run that is on one's own; its cases find it from here on."""
    for kept in (folder / FOLDER).glob("*/"):
        _folders[kept.name] = kept
        return kept.name, tuple(sorted(int(path.stem) for path in kept.glob("*.npz")))
    return None


def is_own(name: str, size: int) -> bool:
    """Whether cases call a mesh of one's own so; a sample may have its name, and has no size."""
    return size > 0 and name in _folders


def version(name: str, size: int) -> TriangleMesh:
    """The version with about so many vertices of what is one's own."""
    files = {int(path.stem): path for path in _folders[name].glob("*.npz")}
    with np.load(files[min(files, key=lambda n: abs(np.log(n / size)))]) as arrays:
        return TriangleMesh(arrays["points"], arrays["triangles"])


def _refusals(mesh: TriangleMesh) -> dict[str, NonManifoldError]:
    """Why structures cannot hold a mesh; of a surface every one can."""
    found = dict[str, NonManifoldError]()
    for name in (_HOLDER, *structures.NAMES):
        try:
            structures.build(name, mesh)
        except NonManifoldError as error:
            found[name] = error
        if not found:
            break
    return found


def _coarser(mesh: TriangleMesh) -> Iterator[TriangleMesh]:
    s = structures.build(_HOLDER, mesh)
    for _ in range(COARSER):
        before = s.n_faces
        if len(mesh.points) < 4 * SMALLEST:
            return
        simplify(s, faces=before // 4)
        if s.n_faces > before // 2:  # small parts cannot be simplified any more
            return
        found = s.to_triangles()
        mesh = TriangleMesh(*used_only(found.points, found.triangles))
        yield mesh


def _finer(mesh: TriangleMesh) -> Iterator[TriangleMesh]:
    points, triangles = used_only(mesh.points, mesh.triangles)
    while 4 * len(points) <= LARGEST:
        sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
        ends, middles = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = triangles.T
        ab, bc, ca = len(points) + middles.reshape(-1, 3).T
        points = np.concatenate([points, points[ends].mean(axis=1)])
        corners = a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca
        triangles = np.stack(corners, axis=1).reshape(-1, 3)
        if len(points) != len(mesh.points):  # as many as there are with those that no face has
            yield TriangleMesh(points, triangles)
        if 4 * len(points) > FINE_ENOUGH:
            return
