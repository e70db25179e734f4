"""Where meshes come from: families of any size, models, files, and the cache of what was made."""

from hem.sources import meshlab
from hem.sources.cache import cache_folder
from hem.sources.families import FAMILIES, Family, generate
from hem.sources.files import as_mesh, encoded, load, load_polygons, save
from hem.sources.named import find_mesh
from hem.sources.samples import SAMPLES, Sample, sample
from hem.sources.valence import valence_hubs, valence_mesh

__all__ = [
    "FAMILIES", "SAMPLES", "Family", "Sample", "as_mesh", "cache_folder", "encoded", "find_mesh",
    "generate", "load", "load_polygons", "meshlab", "sample", "save", "valence_hubs",
    "valence_mesh",
]  # fmt: skip
