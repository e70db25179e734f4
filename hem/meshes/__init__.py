"""Meshes as plain arrays: triangles and polygons, manifoldness, welding and repair."""
