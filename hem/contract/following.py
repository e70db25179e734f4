"""What follows every edit of a mesh: subscribers, attributes, render meshes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from hem.arrays import Handles, Points
from hem.contract.attributes import Attribute, CornerAttribute, EdgeAttribute, Rule
from hem.contract.sides import SideAttribute
from hem.contract.surveying import Surveying
from hem.edit import FACE, Edit
from hem.errors import MeshError
from hem.listeners import Listeners


class AttributeMethod:
    """Makes an attribute of one kind of elements of a mesh, or finds the one of the same name."""

    def __init__(self, mesh: Following, element: str, kind: type[Attribute]) -> None:
        self._mesh, self._element, self._kind = mesh, element, kind

    def __call__(
        self,
        name: str,
        dtype: DTypeLike | None = None,
        shape: int | tuple[int, ...] = (),
        default: ArrayLike = 0,
        on_split: Rule | None = None,
    ) -> Attribute:
        """As ``Structure.vertex_attribute`` says."""
        mesh, element = self._mesh, self._element
        if element == "edge" and mesh.emulated:
            raise MeshError(f"a {mesh.title} mesh records no edges that could have attributes")
        known = mesh._attributes.get((element, name))
        if known is not None and dtype is None:
            return known
        try:
            value = np.broadcast_to(np.asarray(default, dtype or np.float32), shape)
        except (TypeError, ValueError) as error:
            raise MeshError(f"{element} attribute {name!r}: {error}") from error
        if known is None:
            moved = "edge" in element and not mesh.stable_edge_handles
            kind = SideAttribute if moved else self._kind
            made = kind(mesh, element, name, value, on_split)
            mesh._attributes[element, name] = made
            return made
        if (known.default.dtype, known.default.shape) != (value.dtype, value.shape):
            raise MeshError(
                f"there is a {element} attribute {name!r} of {known.default.dtype} "
                f"{known.default.shape} already; remove_attribute it first"
            )
        return known


def attribute_method(element: str, kind: type[Attribute], words: str) -> Any:
    """The attribute ``Structure.vertex_attribute`` and its like."""

    def bound(self: Following) -> AttributeMethod:
        method = AttributeMethod(self, element, kind)
        method.__doc__ = attribute.__doc__
        return method

    attribute = cached_property(bound)
    attribute.__doc__ = (
        f"A value for every {element.replace('_', '-')}, found by its name, or made: the default\n"
        "everywhere.\n\n"
        "``dtype``: float32 unless it is said. ``shape``: of one value, () for a number.\n"
        f"``on_split``: see ``Rule``. {words}\n"
        "Copies of the mesh and pickles have it, too; ``compact`` renumbers it. Cost O(n) once,\n"
        "then O(edit). MeshError where there is one of the name and of another type."
    )
    return attribute


class Following(Surveying, abstract=True):
    """Subscribers, and attributes by element and name."""

    vertex_attribute: AttributeMethod = attribute_method(
        "vertex", Attribute, "Floating-point values are interpolated, others copied."
    )
    face_attribute: AttributeMethod = attribute_method(
        "face", Attribute, "The parts of a split face copy what it has."
    )
    edge_attribute: AttributeMethod = attribute_method(
        "edge",
        EdgeAttribute,
        "The parts of a split edge copy what it has. MeshError where edges are not recorded.",
    )
    corner_attribute: AttributeMethod = attribute_method(
        "corner",
        CornerAttribute,
        "As for vertices; see ``CornerAttribute``. ``collapse_edges`` does an edit per edge then.",
    )

    def attributes(self) -> list[Attribute]:
        """All there are, in the order they were made."""
        return list(self._attributes.values())

    @property
    def told_one_by_one(self) -> bool:
        """Whether every operation is an edit of its own, as corners or half-edges have values.

        A batch does not tell what came where in between, and a seam must not be torn. So it is of
        edges whose handles are not stable.
        """
        stable = ("edge",) if self.stable_edge_handles else ()
        return any(it.element not in ("vertex", "face", *stable) for it in self.attributes())

    def remove_attribute(self, attribute: Attribute) -> None:
        """Have an attribute follow no longer. Raises MeshError if it is not of this mesh."""
        key = attribute.element, attribute.name
        if self._attributes.get(key) is not attribute:
            raise MeshError(f"{attribute!r} is no attribute of this mesh")
        del self._attributes[key]

    def subscribe(self, callback: Callable[[Edit], Any]) -> Callable[[], None]:
        """Have ``callback`` called with every ``Edit`` once it is done -> a way to end that.

        All are called, in the order they subscribed, even if one of them raises; what the first of
        them raised is raised then.
        """
        return self._subscribers.subscribe(callback)

    def copy_touched(self, touched: ArrayLike, points: Points, indices: Handles) -> None:
        """Write what an edit touched into the arrays of a render mesh, clockwise. O(edit).

        ``points`` (n, 3) and ``indices`` (m, 3) have a row for every vertex and face there ever
        was; what is dead becomes zeros. Raises MeshError for what is not there, or has no row.
        """
        entries, out = np.asarray(touched, np.int64), self._out["face"]
        done = self._copy_touched(entries, points, indices, out, *self.records)
        if done < len(entries):
            kind = "vertices" if entries[done] & 7 < FACE else "faces"
            raise MeshError(
                "no row for what an edit touched", **{kind: entries[done : done + 1] >> 3}
            )

    @cached_property
    def _copy_touched(self) -> Callable[..., int]:
        uses, k = self._uses["face_vertices"], self.kernels
        return uses.copy_touched(k["face_exists"], k["coordinate"])

    @cached_property
    def _subscribers(self) -> Listeners:
        return Listeners()

    @cached_property
    def _attributes(self) -> dict[tuple[str, str], Attribute]:
        return {}

    def _publish(self, edit: Edit) -> None:
        self._carry_on(edit)
        self._subscribers.tell(edit)

    def _carry_on(self, edit: Edit) -> None:
        """Have the attributes follow, before anyone looks at them."""
        for attribute in self._attributes.values():
            attribute.follow(edit)

    def _attribute_states(self) -> list[tuple[Any, ...]]:
        """What ``_adopt`` makes the same attributes of, in arrays of their own."""
        return [
            (type(it), it.element, it.name, it.default, it.on_split, it.state())
            for it in self.attributes()
        ]

    def _adopt(self, states: list[tuple[Any, ...]]) -> None:
        for kind, element, name, default, on_split, state in states:
            method = AttributeMethod(self, element, kind)
            method(name, default.dtype, default.shape, default, on_split).restore(state)
