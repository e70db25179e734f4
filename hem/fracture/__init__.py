"""Breaking meshes: on their surface as the thesis does (4.4), and through bodies (its outlook)."""

from hem.fracture.material import MATERIALS, Material, material, materials
from hem.fracture.nearest import nearest_face, scanned
from hem.fracture.pieces import Fracture, Mass
from hem.fracture.surface import shatter

__all__ = [
    "MATERIALS",
    "Fracture",
    "Mass",
    "Material",
    "material",
    "materials",
    "nearest_face",
    "scanned",
    "shatter",
]
