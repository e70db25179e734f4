"""Why an operation is refused: a negative number to compiled code, words to the user."""

from __future__ import annotations

from enum import IntEnum

ALLOWED = 0
"""What a rule answers where nothing speaks against the operation."""

NEEDS_ROOM = -1
"""Not a refusal: there must be more room first, and then the operation is tried again."""


class Refusal(IntEnum):
    """The reasons, each with its ``words``; they are numbered from -2 downwards."""

    words: str

    def __new__(cls, words: str) -> Refusal:
        """Give the next reason the next number."""
        code = NEEDS_ROOM - 1 - len(cls.__members__)
        reason = int.__new__(cls, code)
        reason._value_, reason.words = code, words
        return reason

    NO_EDGE = "there is no such edge in this mesh (any more)"
    NO_FACE = "there is no such face in this mesh (any more)"
    NO_VERTEX = "there is no such vertex in this mesh (any more)"
    NOT_FINITE = "a position must be finite, and not too large for float32"
    CROWDED = (
        "the edge lies in more faces than a surface has there, or they run the same way along it; "
        "mend the mesh first (repair=True)"
    )
    NOT_TRIANGLES = "a face at the edge has more than three corners; split that face first"
    # split_edge, collapse_edge, flip_edge
    SAME_CORNER = "the two faces at the edge have the same three corners"
    # collapse_edge
    NOT_AN_END = "the vertex to keep is not an end of the edge"
    LONE_FACE = (
        "a face at the edge has its other two edges on the border, and would leave an edge without "
        "a face"
    )
    TWO_BORDERS = (
        "both ends lie on the border, but the edge does not, and the surface would be pinched in "
        "one vertex"
    )
    TETRAHEDRON = (
        "the faces at the edge belong to a tetrahedron, of which two coincident faces would be left"
    )
    COMMON_NEIGHBOR = (
        "the ends have a common neighbor that is no corner of a face at the edge, and two sheets "
        "of the surface would be glued together"
    )
    SHARED_FACE = (
        "both ends are corners of a face that does not lie at the edge, and would be pinched"
    )
    # flip_edge
    BORDER_EDGE = "the edge lies on the border, and there is no second face to turn it in"
    JOINED = "the opposite corners are joined by an edge already"
    # add_face and remove_face
    SAME_VERTEX = "a face has three different corners"
    TAKEN = "on that side of one of its edges lies a face already"
    COINCIDENT = "there is a face with these three corners already"
    SECOND_FAN = (
        "at a corner the face would share no edge with the faces that are there, and two fans "
        "would meet in one vertex"
    )
    BETWEEN = (
        "at a corner on the border the face lies between two others, and without it two fans "
        "would meet in one vertex"
    )
    # polygons
    OTHER_FACE = "the two half-edges do not lie in the same face"
    NEIGHBORS = "the two corners are one, or joined by a side of the face already"
    TOUCHING = "the faces meet at other corners, too, and the new one would come past them twice"
    OTHER_VERTEX = "the two half-edges are not different ones that leave the same vertex"
    BORDER_VERTEX = "the vertex lies on the border, or no face uses it"


WORDS = {int(reason): reason.words for reason in Refusal}
"""The words for the result of an operation that is refused."""
