"""Walking a mesh by its half-edges, on structures that record them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol, overload

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Array
from hem.authoring import Kernel, Kernels
from hem.contract.attributes import HalfEdgeAttribute
from hem.contract.description import place_of
from hem.contract.elements import HANDLE_TYPES
from hem.contract.following import AttributeMethod, attribute_method
from hem.contract.queryable import MOST, NUMPY_INTEGERS
from hem.contract.structure import Structure
from hem.errors import MeshError


class Step(NamedTuple):
    """A step from one element to another."""

    source: str
    target: str
    kernel: str
    """What the kernel is called that takes it, ``kernel(m, handle) -> handle``."""

    words: str


STEPS = {
    "next": Step("half_edge", "half_edge", "following", "the half-edge after it in its face"),
    "previous": Step("half_edge", "half_edge", "previous", "the half-edge before it in its face"),
    "twin": Step(
        "half_edge", "half_edge", "twin", "the half-edge of its edge that runs the other way"
    ),
    "origin": Step("half_edge", "vertex", "origin", "the vertex where it starts"),
    "tip": Step("half_edge", "vertex", "tip", "the vertex where it ends"),
    "face": Step("half_edge", "face", "face", "the face that it lies in"),
    "edge": Step("half_edge", "edge", "edge_of", "its edge"),
    "vertex_half_edge": Step(
        "vertex", "half_edge", "leaving", "a half-edge that leaves the vertex"
    ),
    "face_half_edge": Step("face", "half_edge", "within", "a half-edge of the face"),
}
"""Every step by name."""


SOURCES = {it.source for it in STEPS.values()}


def _exists(k: Kernels, source: str) -> Kernel:
    """Whether there is such an element. A half-edge that names its edge is one where that is."""
    return k.get(f"{source}_exists") or k[f"{source.removeprefix('half_')}_exists"]


class StepMethod(Protocol):
    """A step as a method: one handle -> a handle; an array of handles -> an array."""

    @overload
    def __call__(self, handles: int) -> int: ...
    @overload
    def __call__(self, handles: NDArray[Any] | list[int]) -> NDArray[Any]: ...


def _step_method(name: str) -> Any:
    step = STEPS[name]

    def bound(self: Navigable) -> StepMethod:
        pinned = self._pin(lambda: ())
        exists = _exists(self.kernels, step.source)
        take = self._steps[name].step(pinned, exists)
        address = pinned.address

        def walk(handles: Any) -> Any:
            handle = int(handles) if type(handles) in NUMPY_INTEGERS else handles
            if type(handle) is int and -MOST <= handle < MOST:
                found = take(handle, address)
                if found >= 0:
                    return found
            return self._walk(name, handles)

        walk.__name__, walk.__doc__ = name, attribute.__doc__
        walk.__dict__["pinned"] = pinned  # lives as long as the address is in use
        return walk

    attribute = cached_property(bound)
    attribute.__doc__ = (
        f"Of a {step.source.replace('_', '-')}: {step.words}; -1 where there is none.\n\n"
        "One handle gives a handle, an array of handles (n,) an array. Cost O(1). Raises\n"
        f"MeshError for a handle that names no {step.source.replace('_', '-')} of this mesh."
    )
    return attribute


class Navigable(Structure, abstract=True):
    """A structure that records half-edges, which are handles as other elements are.

    Its kernels for the steps lead to a negative number where there is none.
    """

    _steps: ClassVar[dict[str, Any]]

    def __init_subclass__(cls, abstract: bool = False) -> None:
        super().__init_subclass__(abstract)
        if abstract:
            return
        missing = {it.kernel for it in STEPS.values()} - cls.kernels.keys()
        if missing:
            raise TypeError(f"{place_of(cls)} has no kernels of steps: {sorted(missing)}")
        taken = {name: cls.kernels[it.kernel] for name, it in STEPS.items()}
        cls._steps = {name: cls.uses_type(it, cls.records_type) for name, it in taken.items()}

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

    def half_edges(self) -> NDArray[np.int64]:
        """(n_half_edges,) int64: the handles of all live half-edges, ascending. Cost O(n_e)."""
        return np.flatnonzero(self._alive("half_edge"))

    def edges(self) -> NDArray[np.int64]:
        """(n_edges,) int64: the handles of all live edges, each by its one name. Cost O(n_e)."""
        h = self.half_edges()
        return h[self._edge_names(h) == h]

    @cached_property
    def _walks(self) -> dict[str, Callable[..., int]]:
        """Every step from many handles."""
        exists = {it: _exists(self.kernels, it) for it in SOURCES}
        return {name: self._steps[name].walk(exists[it.source]) for name, it in STEPS.items()}

    def _walk(self, name: str, handles: Any) -> Any:
        """Any handles for a step, checked."""
        step = STEPS[name]
        asked: Array = np.asarray(handles)
        if asked.ndim > 1 or (asked.size and not np.issubdtype(asked.dtype, np.integer)):
            raise MeshError(
                f"{name} takes one {step.source} handle or a 1-D array of integers, not "
                f"{handles!r:.60}"
            )
        rows = np.atleast_1d(asked).astype(np.int64)
        found = np.empty(len(rows), HANDLE_TYPES.get(step.target, np.int64))
        if self._walks[name](rows, found, *self.records) < len(rows) or step.source == "vertex":
            self._check_handles(step.source, rows)
        return found if asked.ndim else int(found[0])
