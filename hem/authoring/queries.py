"""The nine adjacency queries, as data: kernels, tests, experiments and tables loop over them."""

from __future__ import annotations

from typing import NamedTuple

ELEMENTS = {"vertex": "vertices", "edge": "edges", "face": "faces"}
"""The elements of a mesh, singular to plural."""


class Query(NamedTuple):
    """Which elements of kind ``target`` are adjacent to one element of kind ``source``."""

    source: str
    target: str

    @property
    def name(self) -> str:
        """The method's name, such as ``vertex_faces``."""
        return f"{self.source}_{ELEMENTS[self.target]}"

    @property
    def title(self) -> str:
        """As in the head of a table row, such as ``Vertex → Faces``."""
        adjacent = "adjacent " if self.source == self.target else ""
        return f"{self.source.capitalize()} → {adjacent}{ELEMENTS[self.target].capitalize()}"


QUERIES = {
    query.name: query
    for query in (Query(source, target) for source in ELEMENTS for target in ELEMENTS)
}
"""The nine queries by name."""
