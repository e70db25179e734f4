"""Breaking a surface, as in thesis 4.4: finding the face that is hit, and what comes off."""

from hem.fracture.surface.breaking import JUMP
from hem.fracture.surface.nearest import Found, closest, face_corners, nearest_face, scanned
from hem.fracture.surface.shatter import break_points, break_surface, in_place, shatter

__all__ = [
    "JUMP", "Found", "break_points", "break_surface", "closest", "face_corners", "in_place",
    "nearest_face", "scanned", "shatter",
]  # fmt: skip
