"""Breaking meshes: on their surface as the thesis does (4.4), and through bodies (its outlook)."""

from hem.fracture.blow import Blow, Motion, motion
from hem.fracture.bodies.solid import Body, require_body, wrapped
from hem.fracture.bodies.tetrahedra import tetrahedra
from hem.fracture.bodies.voronoi import voronoi
from hem.fracture.islands import islands
from hem.fracture.material import MATERIALS, Material, material, materials
from hem.fracture.pieces import Fracture, Mass
from hem.fracture.surface.nearest import nearest_face, scanned
from hem.fracture.surface.shatter import shatter

__all__ = [
    "MATERIALS",
    "Blow",
    "Body",
    "Fracture",
    "Mass",
    "Material",
    "Motion",
    "islands",
    "material",
    "materials",
    "motion",
    "nearest_face",
    "require_body",
    "scanned",
    "shatter",
    "tetrahedra",
    "voronoi",
    "wrapped",
]
