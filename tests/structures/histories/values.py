"""Attributes in random histories, and what they must be, from the changes of faces alone."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import hem
from hem.contract import Navigable, Structure
from tests.structures.histories.surface import Change, Side, Surface, both
from tests.structures.histories.truth import Predicted

ELEMENTS = ("vertex", "face", "corner", "edge", "half_edge", "plain", "plain corner")
"""What a world may have attributes of; ``plain`` ones are linear in the position."""

NOTHING = -1
SLACK = 1e-3


def plain(points: Any) -> Any:
    """Something that is linear in the position; not a bit different at the same place."""
    x, y, z = np.asarray(points, float).reshape(-1, 3).T
    return x - 3 * y + 0.25 * z + 5


class Values:
    """The attributes of some structures that hold the same mesh; ``chosen`` of ``ELEMENTS``."""

    def __init__(self, m: Surface, many: list[Structure], chosen: set[str]) -> None:
        self.chosen = chosen
        self.of: dict[str, dict[Any, Any]] = {
            "vertex": {v: v for v in m.points},
            "face": {f: f for f in m.faces},
            "corner": {(f, v): f % 3 for f, row in m.faces.items() for v in row},
            "edge": {it: 1000 * it[0] + it[1] for it in m.edges()},
        }
        self.ways = {outer: self._ways(m, outer) for outer in (True, False)}
        for s in many:
            self._give(m, s)

    def state(self) -> Any:
        """What ``restore`` needs."""
        return {k: it.copy() for k, it in self.of.items()}, {
            k: it.copy() for k, it in self.ways.items()
        }

    def follow(self, told: Predicted) -> None:
        """Carry on what the values must be."""
        for change in told.changes:
            self._carry(change)
        self.of["vertex"].update({v: NOTHING for v, row in told.vertices.items() if not row})

    def renumber(self, vertex: dict[int, int], face: dict[int, int]) -> None:
        """After ``compact``."""
        of = self.of
        of["vertex"] = {vertex[v]: it for v, it in of["vertex"].items()}
        of["face"] = {face[f]: it for f, it in of["face"].items()}
        of["corner"] = {(face[f], vertex[v]): it for (f, v), it in of["corner"].items()}
        of["edge"] = {both(vertex[a], vertex[b]): it for (a, b), it in of["edge"].items()}
        for outer, ways in self.ways.items():
            self.ways[outer] = {(vertex[a], vertex[b]): it for (a, b), it in ways.items()}

    def rewrite(self, s: Structure, told: Predicted) -> None:
        """Give plain values to what lies elsewhere or has no parents: nobody else can know them."""
        vertices = sorted(told.changed[0] | {v for v, row in told.vertices.items() if not row})
        new = [f for f, of in told.parts.items() if of < 0]
        if "plain" in self.chosen and vertices:
            s.vertex_attribute("plain")[vertices] = plain(s.points[vertices])
        if "plain corner" in self.chosen and (vertices or new):
            faces = np.union1d(s.vertex_faces(vertices).values, new).astype(int)
            at = s.points[s.face_vertices(faces).values]
            s.corner_attribute("plain")[faces] = plain(at)

    def check(self, m: Surface, s: Structure) -> None:
        """All values are what they must be."""
        for element in self.chosen & {"vertex", "face"}:
            values, expected = getattr(s, f"{element}_attribute")("origin"), self.of[element]
            handles = [*expected]
            found = dict(zip(handles, values[handles].tolist(), strict=True))
            assert found == expected, f"{element} values of {s!r}: {differing(found, expected)}"
        if "corner" in self.chosen:
            self._check_corners(s)
        if "edge" in self.chosen and not s.emulated:
            found = dict(zip(*self._edges(s), strict=True))
            assert found == self.of["edge"], (
                f"edge values of {s!r}: {differing(found, self.of['edge'])}"
            )
        if "half_edge" in self.chosen and isinstance(s, Navigable):
            h, expected = s.half_edges(), self.ways[names_outside(type(s))]
            ways = zip(s.origin(h).tolist(), s.tip(h).tolist(), strict=True)
            found = dict(zip(ways, s.half_edge_attribute("origin")[h].tolist(), strict=True))
            assert found == expected, f"half-edge values of {s!r}: {differing(found, expected)}"
        self._check_plain(s)

    # Behind it ---------------------------------------------------------------------------------

    def _give(self, m: Surface, s: Structure) -> None:
        vertices, faces = s.vertices(), s.faces()
        if "vertex" in self.chosen:
            s.vertex_attribute("origin", np.int64, default=NOTHING)[vertices] = vertices
        if "face" in self.chosen:
            s.face_attribute("origin", np.int64, default=NOTHING)[faces] = faces
        if "corner" in self.chosen:
            chart = np.repeat(faces % 3, s.face_vertices(faces).counts)
            s.corner_attribute("chart", np.int64, default=NOTHING)[faces] = chart
        if "edge" in self.chosen and not s.emulated:
            values = s.edge_attribute("origin", np.int64, default=NOTHING)
            pairs, _ = self._edges(s)
            values[s.edges()] = [1000 * a + b for a, b in pairs]
        if "half_edge" in self.chosen and isinstance(s, Navigable):
            h, values = s.half_edges(), s.half_edge_attribute("origin", np.int64, default=NOTHING)
            values[h] = 1000 * s.origin(h).astype(np.int64) + s.tip(h)
        if "plain" in self.chosen:
            s.vertex_attribute("plain", np.float64)[vertices] = plain(s.points[vertices])
        if "plain corner" in self.chosen:
            at = s.points[s.face_vertices(faces).values]
            s.corner_attribute("plain", np.float64)[faces] = plain(at)

    def _ways(self, m: Surface, outer: bool) -> dict[Side, int]:
        sides = {*m.sides} | ({(b, a) for a, b in m.sides} if outer else set())
        return {(a, b): 1000 * a + b for a, b in sides}

    def _carry(self, change: Change) -> None:
        of = self.of
        corners = self._carried_corners(change)
        for f in change.before:
            for v in change.before[f]:
                del of["corner"][f, v]
        of["corner"].update(corners)
        for v, parents in change.vertices.items():
            of["vertex"][v] = of["vertex"][parents[0]]
        of["vertex"].pop(change.gone, None)
        new = {
            f: of["face"].get(change.parts.get(f, -1), NOTHING)
            for f in change.after
            if f not in change.before
        }
        for f in change.before.keys() - change.after.keys():
            del of["face"][f]
        of["face"].update(new)
        gone, came = change.edges
        named = {new: of["edge"].get(both(*change.heirs.get(new, new)), NOTHING) for new in came}
        for it in gone:
            del of["edge"][it]
        of["edge"].update(named)
        outside = [{way for a, b in some for way in ((a, b), (b, a))} for some in change.edges]
        for ways, (went, new) in zip(
            (self.ways[True], self.ways[False]), (outside, change.sides), strict=True
        ):
            given = {it: ways.get(change.heirs.get(it, it), NOTHING) for it in new}
            for it in went:
                del ways[it]
            ways.update(given)

    def _carried_corners(self, change: Change) -> dict[tuple[int, int], int | None]:
        old, found = self.of["corner"], {}
        for f, row in change.after.items():
            whole = change.parts.get(f, f)
            for v in row:
                of = v if (whole, v) in old else change.vertices.get(v, (v,))[0]
                if (whole, of) in old:
                    found[f, v] = old[whole, of]
                else:
                    found[f, v] = self._from_beside(change, whole, of)
        return found

    def _from_beside(self, change: Change, f: int, v: int) -> int | None:
        """The value on this face's side of a seam; None where faces there do not agree."""
        old = self.of["corner"]
        there = [g for g, row in change.before.items() if v in row]
        if not there:
            return NOTHING
        own = old.get((f, change.gone))
        if (f, change.gone) not in old:
            found = {old[g, v] for g in there}
            return found.pop() if len(found) == 1 else None
        sides = {g: old[g, change.gone] for g in there if (g, change.gone) in old}
        found = {old[g, v] for g, side in sides.items() if side == own}
        if None in {own, *found, *sides.values()} or len(found) > 1:
            return None
        return found.pop() if found else own

    def _check_corners(self, s: Structure) -> None:
        expected, faces = self.of["corner"], s.faces()
        rows = s.face_vertices(faces)
        keys = zip(np.repeat(faces, rows.counts).tolist(), rows.values.tolist(), strict=True)
        found = dict(zip(keys, s.corner_attribute("chart")[faces].tolist(), strict=True))
        for key, value in expected.items():
            if value is None:
                expected[key] = found[key]
        assert found == expected, f"corner values of {s!r}: {differing(found, expected)}"

    def _edges(self, s: Structure) -> tuple[list[Side], list[int]]:
        edges = s.edges()
        pairs = [both(a, b) for a, b in s.edge_array().tolist()]
        return pairs, s.edge_attribute("origin")[edges].tolist()

    def _check_plain(self, s: Structure) -> None:
        vertices, faces = s.vertices(), s.faces()
        if "plain" in self.chosen:
            found, expected = s.vertex_attribute("plain")[vertices], plain(s.points[vertices])
            assert np.allclose(found, expected, atol=SLACK), f"plain values of {s!r}"
        if "plain corner" in self.chosen:
            expected = plain(s.points[s.face_vertices(faces).values])
            found = s.corner_attribute("plain")[faces]
            assert np.allclose(found, expected, atol=SLACK), f"plain corners of {s!r}"


@cache
def names_outside(kind: type[Navigable]) -> bool:
    """Whether half-edges beyond the border are recorded, too."""
    return len(kind.build(hem.TriangleMesh(np.eye(3), [(0, 1, 2)])).half_edges()) == 6


def differing(found: dict[Any, Any], expected: dict[Any, Any]) -> str:
    """Where two differ."""
    keys = [k for k in found.keys() | expected.keys() if found.get(k) != expected.get(k)]
    return ", ".join(f"{k}: {found.get(k)} instead of {expected.get(k)}" for k in keys[:5])
