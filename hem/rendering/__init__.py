"""Flat arrays for a renderer that follow every edit of a structure."""

from hem.rendering.render import RenderMesh, Upload, mesh_from_render, split_at_seams

__all__ = ["RenderMesh", "Upload", "mesh_from_render", "split_at_seams"]
