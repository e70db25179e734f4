"""What a structure's file is written with.

- ``kernel``, the decorator; the columns of ``counts`` (``FACE_END`` …); small parts of kernels.
- ``steps`` and ``walks``, from which queries follow; ``packed``, where no edges are recorded;
  ``marked``, where half-edges move;
- ``Field`` and ``counted``, which declare and begin the records;
- ``pair_half_edges`` and ``in_slices`` for the build;
- ``require…``, which state invariants;
- ``hem.authoring.operations``, what all structures do alike around their own changes.

What a structure must offer is said by ``hem.contract.Structure``, of which it is a subclass.
"""

from hem.authoring import marked, packed, scans, steps, sums, walks
from hem.authoring.defaults import OF_ARRAYS, kill_vertex, set_point, sides, vertex_exists
from hem.authoring.invariants import (
    require,
    require_count,
    require_edges,
    require_of_vertices,
    require_one_fan,
    require_one_loop,
    require_records,
    require_triangles,
)
from hem.authoring.kernels import (
    EDGE_END,
    EDGE_GROWTH,
    EDGE_ROOM,
    EDGES,
    FACE_END,
    FACE_ROOM,
    FACES,
    SIDES,
    VALENCE,
    VERTEX_END,
    VERTEX_ROOM,
    VERTICES,
    Kernel,
    Kernels,
    append_face,
    distinct,
    kernel,
    kernels_of,
    without,
)
from hem.authoring.marked import BITS, MARK, named_by_ends, scatter
from hem.authoring.operations import (
    BLOCK,
    ENTRIES,
    LEFT,
    OPERATIONS,
    RIGHT,
    SEEN,
    WIDTH,
    A,
    B,
    C,
    D,
    Operation,
    count_new,
    has_room,
    has_scratch,
    is_point,
    live_vertex,
    log_element,
    log_faces,
    log_parts,
    nothing,
    prefetching,
    vertex_maker,
)
from hem.authoring.pairing import Pairing, number_edges, pair_half_edges, pair_polygons
from hem.authoring.queries import ELEMENTS, QUERIES, Query
from hem.authoring.records import (
    ENDLESS,
    ENDS,
    REFERENCE_TYPES,
    UNKNOWN,
    Field,
    compacted,
    copied,
    counted,
    field_at,
    grown,
    in_use,
    live,
)
from hem.authoring.refusals import ALLOWED, NEEDS_ROOM, WORDS, Refusal
from hem.authoring.slices import in_slices, slice_count
from hem.authoring.sums import Sum
from hem.authoring.walks import visiting

__all__ = [
    "ALLOWED", "BITS", "BLOCK", "EDGES", "EDGE_END", "EDGE_GROWTH", "EDGE_ROOM", "ELEMENTS",
    "ENDLESS", "ENDS", "ENTRIES", "FACES", "FACE_END", "FACE_ROOM", "LEFT", "MARK", "NEEDS_ROOM",
    "OF_ARRAYS", "OPERATIONS", "QUERIES", "REFERENCE_TYPES", "RIGHT", "SEEN", "SIDES", "UNKNOWN",
    "VALENCE", "VERTEX_END", "VERTEX_ROOM", "VERTICES", "WIDTH", "WORDS", "A", "B", "C", "D",
    "Field", "Kernel", "Kernels", "Operation", "Pairing", "Query", "Refusal", "Sum", "append_face",
    "compacted", "copied", "count_new", "counted", "distinct", "field_at", "grown", "has_room",
    "has_scratch", "in_slices", "in_use", "is_point", "kernel", "kernels_of", "kill_vertex", "live",
    "live_vertex", "log_element", "log_faces", "log_parts", "marked", "named_by_ends", "nothing",
    "number_edges", "packed", "pair_half_edges", "pair_polygons", "prefetching", "require",
    "require_count", "require_edges", "require_of_vertices", "require_one_fan", "require_one_loop",
    "require_records", "require_triangles", "scans", "scatter", "set_point", "sides", "slice_count",
    "steps", "sums", "vertex_exists", "vertex_maker", "visiting", "walks", "without",
]  # fmt: skip
