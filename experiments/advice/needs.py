"""What a structure must be able to do, found by trying it on a small mesh or as it declares."""

from collections.abc import Callable
from functools import cache

import hem
from structures import REGISTRY, Structure, build


def _records_edges(kind: type[Structure]) -> bool:
    try:
        build(kind.name, hem.generate("torus", 100)).edge_attribute("needed")  # refused without
    except hem.MeshError:
        return False
    return True


def _has_borders(kind: type[Structure]) -> bool:
    try:
        build(kind.name, hem.generate("grid", 100))
    except hem.MeshError:
        return False
    return True


NEEDS: dict[str, tuple[str, Callable[[type[Structure]], bool]]] = {
    "edges": ("records no edges", _records_edges),
    "borders": ("holds closed meshes only", _has_borders),
    "polygons": ("holds triangles only", lambda kind: kind.holds_polygons),
    "attributes": ("keeps no values of edges", _records_edges),
    "edits": (
        "looks at the whole mesh for an edit",
        lambda kind: not (kind.searches or kind.rebuilds),
    ),
}
"""By name: what is wrong with a structure that cannot, and whether it can. ``edits`` is for what
is drawn while it is edited."""


@cache
def lacks(structure: str, need: str) -> str:
    """What is wrong with a structure that is needed so; empty if nothing is."""
    words, suits = NEEDS[need]
    return "" if suits(REGISTRY[structure]) else words
