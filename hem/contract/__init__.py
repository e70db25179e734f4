"""What every structure offers, for whoever uses one or writes one.

``Structure`` is one class made of layers, each on top of the last:

``Described``    name, title, look and claims, for tables and plots
``Elements``     vertices, faces, positions
``Scratch``      where answers are written, and room for more elements
``Queryable``    the nine queries, ``find_edge``
``Surveying``    borders, components, all triangles
``Following``    what follows every edit: subscribers, values of vertices, edges, faces, corners
``Operating``    how an operation is checked, tried and logged
``Algorithms``   ``run``: algorithms of one's own over any structure
``Editable``     the operations, ``compact``
``Measuring``    what experiments time and count
``Structure``    build, validate, copy, memory
``Navigable``    a structure whose half-edges can be walked
"""

from hem.authoring import ELEMENTS, OPERATIONS, QUERIES, REFERENCE_TYPES, Query
from hem.contract import arguments
from hem.contract.attributes import Attribute
from hem.contract.description import Claims, Described, Look
from hem.contract.elements import HANDLE_TYPES
from hem.contract.measuring import Prepared, Sweep
from hem.contract.navigation import STEPS, Navigable
from hem.contract.operating import Algorithm
from hem.contract.packed import MarkedEdges, PackedEdges
from hem.contract.removal import Remaining, remaining
from hem.contract.structure import Structure

__all__ = [
    "ELEMENTS",
    "HANDLE_TYPES",
    "OPERATIONS",
    "QUERIES",
    "REFERENCE_TYPES",
    "STEPS",
    "Algorithm",
    "Attribute",
    "Claims",
    "Described",
    "Look",
    "MarkedEdges",
    "Navigable",
    "PackedEdges",
    "Prepared",
    "Query",
    "Remaining",
    "Structure",
    "Sweep",
    "arguments",
    "remaining",
]
