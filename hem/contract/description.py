"""What a structure's class declares: its names, look and claims, its records and kernels."""

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from hem.arrays import Array, Indices
from hem.authoring import (
    OF_ARRAYS,
    OPERATIONS,
    QUERIES,
    Kernel,
    Kernels,
    named_by_ends,
    nothing,
    prefetching,
)
from hem.engine import Uses, is_compiled

Algorithm = Callable[[Kernels, Kernels], Kernel]
"""Makes an algorithm of one structure's queries and operations, see ``Structure.run``."""


@dataclass(frozen=True)
class Look:
    """A line in every plot, which stands out from white.

    Where two have one ``line``, the color-blind can tell their colors. ``color`` as
    ``#c77f00``; ``marker`` and ``line`` as Matplotlib has them: ``o``, ``--``.
    """

    color: str
    marker: str
    line: str


@dataclass(frozen=True)
class Claims:
    """What is claimed of the costs of a structure that the thesis does not print.

    ``costs``: the class by query or operation, such as ``{"vertex_faces": "O(n_ev)"}``; what is
    not in it is not claimed. ``like``: another structure of which the same is claimed, but for the
    bytes.
    """

    source: str
    costs: Mapping[str, str] = field(default_factory=dict)
    like: str = ""


class Described:
    """Something with a name in tables and plots.

    A class that forgets a part is a TypeError when it is made; ``abstract=True`` for those that
    leave the parts to others.
    """

    name: ClassVar[str]
    """As in commands and files: ``half_edge``."""

    title: ClassVar[str]
    abbreviation: ClassVar[str]
    look: ClassVar[Look]
    thesis: ClassVar[bool] = False
    """Whether the thesis' table 1 prints it; its claims are those of the table then."""

    claims: ClassVar[Claims]
    order: ClassVar[int] = 1000
    """Its place in tables, after those of the thesis."""

    def __init_subclass__(cls, abstract: bool = False) -> None:
        super().__init_subclass__()
        if abstract:
            return
        parts = ("name", "title", "abbreviation", "look", *(() if cls.thesis else ("claims",)))
        if missing := [it for it in parts if not hasattr(cls, it)]:
            raise TypeError(f"{place_of(cls)} does not say: {', '.join(missing)}")


def place_of(cls: type) -> str:
    """Where a class stands, for errors: its file and its name."""
    try:
        return f"{inspect.getfile(cls)}: {cls.__name__}"
    except (OSError, TypeError):
        return cls.__name__


class _Asked(Mapping[str, Kernel]):
    """Kernels by name that know which were asked for."""

    def __init__(self, kernels: Kernels) -> None:
        self._kernels, self.names = kernels, set[str]()

    def __getitem__(self, name: str) -> Kernel:
        self.names.add(name)
        return self._kernels[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._kernels)

    def __len__(self) -> int:
        return len(self._kernels)


class Declared:
    """What follows from a structure's class, once for all its meshes.

    A class that forgets a part is a TypeError that names the class and the part.
    """

    def __init__(self, cls: Any) -> None:
        self._place = place_of(cls)
        self._require_parts(cls)
        self.kernels: Kernels = cls.kernels
        if cls.compiled:
            self.kernels = {name: it for name, it in cls.kernels.items() if is_compiled(it)}
        self._require_kernels_of_vertices(cls)
        self.operations, self.steps = cls.operations, cls.steps
        self.storage = cls.storage(cls.fields, self.step if self.steps else None)
        self._uses, self._records = self.storage.uses, cls.records_type
        if wrong := self.storage.wrong_fields(cls.records_type._fields):
            raise TypeError(f"{self._place}: {wrong}")
        self._algorithms: dict[Algorithm, tuple[Uses, frozenset[str]]] = {}
        self.queries = {
            name: self._derived(self._kernel(name, f"(m, {name[0]}, out) -> count"))
            for name in QUERIES
        }
        self.operating = {name: self._derived(self._operation(name)) for name in self.operations}
        self.lasting: dict[str, Uses] = {}
        if not cls.stable_edge_handles:
            between = self._kernel("edge_between", "(m, a, b) -> edge or -1")
            for name, uses in self.operating.items():
                if self.operations[name].element == "edge":
                    self.lasting[name] = self._derived(named_by_ends(uses.kernel, between))
        lacking = {it.kernel for it in self.steps.values()} - self.kernels.keys()
        if lacking:
            raise TypeError(f"{self._place} has no kernels of steps: {sorted(lacking)}")
        stepping = ((name, self.kernels[it.kernel]) for name, it in self.steps.items())
        self.stepping = {name: self._derived(kernel) for name, kernel in stepping}

    def exists(self, element: str) -> Kernel:
        """Whether there is one; a half-edge that names its edge is one where that is."""
        own = self.kernels.get(f"{element}_exists")
        return own or self.kernels[f"{element.removeprefix('half_')}_exists"]

    def step(self, name: str, records: Any, handles: Array) -> Indices:
        """Where a step leads from each of the live ``handles`` (n,) int64."""
        found = np.empty(len(handles), np.int64)
        self.walks[name](handles, found, *records)
        return found

    def perform(self, operation: str, pinned: Any) -> Callable[[int], Array]:
        """See ``Uses.perform``. Where batches take lasting names, handles prefetch nothing."""
        ahead = operation not in self.lasting
        prefetch = prefetching(self.kernels, self.operations[operation]) if ahead else nothing
        return self.operating[operation].perform(pinned, prefetch)

    def perform_lasting(self, operation: str, pinned: Any) -> Callable[[int], Array]:
        """The same on edges by their lasting names."""
        prefetch = prefetching(self.kernels, self.operations[operation], by_ends=True)
        return self.lasting[operation].perform(pinned, prefetch)

    def algorithm(self, make: Algorithm) -> tuple[Uses, frozenset[str]]:
        """What ``make`` makes for this structure, and of which kernels; asked once."""
        if make not in self._algorithms:
            operations = {name: uses.kernel for name, uses in self.operating.items()}
            asked = [_Asked(self.kernels), _Asked(operations)]
            made = make(*asked)
            if self._uses is Uses and not is_compiled(made):
                raise TypeError(f"{make!r} makes no @kernel algorithm(m, plan) -> result")
            uses = self._derived(made)
            self._algorithms[make] = uses, frozenset[str]().union(*(it.names for it in asked))
        return self._algorithms[make]

    @cached_property
    def walks(self) -> dict[str, Callable[..., int]]:
        """Every step from many handles, see ``Uses.walk``."""
        sources = {name: self.exists(it.source) for name, it in self.steps.items()}
        return {name: self.stepping[name].walk(exists) for name, exists in sources.items()}

    @cached_property
    def copy_touched(self) -> Callable[..., int]:
        """See ``Uses.copy_touched``."""
        exists, coordinate = self.kernels["face_exists"], self.kernels["coordinate"]
        return self.queries["face_vertices"].copy_touched(exists, coordinate)

    def _derived(self, kernel: Kernel) -> Uses:
        return self._uses(kernel, self._records, self.storage.columns(self._records))

    def _require_parts(self, cls: Any) -> None:
        missing = [it for it in ("records_type", "fields") if not hasattr(cls, it)]
        for method in ("build", "_require_invariants"):
            if getattr(getattr(cls, method), "__isabstractmethod__", False):
                missing.append(method)
        if missing:
            raise TypeError(f"{self._place} does not say: {', '.join(missing)}")
        claimed = cls.claims.costs if hasattr(cls, "claims") else {}
        if unknown := sorted(set(claimed) - {*QUERIES, *OPERATIONS}):
            raise TypeError(f"{self._place}: claims of no query and no operation: {unknown}")

    def _require_kernels_of_vertices(self, cls: Any) -> None:
        """What vertices refer to is kept up by kernels of which the defaults do nothing."""
        refers = any(it.element == "vertex" and it.target for it in cls.fields)
        for name, called in (("clear_vertex", "(m, v)"), ("set_vertex_face", "(m, v, f)")):
            if refers and self.kernels.get(name) in (None, OF_ARRAYS[name]):
                raise TypeError(
                    f"{self._place} has no @kernel {name}{called}, and its vertices refer to "
                    "records; see hem.authoring.defaults"
                )

    def _kernel(self, name: str, called: str) -> Kernel:
        if name not in self.kernels:
            raise TypeError(f"{self._place} has no @kernel {name}{called}")
        return self.kernels[name]

    def _operation(self, name: str) -> Kernel:
        make = self.operations[name].make
        try:
            return make(self.kernels)
        except KeyError as missing:
            raise TypeError(
                f"{self._place} has no @kernel {missing.args[0]}, which {name} takes; see "
                f"{make.__module__}"
            ) from None
