"""One mesh in every structure at once, with all that follows it, for random histories.

Whatever is done is done to all of them: operations, batches, copies, pickles, snapshots that are
restored, edits that are interrupted. All must answer alike, and what follows them must be in step.
"""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np

import hem
import structures
from hem.contract import Structure
from tests.structures.actions import BATCHES, EULER, Action, Aimed, aim, check, perform

HANDLING = ("copy", "compact", "restore", "interrupt")
WAYS = (
    lambda s: s.copy(),
    copy.copy,
    copy.deepcopy,
    lambda s: pickle.loads(pickle.dumps(s)),
)


class Stop(BaseException):
    """An interrupt."""


class World:
    """The structures, their render meshes, and attributes of vertices, faces and corners."""

    def __init__(self, mesh: hem.TriangleMesh) -> None:
        self.many: list[Structure] = [structures.build(name, mesh) for name in structures.NAMES]
        for s in self.many:
            s.vertex_attribute("origin", np.int64)[s.vertices()] = s.vertices()
            s.face_attribute("origin", np.int64)[s.faces()] = s.faces()
            uv = s.corner_attribute("uv", np.float64)
            corners = s.face_vertices().values.astype(float)
            uv[s.faces()] = corners * np.repeat(s.faces() % 2, 3)  # seams between odd and even
        self._follow()
        self.euler: int | None = None
        self.check()

    def step(self, action: Action) -> str:
        """Do it -> what was done, or why it was refused."""
        if action.kind in HANDLING:
            getattr(self, f"_{action.kind}")(action)
            return action.kind
        aimed = aim(self.many[0], action)
        if aimed is None:
            return "nothing to choose from"
        return self._perform(aimed)

    def check(self) -> None:
        """Both validators, and all structures and what follows them alike."""
        self.euler = check(self.many, self.euler)
        expected = _values(self.many[0])
        for s, render in zip(self.many, self.renders, strict=True):
            found = _values(s)
            assert all(map(np.array_equal, found, expected)), f"attributes of {s!r}"
            afresh = hem.RenderMesh(s)
            assert np.array_equal(render.points, afresh.points), f"points of {s!r}"
            assert np.array_equal(render.indices, afresh.indices), f"indices of {s!r}"
            afresh.close()

    def _perform(self, aimed: Aimed) -> str:
        results = [perform(s, aimed) for s in self.many]
        differ = [s.name for s, it in zip(self.many, results, strict=True) if it != results[0]]
        assert not differ, f"{aimed} gave {results[0]}, but {differ} {results}"
        if isinstance(results[0], str):
            return results[0]
        if aimed.kind in EULER or aimed.kind in BATCHES:
            self.euler = None
        return aimed.kind

    def _follow(self) -> None:
        self.renders = [hem.RenderMesh(s) for s in self.many]

    def _copy(self, action: Action) -> None:
        """Go on with copies; what is done to the originals is not their concern."""
        before, self.many = self.many, [WAYS[action.first % 4](s) for s in self.many]
        for s in before:
            aimed = aim(s, action._replace(kind="split_all_faces"))
            if aimed is not None:
                perform(s, aimed)
        self._follow()

    def _compact(self, action: Action) -> None:
        for s in self.many:
            s.compact()

    def _restore(self, action: Action) -> None:
        """Do something and take it back."""
        for s in self.many:
            s.reserve(3)
            before = s.snapshot()
            aimed = aim(s, action._replace(kind=("split_face", "flip_edge")[action.first % 2]))
            if aimed is not None:
                perform(s, aimed)
            s.restore(before)
        self._follow()

    def _interrupt(self, action: Action) -> None:
        """Stop while subscribers are told; the edit is done."""
        aimed = aim(self.many[0], action._replace(kind="split_face"))
        for s in self.many if aimed else ():
            end = s.subscribe(_stop)
            try:
                perform(s, aimed)  # type: ignore[arg-type]
            except Stop:
                pass
            else:
                raise AssertionError("the interrupt did not come through")
            finally:
                end()


def _stop(edit: hem.Edit) -> None:
    raise Stop


def _values(s: Structure) -> list[Any]:
    """All attributes: of vertices, of faces, of corners from the smallest of each face on."""
    rows, uv = s.triangles(), s.corner_attribute("uv")[s.faces()].reshape(-1, 3)
    turned = (rows.argmin(axis=1)[:, None] + range(3)) % 3
    return [
        s.vertex_attribute("origin")[s.vertices()],
        s.face_attribute("origin")[s.faces()],
        np.take_along_axis(uv, turned, 1),
    ]
