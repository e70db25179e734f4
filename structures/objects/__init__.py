"""The thesis' class model, of which ``structures.half_edge_objects`` is made.

``class_model`` has its classes, and ``records`` holds them as the records of a structure.
"""
