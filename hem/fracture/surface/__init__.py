"""Breaking a surface, as in thesis 4.4: finding the face that is hit, and what comes off."""

from hem.fracture.surface.breaking import JUMP
from hem.fracture.surface.nearest import Found, nearest_face, scanned
from hem.fracture.surface.shatter import break_points, shatter

__all__ = ["JUMP", "Found", "break_points", "nearest_face", "scanned", "shatter"]
