"""Real models: those that come inside the pymeshlab package, and the Utah teapot."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hem.errors import MeshError, MeshWarning
from hem.meshes import TriangleMesh
from hem.naming import look_up
from hem.sources.files import load
from hem.sources.teapot import teapot


@dataclass(frozen=True)
class Sample:
    """A model: what it is, and what makes it from the options that `sample` hands on."""

    what: str
    make: Callable[..., TriangleMesh]


def sample(name: str, **options: Any) -> TriangleMesh:
    """A real model by name; SAMPLES says which there are.

    Options: `repair=True` for the scans and models in files (see hem.load), `tessellation=10` and
    `welded=True` for the teapot. Raises MeshError for an unknown name, and where pymeshlab was
    installed without its sample files.
    """
    return look_up(name, SAMPLES, "sample").make(**options)


def _from_file(name: str, repair: bool = False) -> TriangleMesh:
    package = find_spec("pymeshlab")
    if package is None or package.origin is None:
        raise MeshError("the models come with pymeshlab: pip install 'hem-mesh[study]'")
    file = Path(package.origin).parent / "tests" / "sample_meshes" / name
    if not file.exists():
        raise MeshError(f"this pymeshlab came without its sample meshes: there is no {file}")
    with warnings.catch_warnings(action="ignore", category=MeshWarning):
        return load(file, repair, triangulate=True)


def _of_file(what: str, name: str) -> Sample:
    return Sample(what, partial(_from_file, name))


SAMPLES: dict[str, Sample] = {
    "bunny": _of_file("the Stanford bunny: closed, 28,088 vertices", "bunny.obj"),
    "cow": _of_file("a cow: closed, 2,904 vertices", "cow.obj"),
    "airplane": _of_file(
        "an airplane: closed, 7,017 vertices, 1,617 of them without faces", "airplane.obj"
    ),
    "bone": _of_file("a bone: closed, 1,872 vertices, 359 of them without faces", "bone.ply"),
    "face": _of_file(
        "one range scan of a face: 85,849 vertices, a ragged border, 17 pieces, and six "
        "vertices where two fans meet, which only repair=True makes a surface",
        "rangemaps/face000.ply",
    ),
    "teapot": Sample("the Utah teapot, from its patches at any tessellation", teapot),
}
"""The models by name, which ``sample`` reads."""
