"""How long an OpenCTM file has to be: pymeshlab takes what is cut off of one for granted.

Source: Geelnard, The OpenCTM file format specification, version 5.
"""

import struct

_HEADER = 32
_GRID = 48  # of MG2: precisions, bounds and divisions
_COORDINATES, _CORNERS, _TEXTURE, _ATTRIBUTE = 12, 12, 8, 16  # bytes of RAW, each


def besides(data: bytes) -> list[str]:
    """What the file has beside points and faces, by its head."""
    _, _, textures, _, flags = struct.unpack_from("<5I", data, 12)
    found = {"texture coordinates": textures, "normals": flags & 1}
    return [name for name, count in found.items() if count]


def promised_bytes(data: bytes) -> int:
    """The bytes of the whole file that begins like this. struct.error where its head is cut."""
    method = data[8:12].rstrip(b"\0")
    vertices, faces, textures, attributes, flags = struct.unpack_from("<5I", data, 12)
    if textures + attributes > len(data):  # each takes some bytes
        raise struct.error("more maps than bytes")
    at = _after_text(data, _HEADER) + _GRID * (method == b"MG2")
    order = {b"RAW": "INDX VERT", b"MG1": "INDX VERT", b"MG2": "VERT GIDX INDX"}[method].split()
    sizes = {"INDX": _CORNERS * faces, "VERT": _COORDINATES * vertices}
    parts = [(sizes.get(name, 0), 0) for name in order]
    parts += [(_COORDINATES * vertices, 0)] * (flags & 1)  # normals
    parts += [(_TEXTURE * vertices, 2)] * textures + [(_ATTRIBUTE * vertices, 1)] * attributes
    for size, texts in parts:
        at += 4  # the name of the part
        for _ in range(texts):
            at = _after_text(data, at)
        if method == b"RAW":
            at += size
        else:
            at += 4 * (texts > 0 and method == b"MG2")  # a precision
            at += 9 + struct.unpack_from("<I", data, at)[0]  # packed: size, properties, bytes
    return at


def _after_text(data: bytes, at: int) -> int:
    return at + 4 + int(struct.unpack_from("<I", data, at)[0])
