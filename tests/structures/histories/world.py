"""One mesh in every structure at once, with all that follows it, for random histories.

Whatever is done is done to all of them: operations, batches, copies, pickles, snapshots that are
restored, edits that are interrupted. What each operation must do is predicted from the faces alone
(``truth``): whether it is refused, what the edit tells, and what is left.

At every step ``step`` compares what was refused and what all edits told, entry by entry. ``check``
looks at everything else; whoever calls it seldom learns late, and must run the history again.
"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

import hem
import structures
from hem.contract import Structure
from hem.edit import CHANGED, CREATED, FACE, PARENT, REMOVED, VERTEX
from tests.structures.histories.actions import Action, Aimed, aim, faces_of, perform
from tests.structures.histories.answers import check_answers, check_steps
from tests.structures.histories.surface import Cycle, Surface, from_smallest
from tests.structures.histories.truth import FREE, Predicted, adopt, predict
from tests.structures.histories.values import ELEMENTS, Values

HANDLING = ("copy", "compact", "restore", "interrupt", "reserve")
WAYS = (
    lambda s: s.copy(),
    copy.copy,
    copy.deepcopy,
    lambda s: pickle.loads(pickle.dumps(s)),
)
FOLLOWERS = (*ELEMENTS, "render")
"""What may follow the meshes of a world."""


class Stop(BaseException):
    """An interrupt."""


class World:
    """The structures that can hold a mesh, and what follows them, some of ``FOLLOWERS``."""

    def __init__(
        self, mesh: hem.TriangleMesh | hem.PolygonMesh, followers: Iterable[str] = FOLLOWERS
    ) -> None:
        polygons = isinstance(mesh, hem.PolygonMesh)
        kinds = [it for it in structures.REGISTRY.values() if it.holds_polygons or not polygons]
        self.many: list[Structure] = [structures.build(it.name, mesh) for it in kinds]
        self.followers = {*followers}
        self.surface = Surface.of(mesh)
        self.values = Values(self.surface, self.many, self.followers - {"render"})
        self.turn = 0
        self._follow()
        self.check()

    def step(self, action: Action) -> str:
        """Do it -> what was done, or why it was refused."""
        self.turn += 1
        if action.kind in HANDLING:
            getattr(self, f"_{action.kind}")(action)
            return action.kind
        aimed = aim(self.surface, action)
        if aimed is None:
            return "nothing to choose from"
        if aimed.kind == "truncate_vertex":
            # New vertices are made in the order of the spokes, of which any may be the first.
            v, *spokes = aimed.elements
            found = self.many[0].vertex_vertices(v).tolist()
            assert from_smallest(found or [v]) == from_smallest(spokes or [v])
            aimed = aimed._replace(elements=(v, *found))
        return self._perform(aimed)

    def check(self, thorough: bool = True) -> None:
        """The raw validators, and that all structures and what follows them are as predicted.

        What is asked one by one, the queries and steps, is asked of all structures where
        ``thorough``, else of one in turn.
        """
        for s in self.many:
            s.validate()
            check_mesh(self.surface, s)
            assert np.array_equal(s.points, self.many[0].points, equal_nan=True), f"points of {s!r}"
            self.values.check(self.surface, s)
        for s in self.many if thorough else [self.many[self.turn % len(self.many)]]:
            check_answers(self.surface, s)
            check_steps(self.surface, s)
        if all(len(row) == 3 for row in self.surface.faces.values()):
            if not any(self.surface.back(f) >= 0 for f in self.surface.faces):
                hem.require_sound(self.many[0].to_triangles())
            if not self.renders:
                self._follow()
        for s, render in zip(self.many, self.renders, strict=bool(self.renders)):
            afresh = hem.RenderMesh(s)
            assert np.array_equal(render.points, afresh.points), f"points of {s!r}"
            assert np.array_equal(render.indices, afresh.indices), f"indices of {s!r}"
            afresh.close()

    def _perform(self, aimed: Aimed) -> str:
        told, results = predict(self.surface, aimed), []
        for s, heard in zip(self.many, self.heard, strict=True):
            heard.clear()
            results.append(self._one(s, aimed))
            refused = isinstance(results[-1], str)
            assert refused == (told is None), f"{aimed}: {results[-1]} of {s!r}"
            if told is None:
                assert results[-1] == results[0], f"{aimed}: {results}"
                assert not heard, f"{aimed} was refused, but told by {s!r}"
                continue
            if aimed.kind in FREE and s is self.many[0]:
                told = adopt(self.surface, told, faces_of(s), parents_of(heard))
            self._compare(s, aimed, told, results[-1], heard)
        if told is None:
            return str(results[0])
        self._carry_on(told)
        return aimed.kind

    def _one(self, s: Structure, aimed: Aimed) -> Any:
        """Do it. A render mesh cannot hold polygons: it says so once, when the edit is done."""
        try:
            return perform(s, aimed)
        except hem.MeshError as error:
            if "triangles only" not in str(error) or s.most_corners == 3:
                raise
            return None

    def _compare(
        self, s: Structure, aimed: Aimed, told: Predicted, result: Any, heard: list[hem.Edit]
    ) -> None:
        """What a structure told and gave back beside what is predicted."""
        lists, vertices, parts = read(heard)
        expected = (told.created, told.changed, told.removed)
        assert lists == expected, f"{aimed}: {s!r} told {lists} instead of {expected}"
        parents = vertices, {f: parts.get(f, -1) for f in told.created[1]}
        assert parents == (told.vertices, told.parts), f"{aimed}: parents {parents} of {s!r}"
        if result is not None:
            given = told.vertex if told.returned is None else told.returned
            own = aimed.kind in VALUED
            assert own or result[1] in (given, None), f"{aimed} gave {result} of {s!r}, not {given}"
        if s is self.many[self.turn % len(self.many)] and len(heard) == 1:
            check_edit(heard[0], told)

    def _carry_on(self, told: Predicted) -> None:
        self.values.follow(told)
        for s in self.many:
            self.values.rewrite(s, told)
        if any(len(self.surface.faces[f]) > 3 for f in told.created[1] | told.changed[1]):
            self.renders = []

    def _follow(self) -> None:
        self.heard: list[list[hem.Edit]] = [[] for _ in self.many]
        self.renders: list[hem.RenderMesh] = []
        for s, heard in zip(self.many, self.heard, strict=True):
            s._followers.subscribers.clear()
            s.subscribe(heard.append)
        triangles = all(len(row) == 3 for row in self.surface.faces.values())
        if "render" in self.followers and triangles:
            self.renders = [hem.RenderMesh(s) for s in self.many]

    def _copy(self, action: Action) -> None:
        """Go on with copies; what is done to the originals is not their concern."""
        before, self.many = self.many, [WAYS[action.first % 4](s) for s in self.many]
        for s in before:
            s.split_faces(s.faces()[:9], np.zeros((len(s.faces()[:9]), 3)))
        self._follow()

    def _compact(self, action: Action) -> None:
        vertex, face = self.surface.compact()
        self.values.renumber(vertex, face)
        for s in self.many:
            found = s.compact()
            for mine, theirs in ((vertex, found.vertices), (face, found.faces)):
                moved = {old: new for old, new in enumerate(theirs.tolist()) if new >= 0}
                assert moved == mine, f"{s!r} renumbered {moved} instead of {mine}"

    def _reserve(self, action: Action) -> None:
        for s in self.many:
            s.reserve(action.first % 50)

    def _restore(self, action: Action) -> None:
        """Do something and take it back."""
        kind = ("split_face", "flip_edge", "collapse_edge", "remove_face")[action.first % 4]
        aimed = aim(self.surface, action._replace(kind=kind))
        for s in self.many:
            s.reserve(3 + s.most_corners)
            before = s.snapshot()
            if aimed is not None:
                self._one(s, aimed)
            s.restore(before)
        self._follow()

    def _interrupt(self, action: Action) -> None:
        """Stop while subscribers are told; the edit is done."""
        aimed = aim(self.surface, action._replace(kind="split_face"))
        if aimed is None:
            return
        told = predict(self.surface, aimed)
        assert told is not None
        for s in self.many:
            end = s.subscribe(_stop)
            try:
                perform(s, aimed)
            except Stop:
                pass
            else:
                raise AssertionError("the interrupt did not come through")
            finally:
                end()
        self._carry_on(told)


VALUED = ("merge_faces", "erase_center_vertex", "truncate_vertex")
"""Operations that give a face back."""


def _stop(edit: hem.Edit) -> None:
    raise Stop


Lists = tuple[tuple[set[int], set[int]], ...]


def read(heard: Sequence[hem.Edit]) -> tuple[Lists, dict[int, Cycle], dict[int, int]]:
    """Created, changed and removed vertices and faces of several edits; parents of new ones.

    By the log itself: a second reader beside ``Edit``.
    """
    made: dict[int, set[int]] = {kind + what: set() for kind in (VERTEX, FACE) for what in range(3)}
    parents: dict[tuple[int, int], Cycle] = {}
    last = 0, 0
    for edit in heard:
        for entry in np.asarray(edit.touched).tolist():
            code, index = entry & 7, entry >> 3
            if code == PARENT:
                parents[last] = (*parents[last], index)
            else:
                made[code].add(index)
                last = code, index
                parents[last] = ()
    lists = []
    for what in (CREATED, CHANGED, REMOVED):
        both = []
        for kind in (VERTEX, FACE):
            new, gone = made[kind + CREATED], made[kind + REMOVED]
            every = new | gone | made[kind + CHANGED]
            both.append(
                {CREATED: new - gone, CHANGED: every - new - gone, REMOVED: gone - new}[what]
            )
        lists.append((both[0], both[1]))
    vertices = {v: parents[VERTEX + CREATED, v] for v in lists[0][0]}
    faces = {f: parents[FACE + CREATED, f] for f in lists[0][1]}
    return tuple(lists), vertices, {f: row[0] for f, row in faces.items() if row}


def parents_of(heard: Sequence[hem.Edit]) -> dict[int, int]:
    """The parent of every new face."""
    lists, _, parts = read(heard)
    return {f: parts.get(f, -1) for f in lists[0][1]}


def check_edit(edit: hem.Edit, told: Predicted) -> None:
    """The lists of an edit are ascending and hold what is predicted."""
    lists = {"created": told.created, "changed": told.changed, "removed": told.removed}
    for what, (vertices, faces) in lists.items():
        assert getattr(edit, f"{what}_vertices").tolist() == sorted(vertices)
        assert getattr(edit, f"{what}_faces").tolist() == sorted(faces)
    assert edit.vertex_parents.to_list() == [[*told.vertices[v]] for v in sorted(told.vertices)]
    assert edit.face_parents.tolist() == [told.parts[f] for f in sorted(told.parts)]


def check_mesh(m: Surface, s: Structure) -> None:
    """Faces, positions and counts are those predicted."""
    assert faces_of(s) == m.faces, f"faces of {s!r}"
    assert (s.n_faces, s.n_edges, s.n_vertices) == (len(m.faces), m.n_edges, len(m.points))
    vertices = s.vertices()
    assert vertices.tolist() == sorted(m.points)
    expected = np.array([m.points[v] for v in vertices.tolist()]).reshape(-1, 3)
    assert np.allclose(s.points[vertices], expected, atol=1e-5), f"points of {s!r}"
    assert np.isnan(np.delete(s.points, vertices, axis=0)).all()
    assert (len(s.points), s.face_end) == (m.vertex_end, m.face_end)
    assert max(map(len, m.faces.values()), default=3) <= s.most_corners
