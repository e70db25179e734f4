"""Walks around a vertex or a face, and the queries that follow: written once over the steps taken.

A circulator visits what is given by all that it comes past: ``circulate(m, element, state, given)
-> (state, last)``, with ``state = visit(m, it, state, given)`` for each. A query writes it down.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

from hem.arrays import Array
from hem.authoring.kernels import Kernel, append_face, kernel, without


class Way(NamedTuple):
    """How what a circulator comes past is visited."""

    visit: Kernel
    """``visit(m, it, state, given) -> state``"""
    turned: Kernel
    """``turned(given, state) -> state``: what becomes of all that came clockwise."""
    in_order: bool = False
    """Whether it is done for all elements, one after the other."""

    def asking(self, ahead: Kernel) -> Kernel:
        """What asks ahead, see ``steps.asking``, where that pays."""
        return ahead if self.in_order else never


Giving = Callable[[Any, Way], Kernel]
"""Makes a circulator of what is given, and of how that is visited."""

Visiting = Callable[[Way], Kernel]
"""Makes ``visit_all(m, element, state, given) -> (state, open)``.

``open``: whether the faces around a vertex do not close around it, as it lies on the border.
"""

_VISITING: dict[Kernel, Visiting] = {}
"""Of the queries that are made here."""

STEPPING: dict[Kernel, tuple[Kernel, Kernel]] = {}
"""``first`` and ``clockwise`` of what ``joined_by_steps`` has made."""

_IS_OPEN: dict[Kernel, Kernel] = {}
"""Of those whose walk does not tell it, ``is_open(m, v)``."""


@kernel
def never(m: Any, it: int) -> bool:
    """Stands for ``is_open`` where the walk tells it, and for what asks ahead."""
    return False


@kernel
def as_met(m: Any, h: int, at: int) -> int:
    """What is met on the way around a vertex or a face, where that is what is wanted."""
    return h


@kernel
def write(m: Any, it: int, count: int, out: Array) -> int:
    """Visit by writing down -> how many are written."""
    out[count] = it
    return count + 1


@kernel
def reverse(out: Array, count: int) -> int:
    """Turn the first ``count`` elements round, in place."""
    first, last = 0, count - 1
    while first < last:
        out[first], out[last] = out[last], out[first]
        first += 1
        last -= 1
    return count


@kernel
def in_any_order(given: Any, state: Any) -> Any:
    """Stands for ``reverse`` where what was visited is not to be turned round."""
    return state


AS_QUERY = Way(write, reverse)
"""Written down, counterclockwise."""


def query_of(visiting: Visiting, is_open: Kernel | None = None) -> Kernel:
    """Make a query, which writes down what is visited. Others may visit it otherwise.

    ``is_open(m, v)``, where the walk itself does not tell and says no: see ``Visiting``.
    """
    write_all = visiting(AS_QUERY)

    @kernel
    def query(m: Any, element: int, out: Array) -> int:
        count, _ = write_all(m, element, 0, out)
        return int(count)

    _VISITING[query] = visiting
    if is_open:
        _IS_OPEN[query] = is_open
    return query


@cache
def visiting(query: Kernel, visit: Kernel) -> Kernel:
    """Make ``visit_all(m, element, state, given) -> state``, for a query and what to do with each.

    It is for passes over all elements in order: records are asked for before they are read.
    ``visit(m, it, state, given) -> state`` is called for every answer, in any order: on the way,
    where the query is a walk, which takes half the time of writing to scratch and reading again.
    Else the answers are written to ``given.out``. ``state`` is a number, or a tuple of some.
    """
    if query in _VISITING:
        walk = _VISITING[query](Way(visit, in_any_order, in_order=True))

        @kernel
        def visit_all(m: Any, element: int, state: Any, given: Any) -> Any:
            state, _ = walk(m, element, state, given)
            return state

        return visit_all

    @kernel
    def visit_written(m: Any, element: int, state: Any, given: Any) -> Any:
        out = given.out
        for i in range(query(m, element, out)):
            state = visit(m, out[i], state, given)
        return state

    return visit_written


@kernel
def count_one(m: Any, it: int, count: int, given: Any) -> int:
    """Visit by counting."""
    return count + 1


@cache
def counting(query: Kernel) -> Kernel:
    """Make ``count(m, element, out) -> int``: how many answers there are, not kept if it may be."""
    if query not in _VISITING:
        return query
    count_all = visiting(query, count_one)

    @kernel
    def count(m: Any, element: int, out: Array) -> int:
        return int(count_all(m, element, 0, out))

    return count


@cache
def ring(vertex_vertices: Kernel, vertex_faces: Kernel) -> Kernel:
    """Make ``ring(m, v, out) -> (count, open, most)``: the neighbors of v, and if it is a border.

    ``most``: the larger of the numbers of neighbors and of faces, which are more where three meet
    at an edge.
    Cost: that of ``vertex_vertices``, and of ``vertex_faces`` where that does not tell.
    """
    if vertex_vertices in _VISITING:
        write_all = _VISITING[vertex_vertices](Way(write, in_any_order))
        is_open = _IS_OPEN.get(vertex_vertices, never)

        @kernel
        def write_ring(m: Any, v: int, out: Array) -> tuple[int, bool, int]:
            count, told = write_all(m, v, 0, out)
            return count, told or is_open(m, v), count

        return write_ring
    count_faces = counting(vertex_faces)

    @kernel
    def count_both(m: Any, v: int, out: Array) -> tuple[int, bool, int]:
        count = vertex_vertices(m, v, out)
        faces = count_faces(m, v, out[count:])
        return count, faces < count, max(count, faces)

    return count_both


def circulator(clockwise: Kernel, counterclockwise: Kernel, ahead: Kernel = never) -> Giving:
    """Make, for ``give(m, item, v)``, ``around(m, start, v, state, given) -> (state, last)``.

    A step ``step(m, item, v)`` goes from one item at vertex ``v`` (a half-edge, an edge, a
    triangle) to the next, or to a negative number at the border. What the items give comes
    counterclockwise. A fan open at the border is circulated from both sides of ``start``; ``last``
    is its last item, and -1 where the fan is closed. ``ahead(m, item)``: see ``steps.asking``.
    Cost O(valence).
    """

    def giving(give: Kernel, way: Way) -> Kernel:
        visit, turned, asks = way.visit, way.turned, way.asking(ahead)

        @kernel
        def around(m: Any, start: int, v: int, state: Any, given: Any) -> tuple[Any, int]:
            item = start
            while item >= 0:  # what is given is visited at once: to come back to it takes longer
                asks(m, item)
                state = visit(m, give(m, item, v), state, given)
                item = clockwise(m, item, v)
                if item == start:
                    return turned(given, state), -1
            state = turned(given, state)
            last = start
            item = counterclockwise(m, start, v) if start >= 0 else -1
            while item >= 0:
                state = visit(m, give(m, item, v), state, given)
                last = item
                item = counterclockwise(m, item, v)
            return state, last

        return around

    return giving


def from_vertex(first: Kernel, around: Giving, enter: Kernel = as_met) -> Giving:
    """Make, for ``give(m, h)``, the circulator of a vertex that begins at ``first(m, v)``.

    ``enter(m, it, v)`` is the half-edge that leaves v for what ``first`` leads to. O(valence).
    """

    def giving(give: Kernel, way: Way) -> Kernel:
        @kernel
        def give_of(m: Any, h: int, v: int) -> int:
            return give(m, h)

        walk = around(give_of, way)

        @kernel
        def circulate(m: Any, v: int, state: Any, given: Any) -> tuple[Any, int]:
            start = first(m, v)
            return walk(m, enter(m, start, v) if start >= 0 else -1, v, state, given)

        return circulate

    return giving


class Given(NamedTuple):
    """What a half-edge gives: by itself, ``here(m, h)``, or where its twin is known.

    ``beyond(m, h, twin)`` is the same, read where a walk that crosses to the twin comes by anyway.
    """

    here: Kernel
    beyond: Kernel


def by_twins(
    leaving: Kernel, twin: Kernel, following: Kernel, previous: Kernel, ahead: Kernel = never
) -> Giving:
    """Make, for what is ``Given``, the circulator of a vertex where twins are recorded.

    It begins at ``leaving(m, v)``, crosses to the twin and goes on with what follows that, so that
    each step waits for two records. Else as ``from_vertex`` and ``circulator``. O(valence).
    """

    def giving(give: Given, way: Way) -> Kernel:
        here, beyond = give
        visit, turned, asks = way.visit, way.turned, way.asking(ahead)

        @kernel
        def circulate(m: Any, v: int, state: Any, given: Any) -> tuple[Any, int]:
            first = leaving(m, v)
            if first < 0:
                return state, -1
            h, other = first, twin(m, first)
            while other >= 0:
                asks(m, other)
                state = visit(m, beyond(m, h, other), state, given)
                h = following(m, other)
                if h == first:
                    return turned(given, state), -1
                other = twin(m, h)
            state = turned(given, visit(m, here(m, h), state, given))
            last, h = first, twin(m, previous(m, first))
            while h >= 0:
                state = visit(m, here(m, h), state, given)
                last = h
                h = twin(m, previous(m, h))
            return state, last

        return circulate

    return giving


def each(giving: Giving, give: Any) -> Kernel:
    """Make a query: what is given by every half-edge that a circulator comes past."""
    return query_of(_visiting_each(giving, give))


def each_but_last(giving: Giving, give: Kernel) -> Kernel:
    """Make a query as ``each``, without the last half-edge if a fan is open.

    It leaves the vertex along the border, and gives none: a negative number.
    """
    write_all, visiting_each = giving(give, AS_QUERY), _visiting_each(giving, give)

    @kernel
    def query(m: Any, v: int, out: Array) -> int:
        count, last = write_all(m, v, 0, out)
        return count if last < 0 else count - 1

    def visiting(way: Way) -> Kernel:
        visit = way.visit

        @kernel
        def visit_given(m: Any, it: int, state: Any, given: Any) -> Any:
            return visit(m, it, state, given) if it >= 0 else state

        return visiting_each(way._replace(visit=visit_given))

    _VISITING[query] = visiting
    return query


def _visiting_each(giving: Giving, give: Any) -> Visiting:
    def visiting(way: Way) -> Kernel:
        circulate = giving(give, way)

        @kernel
        def visit_all(m: Any, element: int, state: Any, given: Any) -> tuple[Any, bool]:
            state, last = circulate(m, element, state, given)
            return state, last >= 0

        return visit_all

    return visiting


def each_and_last(giving: Giving, give: Any, last_of: Kernel) -> Kernel:
    """Make a query as ``each``, with ``last_of(m, h)`` of the last half-edge if a fan is open.

    No half-edge leaves the vertex beyond it, but the edge and the neighbor are there.
    """

    def visiting(way: Way) -> Kernel:
        circulate, visit = giving(give, way), way.visit

        @kernel
        def visit_all(m: Any, element: int, state: Any, given: Any) -> tuple[Any, bool]:
            state, last = circulate(m, element, state, given)
            if last >= 0:
                state = visit(m, last_of(m, last), state, given)
            return state, last >= 0

        return visit_all

    return query_of(visiting)


def each_side(
    first: Kernel,
    following: Kernel,
    give: Kernel,
    enter: Kernel = as_met,
    ahead: Kernel = never,
) -> Kernel:
    """Make a query of a triangle: ``give(m, h)`` of its half-edges from ``first(m, f)``. O(1).

    ``enter(m, it, f)`` is the half-edge in f of what ``first`` and ``following(m, h)`` lead to.
    """

    def visiting(way: Way) -> Kernel:
        visit, asks = way.visit, way.asking(ahead)

        @kernel
        def visit_all(m: Any, f: int, state: Any, given: Any) -> tuple[Any, bool]:
            it = first(m, f)
            asks(m, it)
            for _ in range(3):
                h = enter(m, it, f)
                state = visit(m, give(m, h), state, given)
                it = following(m, h)
            return state, False

        return visit_all

    return query_of(visiting)


def faces_across(
    first: Kernel, following: Kernel, across: Kernel, enter: Kernel = as_met
) -> Kernel:
    """Make ``face_faces`` as ``each_side``: ``across(m, h)`` is the face beyond h, or -1."""

    @kernel
    def face_faces(m: Any, f: int, out: Array) -> int:
        it, count = first(m, f), 0
        for _ in range(3):
            h = enter(m, it, f)
            face = across(m, h)
            if face >= 0:
                count = append_face(out, count, face)
            it = following(m, h)
        return count

    return face_faces


@kernel
def as_named(m: Any, e: int) -> int:
    """The name of an edge that has one name only."""
    return e


def edges_at_both_ends(
    edge_vertices: Kernel, vertex_edges: Kernel, edge_of: Kernel = as_named
) -> Kernel:
    """Make the kernel ``edge_edges``: the edges at either end, without the edge itself.

    ``edge_of(m, h)`` is the name of an edge that may be asked for by more than one handle.
    """

    @kernel
    def edge_edges(m: Any, e: int, out: Array) -> int:
        edge_vertices(m, e, out)
        a, b = out[0], out[1]
        around = vertex_edges(m, a, out)
        name = e
        count = without(out, around, name)
        if count == around:
            name = edge_of(m, e)
            count = without(out, around, name)
        if count == around:  # the handle names two vertices that are not joined
            return 0
        return count + without(out[count:], vertex_edges(m, b, out[count:]), name)

    return edge_edges


def found_by_steps(first: Kernel, clockwise: Kernel, reaches: Kernel, back: Kernel) -> Kernel:
    """Make ``find(m, a, b) -> item``: the first item around a that reaches b, or -1.

    ``first(m, v)`` is an item to begin at, or -1; ``reaches(m, item, v, w)`` tells whether the item
    at v is the one for w. The steps are those of ``circulator``. Cost O(valence of a).
    """

    @kernel
    def find(m: Any, a: int, b: int) -> int:
        start = first(m, a)
        item = start
        while item >= 0:
            if reaches(m, item, a, b):
                return item
            item = clockwise(m, item, a)
            if item == start:
                return -1
        item = back(m, start, a) if start >= 0 else -1
        while item >= 0:
            if reaches(m, item, a, b):
                return item
            item = back(m, item, a)
        return -1

    return find


def joined_by_steps(first: Kernel, clockwise: Kernel, ends: Kernel, find: Kernel) -> Kernel:
    """Make ``joined(m, a, b) -> bool``: whether an edge joins two vertices that have faces.

    ``ends(m, item, v, w)`` tells whether the edge that leaves v for an item ends at w, and ``find``
    finds an item at v whose face has w. Both vertices are circulated by turns, so the cost is
    O(the smaller of both valences); where the first that comes to an end lies on the border, its.
    """

    @kernel
    def joined(m: Any, a: int, b: int) -> bool:
        from_a, from_b = first(m, a), first(m, b)
        at_a, at_b = from_a, from_b
        while not ends(m, at_a, a, b) and not ends(m, at_b, b, a):
            at_a = clockwise(m, at_a, a)
            if at_a == from_a:
                return False
            if at_a < 0:
                return bool(find(m, a, b) >= 0)
            at_b = clockwise(m, at_b, b)
            if at_b == from_b:
                return False
            if at_b < 0:
                return bool(find(m, b, a) >= 0)
        return True

    STEPPING[joined] = first, clockwise
    return joined
