"""What can be wrong with a mesh, with an operation on it, or with what is installed.

Every error about a mesh names the elements.
"""

from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hem.arrays import Indices

_SHOWN = 6


class _ElementsError(ValueError):
    """A ValueError that carries the offending elements and lists the first few in its message.

    `elements` maps a kind ("vertices", "edges", "faces", "rows" …) to an array: (k,) indices, or
    (k, 2) pairs of vertices for edges. Kinds without elements are left out. `reason` is the
    message without that list.
    """

    reason: str
    elements: dict[str, Indices]

    def __init__(self, message: str, **elements: ArrayLike) -> None:
        self.reason = message
        arrays = {kind: np.asarray(found, dtype=np.int64) for kind, found in elements.items()}
        self.elements = {kind: found for kind, found in arrays.items() if len(found)}
        listed = [f"{kind}: {_listed(found)}" for kind, found in self.elements.items()]
        super().__init__(f"{message} ({'; '.join(listed)})" if listed else message)


def _listed(found: Indices) -> str:
    shown = ", ".join(_one(element) for element in found[:_SHOWN].tolist())
    return f"{shown} and {len(found) - _SHOWN:,} more" if len(found) > _SHOWN else shown


def _one(element: int | list[int]) -> str:
    return "-".join(map(str, element)) if isinstance(element, list) else str(element)


class MeshError(_ElementsError):
    """The input is no mesh that can be worked with."""


class NonManifoldError(MeshError):
    """The mesh is sound as a list of triangles, but some edge or vertex is not a surface's."""


class MeshWarning(UserWarning):
    """What was given holds more than the mesh that was made of it keeps."""


class TopologyError(_ElementsError):
    """The operation would break the surface; the mesh is untouched."""


class NotInstalledError(ImportError):
    """A package or driver that only some need is not installed; the message says what brings it."""


def load_optional(package: str, extra: str) -> Any:
    """A package that an extra of ours brings. NotInstalledError names the extra."""
    try:
        return import_module(package)
    except ImportError as error:
        raise NotInstalledError(
            f"{package} cannot be imported ({error}): pip install 'hem-mesh[{extra}]' brings it"
        ) from error
