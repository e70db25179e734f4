"""OpenMesh in C++, with its array kernel."""

from experiments.peers.program import peer

PEER = peer(
    "OpenMesh",
    "OpenMesh/Core/System/config.h",
    r"define OM_VERSION 0x(\w+)",
    "https://www.graphics.rwth-aachen.de/media/openmesh_static/Documentations/OpenMesh-Doc-Latest/",
    "Ranges such as `vf_range` around an element, `reserve` before adding, `is_collapse_ok` before "
    "`collapse`, and `garbage_collection` after it.",
    "Kernels and traits that say at compile time what an element records, so that a mesh takes no "
    "more than its program needs.",
)
