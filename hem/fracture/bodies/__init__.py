"""Breaking a body: into tetrahedra or Voronoi cells."""
