"""Where meshes come from: families, models, files, and the cache of what was made."""
