"""Pieces as files, and what they are in numbers; nothing is left half-written."""

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Floats
from hem.errors import MeshError, load_optional
from hem.fracture.blow import Blow, Motion, kinetic_energies, kinetic_energy
from hem.fracture.pieces import Fracture
from hem.meshes import direction
from hem.naming import look_up
from hem.sources import encoded

SCHEMA = 1


def names(fracture: Fracture) -> list[str]:
    """The names of all pieces: shard_000 and on, then rest, island_0 and on."""
    digits = max(3, len(str(len(fracture.shards) - 1)))
    shards = [f"shard_{i:0{digits}d}" for i in range(len(fracture.shards))]
    islands = [f"island_{i}" for i in range(len(fracture.rest) - 1)]
    return [*shards, *(["rest"] if len(fracture.rest) else []), *islands]


def save_pieces(
    fracture: Fracture,
    folder: str | os.PathLike[str],
    format: str = "glb",
    up: ArrayLike = (0.0, 1.0, 0.0),
) -> list[Path]:
    """Write all pieces into a folder, which is made if need be -> the files.

    ``glb``  pieces.glb, a node per piece, turned so that ``up`` points up in viewers
    ``obj``  pieces.obj, an ``o`` per piece
    ``ply``  pieces/shard_000.ply …, a file per piece; those of a fracture before are removed

    Coordinates are the model's own, to the last bit of float32. All is written beside and moved
    into place when it is complete; other files stay. Cost O(vertices + faces). Raises MeshError for
    another format, an ``up`` of no direction, and where the folder cannot be written.
    """
    save, top = look_up(format, FORMATS, "format of pieces"), direction(up)
    with whole(folder) as beside:
        made = [path.relative_to(beside) for path in save(fracture, beside, top)]
    return [Path(folder) / path for path in made]


@contextmanager
def whole(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """A folder to write into that becomes, file by file, part of ``folder`` if all went well.

    Files of the same name are replaced, all others stay, but for a fracture's pieces in a folder
    ``pieces`` if there are new ones. An interrupt leaves what was there. Raises MeshError where the
    folder cannot be made or written.
    """
    target = Path(folder).absolute()
    kept = require_writable(target)
    try:
        with tempfile.TemporaryDirectory(dir=kept, prefix=".hem-") as place:
            beside = Path(place) / "new"
            beside.mkdir()
            yield beside
            _move(beside, target, Path(place))
    except OSError as error:
        raise MeshError(f"cannot write into {target}: {error.strerror or error}") from error


def require_writable(folder: str | os.PathLike[str]) -> Path:
    """The folder, or of those above it the first that exists. MeshError if it takes no files."""
    path = Path(folder).absolute()
    for place in (path, *path.parents):
        if place.is_dir():
            if os.access(place, os.W_OK | os.X_OK):
                return place
            raise MeshError(
                f"cannot write into {path}: {place} is read-only; choose another folder"
            )
        if place.exists() or place.is_symlink():
            raise MeshError(f"cannot write into {path}: {place} is a file, not a folder")
    raise MeshError(f"cannot write into {path}: there is no such place")


def _move(beside: Path, target: Path, aside: Path) -> None:
    """Move all files into place, and those whose place it is aside; or none, if interrupted."""
    within = [path.relative_to(beside) for path in sorted(beside.rglob("*")) if path.is_file()]
    for path in within:
        place = target / path
        if place.is_dir() or (place.parent.exists() and not place.parent.is_dir()):
            raise MeshError(f"cannot write {place}: something else has this name")
    before = (target / "pieces").glob("*.ply") if (beside / "pieces").is_dir() else []
    stale = [it for it in before if it.name.startswith(("shard_", "rest.", "island_"))]
    moves = []
    for path in dict.fromkeys([*within, *(it.relative_to(target) for it in stale)]):
        if os.path.lexists(target / path):
            moves.append((target / path, aside / "old" / path))
        if (beside / path).exists():
            moves.append((beside / path, target / path))
    try:
        for here, there in moves:
            there.parent.mkdir(parents=True, exist_ok=True)
            os.replace(here, there)
    except BaseException:
        for here, there in reversed(moves):
            if not os.path.lexists(here):  # it was moved, even if nothing more was noted of it
                os.replace(there, here)
        raise


def _save_glb(fracture: Fracture, folder: Path, up: Floats) -> list[Path]:
    from scipy.spatial.transform import Rotation

    trimesh = load_optional("trimesh", "fracture")

    upright = np.eye(4)  # glTF has y up
    upright[:3, :3] = Rotation.align_vectors([(0, 1, 0)], [up])[0].as_matrix()
    look = trimesh.visual.material.PBRMaterial(
        name=fracture.material.name, baseColorFactor=[*fracture.material.rgb, 255],
        roughnessFactor=0.5, metallicFactor=0.0, doubleSided=True,
    )  # fmt: skip
    scene = trimesh.Scene()
    for name, piece in zip(names(fracture), fracture.pieces, strict=True):
        shown = trimesh.Trimesh(piece.points, piece.triangles, process=False)
        shown.visual = trimesh.visual.TextureVisuals(material=look)
        scene.add_geometry(shown, node_name=name, geom_name=name, transform=upright)
    path = folder / "pieces.glb"
    path.write_bytes(scene.export(file_type="glb"))
    return [path]


def _save_obj(fracture: Fracture, folder: Path, up: Floats) -> list[Path]:
    lines = [f"# {len(fracture.pieces)} pieces of {fracture.material.name!a}, by hem"]
    before = 1
    for name, piece in zip(names(fracture), fracture.pieces, strict=True):
        lines.append(f"o {name}")
        lines += ["v {:.9g} {:.9g} {:.9g}".format(*point) for point in piece.points.tolist()]
        corners = (piece.triangles.astype(np.int64) + before).tolist()
        lines += ["f {} {} {}".format(*face) for face in corners]
        before += len(piece.points)
    path = folder / "pieces.obj"
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")
    return [path]


def _save_ply(fracture: Fracture, folder: Path, up: Floats) -> list[Path]:
    inner = folder / "pieces"
    inner.mkdir()
    paths = [inner / f"{name}.ply" for name in names(fracture)]
    for path, piece in zip(paths, fracture.pieces, strict=True):
        path.write_bytes(encoded(piece, "ply"))
    return paths


FORMATS: dict[str, Callable[[Fracture, Path, Floats], list[Path]]] = {
    "glb": _save_glb,
    "obj": _save_obj,
    "ply": _save_ply,
}


def describe(fracture: Fracture, blow: Blow, motion: Motion, model: str = "") -> dict[str, Any]:
    """A fracture in numbers, as JSON holds them: units are in the names of the entries.

    A unit of the model is taken as a meter. ``neighbors`` are indices of pieces. Cost: that of
    ``fracture.mass`` and ``fracture.neighbors``.
    """
    mass = fracture.mass
    return {
        "schema": SCHEMA,
        "model": model,
        "method": fracture.method,
        "material": asdict(fracture.material) | {"circles": list(fracture.material.circles)},
        "force_J_kg": float(blow.force),
        "seed": int(fracture.seed),
        "impact_m": np.asarray(fracture.impact, float).tolist(),
        "direction": np.asarray(fracture.direction, float).tolist(),
        "thickness_m": None if fracture.closed else _thickness(fracture),
        "break_points": {name: int(count) for name, count in fracture.counts.items()},
        "totals": {
            "pieces": len(fracture.pieces),
            "shards": len(fracture.shards),
            "volume_m3": float(mass.volumes.sum()),
            "mass_kg": float(mass.masses.sum()),
            "momentum_kg_m_s": (mass.masses[:, None] * motion.velocities).sum(axis=0).tolist(),
            "kinetic_energy_J": kinetic_energy(mass, motion),
        },
        "pieces": _described_pieces(fracture, motion),
    }


def _described_pieces(fracture: Fracture, motion: Motion) -> list[dict[str, Any]]:
    mass = fracture.mass
    beside: list[list[int]] = [[] for _ in fracture.pieces]
    for a, b in fracture.neighbors.tolist():
        beside[a].append(b)
        beside[b].append(a)
    columns = {
        "name": names(fracture),
        "vertices": [len(np.unique(piece.triangles)) for piece in fracture.pieces],
        "faces": [len(piece.triangles) for piece in fracture.pieces],
        "volume_m3": mass.volumes.tolist(),
        "mass_kg": mass.masses.tolist(),
        "center_m": mass.centers.tolist(),
        "velocity_m_s": motion.velocities.tolist(),
        "spin_rad_s": motion.spins.tolist(),
        "kinetic_energy_J": kinetic_energies(mass, motion).tolist(),
        "neighbors": beside,
    }
    if not fracture.closed:
        columns["area_m2"] = (mass.volumes / _thickness(fracture)).tolist()
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _thickness(fracture: Fracture) -> float:
    return float(fracture.material.thickness * fracture.diagonal)
