"""Pictures and animations of a fracture."""
