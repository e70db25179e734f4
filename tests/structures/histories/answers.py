"""Whether a structure answers as the faces say: queries, searches and steps along half-edges."""

from __future__ import annotations

from typing import Any

import pytest

from hem.contract import Navigable, Structure
from hem.errors import MeshError
from tests.structures.histories.surface import Side, Surface, both, sides_of


def check_answers(m: Surface, s: Structure) -> None:
    """The nine queries of all elements, every edge and face found by its corners, no dead one."""
    edges, ends = s.edges().tolist(), [both(a, b) for a, b in s.edge_array().tolist()]
    assert sorted(ends) == m.edges(), f"edges of {s!r}"
    name = dict(zip(ends, edges, strict=True))
    for query, expected in expected_answers(m, name).items():
        handles = [*expected]
        found = getattr(s, query)(handles).to_list() if handles else []
        for handle, row in zip(handles, found, strict=True):
            assert sorted(row) == sorted(expected[handle]), f"{query}({handle}) of {s!r}: {row}"
    assert {it: s.find_edge(*it) for it in name} == name, f"find_edge of {s!r}"
    vertices = sorted(m.points)
    for pair in zip(vertices, vertices[len(vertices) // 2 :], strict=False):
        assert s.find_edge(*pair) == name.get(both(*pair)), f"find_edge{pair} of {s!r}"
    for f, row in [*m.faces.items()][:: max(1, len(m.faces) // 8)]:
        if len(row) == 3:
            found = {s.find_face(*row), s.find_face(*row[::-1])}
            assert found <= {f, m.back(f)} - {-1}, f"find_face{row} of {s!r}: {found}"
    _refuse_dead(m, s)


def expected_answers(m: Surface, name: dict[Side, int]) -> dict[str, dict[int, Any]]:
    """What every query must give, by handle; ``name``: the handle of every edge."""
    beside = {v: [name[both(v, x)] for x in m.fan(v)] for v in m.points}
    faces = {it: [m.sides[w] for w in (it, it[::-1]) if w in m.sides] for it in name}
    return {
        "vertex_vertices": {v: m.fan(v) for v in m.points},
        "vertex_edges": beside,
        "vertex_faces": m.around,
        "edge_vertices": {e: it for it, e in name.items()},
        "edge_edges": {e: {*beside[a], *beside[b]} - {e} for (a, b), e in name.items()},
        "edge_faces": {e: faces[it] for it, e in name.items()},
        "face_vertices": m.faces,
        "face_edges": {f: [name[both(*it)] for it in sides_of(row)] for f, row in m.faces.items()},
        "face_faces": {
            f: {m.sides[b, a] for a, b in sides_of(row) if (b, a) in m.sides}
            for f, row in m.faces.items()
        },
    }


def _refuse_dead(m: Surface, s: Structure) -> None:
    """What is gone is no handle."""
    for query, live, end in (
        ("vertex_faces", m.points, m.vertex_end),
        ("face_vertices", m.faces, m.face_end),
    ):
        dead = next((it for it in range(end) if it not in live), end)
        for handles in (dead, [dead], end, -1):
            with pytest.raises(MeshError):
                getattr(s, query)(handles)


def check_steps(m: Surface, s: Structure) -> None:
    """Where each half-edge starts, ends, lies and leads, batched; some of them singly."""
    if not isinstance(s, Navigable):
        return
    h = s.half_edges()
    steps = ("origin", "tip", "face", "next", "previous", "twin", "edge")
    told = {name: getattr(s, name)(h).tolist() for name in steps}
    way = dict(zip(h.tolist(), zip(told["origin"], told["tip"], strict=True), strict=True))
    inner = {way[g]: f for g, f in zip(way, told["face"], strict=True) if f >= 0}
    assert inner == m.sides, f"sides of {s!r}"
    assert len({*way.values()}) == len(way), f"half-edges of {s!r} run the same way"
    for i, (g, (a, b)) in enumerate(way.items()):
        following, twin = told["next"][i], told["twin"][i]
        before = told["previous"][i]
        assert way[following][0] == b, f"next of {g} of {s!r}"
        assert way[before][1] == a, f"previous of {g} of {s!r}"
        if told["face"][i] >= 0:
            after, _ = m.beside(told["face"][i], b)
            assert way[following] == (b, after), f"next of {g} of {s!r}"
        assert way.get(twin, (b, a)) == (b, a), f"twin of {g} of {s!r}"
        assert twin >= 0 or (b, a) not in m.sides, f"twin of {g} of {s!r}"
    assert told["edge"] == [s.find_edge(*it) for it in way.values()], f"edge of {s!r}"
    vertices, faces = sorted(m.points), sorted(m.faces)
    for v, g in zip(vertices, s.vertex_half_edge(vertices).tolist(), strict=True):
        assert (way[g][0] == v) if m.around[v] else g == -1, f"half-edge of vertex {v} of {s!r}"
    for f, g in zip(faces, s.face_half_edge(faces).tolist(), strict=True):
        assert inner.get(way[g]) == f, f"half-edge of face {f} of {s!r}"
    for i in range(0, len(h), max(1, len(h) // 8)):
        singly = {name: getattr(s, name)(int(h[i])) for name in steps}
        assert singly == {name: told[name][i] for name in steps}, f"{h[i]} of {s!r}"
