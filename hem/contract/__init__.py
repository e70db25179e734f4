"""What every structure offers, for whoever uses one or writes one.

``Structure`` is the one class that is used: the contract, each method a line or two that hand it on
to a part. The parts, each on top of those before:

``Declared``    what follows from a structure's class, once: kernels, their uses, its storage
``Storage``     how records are held: which are live, room, numbers after ``compact``, copies
``State``       of one mesh: records, scratch, log, bounds, and what is pinned in memory
``Queries``     the nine queries, ``find_edge``, all edges, steps along half-edges
``Surveying``   borders, components, all triangles: of records and queries alone
``Attribute``   values of vertices, edges, faces, corners, half-edges
``Followers``   attributes and subscribers, which follow every edit
``Operations``  how an operation is checked, tried, given room and logged

``Navigable`` is a structure whose half-edges can be walked, ``PackedEdges`` one that names edges by
their vertices, ``MarkedEdges`` one whose half-edges move.
"""

from hem.authoring import ELEMENTS, OPERATIONS, QUERIES, REFERENCE_TYPES, Query
from hem.contract import arguments
from hem.contract.attributes import Attribute
from hem.contract.description import Algorithm, Claims, Described, Look
from hem.contract.navigation import STEPS, Navigable
from hem.contract.operations import Prepared
from hem.contract.packed import MarkedEdges, PackedEdges, PackedStorage
from hem.contract.queries import Sweep
from hem.contract.recording import (
    ANEW,
    BESIDE,
    CHECKED,
    COMPILED,
    PYTHON,
    Recording,
    is_edit,
    record,
)
from hem.contract.removal import Remaining, remaining
from hem.contract.storage import HANDLE_TYPES, Storage, UncompiledStorage
from hem.contract.structure import Structure
from hem.contract.surveying import centroids

__all__ = [
    "ANEW", "BESIDE", "CHECKED", "COMPILED", "ELEMENTS", "HANDLE_TYPES", "OPERATIONS", "PYTHON",
    "QUERIES", "REFERENCE_TYPES", "STEPS", "Algorithm", "Attribute", "Claims", "Described", "Look",
    "MarkedEdges", "Navigable", "PackedEdges", "PackedStorage", "Prepared", "Query", "Recording",
    "Remaining", "Storage", "Structure", "Sweep", "UncompiledStorage", "arguments", "centroids",
    "is_edit", "record", "remaining",
]  # fmt: skip
