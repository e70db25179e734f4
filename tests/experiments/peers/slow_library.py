"""A library made up for tests: it looks through all triangles for every answer."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from experiments.peers import Peer


def _build(points, triangles):
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)), axis=0)
    if (np.unique(np.sort(triangles), axis=0, return_counts=True)[1] > 1).any():
        raise ValueError("a face twice")
    return SimpleNamespace(points=points, triangles=triangles, edges=edges)


def faces_of(m, vertex):
    return [f for f, corners in enumerate(m.triangles.tolist()) if vertex in corners]


LIBRARY = Peer(
    title="Slow library",
    distribution="numpy",
    module="numpy",
    site="https://example.org/slow",
    manual="As `one` likes.",
    more="Nothing.",
    build=_build,
    faces=lambda m: len(m.triangles),
    arrays=lambda m: (m.points, m.triangles),
    ends=lambda m: m.edges,
    single={
        "vertex_faces": lambda m: lambda vertex: faces_of(m, vertex),
        "face_vertices": lambda m: m.triangles.__getitem__,
        "edge_vertices": lambda m: m.edges.__getitem__,
    },
    bulk={"vertex_faces": lambda m: [faces_of(m, v) for v in range(len(m.points))]},
    objects=True,
)
LIAR = replace(
    LIBRARY,
    single={"vertex_faces": lambda m: lambda vertex: faces_of(m, vertex)[1:]},
    bulk={"vertex_faces": lambda m: [faces_of(m, v)[:-1] for v in range(len(m.points))]},
)
ABSENT = replace(LIBRARY, title="Absent", distribution="no-such-distribution")
