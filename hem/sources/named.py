"""A mesh by a name, as every command takes it: a file, a sample, or a family and a size."""

import re
from os import PathLike, fspath
from os.path import exists, isfile  # which say no where a name is too long for a path
from pathlib import Path
from typing import Literal, overload

from hem.errors import MeshError
from hem.meshes import PolygonMesh, TriangleMesh
from hem.sources.families import FAMILIES, generate
from hem.sources.files import as_mesh, load
from hem.sources.repair import repaired
from hem.sources.samples import SAMPLES, sample

USUAL_SIZE = 2_000  # vertices of a family that is named without a size
Name = str | PathLike[str]


@overload
def find_mesh(name: Name, repair: bool = ..., *, triangulate: Literal[True]) -> TriangleMesh: ...
@overload
def find_mesh(name: Name, repair: bool = ...) -> TriangleMesh | PolygonMesh: ...
def find_mesh(
    name: Name, repair: bool = False, *, triangulate: bool = False
) -> TriangleMesh | PolygonMesh:
    """The mesh of a file, of a sample (`bunny`), or of a family and its size (`sphere:2000`).

    >>> hem.find_mesh("torus:100")
    TriangleMesh(100 vertices, 200 faces)

    A file comes before a sample of its name, a folder does not. `repair` and `triangulate`: see
    `load`. Raises MeshError for a name that nothing has, with those that there are, and for what
    cannot be read.
    """
    name = fspath(name)
    family, _, size = name.partition(":")
    known = name in SAMPLES or family in FAMILIES
    if isfile(name) or (not known and (exists(name) or Path(name).suffix)):
        cut = repair or triangulate
        return load(name, repair, triangulate=True) if cut else as_mesh(name)
    if name in SAMPLES:
        return repaired(sample(name)) if repair else sample(name)
    if family not in FAMILIES:
        raise MeshError(
            f"there is no model {name!r}: name a file, or one of "
            f"{', '.join((*SAMPLES, *FAMILIES))}; families take a size, as in sphere:2000"
        )
    if size and not re.fullmatch(r"\d(_?\d){0,99}", size, re.ASCII):
        raise MeshError(f"{name!r}: after the colon stands a number of vertices")
    return generate(family, int(size or USUAL_SIZE))
