"""Breaking through bodies: meshes with an inside, into tetrahedra or into Voronoi cells."""

from hem.fracture.bodies.solid import Body, require_body, wrapped
from hem.fracture.bodies.tetrahedra import tetrahedra
from hem.fracture.bodies.voronoi import voronoi

__all__ = ["Body", "require_body", "tetrahedra", "voronoi", "wrapped"]
