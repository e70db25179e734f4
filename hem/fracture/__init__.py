"""Breaking meshes: on their surface as the thesis does (4.4), and through bodies (its outlook).

`shatter`, `tetrahedra` and `voronoi` give a `Fracture`; `motion` says how its pieces fly, and
`save_pieces` and `describe` write it down. Pictures are in `hem.fracture.show`, asked for by name.
"""

from hem.fracture.blow import Blow, Motion, kinetic_energy, motion
from hem.fracture.bodies import Body, require_body, tetrahedra, voronoi, wrapped
from hem.fracture.files import describe, names, require_writable, save_pieces, whole
from hem.fracture.mass import Mass
from hem.fracture.material import MATERIALS, Material, material, materials
from hem.fracture.pieces import Fracture, islands
from hem.fracture.surface import JUMP, Found, nearest_face, scanned, shatter

__all__ = [
    "JUMP", "MATERIALS", "Blow", "Body", "Found", "Fracture", "Mass", "Material", "Motion",
    "describe", "islands", "kinetic_energy", "material", "materials", "motion", "names",
    "nearest_face", "require_body", "require_writable", "save_pieces", "scanned", "shatter",
    "tetrahedra", "voronoi", "whole", "wrapped",
]  # fmt: skip
