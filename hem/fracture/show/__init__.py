"""Pictures and animations of a fracture, drawn by PyVista; asked for by name, never by hem itself.

`Picture` draws any mesh off-screen, `FractureScene` the pieces of a fracture, and `flight` says
where they are while they fly; `default_impact` is where a camera sees a mesh struck. PyVista is
loaded when the first picture is drawn.
"""

from hem.fracture.show.flight import GRAVITY, Flight, flight
from hem.fracture.show.picture import (
    AXES,
    Image,
    Picture,
    Size,
    default_impact,
    load_pyvista,
    view_direction,
)
from hem.fracture.show.scene import FRAMES_PER_SECOND, FractureScene, save_animation

__all__ = [
    "AXES", "FRAMES_PER_SECOND", "GRAVITY", "Flight", "FractureScene", "Image", "Picture", "Size",
    "default_impact", "flight", "load_pyvista", "save_animation", "view_direction",
]  # fmt: skip
