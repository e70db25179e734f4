"""Materials: how what is hit breaks, as data."""

import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from hem.errors import MeshError
from hem.fracture.mass import positive
from hem.naming import look_up

_OWN = Path(__file__).parent / "materials.toml"


@dataclass(frozen=True)
class Material:
    """How something breaks; ``materials.toml`` says what each number means and its unit.

    Lengths are parts of the diagonal of a mesh's bounding box, so that a material breaks a large
    model as it does a small one. Raises MeshError for numbers that no material has.
    """

    name: str
    density: float
    thickness: float
    circles: tuple[int, ...]
    scale: float
    sites: float
    reach: float
    burst: float
    color: str = "#b0b0b0"

    @property
    def rgb(self) -> bytes:
        """Its color as three numbers, sRGB in 0 … 255."""
        return bytes.fromhex(self.color[1:])

    def __post_init__(self) -> None:
        wrong = []
        for it in ("density", "thickness", "scale", "sites", "reach", "burst"):
            try:
                object.__setattr__(self, it, positive(getattr(self, it), it))
            except MeshError:
                wrong.append(it)
        if isinstance(self.circles, Iterable):
            object.__setattr__(self, "circles", tuple(self.circles))
        if not (isinstance(self.circles, tuple) and all(map(_is_count, self.circles))):
            wrong.append("circles")
        if "burst" not in wrong and self.burst > 1:
            wrong.append("burst")
        if not re.fullmatch("#[0-9a-fA-F]{6}", str(self.color)):
            wrong.append("color")
        if wrong:
            raise MeshError(
                f"material {self.name!r}: {', '.join(wrong)} cannot be "
                f"{', '.join(f'{getattr(self, it)!r:.60}' for it in wrong)}; numbers are positive, "
                "circles are counts of break points, burst is a part of 1, and a color is #rrggbb"
            )


def materials(path: str | os.PathLike[str] = _OWN) -> dict[str, Material]:
    """The materials of a toml file by name. Raises MeshError that names the file and the entry."""
    try:
        read = tomllib.loads(Path(path).read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise MeshError(f"cannot read materials from {path}: {error}") from error
    return {name: _material(name, entry, path) for name, entry in read.items()}


def material(name: str, known: Mapping[str, Material] | None = None) -> Material:
    """The material of a name, of those that are ``known``. Raises MeshError where there is none."""
    return look_up(name, MATERIALS if known is None else known, "material")


def _is_count(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _material(name: str, entry: Any, path: Any) -> Material:
    names = {field.name for field in fields(Material)} - {"name"}
    if not isinstance(entry, dict):
        raise MeshError(f"{path}: {name} is no table of a material's numbers")
    unknown, missing = set(entry) - names, names - set(entry) - {"color"}
    if unknown or missing:
        what = [f"lacks {', '.join(sorted(missing))}"] if missing else []
        what += [f"has no {', '.join(sorted(unknown))}"] if unknown else []
        raise MeshError(f"{path}: material {name!r} {' and '.join(what)}")
    try:
        return Material(name, **entry)
    except MeshError as error:
        raise MeshError(f"{path}: material {name!r}: {error}") from error


MATERIALS = materials()
"""The materials that come with this, by name."""
