"""The thesis' class model, of which ``structures.half_edge_objects`` is made.

``class_model`` has its classes, and ``records`` holds them as the records of a structure.
"""

from structures.objects.class_model import (
    Face,
    FaceList,
    HalfEdge,
    HalfEdgeList,
    Point,
    Vertex,
    VertexList,
    around,
)
from structures.objects.records import (
    COUNTED,
    ObjectRecords,
    ObjectStorage,
    build_records,
    index_of,
)

__all__ = [
    "COUNTED", "Face", "FaceList", "HalfEdge", "HalfEdgeList", "ObjectRecords", "ObjectStorage",
    "Point", "Vertex", "VertexList", "around", "build_records", "index_of",
]  # fmt: skip
