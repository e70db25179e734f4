"""Walking a mesh by its half-edges, on structures that record them."""

from typing import Any, NamedTuple, Protocol, overload

from hem.arrays import Array, Indices
from hem.contract.attributes import HalfEdgeAttribute
from hem.contract.following import AttributeMethod
from hem.contract.structure import Structure, attribute_method, made_once


class Step(NamedTuple):
    """A step from one element to another, taken by ``kernel(m, handle) -> handle``."""

    source: str
    target: str
    kernel: str
    words: str


_H = "half_edge"
STEPS = {
    "next": Step(_H, _H, "following", "the half-edge after it in its face"),
    "previous": Step(_H, _H, "previous", "the half-edge before it in its face"),
    "twin": Step(_H, _H, "twin", "the half-edge of its edge that runs the other way"),
    "origin": Step(_H, "vertex", "origin", "the vertex where it starts"),
    "tip": Step(_H, "vertex", "tip", "the vertex where it ends"),
    "face": Step(_H, "face", "face", "the face that it lies in"),
    "edge": Step(_H, "edge", "edge_of", "its edge"),
    "vertex_half_edge": Step("vertex", _H, "leaving", "a half-edge that leaves the vertex"),
    "face_half_edge": Step("face", _H, "within", "a half-edge of the face"),
}
"""Every step by name."""


class StepMethod(Protocol):
    """A step as a method: one handle -> a handle; an array of handles -> an array."""

    @overload
    def __call__(self, handles: int) -> int: ...
    @overload
    def __call__(self, handles: Array | list[int]) -> Array: ...


def _step_method(name: str) -> Any:
    source = STEPS[name].source.replace("_", "-")
    text = (
        f"Of a {source}: {STEPS[name].words}; -1 where there is none.\n\n"
        "One handle gives a handle, an array of handles (n,) an array. Cost O(1). Raises\n"
        f"MeshError for a handle that names no {source} of this mesh."
    )
    return made_once(text, lambda self: self._queries.step(name))


class Navigable(Structure, abstract=True):
    """A structure that records half-edges, which are handles as other elements are.

    Its kernels for the steps lead to a negative number where there is none.
    """

    steps = STEPS

    next: StepMethod = _step_method("next")
    previous: StepMethod = _step_method("previous")
    twin: StepMethod = _step_method("twin")
    origin: StepMethod = _step_method("origin")
    tip: StepMethod = _step_method("tip")
    face: StepMethod = _step_method("face")
    edge: StepMethod = _step_method("edge")
    vertex_half_edge: StepMethod = _step_method("vertex_half_edge")
    face_half_edge: StepMethod = _step_method("face_half_edge")

    half_edge_attribute: AttributeMethod = attribute_method(
        "half_edge",
        HalfEdgeAttribute,
        "The parts of one that is split copy what it has. ``collapse_edges`` does an edit per\n"
        "edge then, as for corners.",
    )

    def half_edges(self) -> Indices:
        """(n_half_edges,) int64: the handles of all live half-edges, ascending. Cost O(n_e).

        Where handles of edges are not stable, an operation may give those of the faces that it
        changes to others of their half-edges, and nothing tells: ask for them anew.
        """
        return self._state.live("half_edge")
