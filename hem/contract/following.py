"""What follows every edit of a mesh: its attributes, then whoever subscribed."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from hem.arrays import Array
from hem.contract.attributes import Attribute, Rule, fitting
from hem.contract.queries import Queries
from hem.contract.sides import SideAttribute
from hem.contract.state import State
from hem.edit import Edit
from hem.errors import MeshError
from hem.listeners import Listeners

Kept = dict[tuple[str, str], tuple[type[Attribute], Any, Rule, tuple[Any, ...]]]
"""Attributes as they were: by element and name their kind, default, rule and ``state()``."""


class Followers:
    """Subscribers of one mesh, and its attributes by element and name."""

    def __init__(self, state: State, queries: Queries) -> None:
        self._state, self._queries = state, queries
        self.subscribers = Listeners()
        self.attributes: dict[tuple[str, str], Attribute] = {}

    def __bool__(self) -> bool:
        return bool(self.subscribers or self.attributes)

    def publish(self, edit: Edit) -> None:
        """Have all follow an edit, also where one of them is interrupted."""
        try:
            self.carry(edit)
        finally:
            self.subscribers.tell(edit)

    def carry(self, edit: Edit) -> None:
        """Have the attributes follow, before anyone looks at them."""
        Listeners(it.follow for it in self.attributes.values()).tell(edit)

    def kept(self) -> Kept:
        """What the attributes are, in arrays of its own."""
        each = self.attributes.items()
        return {key: (type(it), it.default, it.on_split, it.state()) for key, it in each}

    def put_back(self, kept: Kept) -> None:
        """Have the values that were kept again, and the default where nothing was."""
        for key, attribute in self.attributes.items():
            as_kept = key in kept and _is_alike(attribute, *kept[key][:3])
            if as_kept:
                attribute.restore(kept[key][-1])
            else:  # made since, if only anew under its name
                attribute.clear()

    def adopt(self, kept: Kept, mesh: Any) -> None:
        """Have the same attributes as another mesh."""
        for key, (kind, default, on_split, values) in kept.items():
            self.make(kind, mesh, *key, default, on_split).restore(values)

    def make(self, kind: type[Attribute], mesh: Any, element: str, name: str, *rule: Any) -> Any:
        """An attribute that follows from here on, with a default and what else ``rule`` says."""
        made = kind(mesh, self._state, self._queries, element, name, *rule)
        self.attributes[element, name] = made
        return made


def _is_alike(attribute: Attribute, kind: type[Attribute], default: Any, rule: Rule) -> bool:
    """Whether an attribute is of a kind, and has the default and the rule that were kept."""
    alike = (type(attribute), attribute.default.dtype, attribute.on_split)
    return alike == (kind, default.dtype, rule) and _same(attribute.default, default)


class AttributeMethod:
    """Makes an attribute of one kind of elements of a mesh, or finds the one of the same name."""

    def __init__(
        self, mesh: Any, followers: Followers, element: str, kind: type[Attribute]
    ) -> None:
        self._mesh, self._followers = mesh, followers
        self._element, self._kind = element, kind

    def __call__(
        self, name: str, dtype: DTypeLike | None = None, shape: int | tuple[int, ...] = (),
        default: ArrayLike | None = None, on_split: Rule | None = None,
    ) -> Attribute:  # fmt: skip
        """As ``Structure.vertex_attribute`` says."""
        mesh, element = self._mesh, self._element
        if element == "edge" and mesh.emulated:
            raise MeshError(f"a {mesh.title} mesh records no edges that could have attributes")
        if not isinstance(name, str):
            raise MeshError(f"an attribute is asked for by its name, not {name!r}")
        known = self._followers.attributes.get((element, name))
        if known is not None and dtype is None and shape == ():
            if default is None and on_split is None:
                return known
            shape = known.default.shape
        if dtype is None:
            dtype = np.float32 if known is None else known.default.dtype
        try:
            given = fitting(0 if default is None else default, np.dtype(dtype), "the default")
            value = np.broadcast_to(given.copy(), shape)
        except (TypeError, ValueError, OverflowError) as error:
            raise MeshError(f"{element} attribute {name!r}: {error}") from error
        if value.dtype.hasobject or not value.size:
            what = "objects" if value.dtype.hasobject else "no numbers"
            raise MeshError(f"{element} attribute {name!r}: values are numbers, not {what}")
        if known is None:
            moved = "edge" in element and not mesh.stable_edge_handles
            kind = SideAttribute if moved else self._kind
            return self._followers.make(kind, mesh, element, name, value, on_split)
        made = known.default.dtype, known.default.shape, known.on_split
        alike = made == (value.dtype, value.shape, on_split or known.on_split)
        if not alike or not (default is None or _same(value, known.default)):
            raise MeshError(
                f"there is a {element} attribute {name!r} of {known.default.dtype} "
                f"{known.default.shape} already, with the default {known.default.tolist()} and "
                f"on_split={known.on_split!r}; ask for its name alone, or remove_attribute it first"
            )
        return known


def _same(one: Array, other: Array) -> bool:
    return np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")
