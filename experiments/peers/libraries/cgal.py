"""CGAL's Surface_mesh, in C++."""

from experiments.peers.program import peer

PEER = peer(
    "CGAL",
    "CGAL/version.h",
    r"define CGAL_VERSION (\S+)",
    "https://doc.cgal.org/latest/Surface_mesh/",
    "Ranges such as `faces_around_target` around an element, `reserve` before adding, "
    "`CGAL::Euler` for operations after `does_satisfy_link_condition`.",
    "Exact arithmetic, and on it Booleans, remeshing, hulls, Delaunay triangulations and most of "
    "computational geometry; its algorithms take other meshes, too.",
)
