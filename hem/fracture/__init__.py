"""Breaking meshes: on their surface as the thesis does (4.4), and through bodies (its outlook)."""

from hem.fracture.blow import Blow, Motion, motion
from hem.fracture.islands import islands
from hem.fracture.material import MATERIALS, Material, material, materials
from hem.fracture.nearest import nearest_face, scanned
from hem.fracture.pieces import Fracture, Mass
from hem.fracture.solid import Body, require_body, wrapped
from hem.fracture.surface import shatter
from hem.fracture.tetrahedra import tetrahedra
from hem.fracture.voronoi import voronoi

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
